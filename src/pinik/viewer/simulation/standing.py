"""The result of an instance at a moment, in words and figures."""

from __future__ import annotations

from typing import NamedTuple

from ...solving.state import Status

__all__ = ["STATUSES", "Standing"]

STATUSES = ("IDLE", *(status.name for status in Status), "FAILED", "REFUSED")
"""How a step may end: with the status of a solve; IDLE without targets; FAILED if a custom solver raised an exception;
REFUSED if the method cannot solve for these targets."""


class Standing(NamedTuple):
    """The present result of an instance.

    Attributes:
        status: One of `STATUSES`; UNREACHABLE only if there is a proof.
        message: An explanation in one sentence.
        position_error: The largest position error of any target [m], by plain forward kinematics; None if no target
            has a position.
        orientation_error: The largest orientation error [rad], likewise.
        active_limits: Names of the joints that are at a limit and could move a target frame.
    """

    status: str
    message: str
    position_error: float | None
    orientation_error: float | None
    active_limits: tuple[str, ...]
