"""The survey of a table of targets, before any work: what is wrong with it, and what its rows ask."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .asked import Reading
from .kinds import Kind
from .solving import RawChunk
from .tables.table import Fault, Source, Table

__all__ = ["Survey", "digest_of", "survey"]

_PIECE = 1 << 20  # [bytes]
_WHOLE = range(-(2**63), 2**63)  # what a column of whole numbers can hold


@dataclass
class Survey:
    """What a table of targets holds.

    Attributes:
        rows: The number of rows, faulty ones included.
        faulty: The number of faulty rows.
        firsts: The number of the first row of each chunk.
        repeated: Chunk → the indices of rows in it whose id belongs to an earlier row.
        whole_ids: Whether the ids are whole numbers of at most 64 bits.
        kinds: The kinds of rows, tolerances aside, with the place of the first row of each.
        like_degrees: The place of the first row whose roll, pitch and yaw look like degrees and are not taken as such;
            "" if there is none.
    """

    rows: int = 0
    faulty: int = 0
    firsts: list[int] = field(default_factory=list)
    repeated: dict[int, tuple[int, ...]] = field(default_factory=dict)
    whole_ids: bool = True
    kinds: dict[Kind, str] = field(default_factory=dict)
    like_degrees: str = ""

    def chunk(self, source: Source, number: int) -> RawChunk:
        """One chunk, as the work on it needs it."""
        return RawChunk(source.raw(number), self.firsts[number], self.repeated.get(number, ()))


def survey(source: Source, reading: Reading, label: str, on_bad: Callable[[str], None]) -> Survey:
    """Read the whole table.

    Args:
        source: The table.
        reading: How its rows are read.
        label: What messages call the file.
        on_bad: Takes each fault in words, with file, line and column. Those of repeated ids come last.

    Raises:
        InputError: The file is damaged.
    """
    found = Survey()
    ids = _Ids()
    for number in range(source.chunks):
        try:
            raw = source.raw(number)
        except ValueError as error:
            raise InputError(f"{label}: {error}") from None
        table = source.decode(raw, reading.columns.cells)
        found.firsts.append(found.rows)
        found.rows += len(table)
        if "id" in table.texts:
            ids.add(table)
        asked = reading.read(table)
        found.faulty += len(table) - len(asked.rows)
        for fault in asked.faults:
            on_bad(_words(label, source, table, fault))
        if not found.like_degrees and (row := reading.like_degrees(table)) is not None:
            found.like_degrees = f"{label}: {source.place} {table.places[row]}"
        for index, kind in enumerate(asked.kinds):
            common = kind._replace(tolerance=None)
            if common not in found.kinds:
                row = asked.rows[np.argmax(asked.kind_of_row == index)]
                found.kinds[common] = f"{label}: {source.place} {table.places[row]}"
    found.whole_ids = ids.whole
    for number, row, place, earlier in ids.repeated(source, reading):
        found.repeated[number] = (*found.repeated.get(number, ()), row)
        found.faulty += 1
        on_bad(f"{label}: {source.place} {place}: column id: comes a second time, after {source.place} {earlier}")
    return found


def _words(label: str, source: Source, table: Table, fault: Fault) -> str:
    column = f"column {fault.column}: " if fault.column else ""
    return f"{label}: {source.place} {table.places[fault.row]}: {column}{fault.reason}"


class _Ids:
    """The ids of all rows, of which only a hash is kept."""

    def __init__(self) -> None:
        self.whole = True
        self._hashes: list[NDArray[np.int64]] = []

    def add(self, table: Table) -> None:
        """Take the ids of the next chunk."""
        names = table.texts["id"]
        self.whole = self.whole and all(isinstance(name, int) and name in _WHOLE for name in names if name is not None)
        self._hashes.append(np.array([hash(str(name)) for name in names], dtype=np.int64))

    def repeated(self, source: Source, reading: Reading) -> Iterator[tuple[int, int, int, int]]:
        """Rows whose id belongs to an earlier row: chunk, index, place, and the place of the earlier row."""
        if not self._hashes:
            return
        ordered = np.sort(np.concatenate(self._hashes))
        twice = np.unique(ordered[1:][ordered[1:] == ordered[:-1]])
        if not len(twice):
            return
        seen: dict[str, int] = {}
        for number, hashes in enumerate(self._hashes):
            candidates = np.flatnonzero(np.isin(hashes, twice))
            if not len(candidates):
                continue
            table = source.decode(source.raw(number), reading.columns.cells)
            good = set(reading.read(table).rows.tolist())
            for row in candidates.tolist():
                if row not in good:
                    continue
                name = table.texts["id"][row]
                place = int(table.places[row])
                if str(name) in seen:
                    yield number, row, place, seen[str(name)]
                seen.setdefault(str(name), place)


def digest_of(path: Path) -> str:
    """The SHA-256 of a file."""
    whole = hashlib.sha256()
    with path.open("rb") as file:
        while piece := file.read(_PIECE):
            whole.update(piece)
    return whole.hexdigest()
