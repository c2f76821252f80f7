"""One run of one solver from one start: the iteration loop of solves, studies and the live view."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics, Linearization
from ..problem.reach import Bounds, bounds_of, shortfall
from ..problem.targets import Target, as_targets
from ..solvers.base import JacobianSolver, Patience, SweepingSolver
from .question import Question
from .state import State, Status
from .stepping import advance

__all__ = ["AT_REST", "TO_THE_END", "Pace", "States", "run"]

Array = NDArray[np.float64]
States = Generator[State, Target | Sequence[Target] | None, None]
"""The states of a run. `send(targets)` moves the targets, takes the next step and returns its state."""

TO_THE_END = Patience(50, 1e-4)
"""The patience of a run after which there are no further attempts."""

AT_REST = 1e-9
"""The largest joint change in one step [rad or m] at which an exact method counts as being at rest."""

BOLD_SHARE = math.sqrt(0.1)
"""The fraction of the distance that determines the damping of a bold run."""

SHARE_OF_CHAIN = 0.5
"""For targets out of reach: the smallest distance in the geometric mean that sets damping, per length of the chain."""


POLISHING_GAIN = 0.5
"""The fraction to which a polishing step must reduce the residual; otherwise it is the last one."""

EXACT_SHARE_OF_CHAIN = 3e-9
"""The residual of the lightest target, per length of the chain, below which no polishing step follows."""


class Pace(NamedTuple):
    """How a run proceeds, and when it gives up.

    Attributes:
        max_iterations: The maximum number of iterations.
        patience: The condition under which the run has stalled.
        bold: Whether a Jacobian method takes larger steps, because another attempt can follow: damping uses √0.1 of the
            distance, and limits are enforced only at the end. If a configuration reaches the targets outside the
            limits, its hinges are moved by whole turns. If that is not enough, it is clipped to the limits, and the run
            continues within them.
        downhill: Whether a Jacobian method's step is shortened until the residual decreases, so that the run converges
            where it would otherwise oscillate.
        attempt: The number of the run.
        loosens: Whether a run that stalls looks for an answer inside wide tolerances.
    """

    max_iterations: int
    patience: Patience = TO_THE_END
    bold: bool = False
    downhill: bool = False
    attempt: int = 0
    loosens: bool = True


def run(question: Question, kinematics: Kinematics, start: Array, pace: Pace, near: Array | None = None) -> States:
    """Yield the states of one run, beginning with the start; the last one has a status.

    If a target is provably out of reach, √(d · max(d, L/2)) replaces the distance d in the damping, where L is the
    chain's length. Otherwise a stretched arm would swing from side to side when λ² is small compared with d · L.

    If a tolerance is wide and the run stalls, it goes on inside the limits with residuals that stop pulling inside
    their tolerances. It stays so when the targets move.

    Args:
        question: The problem and the options.
        kinematics: The kinematics of the targets; the run modifies it.
        start: The start (nq,), inside the limits.
        pace: How the run proceeds and when it gives up.
        near: The configuration (nq,) to which hinges that are moved by whole turns should be near; the start when None.
    """
    loop = _Loop(question, kinematics, start, pace, start if near is None else near)
    while True:
        state = loop.look()
        moved = yield state
        if moved is not None:
            loop.aim_at(moved)
        elif state.status is not None:
            return
        loop.step()


class _Loop:
    """A run in progress: its present linearization, and the iterations since its last progress."""

    def __init__(self, question: Question, kinematics: Kinematics, start: Array, pace: Pace, near: Array) -> None:
        self.question, self.kinematics, self.pace, self.near = question, kinematics, pace, near
        solver, limits = question.solver, question.limits
        self.takes_directions = isinstance(solver, JacobianSolver)
        self.bold = pace.bold and self.takes_directions
        self.box = limits.loosened() if self.bold and limits.enabled else limits
        self.bounds: list[Bounds | None] = question.bounds if self.damps else []
        self.problem = question.problem
        self.beyond = self.is_beyond()
        self.iteration, self.last, self.updates, self.scale, self.rests = 0, pace.max_iterations, 0, 1.0, False
        kinematics.loose = False
        self.at = kinematics.linearize(start)
        self.milestone, self.since = self.at.residual, 0
        self.polishes = question.options.polish and solver.converges_quadratically
        self.before: Linearization | None = None  # the state before the last polishing step

    @property
    def exact(self) -> float:
        """The residual [m] that polishing does not reduce any further."""
        return EXACT_SHARE_OF_CHAIN * self.problem.size_of_chain * self.problem.lightest

    @property
    def damps(self) -> bool:
        """Whether to check if a target is out of reach. A bold run need not: its targets are not provably so."""
        return self.takes_directions and not self.bold

    def is_beyond(self) -> bool:
        """Whether a target is provably out of reach."""
        tolerance = self.question.options.tolerance
        return self.damps and shortfall(self.kinematics.targets, self.bounds, tolerance) is not None

    def look(self) -> State:
        """The present state of the run."""
        solver, limits, patience = self.question.solver, self.question.limits, self.pace.patience
        # An exact method takes a step even if the start is within tolerance, because the other elbow may be requested.
        reached = self.is_reached() and (self.iteration > 0 or not solver.exact)
        if reached and not limits.contains(self.at.q):  # only a bold run leaves the limits
            self.move_inside()
            reached = self.is_reached()
        if self.polishes and not self.kinematics.loose and (reached or self.before is not None):
            reached = not self.is_worth_another_step(reached)
        if self.at.residual < self.milestone * (1.0 - patience.progress):
            self.milestone, self.since = self.at.residual, 0
        status: Status | None
        if reached:
            status = Status.CONVERGED
        elif self.rests or (self.since >= patience.iterations and not solver.exact):
            status = Status.STALLED
        else:
            status = Status.MAX_ITERATIONS if self.iteration >= self.last else None
        if status is Status.STALLED and self.can_loosen():
            self.kinematics.loose, self.scale, status = True, 1.0, None
            self.move_inside()
        at = self.at
        at.q.setflags(write=False)  # the next step starts from it
        return State(at.q, self.iteration, self.updates, tuple(at.errors), at.residual, self.pace.attempt, status)

    def move_inside(self) -> None:
        """Move the configuration inside the limits, and keep it there from now on."""
        limits = self.question.limits
        self.box = limits
        self.at = self.kinematics.linearize(limits.wrap(self.at.q, self.near))
        self.milestone, self.since = self.at.residual, 0

    def can_loosen(self) -> bool:
        """Whether an answer inside wide tolerances remains to be looked for."""
        wanted = self.problem.is_wide and self.pace.loosens
        return wanted and not (self.kinematics.loose or self.beyond or self.question.solver.exact)

    def is_worth_another_step(self, reached: bool) -> bool:
        """Whether to go on although the targets are or were within tolerance; if not, keep the better of two states."""
        at, before = self.at, self.before
        gains = reached and (before is None or at.residual <= POLISHING_GAIN * before.residual)
        if gains and at.residual > self.exact and self.iteration < self.last:
            self.before, self.box, self.since = at, self.question.limits, 0
            return True
        if before is not None and not (reached and at.residual <= before.residual):
            self.at = before
        self.before = None
        return False

    def aim_at(self, targets: Target | Sequence[Target]) -> None:
        """Move the targets, and reset the iteration limit.

        If a tolerance is wide, targets that move before they are reached leave no time to stall, so the run looks for
        answers inside the tolerances at once. The same targets again do not interrupt the wait for a stall.
        """
        kinematics = self.kinematics
        waits = self.can_loosen() and self.since < self.pace.patience.iterations and not self.is_reached()
        moved = as_targets(targets) != kinematics.targets
        kinematics.retarget(targets)
        kinematics.loose = kinematics.loose or (waits and moved)
        if kinematics.problem is not self.problem:
            self.problem, kinematics.loose = kinematics.problem, False
            self.bounds = bounds_of(self.problem, self.question.limits) if self.damps else []
        self.beyond = self.is_beyond()
        self.at = kinematics.linearize(self.at.q)
        if moved or not waits:
            self.milestone, self.since = math.inf, 0
        self.last = self.iteration + self.pace.max_iterations
        self.before = None

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
        """The present linearization, with the distance that determines the damping."""
        at = self.at
        if self.bold:
            return at._replace(distance=BOLD_SHARE * at.distance)
        if self.beyond:
            least = SHARE_OF_CHAIN * self.problem.size_of_chain
            return at._replace(distance=math.sqrt(at.distance * max(at.distance, least)))
        return at

    def is_reached(self) -> bool:
        """Whether every target is within tolerance."""
        return all(
            [error.within(term.tolerance) for error, term in zip(self.at.errors, self.problem.terms, strict=True)]
        )
