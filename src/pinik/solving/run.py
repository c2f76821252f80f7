"""One run of one solver from one start: the loop that every solve, study and live view drains."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics, Linearization
from ..problem.reach import Bounds, bounds_of, shortfall
from ..problem.targets import Target
from ..solvers.base import JacobianSolver, Patience, SweepingSolver
from .question import Question
from .state import State, Status
from .stepping import advance

__all__ = ["AT_REST", "TO_THE_END", "Pace", "States", "run"]

Array = NDArray[np.float64]
States = Generator[State, Target | Sequence[Target] | None, None]
"""The states of a run. `send` moves the targets, takes the next step and returns its state."""

TO_THE_END = Patience(50, 1e-4)
"""The patience of a run that no other attempt follows."""

AT_REST = 1e-9
"""The largest joint change [rad or m] that rounding may cause in an exact method at rest."""

BOLD_SHARE = math.sqrt(0.1)
"""The share of the distance that sets the damping of a bold run."""

SHARE_OF_CHAIN = 0.5
"""A miss that stays is damped like one of at least this share of the chain's length, in the geometric mean."""


class Pace(NamedTuple):
    """How a run proceeds, and when it gives up.

    Attributes:
        max_iterations: Iterations at most.
        patience: When it has stalled.
        bold: Whether a Jacobian method takes bolder steps, because another attempt can follow: damping that depends on
            the distance uses a third of it, and limits hold only at the end. A configuration that reaches the targets
            outside the limits is turned back by whole turns; if that is not enough it is moved inside, and the run goes
            on within the limits.
        downhill: Whether a Jacobian method's step is shortened until the residual falls, so that it comes to rest where
            it would otherwise oscillate.
        attempt: The run's number.
    """

    max_iterations: int
    patience: Patience = TO_THE_END
    bold: bool = False
    downhill: bool = False
    attempt: int = 0


def run(question: Question, kinematics: Kinematics, start: Array, pace: Pace) -> States:
    """The states of one run, the start first; the last one has a status.

    Where a target is provably out of reach, damping that depends on the distance d uses √(d · max(d, L/2)) instead,
    with the chain's length L. A stretched-out arm would swing from side to side where λ² is small compared with d · L.

    Args:
        question: What to solve, and how.
        kinematics: The targets, on which the run works.
        start: Where to start (nq,), inside the limits.
        pace: How to proceed.
    """
    loop = _Loop(question, kinematics, start, pace)
    while True:
        state = loop.look()
        moved = yield state
        if moved is not None:
            loop.aim_at(moved)
        elif state.status is not None:
            return
        loop.step()


class _Loop:
    """A run under way: where it stands, and since when it has made no progress."""

    def __init__(self, question: Question, kinematics: Kinematics, start: Array, pace: Pace) -> None:
        self.question, self.kinematics, self.pace = question, kinematics, pace
        solver, limits = question.solver, question.limits
        self.takes_directions = isinstance(solver, JacobianSolver)
        self.bold = pace.bold and self.takes_directions
        self.box = limits.loosened() if self.bold and limits.enabled else limits
        self.bounds: list[Bounds | None] = question.bounds if self.damps else []
        self.problem = question.problem
        self.beyond = self.is_beyond()
        self.iteration, self.last, self.updates, self.scale, self.rests = 0, pace.max_iterations, 0, 1.0, False
        self.at = kinematics.linearize(start)
        self.milestone, self.since = self.at.residual, 0

    @property
    def damps(self) -> bool:
        """Whether it matters if a target is out of reach; a bold run knows that its targets may be reached."""
        return self.takes_directions and not self.bold

    def is_beyond(self) -> bool:
        """Whether a target is provably out of reach."""
        slack = self.question.options.tolerance.position
        return self.damps and shortfall(self.kinematics.targets, self.bounds, slack) is not None

    def look(self) -> State:
        """The state of the run as it stands."""
        solver, limits, patience = self.question.solver, self.question.limits, self.pace.patience
        # An exact method steps even from a start that is near enough: it may be asked for the other elbow.
        reached = self.is_reached() and (self.iteration > 0 or not solver.exact)
        if reached and not limits.contains(self.at.q):  # only a bold run gets there
            self.box = limits
            self.at = self.kinematics.linearize(limits.clip(limits.wrap(self.at.q)))
            self.milestone, self.since = self.at.residual, 0
            reached = self.is_reached()
        if self.at.residual < self.milestone * (1.0 - patience.progress):
            self.milestone, self.since = self.at.residual, 0
        status: Status | None
        if reached:
            status = Status.CONVERGED
        elif self.rests or (self.since >= patience.iterations and not solver.exact):
            status = Status.STALLED
        else:
            status = Status.MAX_ITERATIONS if self.iteration >= self.last else None
        at = self.at
        at.q.setflags(write=False)  # the next step starts from it
        return State(at.q, self.iteration, self.updates, tuple(at.errors), at.residual, self.pace.attempt, status)

    def aim_at(self, targets: Target | Sequence[Target]) -> None:
        """Move the targets; the run may take as many iterations again."""
        self.kinematics.retarget(targets)
        if self.kinematics.problem is not self.problem:
            self.problem = self.kinematics.problem
            self.bounds = bounds_of(self.problem, self.question.limits) if self.damps else []
        self.beyond = self.is_beyond()
        self.at = self.kinematics.linearize(self.at.q)
        self.milestone, self.since, self.last = math.inf, 0, self.iteration + self.pace.max_iterations

    def step(self) -> None:
        """Take the next step."""
        solver, at = self.question.solver, self.at
        tolerance = self.question.options.tolerance
        q, updated = advance(solver, self.kinematics, self.box, self.damped(), tolerance, self.scale)
        there = self.kinematics.linearize(q)
        self.rests = solver.exact and bool(np.abs(q - at.q).max() < AT_REST)
        if not self.pace.downhill or isinstance(solver, SweepingSolver):
            self.at = there
        elif there.residual < at.residual:
            self.at, self.scale = there, min(2.0 * self.scale, 1.0)
        else:
            self.scale /= 4.0
        self.iteration, self.updates, self.since = self.iteration + 1, self.updates + updated, self.since + 1

    def damped(self) -> Linearization:
        """The present linearization with the distance that damping depends on."""
        at = self.at
        if self.bold:
            return at._replace(distance=BOLD_SHARE * at.distance)
        if self.beyond:
            least = SHARE_OF_CHAIN * self.problem.size_of_chain
            return at._replace(distance=math.sqrt(at.distance * max(at.distance, least)))
        return at

    def is_reached(self) -> bool:
        """Whether every target is within tolerance."""
        tolerance = self.question.options.tolerance
        return all([error.within(tolerance) for error in self.at.errors])
