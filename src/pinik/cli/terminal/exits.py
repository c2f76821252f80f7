"""How a command ends: exit statuses and errors."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["CommandError", "ExitStatus", "in_words"]


class ExitStatus(IntEnum):
    """The exit status of a command."""

    ANSWERED = 0
    """All targets were solved, or the question was answered."""
    MISSED = 1
    """A target was missed; the best answer is still printed."""
    WRONG_USAGE = 2
    """Wrong usage, bad input, or an answer or a file that cannot be written."""
    NO_ROBOT = 3
    """The robot could not be loaded."""
    INTERRUPTED = 130
    """Ctrl-C, or the signal SIGINT, ended the command."""
    TERMINATED = 143
    """The signal SIGTERM ended the command."""


class CommandError(Exception):
    """Ends the command with a line on stderr.

    Attributes:
        status: The exit status.
    """

    def __init__(self, message: str, status: ExitStatus = ExitStatus.WRONG_USAGE) -> None:
        self.status = status
        super().__init__(message)


def in_words(error: BaseException) -> str:
    """An unexpected exception on one line: its class and its message."""
    cause = " ".join(str(error).split())
    return f"{type(error).__name__}: {cause}" if cause else type(error).__name__
