"""`draw`: a robot, at one configuration or several, as a picture."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_length
from ..errors import InputError
from ..model.home import robot_size
from ..robot import Robot
from ..shapes.world import World
from .arguments import (
    as_any_points,
    as_color,
    as_colors,
    as_offsets,
    as_opacities,
    checked_size,
    view_direction,
)
from .bodies import Body, bodies_of
from .camera import Camera, look_from
from .obstacles import obstacles_of
from .picture import Picture
from .poses import Answer, Drawable, Pose, links_of, poses_of, whose
from .render import render
from .solids import ball

__all__ = ["BALL", "PINNED", "ball_radius", "draw"]

Array = NDArray[np.float64]

BALL, PINNED = "#d81f2f", "#3c4654"  # the colours of balls, and of those that no motion moves
_TINT = 0.75  # the share of a tint in a colour
_TOUCHING, _RED = np.array([0.87, 0.04, 0.07]), 0.93  # the tint of links that touch something, and its share
_LENS = float(np.tan(np.deg2rad(26.0) / 2))
_FILLED = 0.86
_SOLID = (-1, 1.0)  # the layer of all that is opaque


def draw(
    robot: Robot | Answer,
    q: Drawable | None = None,
    *,
    balls: ArrayLike = (),
    ball_color: str | Sequence[str] = BALL,
    ball_radius: float | None = None,
    opacity: ArrayLike | None = None,
    color: str | Sequence[str] | None = None,
    offset: ArrayLike = (0.0, 0.0, 0.0),
    collisions: bool = False,
    world: World | None = None,
    view: str | tuple[float, float] | Camera = "angle",
    size: tuple[int, int] = (800, 500),
    ground: bool | float = True,
    background: str | None = "#ffffff",
) -> Picture:
    """Draw a robot with its own shapes, at one or several configurations in one picture.

    A robot without shapes is drawn as a skeleton. Drawing takes a fraction of a second, and about as much for several
    ghosts; reading the meshes of a large robot adds a second or two the first time.

    Args:
        robot: The robot. An answer that knows its own, such as `Branches`, may be given alone: `draw(branches)`.
        q: One configuration (nq,) or several (n, nq); the robot's rest configuration when None. Or an answer: a
            `Solution`; `Branches`, of which the first is solid and the others are ghosts, each in its own tint; a
            `SelfMotion`, as a fan of ghosts that fade with the way from its solid start; or several of them, such as
            the families of `Branches`, each in its own tint. `Branches` that are infinitely many are drawn as their
            families, or as 12 ghosts. Or a `Track`, whose end is solid, with up to 12 ghosts on the way.
        balls: Points (3,) or (k, 3) [m] to mark with a ball, such as targets.
        ball_color: "#rrggbb", for all balls or for each.
        ball_radius: [m]; in proportion to the robot when None.
        opacity: In 0..1, for all configurations or for each (n,); those below 1 look like ghosts. Of configurations 1,
            and of answers as said above, when None.
        color: "#rrggbb" that tints the robot, or one for each configuration; as said above when None.
        offset: (3,) [m] from each configuration to the next, or one position for each (n, 3).
        collisions: Whether to draw in red the links that touch another one, or an object of `world`, as
            `robot.collisions` finds them at each configuration. Those of a `Solution` that was to avoid them are red in
            any case.
        world: What stands around the robot, which is drawn as well.
        view: "angle", "front", "side" or "top"; the azimuth and elevation [rad] of the camera as seen from the robot;
            or the `camera` of another picture.
        size: Width and height [pixels], each 16 to 4000, with at most 10 million pixels in all.
        ground: Whether to draw a ground under the robot's lowest point, or the height of the ground [m].
        background: "#rrggbb", or None for a transparent background.

    Raises:
        UnknownNameError: There is no such view.
        InputError: Another argument has the wrong shape, type or range.
        MissingExtraError: The packages of pinik[pictures] are not installed.

    Warns:
        UrdfWarning: Some shapes could not be read and are left out.
    """
    robot, q = whose(robot, q)
    size = checked_size(size)
    if world is not None and not isinstance(world, World):
        raise InputError(f"must be a pinik.World; got {world!r}", argument="world")
    poses = poses_of(robot, q)
    if collisions:
        poses = [replace(pose, touching=links_of(robot.collisions(pose.q, world))) for pose in poses]
    shown = _shown(poses, opacity, offset, color)
    paper = None if background is None else as_color(background, "background")
    spheres = _spheres(balls, ball_color, _radius(robot, ball_radius))
    layers = _layers(robot, shown)
    if world is not None:
        layers.setdefault(_SOLID, []).extend(obstacles_of(world))
    standing = _vertices(layers.values())
    if spheres:
        layers.setdefault(_SOLID, []).extend(spheres)
    if not layers:
        raise InputError("there is nothing to draw: every configuration has an opacity of 0, and there is no ball")
    everything = _vertices(layers.values())
    camera = _camera(view, everything, size)
    floor = _floor(ground, standing if len(standing) else everything)
    return Picture(render(list(layers.values()), camera, size, floor, paper), camera)


def ball_radius(robot: Robot) -> float:
    """The radius [m] of the balls drawn beside a robot, the same as in the live view."""
    return 0.025 * robot_size(robot)


@dataclass(frozen=True, eq=False)
class _Placed:
    """A pose, and where it stands (3,) [m]."""

    pose: Pose
    offset: Array


def _shown(
    poses: list[Pose], opacity: ArrayLike | None, offset: ArrayLike, color: str | Sequence[str] | None
) -> list[_Placed]:
    if opacity is not None:
        shares = as_opacities(opacity, len(poses))
        poses = [replace(pose, opacity=share, ghost=False) for pose, share in zip(poses, shares, strict=True)]
    if color is not None:
        tints = as_colors(color, len(poses), "color", "configurations")
        poses = [replace(pose, tint=tint) for pose, tint in zip(poses, tints, strict=True)]
    return [_Placed(*one) for one in zip(poses, as_offsets(offset, len(poses)), strict=True)]


def _spheres(balls: ArrayLike, color: str | Sequence[str], radius: float) -> list[Body]:
    points = as_any_points(balls, "balls")
    colors = as_colors(color, len(points), "ball_color", "balls")
    return [Body(ball(at, radius), tone, gloss=0.6, glow=0.4) for at, tone in zip(points, colors, strict=True)]


def _layers(robot: Robot, shown: Sequence[_Placed]) -> dict[tuple[int, float], list[Body]]:
    """The visible bodies: one layer for all opaque ones, and one for each opacity of each configuration."""
    layers: dict[tuple[int, float], list[Body]] = {}
    for k, one in enumerate(shown):
        for body in bodies_of(robot, one.pose.q):
            placed = _placed(body, one)
            if placed.opacity > 0.0:
                solid = placed.opacity >= 1.0 and not placed.ghost
                layers.setdefault(_SOLID if solid else (k, placed.opacity), []).append(placed)
    return layers


def _placed(body: Body, one: _Placed) -> Body:
    tint, share = (_TOUCHING, _RED) if body.link in one.pose.touching else (one.pose.tint, _TINT)
    color = body.color if tint is None else (1.0 - share) * body.color + share * tint
    solid = body.solid.moved(np.eye(3), one.offset)
    return replace(body, solid=solid, color=color, opacity=body.opacity * one.pose.opacity, ghost=one.pose.ghost)


def _vertices(layers: Iterable[Sequence[Body]]) -> Array:
    """Every vertex (n, 3) [m]."""
    return np.vstack([np.zeros((0, 3)), *(body.solid.vertices for layer in layers for body in layer)])


def _radius(robot: Robot, given: float | None) -> float:
    radius = ball_radius(robot) if given is None else as_length(given, "ball_radius")
    if not radius > 0.0:
        raise InputError(f"ball_radius must be greater than 0 m; got {given!r}")
    return radius


def _camera(view: str | tuple[float, float] | Camera, points: Array, size: tuple[int, int]) -> Camera:
    if isinstance(view, Camera):
        return view
    return look_from(view_direction(view), points, aspect=size[0] / size[1], lens=_LENS, filled=_FILLED)


def _floor(ground: bool | float, standing: Array) -> float | None:
    """The height of the ground [m], if there is one."""
    if not isinstance(ground, (bool, np.bool_)):
        return as_length(ground, "ground")
    return float(standing[:, 2].min()) if ground else None
