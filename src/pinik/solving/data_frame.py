"""Answers as data frames of pandas: one row for each configuration, one column for each joint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..extras import needed_by

if TYPE_CHECKING:
    import pandas

__all__ = ["data_frame"]


def data_frame(
    joint_names: Sequence[str],
    angles: NDArray[np.float64],
    others: Mapping[str, Any],
    times: NDArray[np.float64] | None = None,
) -> pandas.DataFrame:
    """A data frame of pandas.

    Args:
        joint_names: The names of the first columns.
        angles: Their values (n, n_joints) [rad or m].
        others: Title → values (n,) of the columns after them; a joint of the same name keeps its own column.
        times: The index (n,) [s], called "time_s"; row numbers when None.

    Raises:
        MissingExtraError: pandas is not installed.
    """
    with needed_by("a data frame", "frames"):
        import pandas

    values: list[Any] = [*angles.T, *map(np.asarray, others.values())]
    index = None if times is None else pandas.Index(times, name="time_s")
    frame = pandas.DataFrame(dict(enumerate(values)), index=index)
    frame.columns = pandas.Index([*joint_names, *others])
    return frame
