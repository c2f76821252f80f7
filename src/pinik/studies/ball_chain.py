"""The thesis's program, after its pseudo-code: a chain of ball joints, each turned about one axis per step."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..errors import InputError, UnknownNameError
from ..model.chains import chain_of
from ..motion.figures import StepFigures
from ..robot import Robot
from .steps import PROGRAM

__all__ = ["METHODS", "BallChain", "ProgramChase"]

Array = NDArray[np.float64]

METHODS = ("ccd", "jt", "pinv", "dls")
"""The four methods of the thesis, by their short names in pinik."""

_NO_AXIS = 1e-12


class BallChain:
    """Bones end to end, each connected to its parent by a ball joint; at zero all of them point along z.

    Attributes:
        R: Each bone's orientation in its parent (n, 3, 3).
    """

    def __init__(self, base: Array, lengths: Array, swing: float = math.inf) -> None:
        """A bone may lean from its parent by up to `swing` about y, then about x [rad]; its spin is free."""
        self._base = base
        self._lengths = lengths
        self._swing = swing
        self.R: Array = np.tile(np.eye(3), (len(lengths), 1, 1))

    @classmethod
    def of(cls, robot: Robot, frame: str, q: Array, unit: float = 1.0, swing: float = math.inf) -> BallChain:
        """The chain of a robot at `q` (nq,) with two hinges per bone, such as pinik's arm, in units of `unit` [m].

        Raises:
            InputError: The robot's chain is built differently.
        """
        model, neutral = robot.model, robot.neutral()
        data = model.createData()
        pinocchio.forwardKinematics(model, data, neutral)
        joints = chain_of(model, robot.joints, robot.frame_id(frame)).joints
        points = [data.oMi[joint.id].translation for joint in joints]
        hinges = [joint.kind == "revolute" for joint in joints]
        paired = all(np.allclose(a, b) for a, b in zip(points[::2], points[1::2], strict=False))
        if not joints or len(joints) % 2 or not all(hinges) or not paired:
            raise InputError(
                f"the thesis's program needs bones of two hinges about one point each; {robot.name} has other joints"
            )
        ends = np.array([*points[::2], robot.placement(frame, neutral).translation]) / unit
        lengths = np.linalg.norm(np.diff(ends, axis=0), axis=1)
        axes = np.array([data.oMi[joint.id].rotation @ np.array(joint.axis) for joint in joints])
        standing = np.allclose(np.diff(ends, axis=0), lengths[:, None] * (0.0, 0.0, 1.0))
        if not standing or not np.allclose(axes, np.tile(np.eye(3)[[1, 0]], (len(lengths), 1))):
            raise InputError(
                f"the thesis's program needs bones that point straight up at zero; those of {robot.name} do not"
            )
        made = cls(ends[0], lengths, swing)
        angles = np.array([joint.angle(q) for joint in joints]).reshape(-1, 2)
        made.R = np.array([_about(1, first) @ _about(0, second) for first, second in angles])
        return made

    def points(self) -> tuple[Array, Array]:
        """(the starts of the bones and the last one's end (n + 1, 3), the orientations of their parents (n, 3, 3))."""
        p, R = self._base, np.eye(3)
        points, parents = [p], []
        for turned, length in zip(self.R, self._lengths, strict=True):
            parents.append(R)
            R = R @ turned
            p = p + length * R[:, 2]
            points.append(p)
        return np.array(points), np.array(parents)

    def turn(self, bone: int, parent: Array, rotation: Array) -> None:
        """Turn a bone and all bones after it by a world rotation vector (3,) [rad]; `parent` is its parent's R."""
        turned = parent.T @ pinocchio.exp3(rotation) @ parent @ self.R[bone]
        # Not by pinocchio.Quaternion(turned): each one made from a matrix leaks 80 bytes (eigenpy of Pinocchio 4.1.0).
        xyzw = np.array(pinocchio.SE3ToXYZQUATtuple(pinocchio.SE3(turned, np.zeros(3)))[3:])
        turned = np.asarray(pinocchio.Quaternion(xyzw).normalized().toRotationMatrix())
        self.R[bone] = self._leaning_less(turned) if math.isfinite(self._swing) else turned

    def leaning(self) -> Array:
        """The lean of each bone about y, then about x (n, 2) [rad]."""
        return np.array([_lean(R) for R in self.R])

    def _leaning_less(self, R: Array) -> Array:
        first, second = _lean(R)
        spin = _about(0, -second) @ _about(1, -first) @ R
        first, second = (min(max(angle, -self._swing), self._swing) for angle in (first, second))
        return np.asarray(_about(1, first) @ _about(0, second) @ spin)


def _lean(R: Array) -> tuple[float, float]:
    """(a, b) of R = Ry(a) Rx(b) Rz(c)."""
    x, y, z = R[:, 2]
    return math.atan2(x, z), -math.asin(min(max(y, -1.0), 1.0))


def _about(axis: int, angle: float) -> Array:
    return np.asarray(pinocchio.exp3(angle * np.eye(3)[axis]))


class ProgramChase:
    """A chase by one of the thesis's methods on a chain of ball joints: the loop of its §4, with two errors corrected.

    The loop continues while the ball is too far away *and* attempts are left; the thesis prints "or" and the opposite
    comparison. If the ball is already reached, no joint moves, but the thesis's counter still ends at one. A column of
    the Jacobian is axis × (s − p) with the axis (s − p) × (t − p), and α scales every angle after the clamp. Lengths
    are in the thesis's units, each `unit` metres long.
    """

    engine = PROGRAM

    def __init__(
        self,
        method: str,
        chain: BallChain,
        *,
        unit: float,
        tolerance: float,
        alpha: float,
        damping: float,
        max_angle: float,
        max_iterations: int,
        unit_axes: bool = True,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """With `unit_axes` the axes have length one; the thesis prints the plain cross product."""
        if method not in METHODS:
            raise UnknownNameError("method of the thesis", method, METHODS)
        self._method, self._chain, self._unit = method, chain, unit
        self._tolerance, self._most = tolerance, max_iterations
        self._alpha, self._damping, self._max_angle = alpha, damping, max_angle
        self._unit_axes = unit_axes
        self._clock = clock

    def step(self, place: Array) -> StepFigures:
        """Chase the ball to a place (3,) [m]; `joint_updates` counts the bones that CCD turned."""
        goal = place / self._unit
        before, began = self._chain.R.copy(), self._clock()
        passes, turns = self._cycle(goal) if self._method == "ccd" else (self._iterate(goal), 0)
        spent = self._clock() - began
        error = float(np.linalg.norm(goal - self._chain.points()[0][-1]))
        turned = [np.linalg.norm(pinocchio.log3(a.T @ b)) for a, b in zip(before, self._chain.R, strict=True)]
        return StepFigures(spent, passes, turns, error < self._tolerance, error * self._unit, float(max(turned)))

    def _cycle(self, goal: Array) -> tuple[int, int]:
        """CCD; returns (sweeps begun, bones turned)."""
        count, turns = len(self._chain.R), 0
        while turns < self._most * count:
            points, parents = self._chain.points()
            if np.linalg.norm(goal - points[-1]) < self._tolerance:
                break
            bone = count - 1 - turns % count
            now, wanted = points[-1] - points[bone], goal - points[bone]
            axis = np.cross(now, wanted)
            across = float(np.linalg.norm(axis))
            if across > _NO_AXIS:
                self._chain.turn(bone, parents[bone], axis * (math.atan2(across, float(now @ wanted)) / across))
            turns += 1
        return -(-turns // count), turns

    def _iterate(self, goal: Array) -> int:
        """The Jacobian methods; returns the number of iterations."""
        for iteration in range(self._most):
            points, parents = self._chain.points()
            e = goal - points[-1]
            if np.linalg.norm(e) < self._tolerance:
                return iteration
            arms = points[-1] - points[:-1]
            axes = np.cross(arms, goal - points[:-1])
            if self._unit_axes:
                norms = np.linalg.norm(axes, axis=1, keepdims=True)
                axes = np.divide(axes, norms, out=np.zeros_like(axes), where=norms > _NO_AXIS)
            rotations = axes * (self._alpha * self._angles(np.cross(axes, arms).T, e))[:, None]
            for bone, rotation in enumerate(rotations):
                self._chain.turn(bone, parents[bone], _within_a_turn(rotation))
        return self._most

    def _angles(self, J: Array, e: Array) -> Array:
        """The angles of the bones (n,) before α, for J (3, n) and e (3,)."""
        if self._method == "jt":
            return np.asarray(J.T @ e)
        if self._method == "pinv":
            return np.asarray(np.linalg.pinv(J, rcond=1e-12) @ e)
        damped = J.T @ np.linalg.solve(J @ J.T + self._damping**2 * np.eye(3), e)
        return np.asarray(np.clip(damped, -self._max_angle, self._max_angle))


def _within_a_turn(rotation: Array) -> Array:
    """The same rotation with an angle of at most π: near singularities the pseudo-inverse gives millions of turns."""
    angle = float(np.linalg.norm(rotation))
    return rotation if angle <= math.pi else rotation * (math.remainder(angle, 2.0 * math.pi) / angle)
