"""Where a run stands, and why it ended."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..problem.targets import TargetError, largest_of

__all__ = ["State", "Status"]

Array = NDArray[np.float64]


class Status(Enum):
    """Why a solve ended; `str()` gives the words."""

    CONVERGED = "every target is within tolerance"
    STALLED = "progress stopped short of the target"
    MAX_ITERATIONS = "the iterations ran out"
    TIME_LIMIT = "the time ran out"
    UNREACHABLE = "the target lies outside the chain's reach"

    def __str__(self) -> str:
        return self.value


class State(NamedTuple):
    """One iteration of a run.

    Attributes:
        q: The configuration (nq,), read-only.
        iteration: 0 at the start, then one more for each step (for CCD, each sweep).
        joint_updates: Single joints updated so far, for sweeping methods.
        errors: Each target's error.
        residual: Norm of the weighted residual, which the steps work on [m].
        attempt: The number of the run, from 0; where every attempt failed, the last run follows the best of them on.
        status: None while running; the reason in a run's last state.
    """

    q: Array
    iteration: int
    joint_updates: int
    errors: tuple[TargetError, ...]
    residual: float
    attempt: int = 0
    status: Status | None = None

    @property
    def position_error(self) -> float | None:
        """The largest of the targets' [m]."""
        return largest_of(self.errors).position

    @property
    def orientation_error(self) -> float | None:
        """The largest of the targets' [rad]."""
        return largest_of(self.errors).orientation
