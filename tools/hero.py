"""Make docs/images/robots.png: the arm, the lion and the Panda reach for a ball each. `python tools/hero.py`"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image
from render import Matrix, Scene, render, turned

import pinik

OUT = Path(__file__).parents[1] / "docs" / "images" / "robots.png"
PANDA = {
    "panda_joint1": -0.25,
    "panda_joint2": -0.10,
    "panda_joint4": -1.95,
    "panda_joint6": 2.65,
    "panda_joint7": 0.6,
    "panda_finger_joint1": 0.034,
}


def ball_at(
    scene: Scene, robot: pinik.Robot, q: Matrix, frame: str, offset: list[float], radius: float, at: Matrix
) -> None:
    """A ball at a point of a frame."""
    point = robot.placement(frame, q).act(np.array(offset))
    scene.add_ball((at @ [*point, 1.0])[:3], radius)


def main() -> None:
    scene = Scene()
    arm, lion, panda = (pinik.load(name) for name in ("arm", "lion", "panda"))

    at = turned((-1.72, -0.60, 0.0), -12)
    scene.add_robot(arm, arm.poses["reach"], at)
    ball_at(scene, arm, arm.poses["reach"], "tip", [0, 0, 0.045], 0.045, at)

    reach = lion.poses["reach"]
    ground = min(
        lion.placement(f"{paw}_paw", reach).translation[2] for paw in ("right_fore", "left_hind", "right_hind")
    )
    at = turned((0.84, 0.35, -ground), 200)
    scene.add_robot(lion, reach, at)
    ball_at(scene, lion, reach, "pelvis", [1.47, 0.27, -0.10], 0.06, at)

    q = panda.configuration(PANDA)
    at = turned((1.90, -0.95, 0.0), -122)
    scene.add_robot(panda, q, at)
    ball_at(scene, panda, q, "panda_hand_tcp", [0, 0, 0], 0.032, at)

    render(
        scene, OUT, size=(1600, 800), scale=1.0, frames=80, fov=15.6,
        camera=(0.05, -8.4, 1.55), look_at=(0.08, 0.0, 0.58), ground=0.0, light=(-0.45, -0.75, 1.25),
    )  # fmt: skip
    Image.open(OUT).convert("RGB").save(OUT, optimize=True)


if __name__ == "__main__":
    main()
