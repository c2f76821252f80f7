"""The work on one chunk of a table of targets: read it, solve it, and write the answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..solving.at_once import lands_at_once
from ..solving.kept import kept_of
from ..solving.many import attempt_all
from ..solving.options import Options
from .answers import Answers
from .asked import Asked, Reading
from .jobs.job import Pause, Result
from .tables.formats import FORMATS
from .tables.table import Column, Fault, Table

__all__ = ["RawChunk", "Solving", "ids_of"]

_ROWS_BETWEEN_PAUSES = {"native": 512, "python": 8, "at once": 8192}


class RawChunk(NamedTuple):
    """A chunk before it is read.

    Attributes:
        raw: The chunk as its source gives it.
        first: The number of its first row in the file, from 0.
        repeated: The indices of rows whose id belongs to an earlier row.
    """

    raw: Any
    first: int
    repeated: tuple[int, ...]


@dataclass(frozen=True)
class Solving:
    """Answers the rows of a chunk, each as `pinik.solve` answers it alone; faulty ones are left out.

    Attributes:
        reading: How rows are read.
        options: The options of the solves.
        columns: The columns of the answers.
        form: The format in which the targets are read.
        output: The format in which the answers are written.
        degrees: Whether angles are written in degrees.
    """

    reading: Reading
    options: Options
    columns: tuple[Column, ...]
    form: str
    output: str
    degrees: bool

    def __call__(self, chunk: RawChunk, pause: Pause) -> Result:
        """Answer one chunk; the notes are the number of rows, and how many ended with each status."""
        table = FORMATS[self.form].source.decode(chunk.raw, self.reading.columns.cells)
        table.faults += [Fault(row, "id", "comes a second time") for row in chunk.repeated]
        asked = self.reading.read(table)
        answers = Answers(self.reading.robot, len(asked.rows))
        for rows, kind in _by_kind(asked):
            self._answer(asked, rows, kind, answers, pause)
        times = self.columns[-1].name == "time_s"
        names: Any = ids_of(table, chunk.first)
        kept = [names[row] for row in asked.rows]
        ids = np.array(kept, dtype=np.int64) if self.columns[0].kind == "whole" else [str(name) for name in kept]
        contents = answers.contents(ids, degrees=self.degrees, times=times)
        notes = {"rows": len(asked.rows), **Counter(answers.statuses)}
        return Result(FORMATS[self.output].writer.encode(self.columns, contents), notes)

    def _answer(self, asked: Asked, rows: NDArray[np.intp], kind: int, answers: Answers, pause: Pause) -> None:
        robot, nearest = self.reading.robot, self.reading.origin.nearest
        prepared = kept_of(robot).prepared(robot, (self.reading.pattern(asked.kinds[kind]),), self.options)
        step = _ROWS_BETWEEN_PAUSES["at once" if lands_at_once(prepared.question) else prepared.engine]
        for begin in range(0, len(rows), step):
            pause()
            own = rows[begin : begin + step]
            starts = asked.starts if len(asked.starts) == 1 else asked.starts[own]
            turned = {name: value if np.ndim(value) == 0 else value[own] for name, value in asked.turned.items()}
            goals = asked.goals[own, np.newaxis]
            outcomes = attempt_all(prepared, goals, starts, nearest, 1, numbered=False)
            answers.put(own, outcomes, starts, turned)


def _by_kind(asked: Asked) -> Iterator[tuple[NDArray[np.intp], int]]:
    """The rows of each kind, as indices of good rows, and the kind."""
    if len(asked.kinds) == 1:
        yield np.arange(len(asked.rows)), 0
        return
    order = np.argsort(asked.kind_of_row, kind="stable")
    ends = np.flatnonzero(np.diff(asked.kind_of_row[order])) + 1
    for rows in np.split(order, ends):
        if len(rows):
            yield rows, int(asked.kind_of_row[rows[0]])


def ids_of(table: Table, first: int) -> Any:
    """The id of each row: the one that it has, or the row's number in the file."""
    return table.texts["id"] if "id" in table.texts else range(first, first + len(table))
