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
from ..problem.targets import NO_DIRECTION, Target
from .changes import JUMP_FLOOR, joint_change, largest_asked, largest_change
from .question import Question
from .run import TO_THE_END, Pace, run
from .starts import Starts
from .state import State, Status
from .stepping import advance

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
        slowed: Whether the largest changes of the joints in one tick were too small.
    """

    ended: Status
    q: Array
    iterations: int
    restarts: int
    slowed: bool = False


class Walk:
    """The Python engine for a path: it goes from point to point, and keeps to its branch wherever that is possible.

    Each thread needs its own instance.
    """

    def __init__(self, question: Question) -> None:
        self.question = question
        self.kinematics = Kinematics.of(question.problem)
        self._starts = Starts(self.kinematics, question.limits, question.options.seed)
        self._iterations, self._restarts, self._deadline = 0, 0, math.inf

    def __call__(self, targets: tuple[Target, ...], q: Array, number: int) -> Stride:
        """Go from `q` to the next targets.

        A plain run comes first. If it misses, or if its answer is a jump, the targets are approached from the frames'
        present places in smaller steps. If that fails too, a longer run looks for the nearest configuration, and
        restarts look for the answer nearest to `q`.

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
        plain = self._run(q, pace)
        if self._is_near(plain, q) or plain.status is Status.TIME_LIMIT or exact:
            return self._stride(plain)
        if shortfall(targets, self.question.bounds, options.tolerance) is None:
            crept = self._creep(targets, q, pace)
            if crept is not None:
                return self._stride(crept)
        best = plain if plain.status is Status.CONVERGED else self._run(plain.q, self._last)
        if self._is_near(best, q) or best.status is Status.TIME_LIMIT:
            return self._stride(best)
        return self._stride(self._elsewhere(q, best, number) or best)

    def tick(self, targets: tuple[Target, ...], q: Array, most: Array) -> Stride:
        """Move from `q` towards the targets within one tick, and never to another branch.

        The first step of the method tells how fast the joints would have to be. If that is too fast, the frames go only
        a part of the way. What is still too fast after the run is shortened, all joints by the same factor.

        Args:
            targets: The targets, of the question's kinds.
            q: The configuration to start from (nq,), inside the limits.
            most: The largest change of each joint within the tick, by tangent coordinate (nv,) [rad or m]; infinite
                where there is none.
        """
        question, options = self.question, self.question.options
        self._iterations, self._restarts = 0, 0
        self._deadline = time.perf_counter() + options.time_limit
        self.kinematics.retarget(targets)
        pace = Pace(min(options.iterations_at_most, TICK_ITERATIONS), options.method.patience, downhill=True)
        at = self.kinematics.linearize(q)
        first, _ = advance(question.solver, self.kinematics, question.limits, at, options.tolerance)
        excess, aim = self._largest_excess(q, first, most), targets
        if excess > 1.0:
            aim = _between(self._present(targets, q), targets, 1.0 / excess)
            self.kinematics.retarget(aim)
        state: State | None = self._run(q, pace)
        assert state is not None
        if self.is_jump(q, state.q):
            state = self._creep(aim, q, pace)
        there = q if state is None else state.q
        beyond = self._largest_excess(q, there, most)
        if beyond > 1.0:
            there = self._shortened(q, there, 1.0 / beyond)
        ended = Status.STALLED if state is None or state.status is None else state.status
        return Stride(ended, there, self._iterations, 0, excess > 1.0 or beyond > 1.0)

    def _largest_excess(self, before: Array, after: Array, most: Array) -> float:
        """The largest change of a joint with one axis, relative to the largest that is allowed."""
        joints = {coordinate.joint for coordinate in self.question.problem.coordinates}
        changes = [abs(joint_change(j, before, after)) / float(most[j.idx_v]) for j in joints if j.has_one_axis]
        return max(changes, default=0.0)

    def _shortened(self, before: Array, after: Array, part: float) -> Array:
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

    def _is_near(self, state: State, q: Array) -> bool:
        """Whether a run reached its targets without a jump away from `q`."""
        return state.status is Status.CONVERGED and not self.is_jump(q, state.q)

    def is_jump(self, before: Array, after: Array) -> bool:
        """Whether joints change far more than the motion of the present targets asks for (see `largest_asked`)."""
        change = largest_change(self.question.problem, before, after)
        return change > JUMP_FLOOR and change > largest_asked(self.kinematics, before)

    def _creep(self, targets: tuple[Target, ...], q: Array, pace: Pace) -> State | None:
        """Approach the targets in smaller steps, each half of the last if it fails; None if the smallest one fails."""
        origins = self._present(targets, q)
        done, step, state = 0.0, 0.5, None
        while done < 1.0 and step >= 0.5**CREEP_HALVINGS:
            part = min(done + step, 1.0)
            self.kinematics.retarget(_between(origins, targets, part))
            tried = self._run(q if state is None else state.q, pace)
            if tried.status is Status.TIME_LIMIT:
                break
            if self._is_near(tried, q if state is None else state.q):
                done, state = part, tried
            else:
                step /= 2.0
        self.kinematics.retarget(targets)
        return state if done >= 1.0 else None

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
                answers.append(state._replace(q=self.question.limits.wrap(state.q, q)))
                if not self.is_jump(q, answers[-1].q):
                    break
            elif state.status is Status.TIME_LIMIT:
                break
        return min(answers, key=lambda state: largest_change(problem, q, state.q), default=None)

    def _present(self, targets: tuple[Target, ...], q: Array) -> tuple[Target, ...]:
        """Targets of the same kinds that the frames meet at `q`."""
        kinematics = self.kinematics
        pinocchio.forwardKinematics(kinematics.model, kinematics.data, q)
        present = []
        for rows, target in zip(kinematics.rows, targets, strict=True):
            rows.update_placements()
            p, R = rows.seen_from_reference()
            axis = R[:, 0] if target.axis is None else R @ target.axis
            at = p if target.at is None else p + axis * np.linalg.norm(target.at - p)
            present.append(target.with_numbers(p.copy(), R.copy(), axis, at))
        return tuple(present)


def _between(origins: tuple[Target, ...], targets: tuple[Target, ...], part: float) -> tuple[Target, ...]:
    """The targets at a part of the way: positions on a line, rotations about one axis, directions in a plane."""
    return tuple(_one_between(origin, target, part) for origin, target in zip(origins, targets, strict=True))


def _one_between(origin: Target, target: Target, part: float) -> Target:
    def line(start: Array | None, end: Array | None) -> Array:
        return np.zeros(3) if start is None or end is None else start + part * (end - start)

    rotation = np.eye(3)
    if origin.rotation is not None and target.rotation is not None:
        whole = pinocchio.log3(target.rotation @ origin.rotation.T)
        rotation = pinocchio.exp3(part * whole) @ origin.rotation
    direction = line(origin.direction, target.direction)
    length = float(np.linalg.norm(direction))
    if target.direction is not None and length < NO_DIRECTION:  # the two directions are opposite
        direction, length = target.direction, 1.0
    return target.with_numbers(
        line(origin.position, target.position), rotation, direction / (length or 1.0), line(origin.at, target.at)
    )
