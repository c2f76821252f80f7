"""Pictures of robots without a browser or a server: `draw`."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_length
from ..errors import InputError
from ..extras import needed_by
from ..model.home import robot_size
from ..robot import Robot
from .arguments import (
    SMALLEST,
    as_any_points,
    as_color,
    as_colors,
    as_configurations,
    as_offsets,
    as_opacities,
    checked_size,
    depth_of,
    view_direction,
)
from .bodies import Body, bodies_of
from .camera import Camera, look_from
from .render import render
from .solids import ball

if TYPE_CHECKING:
    from PIL.Image import Image

__all__ = ["BALL", "Picture", "ball_radius", "draw"]

Array = NDArray[np.float64]

BALL = "#d81f2f"
_TINT = 0.75
_LENS = float(np.tan(np.deg2rad(26.0) / 2))
_FILLED = 0.86
_WITH_OPACITY = ("AVIF", "DDS", "ICNS", "ICO", "JPEG2000", "PNG", "QOI", "SGI", "TGA", "TIFF", "WEBP")


@dataclass(frozen=True, eq=False)
class Picture:
    """A drawn picture. A notebook shows it as it is; for matplotlib it is `axes.imshow(picture.pixels)`.

    Attributes:
        pixels: Red, green, blue, opacity (h, w, 4), 0..255.
        camera: From where it was drawn; `draw(..., view=picture.camera)` draws another from there.
    """

    pixels: NDArray[np.uint8]
    camera: Camera

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [pixels]."""
        height, width = self.pixels.shape[:2]
        return width, height

    def project(self, points: ArrayLike) -> Array:
        """Where points of the robot's world are seen, for labels.

        Args:
            points: (3,) or (n, 3) [m].

        Returns:
            Pixels from the left and from the top (2,) or (n, 2), as `axes.imshow` counts them; NaN for a point behind
            the camera.
        """
        single = depth_of(points) == 1
        x, y, depth = self.camera.seen(as_any_points(points, "points"), self.size).T
        depth = np.where(depth > 0.0, depth, np.nan)
        found = np.stack([x / depth, y / depth], axis=1) - 0.5
        return np.asarray(found[0] if single else found)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it to a file, in the format of its name's end, such as .png or .jpg.

        In a format that knows no opacity it stands on white.

        Raises:
            InputError: The name ends in nothing that Pillow can write.
            OSError: There the file cannot be written.
        """
        with needed_by("a picture's file", "pictures"):
            from PIL import Image

        if not isinstance(path, (str, os.PathLike)) or not isinstance(os.fspath(path), str):
            raise InputError(f"path is a file's name, such as 'robot.png'; got {path!r}")
        kind = Image.registered_extensions().get(Path(path).suffix.lower(), "")
        image = Image.fromarray(self.pixels)
        if kind not in _WITH_OPACITY:
            image = Image.alpha_composite(Image.new("RGBA", image.size, "white"), image).convert("RGB")
        if not _is_written(image, kind):
            raise InputError(
                f"a picture's file ends in .png, .jpg or another format that Pillow writes; got {os.fspath(path)!r}"
            )
        image.save(path)

    def png(self, colors: int | None = None) -> bytes:
        """It as the bytes of a PNG file; with at most so many `colors`, 2 to 256, it takes half the space."""
        with needed_by("a picture's file", "pictures"):
            from PIL import Image

        opaque = bool((self.pixels[..., 3] == 255).all())
        image = Image.fromarray(self.pixels[..., :3] if opaque else self.pixels)
        if colors is not None:
            if type(colors) is not int or not 2 <= colors <= 256:
                raise InputError(f"a PNG has 2 to 256 colors, or all when None; got {colors!r}")
            image = image.quantize(colors, Image.Quantize.MEDIANCUT if opaque else Image.Quantize.FASTOCTREE)
        file = io.BytesIO()
        image.save(file, "png", optimize=True)
        return file.getvalue()

    def _repr_png_(self) -> bytes:
        """What a notebook shows."""
        return self.png()

    def __repr__(self) -> str:
        return f"<Picture of {self.size[0]}×{self.size[1]} pixels>"


def draw(
    robot: Robot,
    q: ArrayLike | None = None,
    *,
    balls: ArrayLike = (),
    ball_color: str | Sequence[str] = BALL,
    ball_radius: float | None = None,
    opacity: ArrayLike = 1.0,
    color: str | Sequence[str] | None = None,
    offset: ArrayLike = (0.0, 0.0, 0.0),
    view: str | tuple[float, float] | Camera = "angle",
    size: tuple[int, int] = (800, 500),
    ground: bool | float = True,
    background: str | None = "#ffffff",
) -> Picture:
    """Draw a robot with its own shapes, at one configuration or at several in one picture.

    A robot without shapes is drawn as a skeleton. It takes a fraction of a second, and for a robot with many meshes a
    second or two more the first time.

    Args:
        robot: The robot.
        q: A configuration (nq,), or several (n, nq); where the robot rests when None.
        balls: Points (3,) or (k, 3) [m] at which a ball is drawn, such as targets.
        ball_color: "#rrggbb", of all balls or of each.
        ball_radius: [m]; in proportion to the robot when None.
        opacity: In 0..1, of all configurations or of each (n,); those under 1 are ghosts.
        color: Tints the robot, "#rrggbb", or each configuration.
        offset: (3,) [m] by which each configuration stands beside the one before, or one for each (n, 3).
        view: "angle", "front", "side" or "top"; the azimuth and elevation [rad] of the camera as seen from the robot;
            or another picture's `camera`.
        size: Width and height [pixels], 16 to 4000 each and 10 million in all.
        ground: Whether it stands on a ground, which lies under the lowest point of the robot, or at this height [m].
        background: "#rrggbb", or None for a transparent one.

    Raises:
        UnknownNameError: No such view.
        InputError: Something else that is not as above.
        MissingExtraError: The packages of pinik[pictures] are not installed.

    Warns:
        UrdfWarning: Shapes that could not be read are left out.
    """
    if not isinstance(robot, Robot):
        raise InputError(f"a picture is drawn of a robot that pinik.load returned; got {robot!r}")
    size = checked_size(size)
    configurations = as_configurations(robot, q)
    count = len(configurations)
    opacities, offsets = as_opacities(opacity, count), as_offsets(offset, count)
    tints = [None] * count if color is None else as_colors(color, count, "color", "configurations")
    paper = None if background is None else as_color(background, "background")
    radius = _radius(robot, ball_radius)
    points = as_any_points(balls, "balls")
    tones = as_colors(ball_color, len(points), "ball_color", "balls")
    layers: dict[tuple[int, float], list[Body]] = {}
    for k, (one, share, tint) in enumerate(zip(configurations, opacities, tints, strict=True)):
        for body in bodies_of(robot, one):
            shown = _placed(body, offsets[k], share, tint)
            if shown.opacity > 0.0:
                layers.setdefault((-1 if shown.opacity >= 1.0 else k, shown.opacity), []).append(shown)
    robots = [body.solid.vertices for layer in layers.values() for body in layer]
    if points.size:
        spheres = [Body(ball(at, radius), tone, gloss=0.6, glow=0.4) for at, tone in zip(points, tones, strict=True)]
        layers.setdefault((-1, 1.0), []).extend(spheres)
    if not layers:
        raise InputError("there is nothing to draw: no configuration with an opacity over zero, and no ball")
    everything = np.vstack([body.solid.vertices for layer in layers.values() for body in layer])
    camera = _camera(view, everything, size)
    if isinstance(ground, (bool, np.bool_)):
        floor = float(np.vstack(robots or [everything])[:, 2].min()) if ground else None
    else:
        floor = as_length(ground, "ground")
    return Picture(render(list(layers.values()), camera, size, floor, paper), camera)


def ball_radius(robot: Robot) -> float:
    """Of the balls that are drawn beside a robot [m], as in the live view."""
    return 0.025 * robot_size(robot)


def _is_written(image: Image, kind: str) -> bool:
    """Whether Pillow writes this format, found out by a corner of the picture."""
    try:
        image.crop((0, 0, SMALLEST, SMALLEST)).save(io.BytesIO(), kind)
    except (KeyError, OSError, ValueError):
        return False
    return True


def _radius(robot: Robot, given: float | None) -> float:
    radius = ball_radius(robot) if given is None else as_length(given, "ball_radius")
    if not radius > 0.0:
        raise InputError(f"ball_radius is greater than zero [m]; got {given!r}")
    return radius


def _placed(body: Body, offset: Array, opacity: float, tint: Array | None) -> Body:
    color = body.color if tint is None else (1.0 - _TINT) * body.color + _TINT * tint
    solid = body.solid.moved(np.eye(3), offset)
    return replace(body, solid=solid, color=color, opacity=body.opacity * opacity)


def _camera(view: str | tuple[float, float] | Camera, points: Array, size: tuple[int, int]) -> Camera:
    if isinstance(view, Camera):
        return view
    return look_from(view_direction(view), points, aspect=size[0] / size[1], lens=_LENS, filled=_FILLED)
