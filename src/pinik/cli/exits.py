"""How a command may end."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["CommandError", "ExitStatus"]


class ExitStatus(IntEnum):
    """The command's exit status."""

    ANSWERED = 0
    """All targets solved, or the question answered."""
    MISSED = 1
    """A target was missed; the best answer is printed all the same."""
    WRONG_USAGE = 2
    """Wrong usage or bad input."""
    NO_ROBOT = 3
    """The robot could not be loaded."""
    INTERRUPTED = 130


class CommandError(Exception):
    """Ends the command with one line on stderr.

    Attributes:
        status: The exit status.
    """

    def __init__(self, message: str, status: ExitStatus = ExitStatus.WRONG_USAGE) -> None:
        self.status = status
        super().__init__(message)
