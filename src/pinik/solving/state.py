"""The state of a run after one iteration, and the reasons why it ends."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..problem.tolerance import TargetError, largest_of

__all__ = ["State", "Status"]

Array = NDArray[np.float64]


class Status(Enum):
    """The reason why a solve ended; `str()` describes it."""

    CONVERGED = "every target is within tolerance"
    STALLED = "progress stopped before the target was reached"
    MAX_ITERATIONS = "the maximum number of iterations was reached"
    TIME_LIMIT = "the time limit was reached"
    UNREACHABLE = "the target lies outside the chain's reach"
    COLLIDING = "the targets are reached only where something touches"

    def __str__(self) -> str:
        return self.value


class State(NamedTuple):
    """One iteration of a run.

    Attributes:
        q: The configuration (nq,), read-only.
        iteration: The number of steps (for CCD, sweeps) so far; 0 at the start.
        joint_updates: The number of single-joint updates so far, for sweeping methods.
        errors: The error of each target.
        residual: Norm of the weighted residual that the steps reduce [m].
        attempt: The number of the run, from 0; if every attempt failed, a last run continues the best of them.
        status: None during the run; the reason why it ended in its last state.
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
        """The largest position error of any target [m]; None if no target has a position."""
        return largest_of(self.errors).position

    @property
    def orientation_error(self) -> float | None:
        """The largest orientation error of any target [rad]; None if no target has an orientation."""
        return largest_of(self.errors).orientation
