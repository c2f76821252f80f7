"""Configurations of a problem, ranked by how near their frames are to the targets."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.joint import WIDEST_RANGE, Joint
from ..model.limits import Limits
from ..problem.kinematics import Kinematics
from ..problem.problem import Problem
from ..problem.rows import Rows
from ..problem.targets import Target

__all__ = ["Table", "configuration_at", "drawn_joints", "range_of"]

Array = NDArray[np.float64]

Share = Callable[[Joint], float]
"""The part of a joint's range, in [0, 1), at which its value lies."""


class Table:
    """Many configurations of one problem, made when they are first needed and used for all targets.

    Attributes:
        configurations: The configurations (size, nq), after the first `rank`.
        drawn: The free joints of one axis, which differ between the configurations; others are as in the start.
        scores: The squared distance of each configuration from the targets (size,), up to a constant, from the last
            `rank`.
    """

    def __init__(self, kinematics: Kinematics, limits: Limits, size: int, share: Callable[[int], Share]) -> None:
        """Prepare a table of `size` configurations; `share(k)` gives the values of number k."""
        self._kinematics, self._limits = kinematics, limits
        self._share = share
        problem = kinematics.problem
        self.drawn = drawn_joints(problem)
        is_drawn = np.zeros(problem.model.nq, dtype=bool)
        for joint in self.drawn:
            is_drawn[joint.idx_q : joint.idx_q + joint.nq] = True
        needed = np.zeros_like(is_drawn)
        for term in problem.terms:
            for joint in problem.robot.joints:
                if joint.id in term.chain.frame_support | term.chain.reference_support:
                    needed[joint.idx_q : joint.idx_q + joint.nq] = True
        self._entries = np.flatnonzero(is_drawn)
        wide = np.zeros_like(is_drawn)
        for joint in self.drawn:
            entry = joint.idx_q
            wide[entry] = joint.kind == "prismatic" and limits.upper[entry] - limits.lower[entry] > WIDEST_RANGE
        self._wide = np.flatnonzero(wide)
        self._settled = np.flatnonzero((needed & ~is_drawn) | wide)
        self._about: Array | None = None  # the table is valid for these values of the settled entries
        self.configurations: Array = np.zeros((size, problem.model.nq))
        self.scores: Array = np.zeros(size)
        self._lengths: Array = np.zeros(size)
        self._seen: Array = np.zeros((size, 0))

    def take(self, index: int, start: Array) -> Array:
        """Configuration `index` (nq,), with all that is not drawn as in `start`."""
        q = start.copy()
        q[self._entries] = self.configurations[index, self._entries]
        return q

    def rank(self, start: Array) -> None:
        """Score the configurations for the current targets, with all that is not drawn as in `start` (nq,).

        Prismatic joints with no or very wide limits are drawn around the whole number of lengths of the chain that is
        nearest to `start`, so that starts near each other share a table.

        A radian counts as in `Linearization.distance`, and a squared angle as 2 − 2 cos, so that the score is linear in
        the numbers of the targets. The direction towards a point (`at`) is not linear, and is left out.
        """
        about = start.copy()
        about[self._entries] = self._kinematics.robot.neutral()[self._entries]
        length = self._kinematics.problem.size_of_chain
        about[self._wide] = length * np.rint(start[self._wide] / length)
        if self._about is None or (self._about[self._settled] != about[self._settled]).any():
            self._make(about)
            self._about = about
        wanted = np.concatenate([_wanted(target) for target in self._kinematics.targets])
        self.scores = self._lengths + self._seen @ wanted

    def _make(self, about: Array) -> None:
        kinematics, problem = self._kinematics, self._kinematics.problem
        rows = []
        for k in range(len(self.configurations)):
            q = configuration_at(problem, self._limits, about, self._share(k))
            self.configurations[k] = q
            pinocchio.forwardKinematics(kinematics.model, kinematics.data, q)
            for own in kinematics.rows:
                own.update_placements()
            of_a_radian = problem.squared_metres_per_radian
            parts = [_seen(own, of_a_radian) for own in kinematics.rows]
            self._lengths[k] = sum(length for length, _ in parts)
            rows.append(np.concatenate([row for _, row in parts]))
        self._seen = np.array(rows)


def drawn_joints(problem: Problem) -> list[Joint]:
    """The free joints of one axis, whose values starts choose, in the order of the problem's coordinates."""
    return [coordinate.joint for coordinate in problem.coordinates if coordinate.joint.has_one_axis]


def configuration_at(problem: Problem, limits: Limits, start: Array, share: Share) -> Array:
    """A configuration (nq,) with every free one-axis joint at a part of its range, and all others as in `start`.

    The range is `Joint.range_to_draw_from`; for prismatic joints with no or very wide limits it is the chain's length
    to both sides of `start`.
    """
    q = start.copy()
    for joint in drawn_joints(problem):
        low, high = range_of(joint, problem, limits, start)
        joint.set_angle(q, low + share(joint) * (high - low))
    return q


def range_of(joint: Joint, problem: Problem, limits: Limits, start: Array) -> tuple[float, float]:
    """The range from which a joint's angle is drawn [rad or m], for configurations about `start` (nq,)."""
    entry = joint.idx_q
    about, length = float(start[entry]), problem.size_of_chain
    return joint.range_to_draw_from(float(limits.lower[entry]), float(limits.upper[entry]), about, length)


def _wanted(target: Target) -> Array:
    parts = [
        np.zeros(0) if target.position is None else target.position[list(target.along)],
        np.zeros(0) if target.rotation is None else target.rotation.ravel(),
        np.zeros(0) if target.direction is None else target.direction,
    ]
    return np.concatenate(parts)


def _seen(rows: Rows, of_a_radian: float) -> tuple[float, Array]:
    """One target's part of a score: a constant, and the factors on `_wanted`; `of_a_radian` in [m²/rad²]."""
    target, weight = rows.target, rows.term.weight**2
    p, R = rows.seen_from_reference()
    length, parts = 0.0, [np.zeros(0)]
    if target.position is not None:
        p = p[list(target.along)]
        length = weight * float(p.dot(p))
        parts.append(-2.0 * weight * p)
    if target.rotation is not None:
        parts.append(-weight * of_a_radian * R.ravel())
    elif target.axis is not None and target.direction is not None:
        parts.append(-2.0 * weight * of_a_radian * R.dot(target.axis))
    return length, np.concatenate(parts)
