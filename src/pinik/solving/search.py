"""The search for all distinct answers to one question."""

from __future__ import annotations

import copy
import dataclasses
import math
import time

import numpy as np
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics
from ..problem.targets import Target
from ..problem.tolerance import Tolerance
from ..solvers.base import Patience
from .choice import SAME_ANSWER
from .continuum import RANK_THRESHOLD, Continuum
from .findings import Findings, Found
from .metric import Metric, largest_difference
from .question import Question
from .run import Pace, run
from .spread import Spread
from .state import Status
from .verdict import all_within, measure_errors

__all__ = ["Search"]

Array = NDArray[np.float64]

EXACT = 1e-9
"""The tolerance of an answer [rad, or m per length of the chain], unless a smaller one is asked for."""

PATIENCE = Patience(5, 0.05)
"""The patience of a run: one more or two fewer iterations find fewer answers in the same time."""

LEAST = 56
"""The smallest number of starts, where answers are isolated."""

SINCE = 3
"""The number of starts for each answer found that must bring nothing new before the search ends."""

SAMPLES = 32
"""The number of starts where answers are not isolated, without those that lead to colliding ones."""

SPACING = 0.5
"""The largest change [rad, or lengths of the chain] from a singular answer to one of a continuum that stands for it,
where answers are usually isolated."""

NEARLY_SINGULAR = 1e-3
"""The singular value per length of the chain below which an answer may belong to a continuum."""

RANKS = 3
"""The number of configurations whose Jacobian's rank tells whether answers are isolated."""

APPROACH = 0.7
"""The part of the distance to a known answer that a step must leave at most, if the run is to be heading for it."""

BASIN = 20.0
"""The distance from a known answer within which a run may be heading for it, per singular value [1/m] there."""

OUTSIDE = 1e-9
"""The largest change [rad, or lengths of the chain] that brings an answer inside the limits."""

ALIKE = 1e-6
"""The unit [rad or m] of distances and configurations that decide on the order of answers; answers are less exact than
1e-9, by which two at the same distance differ."""


