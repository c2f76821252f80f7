"""One point of a path after the other: each starts where the last one ended, on the same branch."""

from __future__ import annotations

import math
import time
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics
from ..problem.reach import shortfall
from ..problem.targets import Target
from ..solvers.base import Patience
from .aims import between, present
from .changes import is_jump, joint_change, largest_change
from .question import Question
from .run import TO_THE_END, Pace, run
from .starts import Starts
from .state import State, Status
from .stepping import advance
from .way_out import WayOut

__all__ = ["CREEP_HALVINGS", "TICK_ITERATIONS", "Stride", "Walk"]

Array = NDArray[np.float64]

CREEP_HALVINGS = 6
"""How many times the step of the target may be halved on the way to a target that a plain run misses."""

TICK_ITERATIONS = 20
"""The maximum number of iterations of a run in one tick."""


class Stride(NamedTuple):
    """The result for one point.

    Attributes:
        ended: Why the last run ended; CONVERGED if `q` reaches the targets.
        q: The configuration that reaches the targets, or the nearest one found on this branch (nq,).
        iterations: Of all runs.
        restarts: The number of restarts.
        approaches: Whether the targets, missed in a tick, will be nearer after further ticks.
        touching: Where something touches that kept the tick from going on (nq,); None if nothing did.
    """

    ended: Status
    q: Array
    iterations: int
    restarts: int
    approaches: bool = False
    touching: Array | None = None


