"""The kinds of rows: what rows have in common that one compiled problem can answer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..problem.tolerance import Tolerance

__all__ = ["Kind", "kinds_of"]

Array = NDArray[np.float64]
Truths = NDArray[np.bool_]


class Kind(NamedTuple):
    """What rows have in common that one compiled problem can answer.

    Attributes:
        frame: The frame to move.
        along: Along which axes the position is asked for.
        rotated: Whether an orientation is asked for.
        tolerance: The tolerance of the rows; None for that of all rows.
    """

    frame: str
    along: tuple[bool, bool, bool]
    rotated: bool
    tolerance: Tolerance | None


def kinds_of(
    frames: Sequence[str],
    along: Truths,
    rotated: Truths,
    tolerances: Array | None,
    rows: NDArray[np.intp],
    tolerance: Tolerance,
) -> tuple[list[Kind], NDArray[np.intp]]:
    """The kinds of some rows, in the order in which they come, and the index of each one's kind.

    Args:
        frames: The frame of each row.
        along: Along which axes each row asks for a position (N, 3).
        rotated: Whether each row asks for an orientation (N,).
        tolerances: The tolerance of each row (N, 2) [m, rad], NaN where it gives none; None where none does.
        rows: The rows (n,).
        tolerance: The tolerance from which a row takes what it does not give.
    """

    def kind(row: int) -> Kind:
        x, y, z = along[row].tolist()
        own = None if tolerances is None else _completed(tolerances[row], tolerance)
        return Kind(frames[row], (x, y, z), bool(rotated[row]), own)

    if len(rows) == 0:
        return [], np.zeros(0, dtype=np.intp)
    codes = (along[rows] @ (1, 2, 4)) + 8 * rotated[rows]
    if tolerances is None and len(set(frames)) == 1 and (codes == codes[0]).all():
        return [kind(int(rows[0]))], np.zeros(len(rows), dtype=np.intp)
    pairs: Any = [()] * len(rows) if tolerances is None else map(tuple, np.nan_to_num(tolerances[rows]).tolist())
    known: dict[tuple[Any, ...], int] = {}
    kinds: list[Kind] = []
    kind_of_row = np.empty(len(rows), dtype=np.intp)
    for k, (row, code, pair) in enumerate(zip(rows.tolist(), codes.tolist(), pairs, strict=True)):
        key = frames[row], code, pair
        if key not in known:
            known[key] = len(kinds)
            kinds.append(kind(row))
        kind_of_row[k] = known[key]
    return kinds, kind_of_row


def _completed(given: Array, tolerance: Tolerance) -> Tolerance | None:
    """A row's own tolerance; None if it gives none."""
    metres, radians = given.tolist()
    if np.isnan(given).all():
        return None
    return Tolerance(
        tolerance.position if np.isnan(metres) else metres, tolerance.orientation if np.isnan(radians) else radians
    )
