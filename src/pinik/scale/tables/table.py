"""A table of rows that were read, with the faults of its cells; and the columns of one that is to be written."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import IO, Any, BinaryIO, Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ...echoes import QUOTED, shortened

__all__ = [
    "Cells",
    "Column",
    "Contents",
    "Fault",
    "Pieces",
    "Source",
    "Table",
    "Writer",
    "not_a_name",
    "not_a_number",
]

Array = NDArray[np.float64]
Name = str | int


class Fault(NamedTuple):
    """What is wrong with a row.

    Attributes:
        row: The index of the row in its table.
        column: The name of the column; None if it is not a single one.
        reason: What is wrong, in words.
    """

    row: int
    column: str | None
    reason: str


@dataclass
class Table:
    """Rows of a file.

    Attributes:
        places: Where each row is in the file (N,): its line, from 1, or its row, from 0.
        numbers: The columns of numbers (N,); NaN where a cell is empty or faulty.
        texts: The columns of names, as texts or whole numbers; None where a cell is empty or faulty.
        faults: The faults of cells and rows.
    """

    places: NDArray[np.int64]
    numbers: dict[str, Array] = field(default_factory=dict)
    texts: dict[str, list[Name | None]] = field(default_factory=dict)
    faults: list[Fault] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.places)


class Cells(NamedTuple):
    """The columns of a file.

    Attributes:
        names: Their names, in the order of the file.
        texts: The names of those that hold names; all others hold numbers.
    """

    names: tuple[str, ...]
    texts: frozenset[str]


class Source(Protocol):
    """A file of rows, in numbered chunks.

    Attributes:
        place: What messages call the place of a row: "line" or "row".
        names: The names of its columns.
        chunks: The number of chunks.
    """

    place: str

    @property
    def names(self) -> tuple[str, ...]: ...  # noqa: D102

    @property
    def chunks(self) -> int: ...  # noqa: D102

    def raw(self, number: int) -> Any:
        """A chunk as it is in the file, which can be pickled. It is quick if chunks are read in ascending order.

        Raises:
            ValueError: The file is damaged.
        """

    @staticmethod
    def decode(raw: Any, cells: Cells) -> Table:
        """Read a chunk, in any process."""

    def close(self) -> None:
        """Close the file."""


class Column(NamedTuple):
    """A column to be written.

    Attributes:
        name: Its name.
        kind: What its cells are: texts, whole numbers, numbers with NaN for empty cells, or truth values.
    """

    name: str
    kind: Literal["text", "whole", "number", "truth"]


Contents = Sequence[Any]
"""For each column its cells: a list of texts, or an array."""


class Pieces(Protocol):
    """The parts of an output, in order, which can be read more than once."""

    def __len__(self) -> int: ...

    def __iter__(self) -> Iterator[bytes]: ...

    def open(self, number: int) -> IO[bytes]: ...  # noqa: D102


class Writer(Protocol):
    """A format in which rows are written.

    Attributes:
        streams: Whether the output is `start` and then all parts, one after the other.
    """

    streams: bool

    def encode(self, columns: Sequence[Column], contents: Contents) -> bytes:
        """The rows of one chunk as bytes, its part."""

    def start(self, columns: Sequence[Column]) -> bytes:
        """What comes before all parts."""

    def assemble(self, columns: Sequence[Column], parts: Pieces, file: BinaryIO) -> None:
        """Write the output from all parts."""


def not_a_number(cell: object) -> str:
    """The reason why a cell is no number."""
    if isinstance(cell, float) and not math.isfinite(cell):
        return f"must be a finite number; got {cell:g}"
    return f"must be a number; got {shortened(repr(cell), QUOTED)}"


def not_a_name(cell: object) -> str:
    """The reason why a cell is no name."""
    return f"must be a text or a whole number; got {shortened(repr(cell), QUOTED)}"
