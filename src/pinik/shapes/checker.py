"""Checkers: which pairs of solids touch at a configuration, and how deep, by coal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..engine import load
from ..model.robot_model import RobotModel
from .coal_checker import CoalChecker
from .native_checker import NativeChecker
from .solids import Solid
from .touch import Gap, Pair, Touch

__all__ = ["Checker", "make_checker"]

Array = NDArray[np.float64]


class Checker(Protocol):
    """What both engines do. Configurations must be valid ones of the robot; a checker may be used from any thread."""

    def report(self, q: Array) -> list[Touch]:
        """All pairs that touch at q (nq,), in the order of the pairs."""
        ...

    def clearance(self, q: Array) -> Gap | None:
        """The pair that is the least apart at q (nq,); None without pairs."""
        ...

    def touches(self, Q: Array) -> NDArray[np.bool_]:
        """Whether anything touches at each of N configurations (N, nq)."""
        ...

    def counts(self, Q: Array) -> NDArray[np.int64]:
        """In how many of N configurations (N, nq) each group touches."""
        ...


def make_checker(robot: RobotModel, solids: Sequence[Solid], pairs: Sequence[Pair], engine: str = "auto") -> Checker:
    """A checker of these pairs of solids.

    Args:
        robot: The robot that carries the solids.
        solids: The solids; those of the world are fixed to joint 0.
        pairs: The pairs.
        engine: "native", "python", or "auto" for the compiled engine where there is one.
    """
    native = engine == "native" or (engine == "auto" and not isinstance(load(), str))
    return NativeChecker(robot, solids, pairs) if native else CoalChecker(robot, solids, pairs)
