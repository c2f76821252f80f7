"""Tables as JSON Lines: one object on each line, whose keys are the columns."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from .lines import LinesFile, RawLines, not_utf8
from .table import Cells, Column, Contents, Fault, Pieces, Table, not_a_name, not_a_number

__all__ = ["JsonSource", "JsonWriter"]


class JsonSource(LinesFile):
    """A file of JSON Lines. Keys that are absent, and null, are empty cells."""

    place = "line"

    def __init__(self, path: Path, rows: int) -> None:
        """Open it, and find its columns, which are the keys of all objects."""
        super().__init__(path, rows, has_header=False)
        names: dict[str, None] = {}
        fault = ""
        for number in range(self.chunks):
            for place, line in self.raw(number).lines():
                row = _read(line)
                if isinstance(row, str):
                    fault = fault or f"line {place}: {row}"
                else:
                    names |= dict.fromkeys(row)
        self.names = tuple(names)
        if fault and not names:
            self.close()
            raise ValueError(fault)

    @staticmethod
    def decode(raw: RawLines, cells: Cells) -> Table:
        """Read a chunk."""
        places: list[int] = []
        rows: list[Mapping[str, Any]] = []
        faults: list[Fault] = []
        for place, line in raw.lines():
            row: Any = _read(line)
            if isinstance(row, str):
                faults.append(Fault(len(rows), None, row))
                row = {}
            places.append(place)
            rows.append(row)
        table = Table(np.array(places, dtype=np.int64), faults=faults)
        for name in cells.names:
            values = [fields.get(name) for fields in rows]
            if name in cells.texts:
                table.texts[name] = [_name(value, row, name, faults) for row, value in enumerate(values)]
            else:
                table.numbers[name] = _numbers(values, name, faults)
        return table


def _read(line: str | UnicodeDecodeError) -> Mapping[str, Any] | str:
    """The object of a line, or what is wrong with it."""
    if isinstance(line, UnicodeDecodeError):
        return not_utf8(line)
    try:
        fields = json.loads(line, object_pairs_hook=_without_duplicates)
    except (ValueError, RecursionError) as error:
        return f"not JSON: {error}"
    return fields if isinstance(fields, dict) else 'must be an object such as {"x": 0.1, "y": 0.2, "z": 0.9}'


def _without_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    fields = dict(pairs)
    if len(fields) < len(pairs):
        raise ValueError("a key comes twice")
    return fields


def _numbers(values: list[Any], column: str, faults: list[Fault]) -> NDArray[np.float64]:
    """The numbers of a column; NaN where a cell is empty, and a fault where it is no finite number."""
    if {*map(type, values)} == {float}:
        numbers = np.array(values)
        if np.isfinite(numbers).all():
            return numbers
    numbers = np.full(len(values), math.nan)
    for row, value in enumerate(values):
        if value is None:
            continue
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= sys.float_info.max:
            faults.append(Fault(row, column, not_a_number(value)))
        else:
            numbers[row] = value
    return numbers


def _name(value: Any, row: int, column: str, faults: list[Fault]) -> str | int | None:
    if isinstance(value, str) and _is_unicode(value):
        return value or None
    if value is None or (isinstance(value, int) and not isinstance(value, bool)):
        return value
    faults.append(Fault(row, column, not_a_name(value)))
    return None


def _is_unicode(text: str) -> bool:
    """Whether a text can be written: JSON can hold halves of characters, such as \\ud800."""
    return text.isascii() or not any("\ud800" <= letter <= "\udfff" for letter in text)


class JsonWriter:
    """Writes JSON Lines, with null for a number that does not exist."""

    streams = True

    def encode(self, columns: Sequence[Column], contents: Contents) -> bytes:
        """The lines of some rows."""
        keys = [json.dumps(column.name) for column in columns]
        cells = [_words(column, content) for column, content in zip(columns, contents, strict=True)]
        form = "{" + ", ".join(f"{key.replace('%', '%%')}: %s" for key in keys) + "}\n"
        return "".join([form % row for row in zip(*cells, strict=True)]).encode()

    def start(self, columns: Sequence[Column]) -> bytes:
        """Nothing: each line has the names of its columns."""
        return b""

    def assemble(self, columns: Sequence[Column], parts: Pieces, file: BinaryIO) -> None:
        """All lines."""
        for part in parts:
            file.write(part)


def _words(column: Column, content: Any) -> list[str]:
    if column.kind == "text":
        return [json.dumps(text, ensure_ascii=False) for text in content]
    if column.kind == "truth":
        return ["true" if value else "false" for value in content.tolist()]
    listed = content.tolist()
    if column.kind == "whole" or np.isfinite(content).all():
        return list(map(repr, listed))
    return [repr(number) if math.isfinite(number) else "null" for number in listed]
