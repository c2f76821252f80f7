"""The `pinik` command: data on stdout, words on stderr, and an exit status that says how it went."""

from .app import main
from .terminal.exits import ExitStatus

__all__ = ["ExitStatus", "main"]
