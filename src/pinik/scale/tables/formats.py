"""The formats of tables, by name, by the ending of a file, and by how a file begins."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from ...errors import InputError, UnknownNameError
from .comma_separated import CsvSource, CsvWriter
from .json_lines import JsonSource, JsonWriter
from .numpy_archive import NpzSource, NpzWriter
from .parquet import ParquetSource, ParquetWriter
from .table import Source, Writer

__all__ = ["FORMATS", "Format", "format_by_content", "format_of", "open_source"]


class Format(NamedTuple):
    """How tables are read and written.

    Attributes:
        source: Opens a file.
        writer: Writes one.
        endings: The endings of its files.
    """

    source: type[CsvSource] | type[JsonSource] | type[NpzSource] | type[ParquetSource]
    writer: Writer
    endings: tuple[str, ...]


FORMATS: Mapping[str, Format] = {
    "csv": Format(CsvSource, CsvWriter(), (".csv",)),
    "jsonl": Format(JsonSource, JsonWriter(), (".jsonl", ".ndjson")),
    "npz": Format(NpzSource, NpzWriter(), (".npz",)),
    "parquet": Format(ParquetSource, ParquetWriter(), (".parquet",)),
}

_MARKS = {"jsonl": b"{", "npz": b"PK", "parquet": b"PAR1"}


def format_of(path: Path, given: str | None) -> str:
    """The name of a file's format: the one that is given, or the one of its ending.

    Raises:
        UnknownNameError: There is no format of the name that is given.
        InputError: The ending tells none.
    """
    if given is not None:
        if given not in FORMATS:
            raise UnknownNameError("format", given, FORMATS)
        return given
    for name, own in FORMATS.items():
        if path.suffix.lower() in own.endings:
            return name
    endings = ", ".join(ending for own in FORMATS.values() for ending in own.endings)
    raise InputError(f"{path} must end in {endings}; or name its format")


def format_by_content(path: Path) -> str:
    """The name of a stream's format, by how it begins; CSV if it begins like none of the others."""
    with path.open("rb") as file:
        begin = file.read(64).removeprefix(b"\xef\xbb\xbf").lstrip()
    return next((name for name, mark in _MARKS.items() if begin.startswith(mark)), "csv")


def open_source(path: Path, form: str, rows: int) -> Source:
    """Open a file in chunks of so many rows.

    Raises:
        ValueError: It is not of this format, or cannot be read as a table.
        MissingExtraError: Parquet needs pyarrow, which is not installed.
        OSError: It cannot be read.
    """
    source: Source = FORMATS[form].source(path, rows)
    return source
