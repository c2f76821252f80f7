"""A file of targets, or a stream of them that is kept in a file meanwhile, opened as a table."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from ..errors import InputError
from .tables.formats import format_by_content, format_of, open_source
from .tables.table import Source

__all__ = ["TargetsFile", "TargetsGiven", "opened"]

TargetsGiven = str | os.PathLike[str] | BinaryIO
"""The path of a file, or an open binary stream."""


@dataclass(frozen=True)
class TargetsFile:
    """An open file of targets.

    Attributes:
        source: Its rows.
        path: The file.
        label: What messages call it.
        form: The name of its format.
    """

    source: Source
    path: Path
    label: str
    form: str


@contextlib.contextmanager
def opened(targets: TargetsGiven, form: str | None, rows: int) -> Iterator[TargetsFile]:
    """Open a file of targets in chunks of so many rows.

    Args:
        targets: The file, or a stream.
        form: The name of its format; by the ending of the file, or by how the stream begins, when None.
        rows: The number of rows in a chunk.

    Raises:
        InputError: It cannot be read as a table, or has no rows.
        UnknownNameError: There is no such format.
        MissingExtraError: Parquet needs pyarrow, which is not installed.
        OSError: It cannot be read.
    """
    with _as_file(targets) as (path, label):
        by_itself = form is None and not isinstance(targets, (str, os.PathLike))
        form = format_by_content(path) if by_itself else format_of(path, form)
        try:
            source = open_source(path, form, rows)
        except ValueError as error:
            raise InputError(f"{label}: {error}") from None
        with contextlib.closing(source):
            if not source.chunks:
                raise InputError(f"{label}: there are no rows")
            yield TargetsFile(source, path, label, form)


@contextlib.contextmanager
def _as_file(targets: TargetsGiven) -> Iterator[tuple[Path, str]]:
    """(a regular file, what messages call it). A stream or a pipe is copied to a file, since it is read twice."""
    if isinstance(targets, (str, os.PathLike)):
        path = Path(targets).expanduser()
        if path.is_file():
            yield path, str(targets)
            return
        with path.open("rb") as stream, _as_file(stream) as (copy, _):  # a pipe; otherwise the error of open
            yield copy, str(targets)
        return
    with tempfile.TemporaryDirectory(prefix="pinik-") as folder:
        copy = Path(folder) / "targets"
        with copy.open("wb") as file:
            shutil.copyfileobj(targets, file)
        name = getattr(targets, "name", None)
        yield copy, "stdin" if name in ("<stdin>", 0) else str(name or "the stream")
