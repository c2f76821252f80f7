"""The attempts of one solve, with restarts, and the best configuration so far."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics
from ..problem.reach import Shortfall, shortfall
from ..problem.targets import Target
from ..problem.tolerance import TargetError
from .choice import NOTHING_NEW_SHARE, Choice
from .colliding import Colliding
from .question import Question
from .run import TO_THE_END, Pace, run
from .starts import Starts
from .state import State, Status
from .verdict import judge
from .way_out import WayOut

__all__ = ["Attempts", "Outcome", "Outcomes"]

Array = NDArray[np.float64]

EXACT_ATTEMPTS = 8
"""With a wide tolerance, the number of attempts that look for the exact place only."""

RESTARTS_WHEN_UNREACHABLE = 8
"""The maximum number of restarts for a target provably out of reach: the distance to it can have local minima too."""


RESTARTS_WHEN_EXACT = 16
"""The maximum number of restarts of an exact method whose answer collides: the start decides which elbow it takes."""

WAYS_OUT = 3
"""If something touches at all answers, the number of those from which a way out is tried, the shallowest first."""


class Outcome(NamedTuple):
    """The result of a solve.

    Attributes:
        status: The verdict on `q`.
        q: The best configuration (nq,), inside the limits.
        start: The start (nq,), moved inside the limits; the compiled engine leaves it empty if no joint of the robot is
            (cos, sin) in q.
        errors: The error of each target at `q`, by plain forward kinematics.
        iterations, joint_updates: Totals over all attempts.
        restarts: The number of restarts used.
        chosen_from: The number of distinct answers that `q` was chosen from; if the status is COLLIDING, all of them
            collide.
        proof: The proof that a target is out of reach, if there is one.
        states: Every state of every attempt, if a trace was requested.
        targets: The targets.
        time: The duration of the solve [s].
        engine: The engine that was used: "python" or "native".
    """

    status: Status
    q: Array
    start: Array
    errors: tuple[TargetError, ...]
    iterations: int
    joint_updates: int
    restarts: int
    chosen_from: int
    proof: Shortfall | None
    states: tuple[State, ...]
    targets: tuple[Target, ...]
    time: float
    engine: str = "python"


@dataclass(frozen=True, eq=False)
class Outcomes:
    """What N solves came to, one entry each; `many.Solutions` describes the fields."""

    q: Array
    status: NDArray[np.object_]
    position_error: Array
    orientation_error: Array
    iterations: NDArray[np.int64]
    joint_updates: NDArray[np.int64]
    restarts: NDArray[np.int64]
    chosen_from: NDArray[np.int64]
    time: Array


class Attempts:
    """The Python engine for one kind of question; each thread needs its own instance.

    Attributes:
        question: The kinds of the targets, and the options.
        kinematics: The kinematics of the current targets.
        way_out: The way out of slight touches.
        colliding: The answers of the present solve at which something touches.
    """

    def __init__(self, question: Question) -> None:
        self.question = question
        self.kinematics = Kinematics.of(question.problem)
        self.way_out = WayOut(question, self.kinematics)
        self.colliding = Colliding(question)
        self._starts = Starts(self.kinematics, question.limits, question.options.seed)

    def __call__(
        self,
        targets: tuple[Target, ...],
        start: Array,
        *,
        number: int = 0,
        nearest: bool = False,
        began: float | None = None,
    ) -> Outcome:
        """Make attempts until one reaches the targets: the first from `start`, the others from other starts.

        Args:
            targets: The targets, of the question's kinds.
            start: The start of the first attempt (nq,); it is moved inside the limits first.
            number: The index of this problem among many, which is one of the keys of the random starts.
            nearest: Whether the first attempt too starts near the targets; other joints stay as in `start`.
            began: The time at which the solve began, from `time.perf_counter` [s]; now when None.
        """
        self.kinematics.retarget(targets)
        return _Search(self, self.question.limits.wrap(start), number, nearest, began).outcome()

    def start(self, given: Array, attempt: int, number: int) -> Array:
        """The start of an attempt: as given for attempt 0, otherwise from the table or drawn at random."""
        return self._starts.next(given, target=number, number=attempt) if attempt else given

    @property
    def draws(self) -> bool:
        """Whether restarts begin at different configurations."""
        return self._starts.draws


class _Search:
    """The attempts for one set of targets, in progress.

    Attributes:
        iterations, joint_updates: Totals over the attempts so far.
        restarts: The number of restarts so far.
        best: The state inside the limits with the smallest residual so far.
        choice: The answers so far, for `choose="nearest"`.
        states: Every state so far, if a trace was requested.
    """

    def __init__(self, attempts: Attempts, start: Array, number: int, nearest: bool, began: float | None) -> None:
        self.attempts, self.question, self.kinematics = attempts, attempts.question, attempts.kinematics
        self.given, self.number, self.nearest = start, number, nearest
        self.began = time.perf_counter() if began is None else began
        self.deadline = self.began + self.question.options.time_limit
        self.iterations = 0
        self.joint_updates = 0
        self.restarts = 0
        self.best: State | None = None
        self.choice = Choice(self.question, start)
        self.colliding = attempts.colliding
        self.colliding.begin()
        self.states: list[State] = []

    def outcome(self) -> Outcome:
        """Make the attempts and judge the best configuration."""
        options = self.question.options
        if not self.question.problem.free.any():
            self._attempt(self._start(), Pace(0))
            status = Status.STALLED
        elif options.method.exact:
            status = self._attempt(self._start(), Pace(options.iterations_at_most))
            while status is Status.COLLIDING and self.restarts < RESTARTS_WHEN_EXACT:
                self.restarts += 1
                status = self._attempt(self._start(), Pace(options.iterations_at_most))
        elif options.restarts_at_most == 0:  # the method alone, as in `iterate`
            status = self._attempt(self._start(), Pace(options.iterations_at_most))
        else:
            status = self._attempt_and_restart()
        return self._judged(status)

    def _attempt_and_restart(self) -> Status:
        options = self.question.options
        proof = shortfall(self.kinematics.targets, self.question.bounds, options.tolerance)
        most = options.restarts_at_most if self.attempts.draws else 0
        if proof is not None:
            most = min(most, RESTARTS_WHEN_UNREACHABLE)
        pace = Pace(options.iterations_at_most, options.method.patience, bold=proof is None, downhill=proof is not None)
        # With a wide tolerance, the first attempts look for the exact place only. The next one begins where they began.
        first_loose = min(EXACT_ATTEMPTS, most)
        for self.restarts in range(most + 1):
            again = self.question.problem.is_wide and self.restarts == first_loose and not self.nearest
            start = self.given if again else self._start()
            loosens = self.restarts >= first_loose
            status = self._attempt(start, pace._replace(attempt=self.restarts, loosens=loosens))
            if status is Status.TIME_LIMIT or (status is Status.CONVERGED and options.choose == "first"):
                break
            assert self.best is not None
            self.choice.add(self.best.q if status is Status.CONVERGED else None)
            if self.choice.found:
                ends = self.choice.since >= math.ceil(NOTHING_NEW_SHARE * most)
            else:
                ends = self._no_other_answer()
            if ends:
                break
        assert self.best is not None
        if self.choice.found:
            self.best = self.best._replace(q=self.choice.nearest)
            return Status.CONVERGED
        if status is Status.CONVERGED:
            return status
        if not self.colliding.found and status is not Status.TIME_LIMIT:
            last = Pace(options.iterations_to_the_end, TO_THE_END, downhill=True, attempt=self.restarts + 1)
            status = self._attempt(self.best.q, last)
        return self._leave_touches() if self.colliding.found else status

    def _no_other_answer(self) -> bool:
        """Whether further attempts are unlikely to bring another answer than those that collide, which are isolated."""
        colliding = self.colliding
        return colliding.is_enough(self.restarts + 1) and all(map(self.attempts.way_out.is_isolated, colliding.found))

    def _leave_touches(self) -> Status:
        """Try the way out of the shallowest touches; take the first answer that is free, or else the shallowest."""
        assert self.best is not None
        way_out, tried = self.attempts.way_out, []
        ordered = sorted([(way_out.depth(q), number) for number, q in enumerate(self.colliding.found)])
        for _, number in ordered[:WAYS_OUT]:
            q, depth = way_out(self.colliding.found[number], self.given, self.deadline)
            tried.append((depth, number, q))
            if depth < 0.0:
                break
        depth, _, q = min(tried, key=lambda one: one[:2])
        self.best = self.best._replace(q=q)
        return Status.CONVERGED if depth < 0.0 else Status.COLLIDING

    def _start(self) -> Array:
        return self.attempts.start(self.given, self.restarts + self.nearest, self.number)

    def _attempt(self, start: Array, pace: Pace) -> Status:
        limits, options = self.question.limits, self.question.options
        for state in run(self.question, self.kinematics, start, pace, self.given):
            if options.trace:
                self.states.append(state)
            if (self.best is None or self._miss(state) < self._miss(self.best)) and limits.contains(state.q):
                self.best = state
            status = state.status
            if status is None and self.deadline < math.inf and time.perf_counter() > self.deadline:
                status = Status.TIME_LIMIT
            if status is not None:
                break
        self.iterations += state.iteration
        self.joint_updates += state.joint_updates
        if status is Status.CONVERGED:
            self.best = state
            q = limits.wrap(state.q, self.given)
            if self.question.touches(q):
                self.colliding.add(q, self.restarts)
                status = Status.COLLIDING
        elif not limits.contains(state.q):
            self._consider_inside(state)
        assert status is not None  # a run's last state has one
        return status

    def _miss(self, state: State) -> float:
        """How far a state misses the targets [m]: its residual, or its errors beyond the tolerances if one is wide."""
        problem = self.question.problem
        if not problem.is_wide:
            return state.residual
        metres = math.sqrt(problem.squared_metres_per_radian)
        return math.hypot(
            *[
                term.weight * error.excess(term.tolerance, metres)
                for term, error in zip(problem.terms, state.errors, strict=True)
            ]
        )

    def _consider_inside(self, state: State) -> None:
        """Move a state from outside the limits to the inside, and keep it if it is the best so far."""
        limits = self.question.limits
        at = self.kinematics.linearize(limits.wrap(state.q, self.given))
        inside = state._replace(q=at.q, errors=tuple(at.errors), residual=at.residual)
        if self.best is None or self._miss(inside) < self._miss(self.best):
            self.best = inside

    def _judged(self, ended: Status) -> Outcome:
        """The outcome with the best state, judged by plain forward kinematics."""
        assert self.best is not None
        q, targets = self.question.limits.wrap(self.best.q, self.given), self.kinematics.targets
        status, errors, proof = judge(self.question, targets, q, ended)
        chosen_from = len(self.colliding.found if status is Status.COLLIDING else self.choice.found)
        return Outcome(
            status, q, self.given, errors, self.iterations, self.joint_updates, self.restarts,
            max(1, chosen_from), proof, tuple(self.states), targets, time.perf_counter() - self.began,
        )  # fmt: skip
