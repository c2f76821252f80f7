"""Paths for a ball around a robot: a curve that its frame can follow, and random positions that it can reach."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..model.home import home_configuration, lowest_point
from ..problem.kinematics import Kinematics
from ..problem.targets import Target
from ..robot import Robot
from ..solving.front import iterate
from ..solving.state import Status
from .curves import CURVES, Curve, polyline

__all__ = ["Track", "curve_axes", "lay_track", "random_configuration"]

Array = NDArray[np.float64]


class Track(NamedTuple):
    """The curve of one ball: its center (3,), its axes (3, 3) with rows u, v, w, and its points (n, 3), all in [m]."""

    curve: Curve
    center: Array
    axes: Array
    path: Array

    def at(self, phase: float) -> Array:
        """The point (3,) at a phase in [0, 1) [m]."""
        return np.asarray(self.center + np.array(self.curve.point(phase)) @ self.axes)


def lay_track(robot: Robot, frame: str, name: str, start: Array) -> Track:
    """The named curve around `start` (3,) [m], raised if necessary so that all of it is above the ground."""
    curve, home = CURVES[name], home_configuration(robot)
    axes = curve_axes(robot, frame, home, start, curve)
    lowest = float(polyline(curve, start, axes)[:, 2].min())
    center = start + np.array([0.0, 0.0, max(0.0, lowest_point(robot, home) - lowest)])
    return Track(curve, center, axes, polyline(curve, center, axes))


def random_configuration(robot: Robot, home: Array, rng: np.random.Generator) -> Array:
    """A reachable configuration: one-axis joints drawn at random inside their limits, the others as in `home` (nq,)."""
    q = home.copy()
    drawn = robot.random(rng)
    for name in robot.joint_names:
        joint = robot.joint(name)
        if joint.has_one_axis:
            joint.set_angle(q, joint.angle(drawn))
    return q


def curve_axes(robot: Robot, frame: str, q: Array, center: Array, curve: Curve) -> Array:
    """The axes u, v, w of a curve around `center`, as rows (3, 3) [m], scaled so that the chain can follow the curve.

    u is along the world's y axis, v along z and w along x; for a chain that moves in a plane, u and v lie in that
    plane. The size starts at a quarter of the chain's length and shrinks until the chain can follow.
    """
    kinematics = Kinematics(robot, Target(frame, center))
    size = 0.25 * kinematics.problem.size_of_chain
    axes = np.roll(np.eye(3), -1, axis=0) * size
    plane = _plane(kinematics, robot, q)
    if plane is not None:
        axes = plane * size
    for _ in range(4):
        if _follows(robot, frame, q, polyline(curve, center, axes, count=8)):
            break
        axes = 0.6 * axes
    return axes


def _plane(kinematics: Kinematics, robot: Robot, q: Array) -> Array | None:
    """Rows u, v and zero (3, 3) for a chain whose frame moves in a plane, with u horizontal if possible; else None."""
    rng = np.random.default_rng(0)
    columns = [kinematics.linearize(robot.random(rng) if k else q).J[:3] for k in range(6)]
    left, sigma, _ = np.linalg.svd(np.hstack(columns))
    if len(sigma) == 3 and sigma[2] > 1e-6 * sigma[0]:
        return None
    normal = left[:, 2]
    across = np.cross(normal, (0.0, 0.0, 1.0))
    u = across / np.linalg.norm(across) if np.linalg.norm(across) > 1e-6 else np.array([0.0, 1.0, 0.0])
    return np.vstack([u, np.cross(u, normal), np.zeros(3)])


def _follows(robot: Robot, frame: str, q: Array, points: Array) -> bool:
    states = iterate(robot, Target(frame, points[0]), "dls", q, max_iterations=60, tolerance=(1e-3, 1e-3), polish=False)
    state = next(states)
    for point in points:
        state = states.send(Target(frame, point))
        while state.status is None:
            state = next(states)
        if state.status is not Status.CONVERGED:
            return False
    return True
