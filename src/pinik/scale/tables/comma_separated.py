"""Tables as CSV: a header, and one row on each line; numbers are written with as many digits as they have."""

from __future__ import annotations

import csv
import io
import itertools
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from .lines import Line, LinesFile, RawLines, not_utf8
from .table import Cells, Column, Contents, Fault, Pieces, Table, not_a_number

__all__ = ["CsvSource", "CsvWriter"]


class CsvSource(LinesFile):
    """A CSV file. A quoted cell may hold commas and quotes, but no line break."""

    place = "line"

    def __init__(self, path: Path, rows: int) -> None:
        """Open it; `ValueError` says what is wrong with its header."""
        try:
            super().__init__(path, rows, has_header=True)
        except UnicodeDecodeError as error:
            raise ValueError(f"the header: {not_utf8(error)}") from None
        try:
            self.names = _names(self.header)
        except ValueError:
            self.close()
            raise

    @staticmethod
    def decode(raw: RawLines, cells: Cells) -> Table:
        """Read a chunk."""
        text, width = raw.text(), len(cells.names)
        if text is not None and '"' not in text:
            lines = text.split("\n")
            if all(line.count(",") == width - 1 for line in lines):
                all_cells = ",".join(lines).split(",")
                table = Table(np.arange(raw.first, raw.first + len(lines)))
                return _filled(table, cells, [all_cells[k::width] for k in range(width)], careful="_" in text)
        return _read_one_by_one(raw, cells)


def _names(header: Line | None) -> tuple[str, ...]:
    if header is None:
        raise ValueError("there is no header")
    number, text = header
    if "\r" in text:
        raise ValueError(f"line {number}: lines must end in \\n or \\r\\n, and not in \\r alone")
    for mark, name in ((";", "semicolons"), ("\t", "tabs")):
        if mark in text and "," not in text:
            raise ValueError(
                f"line {number}: the cells are divided by {name}; there must be commas between them, and points in "
                "decimal numbers"
            )
    try:
        return tuple(name.strip() for name in next(csv.reader([text], strict=True)))
    except csv.Error as error:
        raise ValueError(f"line {number}: not CSV: {_reason(error)}") from None


def _reason(error: csv.Error) -> str:
    """What the module csv finds wrong with a line."""
    if "unexpected end" in str(error):
        return "a quote is not closed on the same line; a cell can hold no line break"
    return str(error)


def _read_one_by_one(raw: RawLines, cells: Cells) -> Table:
    """The same for lines with quotes, blank lines, and faulty ones, whose cells are left empty."""
    places: list[int] = []
    rows: list[Sequence[str]] = []
    faults: list[Fault] = []
    width = len(cells.names)
    for number, line in raw.lines():
        row, fault = _split(line, width)
        if fault:
            faults.append(Fault(len(rows), None, fault))
        places.append(number)
        rows.append(row)
    columns = [list(column) for column in zip(*rows, strict=True)] if rows else [[] for _ in range(width)]
    broken = {fault.row for fault in faults}
    table = _filled(Table(np.array(places, dtype=np.int64), faults=faults), cells, columns, careful=True)
    table.faults[:] = [fault for fault in table.faults if fault.column is None or fault.row not in broken]
    return table


def _split(line: str | UnicodeDecodeError, width: int) -> tuple[Sequence[str], str]:
    """(the cells of a line, empty ones if it is faulty; what is wrong with it)."""
    nothing = [""] * width
    if isinstance(line, UnicodeDecodeError):
        return nothing, not_utf8(line)
    try:
        row = next(csv.reader([line], strict=True))
    except csv.Error as error:
        return nothing, f"not CSV: {_reason(error)}"
    if len(row) != width:
        return nothing, f"there must be {width} cells, as in the header; got {len(row)}"
    return row, ""


def _filled(table: Table, cells: Cells, columns: Sequence[Sequence[str]], *, careful: bool) -> Table:
    for name, column in zip(cells.names, columns, strict=True):
        if name in cells.texts:
            table.texts[name] = [cell.strip() or None for cell in column]
        else:
            table.numbers[name] = _numbers(name, column, table.faults, careful=careful)
    return table


def _numbers(name: str, column: Sequence[str], faults: list[Fault], *, careful: bool) -> NDArray[np.float64]:
    """The numbers of a column; NaN where a cell is empty, and a fault where it is no finite number."""
    if not careful:  # float() would read 1_000, too
        try:
            numbers = np.array(list(map(float, column)))
        except ValueError:
            careful = True
        else:
            careful = not np.isfinite(numbers).all()
    if careful:
        numbers = np.full(len(column), math.nan)
        for row, cell in enumerate(column):
            if not cell or not cell.strip():
                continue
            number = _number(cell)
            if isinstance(number, float) and math.isfinite(number):
                numbers[row] = number
            else:
                faults.append(Fault(row, name, not_a_number(number)))
    return numbers


def _number(cell: str) -> float | str:
    """The number of a cell, or the cell itself."""
    try:
        return cell.strip() if "_" in cell else float(cell)
    except ValueError:
        return cell.strip()


class CsvWriter:
    """Writes CSV, with \\n as line break and an empty cell for a number that does not exist."""

    streams = True

    def encode(self, columns: Sequence[Column], contents: Contents) -> bytes:
        """The lines of some rows."""
        cells = [_WORDS[column.kind](content) for column, content in zip(columns, contents, strict=True)]
        return "".join(itertools.chain.from_iterable(zip(map(",".join, zip(*cells, strict=True)), _BREAKS))).encode()  # noqa: B905

    def start(self, columns: Sequence[Column]) -> bytes:
        """The header."""
        return (",".join(_quoted([column.name for column in columns])) + "\n").encode()

    def assemble(self, columns: Sequence[Column], parts: Pieces, file: BinaryIO) -> None:
        """The header, and all lines."""
        file.write(self.start(columns))
        for part in parts:
            file.write(part)


_BREAKS = itertools.repeat("\n")


def _quoted(texts: Sequence[str]) -> list[str]:
    if not any(mark in "".join(texts) for mark in ',"\n\r'):
        return list(texts)
    line = io.StringIO()
    writer = csv.writer(line, lineterminator="\n")
    quoted = []
    for text in texts:
        line.seek(0)
        line.truncate()
        writer.writerow([text])
        quoted.append(line.getvalue()[:-1])
    return quoted


def _number_words(numbers: Any) -> list[str]:
    listed = numbers.tolist()
    if np.isfinite(numbers).all():
        return list(map(repr, listed))
    return [repr(number) if math.isfinite(number) else "" for number in listed]


_WORDS: dict[str, Callable[[Any], list[str]]] = {
    "text": _quoted,
    "whole": lambda numbers: list(map(str, numbers.tolist())),
    "number": _number_words,
    "truth": lambda values: ["true" if value else "false" for value in values.tolist()],
}
