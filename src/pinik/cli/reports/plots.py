"""The picture files that a command writes (matplotlib, imported only when it draws)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from ..terminal.exits import CommandError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["check_plot", "save_plot"]


def check_plot(path: Path, option: str = "--plot") -> None:
    """Check that a picture can be written, before minutes are spent on computing it.

    Raises:
        CommandError: matplotlib is not installed or cannot write such files, or the place is not writable.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise CommandError(f"{option} needs matplotlib: pip install 'pinik[plots]'") from None
    kinds = Figure().canvas.get_supported_filetypes()
    if path.suffix.removeprefix(".").lower() not in kinds:
        raise CommandError(f"{option} {path}: the file name must end in one of {', '.join(sorted(kinds))}")
    if not path.parent.is_dir():
        raise CommandError(f"{option} {path}: no such folder")
    if path.is_dir():
        raise CommandError(f"{option} {path}: this is a folder")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise CommandError(f"{option} {path}: no permission to write it")


def save_plot(figure: Figure, path: Path, option: str = "--plot") -> None:
    """Write a picture.

    Raises:
        CommandError: The file cannot be written.
    """
    try:
        figure.savefig(path, dpi=150)
    except OSError as error:
        raise CommandError(f"{option} {path}: cannot write it: {error.strerror}") from None
