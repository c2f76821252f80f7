"""The picture files that a command writes (matplotlib, imported only when it draws)."""

from __future__ import annotations

import io
import logging
from pathlib import Path
from typing import TYPE_CHECKING

from ..inputs.files import check_file, write_file
from ..terminal.exits import CommandError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["check_plot", "save_plot"]

# Otherwise matplotlib tells on stderr how it gets on without a folder for its cache; programs can still listen to it.
logging.getLogger("matplotlib").addHandler(logging.NullHandler())


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
    check_file(path, option)


def save_plot(figure: Figure, path: Path, option: str = "--plot") -> None:
    """Write a picture.

    Raises:
        CommandError: The file cannot be written.
    """
    picture = io.BytesIO()
    figure.savefig(picture, dpi=150, format=path.suffix.removeprefix(".").lower())
    write_file(path, picture.getvalue(), option)
