"""Draw docs/images/targets/: each target of docs/targets.md, as the page's own Python asks for it and pinik answers.

`python tools/draw_targets.py [NAME ...]` writes the pictures of all kinds, or of some. Needs pinik[pictures,plots].
"""

from __future__ import annotations

import io
import json
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from marks import Marks, as_color
from matplotlib.font_manager import findfont
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont
from PIL.PngImagePlugin import PngInfo

import pinik
from pinik.picture.bodies import Body, bodies_of
from pinik.picture.camera import Camera, look_from
from pinik.picture.render import render

Array = NDArray[np.float64]

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "targets.md"
FOLDER = ROOT / "docs" / "images" / "targets"
SIZE = (640, 480)
INK = "#1d2733"
_LENS = float(np.tan(np.deg2rad(26.0) / 2))
_GHOST, _BEHIND = 0.3, 0.6  # opacity of the start; of marks that the robot hides
_FINE = 3  # the labels are drawn this many times as large, and shrunk


@dataclass(frozen=True)
class Label:
    """Words beside a named point of the picture, `dx` to the right and `dy` down [pixels].

    `{position}` [cm] and `{angle}` [degrees] stand for the answer's errors.
    """

    words: str
    at: str
    dx: float
    dy: float


@dataclass(frozen=True)
class View:
    """How a target is shown.

    Attributes:
        labels: What is written.
        azimuth: Of the camera as seen from the robot [degrees].
        elevation: The same.
        unit: Length of the axes that are drawn [m].
        near: The camera shows a ball of this radius [m]; the whole robot when None.
        aim: From the target to the ball's centre [m].
        ghost: Whether the start is shown.
    """

    labels: tuple[Label, ...]
    azimuth: float = -50.0
    elevation: float = 18.0
    unit: float = 0.2
    near: float | None = None
    aim: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ghost: bool = True

    @property
    def back(self) -> Array:
        """The unit vector (3,) from the robot to the camera."""
        azimuth, elevation = np.deg2rad([self.azimuth, self.elevation])
        flat = np.cos(elevation) * np.array([np.cos(azimuth), np.sin(azimuth)])
        return np.array([*flat, np.sin(elevation)])


VIEWS: Mapping[str, View] = {
    "position": View((Label("position", "goal", 60, -40), Label("start", "start", 60, 20)), unit=0.25),
    "pose": View((Label("position and rpy", "goal", 70, 60),), azimuth=-62),
    "axis": View((Label("axis z, along direction", "axis", -60, 10), Label("free", "spin", -60, -25)), azimuth=-62),
    "at": View((Label("at", "at", -50, -10), Label("axis z", "axis", 50, -30), Label("free", "spin", -30, 70))),
    "tool": View((Label("tool point", "goal", -70, 20), Label("frame", "frame", 60, -20)), azimuth=-35),
    "relative_to": View(
        (Label("relative_to: the head's axes", "reference", -130, -40), Label("position", "goal", -30, 110)),
        azimuth=-40,
        unit=0.3,
    ),
    "several": View(
        (Label("position, weight 1", "goal", -40, 70), Label("axis x at the ball,\nweight 0.5", "axis2", 88, -205)),
        unit=0.3,
    ),
    "free_axes": View((Label("z = 0.3, x and y free", "corner", -30, 30), Label("start", "start", 70, -10))),
    "wide_angle": View(
        (
            Label("target: within 20°", "rim", 10, 60),
            Label("answer: {angle:.0f}° off", "answer", 10, -90),
        ),
        azimuth=-60,
        elevation=45,
        unit=0.09,
        near=0.165,
        aim=(-0.02, 0.0, 0.01),
        ghost=False,
    ),
    "box": View(
        (
            Label("±5 cm along x, ±1 mm across", "end", 25, -80),
            Label("answer: {position:.1f} cm off", "answer", -90, 30),
        ),
        azimuth=-70,
        unit=0.07,
        near=0.135,
        aim=(0.0, 0.0, 0.035),
    ),
}


def answers() -> dict[str, tuple[pinik.Solution, Array]]:
    """The picture's name → the solution and the start of the section of the page that shows it."""
    found, names = {}, dict[str, Any]()
    for section in re.split(r"^## ", PAGE.read_text("utf-8"), flags=re.MULTILINE)[1:]:
        for code in re.findall(r"^```python\n(.*?)^```$", section, re.MULTILINE | re.DOTALL):
            exec(code, names)
        picture = re.search(r"\(images/targets/(\w+)\.png\)", section)
        assert picture, f"a section of {PAGE.name} has no picture"
        found[picture[1]] = (names["solution"], names["start"])
    return found


