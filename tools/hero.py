"""Render docs/images/robots.png, the arm, the lion and the Panda reaching for balls: `python tools/hero.py`"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image
from render import Matrix, Scene, render, turned

import pinik

OUT = Path(__file__).parents[1] / "docs" / "images" / "robots.png"
SIZE = (1600, 800)
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
    """Add a ball at a point given in a frame."""
    point = robot.placement(frame, q).act(np.array(offset))
    scene.add_ball((at @ [*point, 1.0])[:3], radius)


def main(scale: float = 1.0, frames: int = 160) -> None:
    scene = Scene()
    arm, lion, panda = (pinik.load(name) for name in ("arm", "lion", "panda"))

    at = turned((-1.50, -1.70, 0.0), -2)
    scene.add_robot(arm, arm.poses["reach"], at)
    ball_at(scene, arm, arm.poses["reach"], "tip", [0, 0, 0], 0.040, at)

    reach = lion.poses["reach"]
    ground = min(
        lion.placement(f"{paw}_paw", reach).translation[2] for paw in ("right_fore", "left_hind", "right_hind")
    )
    at = turned((0.68, 0.75, -ground), 207)
    scene.add_robot(lion, reach, at)
    ball_at(scene, lion, reach, "pelvis", [1.47, 0.27, -0.10], 0.06, at)

    q = panda.configuration(PANDA)
    at = turned((1.50, -1.60, 0.0), -112)
    scene.add_robot(panda, q, at)
    ball_at(scene, panda, q, "panda_hand_tcp", [0, 0, 0], 0.032, at)

    width, height = SIZE
    render(
        scene, OUT, size=(round(scale * width), round(scale * height)), frames=frames, fov=15.6,
        camera=(0.05, -8.4, 1.55), look_at=(0.05, 0.0, 0.56), ground=0.0, light=(-0.2, -0.75, 1.3),
    )  # fmt: skip
    Image.open(OUT).convert("RGB").save(OUT, optimize=True)


if __name__ == "__main__":
    main()
