"""Pictures of maps: the robot in what it can reach, cut open."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, UnknownNameError
from ..picture.arguments import as_color, checked_size, view_direction
from ..picture.bodies import Body, bodies_of
from ..picture.camera import look_from
from ..picture.picture import Picture
from ..picture.render import render
from ..picture.solids import Solid
from ..robot import Robot
from .colors import colors_of
from .pose import shown_configuration
from .voxel_map import VoxelMap, Workspace

__all__ = ["CUTS", "QUANTITIES", "draw_map", "quantity_of"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CUTS = ("quarter", "half", "none")
"""How a map is cut open towards the camera."""

QUANTITIES = ("share", "manipulability", "room", "branches")
"""What colours can stand for."""

_SHADES = 48
_LENS = float(np.tan(np.deg2rad(24.0) / 2))
_FILLED = 0.92
_BEYOND = 0.06  # a cut goes so far past the middle, as a share of the width, so that the robot stands clear

# For each axis, the corners of a cell's face on its upper side, seen from outside, in halves of an edge.
_FACES = (
    ((1, -1, -1), (1, 1, -1), (1, 1, 1), (1, -1, 1)),
    ((-1, 1, -1), (-1, 1, 1), (1, 1, 1), (1, 1, -1)),
    ((-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)),
)


def quantity_of(reach: VoxelMap, quantity: str) -> tuple[Array, float]:
    """(a quantity of each cell, of the grid's shape; the value to which the last colour belongs).

    Raises:
        UnknownNameError: There is no such quantity.
        InputError: The map does not have it.
    """
    if quantity not in QUANTITIES:
        raise UnknownNameError("quantity", quantity, QUANTITIES)
    values: Array = getattr(reach, quantity)
    return values, float(np.nanmax(values, initial=0.0)) or 1.0


def draw_map(
    reach: VoxelMap,
    robot: Robot | None = None,
    *,
    quantity: str = "share",
    workspace: Workspace = "any",
    cut: str = "quarter",
    q: Array | None = None,
    view: str | tuple[float, float] = "angle",
    size: tuple[int, int] = (900, 700),
    ground: bool = False,
    background: str | None = "#ffffff",
) -> Picture:
    """Draw the robot in what it can reach.

    Args:
        reach: The map.
        robot: The robot; that of the map when None.
        quantity: What the colours stand for: "share", "manipulability", "room" or "branches", from 0 to the largest.
        workspace: The workspace to draw, as for `ReachMap.workspace`.
        cut: "quarter" removes the quarter that faces the camera, "half" the half, and "none" nothing.
        q: The robot's configuration (nq,); when None, its rest configuration, or another if that would hide the frame.
        view: "angle", "front", "side" or "top"; or the azimuth and elevation [rad] of the camera.
        size: Width and height [pixels].
        ground: Whether to draw a ground below the robot and the map.
        background: "#rrggbb", or None for a transparent background.

    Raises:
        UnknownNameError: There is no such quantity, workspace, cut or view.
        InputError: The workspace is empty, or the robot is missing.
        MissingExtraError: The packages of pinik[pictures] are not installed.
    """
    if cut not in CUTS:
        raise UnknownNameError("cut", cut, CUTS)
    machine = reach.require_robot(robot, "a picture of a map")
    size = checked_size(size)
    shown = reach.workspace(workspace)
    if not shown.any():
        raise InputError(f"the workspace {workspace!r} is empty, so there is nothing to draw")
    direction = view_direction(view)
    pose = shown_configuration(reach, machine, direction) if q is None else machine.check_configuration(q)
    values, largest = quantity_of(reach, quantity)
    robot_bodies = bodies_of(machine, pose)
    cells = list(_cells(reach, shown & ~_removed(reach, cut, direction), values / largest))
    if reach.relative_to is not None:
        at = machine.placement(reach.relative_to, pose)
        cells = [Body(body.solid.moved(at.rotation, at.translation), body.color, glow=body.glow) for body in cells]
    points = np.vstack([body.solid.vertices for body in (*robot_bodies, *cells)])
    camera = look_from(direction, points, aspect=size[0] / size[1], lens=_LENS, filled=_FILLED)
    floor = float(points[:, 2].min()) if ground else None
    paper = None if background is None else as_color(background, "background")
    return Picture(render([[*robot_bodies, *cells]], camera, size, floor, paper), camera)


def _removed(reach: VoxelMap, cut: str, direction: Array) -> Mask:
    """The cells that are cut away: those that are nearer to the camera than the middle, in x and y."""
    removed = np.zeros(reach.grid.shape, dtype=bool)
    if cut == "none":
        return removed
    middles = [0.5 * (axis[0] + axis[-1]) for axis in reach.grid.axes]
    nearer = [
        (axis - middle) * np.sign(way) > -_BEYOND * np.ptp(axis) - 1e-9 * reach.grid.size
        for axis, middle, way in zip(reach.grid.axes[:2], middles[:2], direction[:2], strict=True)
    ]
    if cut == "half":
        facing = int(np.argmax(np.abs(direction[:2])))
        removed[(nearer[0], slice(None)) if facing == 0 else (slice(None), nearer[1])] = True
    else:
        removed |= nearer[0][:, None, None] & nearer[1][None, :, None]
    return removed


def _cells(reach: VoxelMap, shown: Mask, values: Array) -> Any:
    """The faces of the cells that have no neighbour there, as one body for each shade."""
    corners, shades = [], []
    filled = np.pad(shown, 1)
    for axis in range(3):
        for side in (1, -1):
            alone = shown & ~np.roll(filled, -side, axis)[1:-1, 1:-1, 1:-1]
            cells = np.flatnonzero(alone)
            face = np.array(_FACES[axis], dtype=np.float64)
            if side < 0:
                face = face[::-1] * np.where(np.arange(3) == axis, -1.0, 1.0)
            corners.append(reach.grid.centers(cells)[:, None] + 0.5 * reach.grid.size * face)
            shades.append(np.rint(np.nan_to_num(values.ravel()[cells]).clip(0.0, 1.0) * (_SHADES - 1)).astype(int))
    quads, shade = np.concatenate(corners), np.concatenate(shades)
    for one in np.unique(shade):
        own = quads[shade == one]
        normals = np.cross(own[:, 1] - own[:, 0], own[:, 3] - own[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        first = 4 * np.arange(len(own))[:, None]
        faces = np.concatenate([first + np.array([0, 1, 2]), first + np.array([0, 2, 3])])
        solid = Solid(own.reshape(-1, 3), np.repeat(normals, 4, axis=0), faces)
        yield Body(solid, colors_of(np.array(one / (_SHADES - 1))), gloss=0.0, glow=0.35)