class Walk:
    """The Python engine for a path: it goes from point to point, and keeps to its branch wherever that is possible.

    Each thread needs its own instance.

    Attributes:
        question: The kinds of the targets, and the options.
        kinematics: The kinematics of the current targets.
        way_out: The way out of slight touches.
    """

    def __init__(self, question: Question) -> None:
        self.question = question
        self.kinematics = Kinematics.of(question.problem)
        self._starts = Starts(self.kinematics, question.limits, question.options.seed)
        self.way_out = WayOut(question, self.kinematics)
        self._iterations, self._restarts, self._deadline = 0, 0, math.inf

    def __call__(self, targets: tuple[Target, ...], q: Array, number: int) -> Stride:
        """Go from `q` to the next targets.

        A plain run comes first. If it misses, or if its answer is a jump, the targets are approached from the frames'
        present places in smaller steps. If that fails too, a longer run looks for the nearest configuration, and
        restarts look for the answer nearest to `q`. An answer at which something touches that is to be avoided counts
        as a miss, unless the way out leads to one nearby.

        Args:
            targets: The targets, of the question's kinds.
            q: The configuration to start from (nq,), inside the limits.
            number: The index of the point, which is one of the keys of the random starts.
        """
        options, exact = self.question.options, self.question.solver.exact
        began = time.perf_counter()
        self._iterations, self._restarts, self._deadline = 0, 0, began + options.time_limit
        self.kinematics.retarget(targets)
        pace = Pace(options.iterations_at_most, TO_THE_END if exact else options.method.patience, downhill=not exact)
        plain = self._free(self._run(q, pace), q)
        if self._is_near(plain, q) or plain.status is Status.TIME_LIMIT or exact:
            return self._stride(plain)
        if shortfall(targets, self.question.bounds, options.tolerance) is None:
            done, crept = self._creep(targets, q, pace)
            if crept is not None and done >= 1.0:
                crept = self._free(crept, q)
                if crept.status is Status.CONVERGED:
                    return self._stride(crept)
        reaches = plain.status in (Status.CONVERGED, Status.COLLIDING)
        best = plain if reaches else self._free(self._run(plain.q, self._last), q)
        if self._is_near(best, q) or best.status is Status.TIME_LIMIT:
            return self._stride(best)
        return self._stride(self._elsewhere(q, best, number) or best)

    def tick(self, targets: tuple[Target, ...], q: Array, most: Array) -> Stride:
        """Move from `q` towards the targets within one tick, and never to another branch.

        If a run reaches the targets without a jump, but needs more than one tick, the frames go straight towards them
        as far as the joints' speeds allow, or the joints go towards that answer where the straight way does not lead
        there. If a run does not reach them, the residual decreases in every tick. So the frames come to rest.

        Args:
            targets: The targets, of the question's kinds.
            q: The configuration to start from (nq,), inside the limits.
            most: The largest change of each joint within the tick, by tangent coordinate (nv,) [rad or m]; infinite
                where there is none.
        """
        self._iterations, self._restarts = 0, 0
        self._deadline = time.perf_counter() + self.question.options.time_limit
        self.kinematics.retarget(targets)
        plain = self._run(q, self._pace_of_a_tick)
        assert plain.status is not None
        near, ticks = not is_jump(self.kinematics, q, plain.q), self.largest_excess(q, plain.q, most)
        if near and ticks <= 1.0:
            approaches = plain.status in (Status.MAX_ITERATIONS, Status.TIME_LIMIT)
            return Stride(plain.status, plain.q, self._iterations, 0, approaches)
        leads, before = near and plain.status is Status.CONVERGED, self._residual(q)
        there, first = self._straight(targets, q, most, plain if near else None)
        if leads:
            if self.largest_excess(there, plain.q, most) > ticks - 0.5:
                there = self.within(q, plain.q, most)
        elif self._residual(there) >= before:
            there = self._down(q, first, most, before)
        least = TO_THE_END.progress
        approaches = self.largest_excess(q, there, most) >= least or self._residual(there) <= (1.0 - least) * before
        return Stride(plain.status, there, self._iterations, 0, approaches)

    @property
    def _pace_of_a_tick(self) -> Pace:
        """The pace of a run in a tick: it stalls if half the iterations progress more slowly than the method should."""
        options, patience = self.question.options, self.question.options.method.patience
        iterations = min(options.iterations_at_most, TICK_ITERATIONS)
        half = max(iterations // 2, 1)
        progress = min(half / max(patience.iterations, 1), 1.0) * patience.progress
        return Pace(iterations, Patience(half, progress), downhill=True)

    def _residual(self, q: Array) -> float:
        """The residual at `q`, where the targets pull inside wide tolerances too."""
        self.kinematics.loose = False
        return float(self.kinematics.linearize(q).residual)

    def _straight(self, targets: tuple[Target, ...], q: Array, most: Array, plain: State | None) -> tuple[Array, Array]:
        """(a place on the straight way of the frames, within the largest changes; the method's first step).

        The first step says how much of the way to go. `plain` is the result of a run to the targets, if it is no jump.
        """
        question, aim, state = self.question, targets, plain
        self.kinematics.loose = False
        at = self.kinematics.linearize(q)
        first, _ = advance(question.solver, self.kinematics, question.limits, at, question.options.tolerance)
        excess, pace = self.largest_excess(q, first, most), self._pace_of_a_tick
        if excess > 1.0:
            aim = between(present(self.kinematics, targets, q), targets, 1.0 / excess)
            self.kinematics.retarget(aim)
            state = self._run(q, pace)
            state = None if is_jump(self.kinematics, q, state.q) else state
        if state is None:
            _, state = self._creep(aim, q, pace)
        self.kinematics.retarget(targets)
        return (q if state is None else self.within(q, state.q, most)), first

    def _down(self, q: Array, first: Array, most: Array, before: float) -> Array:
        """A part of the first step after which the residual is below `before`; `q` if there is none."""
        there = self.within(q, first, most)
        for _ in range(CREEP_HALVINGS):
            if self._residual(there) < before:
                return there
            there = self.shortened(q, there, 0.5)
        return q

    def largest_excess(self, before: Array, after: Array, most: Array) -> float:
        """The largest change of a joint with one axis, relative to the largest that is allowed."""
        joints = {coordinate.joint for coordinate in self.question.problem.coordinates}
        changes = [abs(joint_change(j, before, after)) / float(most[j.idx_v]) for j in joints if j.has_one_axis]
        return max(changes, default=0.0)

    def within(self, before: Array, after: Array, most: Array) -> Array:
        """The configuration on the way from one to another where no change is larger than allowed."""
        excess = self.largest_excess(before, after, most)
        return self.shortened(before, after, 1.0 / excess) if excess > 1.0 else after

    def shortened(self, before: Array, after: Array, part: float) -> Array:
        """The configuration at a part of the way between two, inside the limits."""
        problem = self.question.problem
        q: Array = pinocchio.interpolate(problem.robot.model, before, after, part)
        if problem.held_entries is not None:
            q[problem.held_entries] = before[problem.held_entries]
        return np.asarray(self.question.limits.clip(q))

    @property
    def _last(self) -> Pace:
        """The pace of the run that looks for the nearest configuration."""
        return Pace(self.question.options.iterations_to_the_end, TO_THE_END, downhill=True)

    def _stride(self, state: State) -> Stride:
        assert state.status is not None
        return Stride(state.status, state.q, self._iterations, self._restarts)

    def _run(self, start: Array, pace: Pace) -> State:
        """The best state of a run inside the limits, with the status of its last state."""
        limits, best = self.question.limits, None
        for state in run(self.question, self.kinematics, start, pace):
            status = state.status
            if status is None and self._deadline < math.inf and time.perf_counter() > self._deadline:
                status = Status.TIME_LIMIT
            if status is Status.CONVERGED or (
                (best is None or state.residual < best.residual) and limits.contains(state.q)
            ):
                best = state
            if status is not None:
                break
        self._iterations += state.iteration
        return (best or state)._replace(status=status)

    def _free(self, state: State, q: Array) -> State:
        """An answer at which nothing touches, after the way out if need be; else the state with COLLIDING."""
        if state.status is not Status.CONVERGED or not self.question.touches(state.q):
            return state
        there, depth = self.way_out(state.q, q, self._deadline)
        return state._replace(q=there, status=Status.CONVERGED if depth < 0.0 else Status.COLLIDING)

    def aside(self, targets: tuple[Target, ...], q: Array, near: Array) -> Array:
        """The end of the way out of what touches at `q` (nq,), with the frames where they are there."""
        self.kinematics.retarget(present(self.kinematics, targets, q))
        there, _ = self.way_out(q, near, self._deadline)
        self.kinematics.retarget(targets)
        return there

    def _is_near(self, state: State, q: Array) -> bool:
        """Whether a run reached its targets without a jump away from `q`."""
        return state.status is Status.CONVERGED and not is_jump(self.kinematics, q, state.q)

    def _creep(self, targets: tuple[Target, ...], q: Array, pace: Pace) -> tuple[float, State | None]:
        """Approach the targets in smaller steps, each half of the last if it fails.

        Returns:
            The part of the way that was gone, and the state there; None if no step succeeded.
        """
        origins = present(self.kinematics, targets, q)
        done, step, state = 0.0, 0.5, None
        while done < 1.0 and step >= 0.5**CREEP_HALVINGS:
            part = min(done + step, 1.0)
            self.kinematics.retarget(between(origins, targets, part))
            tried = self._run(q if state is None else state.q, pace)
            if tried.status is Status.TIME_LIMIT:
                break
            if self._is_near(tried, q if state is None else state.q):
                done, state = part, tried
            else:
                step /= 2.0
        self.kinematics.retarget(targets)
        return done, state

    def _elsewhere(self, q: Array, best: State, number: int) -> State | None:
        """The answer nearest to `q`, of the best one so far and those of the restarts; None if there is none."""
        options, problem = self.question.options, self.question.problem
        answers = [best] if best.status is Status.CONVERGED else []
        possible = shortfall(self.kinematics.targets, self.question.bounds, options.tolerance) is None
        pace = Pace(options.iterations_at_most, options.method.patience, bold=True)
        for attempt in range(1, options.restarts_at_most + 1 if possible and self._starts.draws else 1):
            self._restarts = attempt
            state = self._run(self._starts.next(q, target=number, number=attempt), pace)
            if state.status is Status.CONVERGED:
                state = state._replace(q=self.question.limits.wrap(state.q, q))
                if self.question.touches(state.q):
                    continue
                answers.append(state)
                if not is_jump(self.kinematics, q, answers[-1].q):
                    break
            elif state.status is Status.TIME_LIMIT:
                break
        return min(answers, key=lambda state: largest_change(problem, q, state.q), default=None)
