"""Files that a command draws into, and the colours of the methods (matplotlib, imported only when it draws)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from ...solvers.registry import SOLVERS
from ..terminal.exits import CommandError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["METHOD_COLORS", "check_plot", "save_plot"]

METHOD_COLORS = dict(zip(SOLVERS, ("#1f6fc4", "#d97a00", "#0c9a72", "#b9559a"), strict=True))
"""Short name → colour; those of the live page's four instances."""


def check_plot(path: Path, option: str = "--plot") -> None:
    """See that a picture can be drawn, before minutes are spent on what it should show.

    Raises:
        CommandError: matplotlib is not installed, it does not write such files, or not in this place.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise CommandError(f"{option} needs matplotlib: pip install 'pinik[plots]'") from None
    kinds = Figure().canvas.get_supported_filetypes()
    if path.suffix.removeprefix(".").lower() not in kinds:
        raise CommandError(f"{option} {path}: the name's end is one of {', '.join(sorted(kinds))}")
    if not path.parent.is_dir():
        raise CommandError(f"{option} {path}: there is no such folder")
    if path.is_dir():
        raise CommandError(f"{option} {path}: it is a folder")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise CommandError(f"{option} {path}: it may not be written")


def save_plot(figure: Figure, path: Path, option: str = "--plot") -> None:
    """Write a picture.

    Raises:
        CommandError: The file cannot be written.
    """
    try:
        figure.savefig(path, dpi=150)
    except OSError as error:
        raise CommandError(f"{option} {path}: it cannot be written: {error.strerror}") from None
