"""How a command may end."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["CommandError", "ExitStatus", "in_words"]


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


def in_words(error: BaseException) -> str:
    """An unforeseen exception on one line: its class and its cause."""
    cause = " ".join(str(error).split())
    return f"{type(error).__name__}: {cause}" if cause else type(error).__name__
