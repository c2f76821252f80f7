"""Draw docs/images/solve.svg: the way of a target through `solve`. `python tools/draw_solve.py` writes it."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from pathlib import Path

from svg import BLUE, FAINT, GREEN, ORANGE, PINK, Drawing, tint

PICTURE = Path(__file__).parents[1] / "docs" / "images" / "solve.svg"


@dataclass(frozen=True)
class Stop:
    """A box: what happens there, and in which module."""

    title: str
    words: tuple[str, ...]
    module: str
    x: float
    y: float
    w: float
    color: str
    h: float = 112

    @property
    def middle(self) -> float:
        return self.y + self.h / 2

    @property
    def right(self) -> float:
        return self.x + self.w


QUESTION = (
    Stop("Front", ("takes a frame's name", "and keywords, or Targets"), "solving/front", 24, 90, 196, BLUE),
    Stop("Options", ("every option, checked", "once; immutable"), "solving/options", 256, 90, 196, BLUE),
    Stop("Kept question", ("targets compiled for this", "robot; kept and reused"), "solving/kept", 488, 90, 196, BLUE),
)
ENGINES = (24, 262, 892, 196)
NATIVE = Stop("C++", ("the same algorithm, file", "by file, for all cores"), "src/native", 44, 306, 176, GREEN, 130)
PYTHON = (
    Stop("Attempts", ("restarts, and the", "best one so far"), "solving/attempts", 280, 306, 140, GREEN, 130),
    Stop("Run", ("one loop from one", "start: limits, stalls"), "solving/run", 440, 306, 140, GREEN, 130),
    Stop("Step", ("clamped, scaled,", "along the limits"), "solving/stepping", 600, 306, 140, GREEN, 130),
    Stop("direction(J, e)", ("or CCD's sweep:", "the method itself"), "solvers/", 760, 306, 140, GREEN, 130),
)
ANSWER = (
    Stop("Certifier", ("plain Pinocchio measures", "q again from scratch"), "solving/verdict", 24, 510, 196, ORANGE),
    Stop("Verdict", ("errors against tolerances:", "one status"), "solving/verdict", 256, 510, 196, ORANGE),
    Stop("Solution", ("q, angles, errors, why", "it stopped"), "solving/solution", 488, 510, 196, PINK),
    Stop("Message", ("one sentence, written", "when somebody reads it"), "solving/message", 720, 510, 196, PINK),
)


def drawing() -> Drawing:
    picture = Drawing(940, 650, "The way of a target through solve")
    picture.text(24, 36, "A target's way through solve", size=18, bold=True)
    picture.text(24, 58, 'robot.solve("tip", position=[0.6, 0.3, 0.7])', size=13, color=FAINT, mono=True)
    x, y, w, h = ENGINES
    picture.box(x, y, w, h, fill=tint(GREEN, 0.06), edge=tint(GREEN, 0.4), round_=8)
    picture.text(44, y + 26, "Engine: compiled", size=13, bold=True)
    picture.text(280, y + 26, "or Python, the definition that the compiled one follows", size=13, bold=True)
    picture.line([(250, y + 14), (250, y + h - 14)], tint(GREEN, 0.4), dashed=True)
    for stop in (*QUESTION, NATIVE, *PYTHON, *ANSWER):
        show(picture, stop)
    for row in (QUESTION, PYTHON, ANSWER):
        for before, after in itertools.pairwise(row):
            picture.line([(before.right + 3, before.middle), (after.x - 4, after.middle)], FAINT, arrow=True)
    kept, certifier = QUESTION[-1], ANSWER[0]
    turn = kept.x + kept.w / 2
    picture.line([(turn, kept.y + kept.h + 3), (turn, y - 4)], FAINT, arrow=True)
    picture.line(
        [(certifier.x + certifier.w / 2, y + h + 3), (certifier.x + certifier.w / 2, certifier.y - 4)],
        FAINT,
        arrow=True,
    )
    picture.text(turn + 12, y - 22, "targets and options as numbers", size=12, color=FAINT)
    picture.text(
        certifier.x + certifier.w / 2 + 12,
        certifier.y - 22,
        "the best q found, inside the limits",
        size=12,
        color=FAINT,
    )
    return picture


def show(picture: Drawing, stop: Stop) -> None:
    picture.box(stop.x, stop.y, stop.w, stop.h, fill="#ffffff", edge=tint(stop.color, 0.55), round_=6)
    picture.box(stop.x, stop.y, stop.w, 6, fill=stop.color, round_=3)
    picture.text(stop.x + 14, stop.y + 33, stop.title, size=15, bold=True)
    for k, line in enumerate(stop.words):
        picture.text(stop.x + 14, stop.y + 55 + 17 * k, line, size=12.5)
    picture.text(stop.x + 14, stop.y + stop.h - 13, stop.module, size=11, color=FAINT, mono=True)


if __name__ == "__main__":
    PICTURE.write_text(str(drawing()), "utf-8")
