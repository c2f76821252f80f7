"""Draw the pictures of docs/pictures.md: every answer of a UR5, the families of a Panda, and what touches.

`python tools/draw_answers.py` writes them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import pinik

IMAGES = Path(__file__).parents[1] / "docs" / "images" / "answers"
SIZE = (900, 600)
FROM_THE_RIGHT, FROM_THE_LEFT = (-0.75, 0.3), (0.5, 0.35)
COLLIDING = 15  # the seed of a random configuration of the Panda in which it touches itself


def branches() -> pinik.Picture:
    """The eight answers of a UR5 whose hand points down."""
    ur5 = pinik.load("ur5")
    target = pinik.Target("tool0", position=[0.4, 0.25, 0.35], rpy=[np.pi, 0, 0.4])
    return pinik.draw(ur5, ur5.solve_all(target), balls=target.position, view=FROM_THE_RIGHT, size=SIZE)


def around() -> pinik.Picture:
    """The same answers above a table, into which two of them go."""
    ur5 = pinik.load("ur5")
    table = pinik.World()
    table.add_box("table", [1.0, 1.0, 0.04], [0.1, 0.0, -0.025])
    target = pinik.Target("tool0", position=[0.4, 0.25, 0.35], rpy=[np.pi, 0, 0.4])
    found = ur5.solve_all(target)
    return pinik.draw(ur5, found, world=table, collisions=True, balls=target.position, view=FROM_THE_RIGHT, size=SIZE)


def families() -> pinik.Picture:
    """Both families of the Panda's default pose."""
    panda = pinik.load("panda")
    q = panda.poses["default"]
    found = panda.solve_all("panda_hand_tcp", placement=panda.placement("panda_hand_tcp", q), q0=q)
    return pinik.draw(panda, found, view=FROM_THE_LEFT, size=SIZE)


def collisions() -> pinik.Picture:
    """A Panda that touches itself."""
    panda = pinik.load("panda")
    return pinik.draw(panda, panda.random(COLLIDING), collisions=True, size=SIZE)


def main() -> None:
    """Write all pictures."""
    IMAGES.mkdir(exist_ok=True)
    for picture in (branches, around, families, collisions):
        (IMAGES / f"{picture.__name__}.png").write_bytes(picture().png(colors=256))


if __name__ == "__main__":
    main()