def description(name: str, solution: pinik.Solution) -> str:
    """What a picture shows, as text that is kept in its file: a test finds pictures that are out of date."""
    exact = json.dumps([target.to_dict() for target in solution.targets])
    rounded = json.loads(exact, parse_float=lambda text: round(float(text), 6) + 0.0)
    return f"{rounded} {VIEWS[name]}"


def drawn(name: str, solution: pinik.Solution, start: Array) -> bytes:
    """The picture as a PNG file."""
    robot, view = solution.robot, VIEWS[name]
    assert isinstance(robot, pinik.Robot)
    marks = Marks(view.unit, view.back)
    for target in solution.targets:
        marks.add(robot, target, solution.q)
    marks.points["start"] = robot.placement(solution.targets[0].frame, start).translation
    solid = bodies_of(robot, solution.q)
    ghost = []
    if view.ghost:
        ghost = [Body(b.solid, 0.3 * b.color + 0.7 * as_color("#7f9dbb"), _GHOST) for b in bodies_of(robot, start)]
    camera = _camera(view, marks, [*solid, *ghost, *marks.solid])
    floor = min(float(body.solid.vertices[:, 2].min()) for body in solid)
    image = Image.fromarray(render([solid], camera, SIZE, floor, np.ones(3)))
    for layers, share in (
        ([[*solid, *marks.solid], *([ghost] if ghost else []), *marks.translucent()], 1.0),
        ([marks.solid], _BEHIND),
    ):
        over = Image.fromarray(render(layers, camera, SIZE, None, None))
        over.putalpha(over.getchannel("A").point(lambda a, share=share: round(share * a)))
        image = Image.alpha_composite(image, over)
    file = io.BytesIO()
    position, angle = solution.position_error or 0.0, solution.orientation_error or 0.0
    errors = {"position": 100.0 * position, "angle": float(np.rad2deg(angle))}
    labels = [replace(label, words=label.words.format(**errors)) for label in view.labels]
    written = _written(image, camera, labels, marks.points).convert("RGB")
    note = PngInfo()
    note.add_itxt("Description", description(name, solution))
    written.point(lambda value: value | 1).save(file, "png", optimize=True, pnginfo=note)  # 7 bits make smaller files
    return file.getvalue()


def _camera(view: View, marks: Marks, bodies: list[Body]) -> Camera:
    points = np.vstack([body.solid.vertices for body in bodies])
    if view.near is not None:
        corners = np.array(list(np.ndindex(2, 2, 2))) * 2.0 - 1.0
        points = marks.points["goal"] + view.aim + view.near / np.sqrt(3.0) * corners
    return look_from(view.back, points, aspect=SIZE[0] / SIZE[1], lens=_LENS, filled=0.82)


def _written(image: Image.Image, camera: Camera, labels: Sequence[Label], points: Mapping[str, Array]) -> Image.Image:
    """The picture with its labels, each with a line to its point."""
    paper = Image.new("RGBA", (SIZE[0] * _FINE, SIZE[1] * _FINE))
    pen, font = ImageDraw.Draw(paper), ImageFont.truetype(findfont("DejaVu Sans"), 17 * _FINE)
    for label in labels:
        x, y, ahead = camera.seen(points[label.at], SIZE)
        x, y = float(x / ahead), float(y / ahead)
        end = (x + label.dx, y + label.dy)
        near = 9.0 / float(np.hypot(label.dx, label.dy))
        line = [_FINE * c for c in (x + near * label.dx, y + near * label.dy, *end)]
        anchor = "lm" if label.dx > 0 else "rm"
        if abs(label.dx) < 0.5 * abs(label.dy):
            anchor = "ma" if label.dy > 0 else "md"
        for width, color in ((5, "#ffffffc0"), (1.4, INK)):
            pen.line(line, color, round(width * _FINE))
        pad = {"l": 5, "r": -5, "m": 0}[anchor[0]], {"a": 3, "d": -3, "m": 0}[anchor[1]]
        at = (_FINE * (end[0] + pad[0]), _FINE * (end[1] + pad[1]))
        pen.text(at, label.words, INK, font, anchor, align="center", stroke_width=3 * _FINE, stroke_fill="#ffffffe0")
    return Image.alpha_composite(image, paper.resize(SIZE, Image.Resampling.LANCZOS))


def main(names: list[str]) -> None:
    FOLDER.mkdir(exist_ok=True)
    for name, (solution, start) in answers().items():
        if not names or name in names:
            (FOLDER / f"{name}.png").write_bytes(drawn(name, solution, start))


if __name__ == "__main__":
    main(sys.argv[1:])
