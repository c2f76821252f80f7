"""The `pinik` command: data on stdout, messages on stderr, and an exit status that tells the outcome."""

from .app import main
from .terminal.exits import ExitStatus

__all__ = ["ExitStatus", "main"]