class Search:
    """Searches for the answers to questions of one kind, with the working memory of one thread."""

    def __init__(self, question: Question) -> None:
        self.question = question
        self._sharp = _sharpened(question)
        self._limits = question.limits
        self._loose = dataclasses.replace(self._sharp, limits=self._limits.loosened())
        self._kinematics = Kinematics.of(self._sharp.problem)
        self._metric = Metric(self._sharp.problem, self._limits)
        self._continuum = Continuum(self._kinematics, self._limits)
        self._spread = Spread(self._kinematics, self._limits, question.options.seed)
        self._redundancy: int | None = None

    def __call__(self, targets: tuple[Target, ...], start: Array) -> Findings:
        """Search for the answers to these targets, from `start` (nq,), inside the limits, and from other starts."""
        self._began = time.perf_counter()
        options = self.question.options
        deadline = self._began + options.time_limit
        self._kinematics.retarget(targets)
        candidates = self._spread.begin(start)
        most = min(candidates, options.restarts_at_most)
        self._spread.mark(start)
        if self._redundancy is None:
            self._redundancy = self._dimension(start)
        self._answers: list[Found] = []
        self._last_new, self._starts, self._iterations, self._deadline = 0, 0, 0, deadline
        self._arrived, self._colliding = 0, 0
        self._is_late = False
        q = start
        while True:
            self._attempt(q, start)
            if self._is_late or self._starts > most or self._is_enough():
                return self._findings(targets, start)
            q = self._spread.next()

    def _dimension(self, start: Array) -> int:
        """The number of free coordinates without the rank of the Jacobian at general configurations."""
        take, rank = self._spread.take, self._continuum.rank
        return len(self._continuum.free) - max(rank(take(k, start), RANK_THRESHOLD) for k in range(1, RANKS + 1))

    def _is_enough(self) -> bool:
        """Whether further starts are unlikely to bring a new answer.

        Of infinitely many there are enough. Of isolated answers, each inside the limits was found twice, and there were
        three starts for each since the last new one.
        """
        isolated = [answer for answer in self._answers if answer.dimension == 0]
        if self._redundancy and not (isolated and len(isolated) == len(self._answers)):
            return self._starts - self._colliding >= SAMPLES
        since = self._starts - 1 - self._last_new
        return (
            self._starts >= LEAST
            and since >= SINCE * len(isolated)
            and all(answer.hits >= 2 for answer in isolated if answer.is_inside)
        )

    def _attempt(self, start: Array, near: Array) -> None:
        """Run from one start.

        If answers are isolated, the run may leave the limits to the end, since an answer outside counts as known too.
        A continuum outside the limits may have another part inside them, so a second run looks for one there.
        """
        number = self._starts
        self._starts += 1
        answer = self._run(self._sharp if self._redundancy else self._loose, start, near, number)
        self._arrived += answer is not None
        if answer is not None and answer.dimension and not answer.is_inside:
            answer = self._run(self._sharp, self._limits.wrap(answer.q, near), near, number)
        if answer is not None and answer.collides:
            self._colliding += 1

    def _run(self, question: Question, start: Array, near: Array, number: int) -> Found | None:
        """The answer that a run from start `number` leads to, with one more hit; None if to none.

        If answers are isolated, the run ends as soon as it is heading for a known one.
        """
        pace = Pace(self.question.options.iterations_at_most, PATIENCE, bold=True, loosens=False)
        known: Found | None = None
        before = start
        for state in run(question, self._kinematics, start, pace, near):
            self._iterations += 1
            if state.status is not None:
                break
            if self._deadline < math.inf and time.perf_counter() > self._deadline:
                self._is_late = True
                return None
            known = self._heading_for(state.q, before) if state.iteration else None
            if known is not None:
                break
            before = state.q
        if known is None and state.status is not Status.CONVERGED:
            return None
        for answer in self._answers:
            if known is None and self._metric.largest(state.q, answer.q) <= SAME_ANSWER:
                known = answer
        if known is None:
            return self._add(state.q, near, number)
        known.hits += 1
        return known

    def _heading_for(self, q: Array, before: Array) -> Found | None:
        """The known answer that a run is heading for: one nearby, which the step from `before` to `q` led towards."""
        for answer in self._answers:
            now = self._metric.length(q, answer.q)
            if now < answer.basin and now < APPROACH * self._metric.length(before, answer.q):
                return answer
        return None

    def _add(self, q: Array, near: Array, number: int) -> Found:
        """Add an answer; or count it for the known one of a continuum that stands for it, and return that one."""
        inside = self._limits.wrap(q, near)
        is_inside = self._metric.largest(inside, q) <= OUTSIDE
        answer = Found(inside if is_inside else q, is_inside, number)
        usual = answer.dimension = self._redundancy or 0
        least = self._least_singular_value(answer.q)
        answer.basin = 0.0 if usual else BASIN * least
        is_singular = least < NEARLY_SINGULAR
        exact = self._continuum.settled(answer.q) if is_singular else answer.q
        kernel = self._continuum.kernel(exact) if is_singular else np.zeros((0, 0))
        if usual or len(kernel):
            answer.collides = is_inside and self.question.touches(answer.q)
        if len(kernel) > usual:
            for other in self._answers:
                if not usual and self._stands_for(other, answer):
                    other.hits += 1
                    return other
            answer.dimension = self._continuum.dimension(exact, kernel, usual)
        self._spread.mark(answer.q)
        self._answers.append(answer)
        if answer.dimension == 0 or self._redundancy:
            self._last_new = number
        return answer

    def _stands_for(self, known: Found, answer: Found) -> bool:
        """Whether a known answer belongs to a continuum and is like a singular one nearby."""
        alike = (known.is_inside, known.collides) == (answer.is_inside, answer.collides)
        return known.dimension > 0 and alike and self._metric.largest(known.q, answer.q) <= SPACING

    def _least_singular_value(self, q: Array) -> float:
        """A lower bound of the Jacobian's smallest singular value, per length of the chain: σ² ≥ 1 / trace (JᵀJ)⁻¹.

        With more columns than rows, JJᵀ takes the place of JᵀJ.
        """
        J = self._kinematics.linearize(q).J[:, self._sharp.problem.free]
        try:
            trace = float(np.trace(np.linalg.inv(J.T @ J if len(J) >= len(J.T) else J @ J.T)))
        except np.linalg.LinAlgError:
            return 0.0
        return 1.0 / math.sqrt(trace) / self._sharp.problem.size_of_chain if 0.0 < trace < math.inf else 0.0

    def _findings(self, targets: tuple[Target, ...], start: Array) -> Findings:
        question = self.question
        findings = dataclasses.replace(
            Findings.nothing(question.robot.model.nq),
            outside=sum(not answer.is_inside for answer in self._answers),
            starts=self._starts,
            arrived=self._arrived,
            iterations=self._iterations,
            redundancy=max([answer.dimension for answer in self._answers if answer.is_inside], default=None),
            ended_early=self._is_late,
        )
        model = question.robot.model
        inside = [(largest_difference(model, start, answer.q), answer) for answer in self._answers if answer.is_inside]
        for distance, answer in sorted(inside, key=lambda pair: _in_order(pair[0], pair[1].q)):
            errors = measure_errors(question.robot, targets, answer.q, question.options.tolerance)
            if not all_within(errors, question):
                continue
            if question.touches(answer.q) if answer.collides is None else answer.collides:
                findings.colliding += 1
                continue
            findings = findings.with_answer(
                answer.q, distance, errors, found_at=answer.start, hits=answer.hits, dimension=answer.dimension
            )
        findings.time = time.perf_counter() - self._began
        return findings


def _in_order(distance: float, q: Array) -> tuple[float, ...]:
    """The key of an answer's place among others: its distance, and where those are alike its configuration (nq,)."""
    return tuple(np.rint(np.append(distance, q) / ALIKE).tolist())


def _sharpened(question: Question) -> Question:
    """The question with tolerances that only exact answers meet."""
    problem = copy.copy(question.problem)
    size = problem.size_of_chain
    problem.terms = tuple([dataclasses.replace(term, tolerance=_sharp(term.tolerance, size)) for term in problem.terms])
    problem.is_wide = False
    options = dataclasses.replace(question.options, tolerance=_sharp(question.options.tolerance, size))
    return dataclasses.replace(question, problem=problem, options=options)


def _sharp(tolerance: Tolerance, size_of_chain: float) -> Tolerance:
    allowed = tolerance.position
    least = min(allowed) if isinstance(allowed, tuple) else allowed
    return Tolerance(min(least, EXACT * size_of_chain), min(tolerance.orientation, EXACT))
