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

__all__ = ["Detours"]

_RESTARTS = 24


class Detours:
    """Finds free answers, each nearest to where the instance stands. The last question is kept compiled."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._prepared: Prepared | None = None
        self._key: tuple[Any, ...] = ()

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
