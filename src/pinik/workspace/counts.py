"""What was found in each cell, in whole numbers: those of parts add up to the same bits in any order."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["QUANTA", "Counts"]

Indices = NDArray[np.int64]

QUANTA = 2**24
"""The number of parts into which the unit of a measure is divided, so that sums of it are exact."""


@dataclass(eq=False)
class Counts:
    """What was found in some cells of a grid.

    Attributes:
        cells: The numbers of the cells (n,), in increasing order.
        reached: Which orientations were reached (n, orientations).
        found: The number of samples, or of answers (n,).
        manipulability, room: Sums of these measures over what was found (n,), in parts of their units.
        branches: The sum of the numbers of distinct answers (n,).
    """

    cells: Indices
    reached: NDArray[np.bool_]
    found: Indices
    manipulability: Indices
    room: Indices
    branches: Indices

    @classmethod
    def empty(cls, cells: Indices, orientations: int) -> Counts:
        """Counts in which nothing has been found yet."""
        sums = (np.zeros(len(cells), dtype=np.int64) for _ in range(4))
        return cls(cells, np.zeros((len(cells), orientations), dtype=bool), *sums)

    def add(
        self, rows: Indices, orientations: Indices, manipulability: NDArray[np.float64], room: NDArray[np.float64]
    ) -> None:
        """Add what was found, each in a row of these and an orientation, with its measures in their units."""
        self.reached[rows, orientations] = True
        self.found += np.bincount(rows, minlength=len(self.cells))
        for total, measure in ((self.manipulability, manipulability), (self.room, room)):
            parts = np.rint(measure * QUANTA)  # whole numbers, whose sums are exact in doubles below 2⁵³
            total += np.bincount(rows, weights=parts, minlength=len(self.cells)).astype(np.int64)

    def merge(self, other: Counts) -> None:
        """Add others, all of whose cells are among these ones."""
        rows = np.searchsorted(self.cells, other.cells)
        self.reached[rows] |= other.reached
        self.found[rows] += other.found
        self.manipulability[rows] += other.manipulability
        self.room[rows] += other.room
        self.branches[rows] += other.branches

    def touched(self) -> Counts:
        """These counts without the cells in which nothing was found."""
        rows = np.flatnonzero(self.found)
        return Counts(
            self.cells[rows], self.reached[rows], self.found[rows], self.manipulability[rows], self.room[rows],
            self.branches[rows],
        )  # fmt: skip

    def to_bytes(self) -> bytes:
        """The counts as bytes, equal for equal counts."""
        file = io.BytesIO()
        np.savez(file, **self.to_arrays())  # type: ignore[arg-type]
        return file.getvalue()

    @classmethod
    def from_bytes(cls, content: bytes, orientations: int) -> Counts:
        """The counts that `to_bytes` returned."""
        with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
            return cls.from_arrays(arrays, orientations)

    def to_arrays(self) -> dict[str, NDArray[np.generic]]:
        """The counts as arrays for a file, with eight orientations in a byte."""
        arrays: dict[str, NDArray[np.generic]] = dict(vars(self))
        return arrays | {"reached": np.packbits(self.reached, axis=1)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[np.generic]], orientations: int) -> Counts:
        """The counts that `to_arrays` returned."""
        bits = np.unpackbits(np.asarray(arrays["reached"], dtype=np.uint8), axis=1, count=orientations)
        others = {name: np.asarray(arrays[name], dtype=np.int64) for name in _SUMS}
        return cls(reached=bits.astype(bool), **others)


_SUMS = ("cells", "found", "manipulability", "room", "branches")
