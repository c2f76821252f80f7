"""One run of one solver from one start: the loop that every solve, study and live view drains."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..model.limits import Limits
from ..model.robot_model import Robot
from ..problem.kinematics import Kinematics, Linearization
from ..problem.reach import bounds_of, shortfall
from ..problem.targets import Target, Tolerance
from ..solvers.base import JacobianSolver, Patience, Solver, SweepingSolver
from .state import State, Status
from .stepping import advance

__all__ = ["AT_REST", "TO_THE_END", "compiled_for", "run"]

Array = NDArray[np.float64]

TO_THE_END = Patience(50, 1e-4)
"""How patiently a run is followed to its end when no other attempt waits."""

AT_REST = 1e-9
"""What an exact method's rounding may still move a joint by [rad or m]."""

OF_THE_DISTANCE = math.sqrt(0.1)  # what a bold run's damping goes by
OF_THE_CHAIN = 0.5  # a miss that stays is damped as if it were this part of the chain's length, in the geometric mean


def compiled_for(
    solver: Solver, robot: Robot, targets: Target | Sequence[Target], locked: Iterable[str] = ()
) -> Kinematics:
    """The targets as this solver sees them: with the joints that it holds, and its kind of Jacobian.

    Raises:
        UnknownNameError, InputError: As `Kinematics`; or the solver cannot do what is asked.
    """
    at_target = isinstance(solver, JacobianSolver) and solver.target_jacobian
    kinematics = Kinematics(robot, targets, locked=(*locked, *solver.held), target_jacobian=at_target)
    solver.check(kinematics)
    return kinematics


def run(
    solver: Solver,
    kinematics: Kinematics,
    limits: Limits,
    start: Array,
    max_iterations: int,
    tolerance: Tolerance,
    patience: Patience,
    *,
    bold: bool = False,
    downhill: bool = False,
    attempt: int = 0,
) -> Generator[State, Target | Sequence[Target] | None, None]:
    """States of one attempt.

    A `bold` run of a Jacobian method dares more, as another attempt waits: damping that follows the distance goes by a
    third of it, and limits hold only in the end. What lies outside them once the targets are reached is turned by whole
    turns, and where that is not enough put inside and led on inside. With `downhill` a
    Jacobian method's step is cut until the residual falls, so that it comes to rest where it would swing about.

    Where a target is proved out of reach, damping that follows the distance d goes by √(d · max(d, L/2)) with the
    chain's length L: a stretched-out arm swings from side to side where λ² is small beside d · L.
    """
    bold = bold and isinstance(solver, JacobianSolver)
    damps = isinstance(solver, JacobianSolver) and not bold  # a bold run knows that its targets may be reached
    compiled, bounds = kinematics.terms, bounds_of(kinematics, limits) if damps else []
    beyond = damps and shortfall(kinematics, limits, tolerance.position, bounds) is not None
    box = limits.loosened() if bold and limits.enabled else limits
    at = kinematics.linearize(start)
    milestone, since = at.residual, 0
    iteration, last, updates, scale, rests = 0, max_iterations, 0, 1.0, False
    status: Status | None
    while True:
        # An exact method takes its step from a start that is near enough as well: it may be asked for another elbow.
        reached = _reached(at, tolerance) and (iteration > 0 or not solver.exact)
        if reached and not limits.contains(at.q):  # only a run that steps freely gets there
            box, at = limits, kinematics.linearize(limits.clip(limits.wrap(at.q)))
            milestone, since = at.residual, 0
            reached = _reached(at, tolerance)
        if at.residual < milestone * (1.0 - patience.progress):
            milestone, since = at.residual, 0
        if reached:
            status = Status.CONVERGED
        elif rests or (since >= patience.iterations and not solver.exact):
            status = Status.STALLED
        else:
            status = Status.MAX_ITERATIONS if iteration >= last else None
        at.q.setflags(write=False)  # the next step starts from it
        moved = yield State(at.q, iteration, updates, tuple(at.errors), at.residual, attempt, status)
        if moved is not None:
            kinematics.retarget(moved)
            if damps and kinematics.terms is not compiled:
                compiled, bounds = kinematics.terms, bounds_of(kinematics, limits)
            beyond = damps and shortfall(kinematics, limits, tolerance.position, bounds) is not None
            at = kinematics.linearize(at.q)
            milestone, since, last = math.inf, 0, iteration + max_iterations
        elif status is not None:
            return
        seen = at
        if bold:
            seen = at._replace(distance=OF_THE_DISTANCE * at.distance)
        elif beyond:
            least = OF_THE_CHAIN * kinematics.size_of_chain
            seen = at._replace(distance=math.sqrt(at.distance * max(at.distance, least)))
        q, updated = advance(solver, kinematics, box, seen, tolerance, scale)
        there, rests = kinematics.linearize(q), solver.exact and bool(np.abs(q - at.q).max() < AT_REST)
        if not downhill or isinstance(solver, SweepingSolver):
            at = there
        elif there.residual < at.residual:
            at, scale = there, min(2.0 * scale, 1.0)
        else:
            scale /= 4.0
        iteration, updates, since = iteration + 1, updates + updated, since + 1


def _reached(at: Linearization, tolerance: Tolerance) -> bool:
    return all([error.within(tolerance) for error in at.errors])
