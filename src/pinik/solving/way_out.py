"""The way out of a slight touch: small steps in which parts move away from each other and targets stay reached."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics
from ..shapes.touch import Touch
from .question import Question
from .run import Pace, run
from .state import Status

__all__ = ["WayOut"]

Array = NDArray[np.float64]

STEPS = 12
"""The maximum number of steps."""

LONGEST_STEP = 0.1
"""The largest change of a joint in one step [rad or m], before the targets are reached again."""

GAP_SHARE_OF_CHAIN = 1e-3
"""The gap that a step aims at, per length of the chain."""

ITERATIONS = 30
"""The maximum number of iterations in which the targets are reached again."""

PROBE = 1e-6
"""The change of a joint by which derivatives are measured [rad or m]."""

SAME_RANK = 1e-6
"""The smallest singular value of the Jacobian that counts towards its rank, relative to the largest."""

STUCK = 1e-3
"""The part of the derivatives of the distances that must be left where the targets stay reached."""

DAMPING = 1e-2
"""The damping of a step, relative to the derivatives of the distances."""


class WayOut:
    """Leads away from touches, for one kind of question; each thread needs its own instance."""

    def __init__(self, question: Question, kinematics: Kinematics) -> None:
        self._question, self._kinematics = question, kinematics

    def depth(self, q: Array) -> float:
        """The depth of the deepest touch at q (nq,) [m]; −1 if nothing touches."""
        return _deepest(self._touches(q))

    def is_isolated(self, q: Array) -> bool:
        """Whether the targets leave no motion at an answer (nq,): whether their Jacobian has no kernel."""
        self._kinematics.loose = False
        J = self._kinematics.linearize(q).J[:, self._question.problem.free]
        singular = np.linalg.svd(J, compute_uv=False)
        return bool(np.sum(singular > SAME_RANK * singular.max(initial=0.0)) == J.shape[1])

    def __call__(self, q: Array, near: Array, deadline: float) -> tuple[Array, float]:
        """Go on from an answer at which something touches, as long as the touches become less deep.

        Args:
            q: The answer (nq,).
            near: The configuration to which hinges are turned (nq,).
            deadline: When to end, by `time.perf_counter` [s].

        Returns:
            The last answer (nq,), and its depth, as `depth` gives it.
        """
        touches = self._touches(q)
        depth = _deepest(touches)
        for _ in range(STEPS):
            aside = self._step(q, touches)
            there = None if aside is None else self._reached(aside, near, deadline)
            if there is None:
                break
            touches = self._touches(there)
            now = _deepest(touches)
            if now >= depth:
                break
            q, depth = there, now
            if not touches:
                break
        return q, depth

    def _touches(self, q: Array) -> Sequence[Touch]:
        guard = self._question.guard
        return [] if guard is None else guard.checker.report(q)

    def _step(self, q: Array, touches: Sequence[Touch]) -> Array | None:
        """A configuration where the parts are apart, as far as the targets' Jacobian stays zero; None if there is none.

        With the derivatives G of the distances and the projection N onto the kernel of the Jacobian, the step is
        N Gᵀ (G N Gᵀ + μ²I)⁻¹ d, where d are the depths and the gap that is aimed at.
        """
        problem, limits = self._question.problem, self._question.limits
        self._kinematics.loose = False
        J = self._kinematics.linearize(q).J[:, problem.free]
        G = self._derivatives(q, touches)
        _, singular, V = np.linalg.svd(J, full_matrices=False)
        V = V[singular > SAME_RANK * singular.max(initial=0.0)]
        projected = G - (G @ V.T) @ V
        size = float(np.linalg.norm(projected))
        if not size > STUCK * float(np.linalg.norm(G)):
            return None
        wanted = np.array([touch.depth for touch in touches]) + GAP_SHARE_OF_CHAIN * problem.size_of_chain
        square = projected @ projected.T + (DAMPING * size) ** 2 * np.eye(len(wanted))
        step = projected.T @ np.linalg.solve(square, wanted)
        largest = float(np.abs(step).max())
        dq = np.zeros(len(problem.free))
        dq[problem.free] = step * min(1.0, LONGEST_STEP / largest)
        return np.asarray(limits.clip(self._question.problem.moved(q, dq)))

    def _derivatives(self, q: Array, touches: Sequence[Touch]) -> Array:
        """By how much each touch (rows) opens as each free coordinate (columns) moves.

        The points of contact move with their parts, along the normal: so the distance changes, to first order.
        """
        model, data = self._kinematics.model, self._question.robot.data
        free = np.flatnonzero(self._question.problem.free)
        pinocchio.forwardKinematics(model, data, q)
        own = [[data.oMi[j].actInv(np.array(p)) for j, p in zip(t.joints, t.points, strict=True)] for t in touches]
        G = np.zeros((len(touches), len(free)))
        for column, coordinate in enumerate(free):
            for sign in (1.0, -1.0):
                dq = np.zeros(model.nv)
                dq[coordinate] = sign * PROBE
                pinocchio.forwardKinematics(model, data, self._question.problem.moved(q, dq))
                for row, (touch, points) in enumerate(zip(touches, own, strict=True)):
                    first, second = (data.oMi[j].act(p) for j, p in zip(touch.joints, points, strict=True))
                    G[row, column] += sign * float(np.dot(touch.normal, second - first)) / (2.0 * PROBE)
        return G

    def _reached(self, start: Array, near: Array, deadline: float) -> Array | None:
        """The configuration near `start` that reaches the targets again; None if there is none or the time is up."""
        question = self._question
        iterations = min(ITERATIONS, question.options.iterations_at_most)
        pace = Pace(iterations, question.options.method.patience, downhill=True, loosens=False)
        states = run(question, self._kinematics, start, pace, near)
        state = next(states)
        while state.status is None:
            if deadline < math.inf and time.perf_counter() > deadline:
                return None
            state = next(states)
        return question.limits.wrap(state.q, near) if state.status is Status.CONVERGED else None


def _deepest(touches: Sequence[Touch]) -> float:
    return max((touch.depth for touch in touches), default=-1.0)
