"""A grid of cubic cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_array
from ..errors import InputError

__all__ = ["Grid", "readable_size"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_MOST_CELLS = 2**27


@dataclass(frozen=True)
class Grid:
    """A grid of cubic cells, numbered with z running fastest.

    Attributes:
        origin: The centre of the first cell (x, y, z) [m].
        size: The length of a cell's edges [m].
        shape: The number of cells along x, y and z.
    """

    origin: tuple[float, float, float]
    size: float
    shape: tuple[int, int, int]

    @classmethod
    def around(cls, center: Array, half: Array, size: float) -> Grid:
        """For pinik itself: a grid with a cell in the middle of a box.

        Args:
            center: The middle of the box (3,) [m].
            half: Half the lengths of its edges (3,) [m].
            size: The length of a cell's edges [m].

        Raises:
            InputError: There would be too many cells.
        """
        beside = np.ceil(half / size - 0.5 - 1e-9).clip(min=0.0)
        return cls._checked(center - size * beside, size, 2.0 * beside + 1.0)

    @classmethod
    def in_box(cls, box: ArrayLike, size: float) -> Grid:
        """For pinik itself: a grid whose cells fill a box: its lower and upper corner (2, 3) [m].

        Raises:
            InputError: The box is not one, or there would be too many cells.
        """
        lower, upper = as_array(box, (2, 3), "box", "the lower and the upper corner")
        if not (upper > lower).all():
            raise InputError("must have its upper corner above the lower one in x, y and z", argument="box")
        shape = np.ceil((upper - lower) / size - 1e-9).clip(min=1.0)
        return cls._checked(lower + 0.5 * size, size, shape)

    @classmethod
    def _checked(cls, origin: Array, size: float, shape: Array) -> Grid:
        if not np.prod(shape) <= _MOST_CELLS:
            raise InputError(
                f"{size:g} m gives {np.prod(shape):.3g} cells; at most {_MOST_CELLS} are possible", argument="cell"
            )
        x, y, z = shape.astype(int).tolist()
        return cls(tuple(origin.tolist()), size, (x, y, z))

    def __len__(self) -> int:
        """The number of cells."""
        return int(np.prod(self.shape))

    @property
    def axes(self) -> tuple[Array, Array, Array]:
        """The x, y and z of the centres [m]."""
        x, y, z = (
            np.asarray(start + self.size * np.arange(count, dtype=np.float64))
            for start, count in zip(self.origin, self.shape, strict=True)
        )
        return x, y, z

    def centers(self, cells: Indices) -> Array:
        """The centres (n, 3) of cells by number [m]."""
        return np.asarray(np.array(self.origin) + self.size * np.stack(np.unravel_index(cells, self.shape), axis=1))

    def cells_at(self, points: Array) -> Indices:
        """For pinik itself: the numbers (n,) of the cells in which points (n, 3) [m] lie; −1 outside the grid."""
        at = np.floor((points - np.array(self.origin)) / self.size + 0.5)
        inside = ((at >= 0.0) & (at < self.shape)).all(axis=1)
        x, y, z = np.where(inside[:, None], at, 0.0).astype(np.int64).T
        _, ny, nz = self.shape
        return np.where(inside, (x * ny + y) * nz + z, -1)


def readable_size(length: float) -> float:
    """The length of the form 1, 2 or 5 times a power of ten that is nearest to a length."""
    sizes = np.outer(10.0 ** np.arange(-9, 10), (1.0, 2.0, 5.0)).ravel()
    return float(sizes[np.argmin(np.abs(np.log(sizes / length)))])
