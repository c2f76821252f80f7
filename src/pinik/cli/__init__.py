"""The `pinik` command: data on stdout, messages on stderr, and an exit status that tells the outcome."""

from __future__ import annotations

from collections.abc import Sequence

from ..extras import MissingExtraError, needed_by
from .terminal import output
from .terminal.exits import ExitStatus

__all__ = ["ExitStatus", "main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command line.

    Args:
        arguments: Everything after "pinik"; this process's own when None.

    Returns:
        The exit status, see `ExitStatus`.
    """
    try:
        with needed_by("the pinik command", "cli"):
            from . import app
    except MissingExtraError as error:
        output.prepare_streams()
        return output.say_error(str(error), ExitStatus.WRONG_USAGE)
    return app.main(arguments)
