"""Residual and Jacobian of the targets at one configuration."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..model.robot_model import RobotModel
from .problem import RADIAN, Problem
from .rows import Rows
from .targets import Target, as_targets
from .tolerance import TargetError

__all__ = ["Kinematics", "Linearization"]

Array = NDArray[np.float64]


class Linearization(NamedTuple):
    """Residual, Jacobian and errors at one configuration.

    Attributes:
        q: The configuration (nq,).
        e: Weighted residual (m,) [m]. Orientation rows are radians times the chain's length.
        J: Weighted Jacobian (m, nv), zero in the columns that are not free.
        errors: The error of each target, unweighted.
        residual: The norm of e, before D_max shortens it [m].
        distance: The weighted norm of all errors [m]; a radian counts as 0.3 of the chain's length.
        free: (nv,) whether the solver may move a tangent coordinate.
    """

    q: Array
    e: Array
    J: Array
    errors: list[TargetError]
    residual: float
    distance: float
    free: NDArray[np.bool_]


class Kinematics:
    """The targets of a robot, ready to be evaluated at many configurations.

    An instance owns a `pinocchio.Data`, so each thread needs its own instance.

    Attributes:
        problem: The targets, compiled; see `Problem`. Any thread may read it.
        robot, model: The robot and the model of the problem.
        data: The `pinocchio.Data` of the last evaluation.
        targets: The current targets.
        rows: The rows of e and J for each target.
        evaluations: The number of residual evaluations so far.
        loose: Whether residuals stop pulling inside their tolerances (`problem.slack`).
    """

    def __init__(
        self,
        robot: RobotModel,
        targets: Target | Sequence[Target],
        *,
        locked: Iterable[str] = (),
        target_jacobian: bool = False,
    ) -> None:
        """Compile the targets; the arguments and errors are those of `Problem`."""
        self._begin(Problem(robot, targets, locked=locked, target_jacobian=target_jacobian))

    @classmethod
    def of(cls, problem: Problem) -> Kinematics:
        """For pinik itself: the kinematics of a compiled problem."""
        made = cls.__new__(cls)
        made._begin(problem)
        return made

    def _begin(self, problem: Problem) -> None:
        self.evaluations, self.loose = 0, False
        self._compile(problem)

    def _compile(self, problem: Problem) -> None:
        self.problem = problem
        self.robot, self.model, self.targets = problem.robot, problem.model, problem.targets
        self.data = self.model.createData()
        self.rows = [
            Rows(term, target, self.model, self.data, problem.target_jacobian)
            for term, target in zip(problem.terms, problem.targets, strict=True)
        ]

    def retarget(self, targets: Target | Sequence[Target]) -> None:
        """For pinik itself: replace the targets. If they are of the same kinds, nothing is compiled again."""
        asked = as_targets(targets)
        problem = self.problem
        if [target.shape for target in asked] != problem.kinds:
            locked = [joint.name for joint in problem.locked]
            at_target, tolerance = problem.target_jacobian, problem.tolerance
            self._compile(Problem(self.robot, asked, locked=locked, target_jacobian=at_target, tolerance=tolerance))
            return
        self.targets = asked
        for rows, target in zip(self.rows, asked, strict=True):
            rows.target = target

    def linearize(self, q: Array) -> Linearization:
        """Residual, Jacobian and errors at `q` (nq,)."""
        self.evaluations += 1
        if len(self.rows) == 1:
            e, J, error = self.rows[0].linearize(q, self.loose)
            errors = [error]
        else:
            parts = [rows.linearize(q, self.loose) for rows in self.rows]
            e = np.concatenate([part[0] for part in parts])
            J = np.vstack([part[1] for part in parts])
            errors = [part[2] for part in parts]
        problem = self.problem
        if problem.columns_to_clear is not None:
            J[:, problem.columns_to_clear] = 0.0
        distance = self._distance_outside(e) if self.loose else self._distance(errors)
        return Linearization(q, e, J, errors, math.sqrt(e.dot(e)), distance, problem.free)

    def _distance_outside(self, e: Array) -> float:
        """The distance of a residual that has stopped pulling inside the tolerances."""
        squared, row = 0.0, 0
        for term in self.problem.terms:
            turning = row + term.size - 3 * term.pattern.asks_orientation
            squared += float(e[row:turning].dot(e[row:turning]))
            row += term.size
            squared += RADIAN * RADIAN * float(e[turning:row].dot(e[turning:row]))
        return math.sqrt(squared)

    def _distance(self, errors: list[TargetError]) -> float:
        squared, of_a_radian = 0.0, self.problem.squared_metres_per_radian
        for rows, (position, orientation) in zip(self.rows, errors, strict=True):
            own = 0.0 if position is None else position * position
            if orientation is not None:
                own += of_a_radian * orientation * orientation
            squared += rows.term.weight * rows.term.weight * own
        return math.sqrt(squared)

    def shortened(self, e: Array, longest: float) -> Array:
        """The residual with each position part shortened to at most `longest` [m] (ClampMag in the thesis)."""
        e = e.copy()
        row = 0
        for term in self.problem.terms:
            if term.pattern.position is not None:
                part = e[row : row + 3]
                length = math.sqrt(part.dot(part)) / term.weight
                if length > longest:
                    part *= longest / length
            row += term.size
        return e
