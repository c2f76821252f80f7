"""`Robot`: a robot with forward and inverse kinematics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pinocchio
from numpy.typing import ArrayLike

from .model.robot_model import RobotModel
from .problem.targets import Target, Tolerance
from .solvers.registry import Method
from .solving.front import answer
from .solving.solution import Solution
from .solving.words import UNWEIGHTED

__all__ = ["Robot"]


class Robot(RobotModel):
    """A robot as returned by `pinik.load`: a `RobotModel` with the method `solve`."""

    def solve(
        self,
        targets: str | Target | Sequence[Target],
        position: ArrayLike | None = None,
        *,
        rotation: ArrayLike | None = None,
        rpy: ArrayLike | None = None,
        quat_xyzw: ArrayLike | None = None,
        quat_wxyz: ArrayLike | None = None,
        placement: pinocchio.SE3 | ArrayLike | None = None,
        axis: str | ArrayLike | None = None,
        direction: ArrayLike | None = None,
        at: ArrayLike | None = None,
        tool: pinocchio.SE3 | ArrayLike | None = None,
        relative_to: str | None = None,
        weight: float = UNWEIGHTED,
        method: Method = "dls",
        q0: ArrayLike | Mapping[str, float] | str | None = None,
        limits: bool = True,
        locked: Iterable[str] = (),
        restarts: int | None = None,
        seed: int = 0,
        max_iterations: int | None = None,
        tolerance: Tolerance | ArrayLike | None = None,
        time_limit: float | None = None,
        engine: str = "auto",
        trace: bool = False,
        polish: bool = True,
        choose: str = "first",
        choose_weights: Mapping[str, float] | None = None,
        **solver_parameters: Any,
    ) -> Solution:
        """Find joint values that move frames of the robot to their targets.

        `pinik.solve` explains the arguments, the solution and the errors. Problems of the same kind are compiled only
        once.
        """
        wanted = (
            position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
        )  # fmt: skip
        given = (
            limits, locked, restarts, seed, max_iterations, tolerance, time_limit, engine, trace, polish, choose,
            choose_weights,
        )  # fmt: skip
        return answer(self, targets, method, wanted, q0, given, solver_parameters)
