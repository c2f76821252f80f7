"""The ways that a ball takes about a robot: a curve that its frame can follow, and places that it can reach."""

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
    """One ball's curve: its center (3,), the rows u, v, w of its axes (3, 3) and its points (n, 3), all in [m]."""

    curve: Curve
    center: Array
    axes: Array
    path: Array

    def at(self, phase: float) -> Array:
        """The point (3,) at a phase in [0, 1) [m]."""
        return np.asarray(self.center + np.array(self.curve.point(phase)) @ self.axes)


def lay_track(robot: Robot, frame: str, name: str, start: Array) -> Track:
    """The curve of that name about `start` (3,) [m], raised until nothing dips into the ground."""
    curve, home = CURVES[name], home_configuration(robot)
    axes = curve_axes(robot, frame, home, start, curve)
    lowest = float(polyline(curve, start, axes)[:, 2].min())
    center = start + np.array([0.0, 0.0, max(0.0, lowest_point(robot, home) - lowest)])
    return Track(curve, center, axes, polyline(curve, center, axes))


def random_configuration(robot: Robot, home: Array, rng: np.random.Generator) -> Array:
    """All one-axis joints drawn anew inside their limits, the rest as in `home` (nq,): its places can be reached."""
    q = home.copy()
    drawn = robot.random(rng)
    for name in robot.joint_names:
        joint = robot.joint(name)
        if joint.has_one_axis:
            joint.set_angle(q, joint.angle(drawn))
    return q


def curve_axes(robot: Robot, frame: str, q: Array, center: Array, curve: Curve) -> Array:
    """The rows u, v, w (3, 3) [m] that a curve about `center` is drawn along, as large as the chain follows well.

    To the side is the world's y, up its z, towards the viewer its x; a chain that moves in a plane gets the plane's
    own axes. The size starts at a quarter of the chain's length and shrinks while the chain cannot follow.
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
    """Rows u, v and a zero (3, 3) for a chain whose frame keeps to a plane, u as level as it gets; else None."""
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
    states = iterate(robot, Target(frame, points[0]), "dls", q, max_iterations=60, tolerance=(1e-3, 1e-3))
    state = next(states)
    for point in points:
        state = states.send(Target(frame, point))
        while state.status is None:
            state = next(states)
        if state.status is not Status.CONVERGED:
            return False
    return True
