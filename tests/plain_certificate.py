"""The errors of targets at a configuration as it stands, by Pinocchio's own functions on `robot.model` alone.

The judge reads a robot's file himself and therefore rounds otherwise. Where a tolerance is as small as rounding, only
the same model and the same q can decide; this is what a user of Pinocchio computes from `robot.model` and `solution.q`.
"""

from __future__ import annotations

import math
import weakref
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pinocchio

import pinik

AT_THE_POINT = 1e-6  # [m]: docs/targets.md
ROUNDING = 1e-12  # relative
_DATA: weakref.WeakKeyDictionary[pinik.Robot, pinocchio.Data] = weakref.WeakKeyDictionary()


def plain_errors(
    robot: pinik.Robot, targets: Sequence[pinik.Target], q: np.ndarray, tolerance: Any
) -> list[tuple[float | None, float | None, tuple[float, float, float] | None]]:
    """(metres, radians, errors along the axes of a box) of each target."""
    if robot not in _DATA:
        _DATA[robot] = robot.model.createData()
    data = _DATA[robot]
    pinocchio.framesForwardKinematics(robot.model, data, q)
    return [_errors(robot, data, target, target.tolerance or tolerance) for target in targets]


def _errors(robot: pinik.Robot, data: pinocchio.Data, target: pinik.Target, tolerance: Any) -> Any:
    found = data.oMf[robot.frame_id(target.frame)]
    if target.relative_to is not None:
        found = data.oMf[robot.frame_id(target.relative_to)].actInv(found)
    if target.tool is not None:
        found = found * target.tool
    position = orientation = offset = None
    if target.position is not None:
        left = [0.0 if math.isnan(a) else a - b for a, b in zip(target.position, found.translation, strict=True)]
        position = length(left)
        if np.ndim(tolerance[0]) == 1:
            box = pinocchio.SE3.Identity() if target.rotation is None else pinocchio.SE3(target.rotation, np.zeros(3))
            offset = tuple(box.actInv(np.array(left)).tolist())
    if target.rotation is not None:
        turn = pinocchio.SE3(target.rotation, np.zeros(3)) * pinocchio.SE3(found.rotation, np.zeros(3)).inverse()
        orientation = length(pinocchio.log3(turn.rotation).tolist())
    elif target.axis is not None:
        pointing = pinocchio.SE3(found.rotation, np.zeros(3)).act(target.axis)
        line = target.direction if target.at is None else target.at - found.translation
        orientation = 0.0
        if target.at is None or length(line.tolist()) >= AT_THE_POINT:
            (a, b, c), (x, y, z) = pointing.tolist(), line.tolist()
            sine = length([b * z - c * y, c * x - a * z, a * y - b * x])
            orientation = math.atan2(sine, a * x + b * y + c * z)
    return position, orientation, offset


def length(vector: Sequence[float]) -> float:
    x, y, z = vector
    return math.sqrt(x * x + y * y + z * z)


class ErrorRows(NamedTuple):
    """The errors of one target at n configurations, and what rounding may change of them.

    Attributes:
        metres, radians: The errors (n,) [m], [rad]; None for what is not asked for.
        offsets: The position errors along the axes of a box (n, 3) [m]; None if no position is asked for.
        blur, turn_blur: What rounding may change of lengths [m] and angles [rad] (n,).
    """

    metres: np.ndarray | None
    radians: np.ndarray | None
    offsets: np.ndarray | None
    blur: np.ndarray
    turn_blur: np.ndarray


def plain_error_rows(robot: pinik.Robot, asked: Sequence[Sequence[pinik.Target]], q: np.ndarray) -> list[ErrorRows]:
    """The same in arrays and up to rounding: the errors of targets of the same kinds, row i of them at row i of q."""
    kinds = list(zip(*asked, strict=True))
    names = {name for one in asked[0] for name in (one.frame, one.relative_to) if name is not None}
    frames = _placement_rows(robot, names, q)
    blur = rounding(robot, q)
    return [_error_rows(frames, targets, blur) for targets in kinds]


def rounding(robot: pinik.Robot, q: np.ndarray) -> np.ndarray:
    """What rounding may change of positions at configurations (n, nq) [m] (n,), by how far the robot may extend."""
    model = robot.model
    extent = sum(float(np.linalg.norm(placement.translation)) for placement in [*model.jointPlacements])
    stretch = np.zeros(model.nq)
    for joint in robot.joints:
        if joint.kind == "prismatic":
            leader = joint if joint.leader is None else robot.joint(joint.leader)
            stretch[leader.idx_q] += abs(joint.multiplier) if joint.leader else 1.0
            extent += abs(joint.offset) if joint.leader else 0.0
        elif joint.nv > 1:  # floating and planar joints begin with a position
            stretch[joint.idx_q : joint.idx_q + (3 if joint.nv == 6 else 2)] = 1.0
    return ROUNDING * np.maximum(extent + np.abs(q) @ stretch, 1.0)


def turn_rounding(target: pinik.Target, blur: Any) -> Any:
    """What rounding may change of an angle [rad]: more where an axis points at a point that the frame may touch."""
    return 1e-7 + (0.0 if target.at is None else 100.0 / AT_THE_POINT) * blur


def _placement_rows(robot: pinik.Robot, names: set[str], q: np.ndarray) -> dict[str, np.ndarray]:
    """Frame → its placements (n, 4, 4)."""
    if robot not in _DATA:
        _DATA[robot] = robot.model.createData()
    data, numbers = _DATA[robot], {name: robot.frame_id(name) for name in names}
    found: dict[str, list[np.ndarray]] = {name: [] for name in names}
    for row in q:
        pinocchio.forwardKinematics(robot.model, data, row)
        for name, number in numbers.items():
            found[name].append(pinocchio.updateFramePlacement(robot.model, data, number).homogeneous)
    return {name: np.array(rows) for name, rows in found.items()}


def _error_rows(frames: dict[str, np.ndarray], targets: Sequence[pinik.Target], blur: np.ndarray) -> ErrorRows:
    one = targets[0]
    found = frames[one.frame]
    if one.relative_to is not None:
        found = np.linalg.inv(frames[one.relative_to]) @ found
    if one.tool is not None:
        found = found @ one.tool.homogeneous
    turn, point = found[:, :3, :3], found[:, :3, 3]
    metres = radians = offsets = None
    if one.position is not None:
        left = np.nan_to_num(np.array([target.position for target in targets])) - point
        left[:, np.isnan(one.position)] = 0.0
        metres, offsets = np.linalg.norm(left, axis=1), left
    if one.rotation is not None:
        wanted = np.array([target.rotation for target in targets])
        if offsets is not None:
            offsets = np.einsum("nji,nj->ni", wanted, offsets)
        apart = wanted @ turn.transpose(0, 2, 1)
        skew = apart - apart.transpose(0, 2, 1)
        sine = np.linalg.norm(skew[:, (2, 0, 1), (1, 2, 0)], axis=1)
        radians = np.arctan2(sine, np.trace(apart, axis1=1, axis2=2) - 1.0)
    elif one.axis is not None:
        pointing = turn @ one.axis
        near = np.zeros(len(targets), dtype=bool)
        if one.at is None:
            line = np.array([target.direction for target in targets])
        else:
            line = np.array([target.at for target in targets]) - point
            near = np.linalg.norm(line, axis=1) < AT_THE_POINT
        sine = np.linalg.norm(np.cross(pointing, line), axis=1)
        radians = np.where(near, 0.0, np.arctan2(sine, np.einsum("ni,ni->n", pointing, line)))
    return ErrorRows(metres, radians, offsets, blur, turn_rounding(one, blur))
