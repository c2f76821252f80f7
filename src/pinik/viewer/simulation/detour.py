"""Detours: free configurations for an instance whose next step would touch something."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...problem.targets import Target
from ...robot import Robot
from ...shapes.avoid import Avoid
from ...solving.options import Options
from ...solving.prepared import Prepared
from ...solving.solution import Solution
from ...solving.state import State, Status
from ...solving.verdict import measure_errors

__all__ = ["Detours"]

_RESTARTS = 24


class Detours:
    """Finds free answers, each nearest to where the instance stands. The last question is kept compiled."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._prepared: Prepared | None = None
        self._key: tuple[Any, ...] = ()

    def around(
        self, state: State, targets: tuple[Target, ...], q: NDArray[np.float64], options: Options, avoid: Avoid
    ) -> tuple[State, str]:
        """The state to take instead of one at which something touches, and why it is none that reaches the targets.

        It is a free one that reaches them, or else the place from which the step began.

        Args:
            state: Where something touches.
            targets: What was asked for.
            q: Where the step began (nq,).
            options: The method and settings of the step.
            avoid: What must not be touched.
        """
        free = self.find(targets, q, options, avoid)
        if free.success:
            return state._replace(q=free.q, errors=free.errors, status=Status.CONVERGED), ""
        errors = measure_errors(self._robot, targets, q, options.tolerance)
        return state._replace(q=q, errors=errors, status=Status.COLLIDING), free.message

    def find(self, targets: tuple[Target, ...], q: NDArray[np.float64], options: Options, avoid: Avoid) -> Solution:
        """The solution for targets from q (nq,), with the method and settings of `options`.

        A success touches nothing. The way there is not looked at: the robot jumps, as it does whenever a ball does.
        """
        key = (options, avoid.around, [target.shape for target in targets])
        if self._prepared is None or key != self._key:
            asked = Options.of(
                method=options.method, limits=options.limits, tolerance=options.tolerance, restarts=_RESTARTS,
                choose="nearest", avoid=avoid,
            )  # fmt: skip
            self._prepared, self._key = Prepared(self._robot, targets, asked), key
        return self._prepared.answer(targets, q)
