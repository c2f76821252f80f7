"""Checks of arguments: numbers, names, files, arrays, vectors and points. Errors name argument and requirement."""

from __future__ import annotations

import contextlib
import math
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InputError

__all__ = [
    "as_array",
    "as_count",
    "as_file_name",
    "as_finite_number",
    "as_length",
    "as_many",
    "as_names",
    "as_numbers",
    "as_plain",
    "as_point",
    "as_points",
    "as_positive_number",
    "as_unit_vector",
    "as_vector",
]

FARTHEST = 1e9  # [m]: beyond it, squared distances lose all precision

_NUMBERS_IN_MEMORY = frozenset("bhilqnHILQNefdg")  # formats of memoryviews; bytes have "B"
_NO_NUMBERS = (str, bytes, bytearray, bool, np.bool_, complex, np.complexfloating)

Array = NDArray[np.float64]


def as_finite_number(value: object, what: str) -> float:
    """`value` as a float; InputError unless it is one finite number."""
    if type(value) is float and math.isfinite(value):
        return value
    number = math.nan
    with contextlib.suppress(TypeError, ValueError, OverflowError):
        value = as_plain(value, what)
        if not isinstance(value, _NO_NUMBERS) and np.ndim(value) == 0:  # type: ignore[arg-type]
            number = float(value)  # type: ignore[arg-type]
    if not math.isfinite(number):
        raise InputError(f"must be a finite number; got {value!r}", argument=what)
    return number


def as_positive_number(value: object, what: str, unit: str = "") -> float:
    """`value` as a float; InputError unless it is one finite number above zero."""
    number = as_finite_number(value, what)
    if number <= 0.0:
        raise InputError(f"must be a positive number{f' of {unit}' if unit else ''}; got {value!r}", argument=what)
    return number


def as_count(value: object, what: str, least: int = 1, most: int | None = None) -> int:
    """`value` as an int; InputError unless it is a whole number of at least `least` and at most `most`."""
    whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not whole or value < least or (most is not None and value > most):  # type: ignore[operator]
        bounds = f"of at least {least}" if most is None else f"from {least} to {most}"
        raise InputError(f"must be a whole number {bounds}; got {value!r}", argument=what)
    return int(value)  # type: ignore[call-overload, no-any-return]


def as_length(value: object, what: str) -> float:
    """`value` as a length [m]; InputError also if it exceeds a million kilometres."""
    length = as_finite_number(value, what)
    if abs(length) > FARTHEST:
        raise InputError(f"must be within ±{FARTHEST:g} m; got {length:g}", argument=what)
    return length


def as_plain(value: Any, what: str) -> Any:
    """`value` with the memoryviews in it as arrays, and with masked arrays that mask nothing as plain ones.

    Numpy reads masked arrays without their masks, and some memoryviews not at all. Anything else stays as it is.

    Raises:
        InputError: A masked entry, or a memoryview of bytes or of no numbers.
    """
    if type(value) is np.ndarray and value.dtype.kind != "O":
        return value
    if isinstance(value, np.ma.MaskedArray):
        if np.ma.is_masked(value) or value is np.ma.masked:
            raise InputError(f"must have no masked entries; got {value!r}", argument=what)
        return value.data
    if isinstance(value, (memoryview, bytearray)):
        try:
            own = memoryview(value)
        except ValueError:
            raise InputError("must be numbers; got a memoryview that is released", argument=what) from None
        if own.format not in _NUMBERS_IN_MEMORY:
            raise InputError(f"must be numbers; got a {type(value).__name__} of format {own.format!r}", argument=what)
        return np.asarray(own)
    if isinstance(value, np.ndarray) and value.dtype.kind == "O":
        for item in value.flat:
            as_plain(item, what)
    if type(value) in (list, tuple):
        return [item if type(item) in (float, int) else as_plain(item, what) for item in value]
    return value


def as_array(value: ArrayLike, shape: tuple[int, ...], what: str, of: str = "") -> Array:
    """A new float64 array of that shape; InputError for other shapes or types, NaN and infinities."""
    size = "×".join(map(str, shape))
    expected = f"{size} finite numbers" + (f" ({of})" if of else "")
    value = as_plain(value, what)
    try:
        numbers = np.asarray(value)
        items = (
            () if isinstance(value, np.ndarray) and numbers.dtype.kind != "O" else np.asarray(value, dtype=object).flat
        )
        if numbers.dtype.kind not in "iufO" or any(isinstance(item, _NO_NUMBERS) for item in items):
            raise TypeError  # such as strings and booleans, which numpy would convert
        array = _as_float64(numbers)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"must be {expected}; got {value!r}", argument=what) from None
    if array.shape != shape:
        raise InputError(f"must be {expected}; got an array of shape {array.shape}", argument=what)
    if not np.isfinite(array).all():
        raise InputError(f"must be {expected}; got {array.tolist()}", argument=what)
    return array


def as_many(values: ArrayLike, shape: tuple[int, ...], what: str) -> Array:
    """`values` as a new float64 array (n, *shape); InputError names the first entry that is not finite."""
    size = "×".join(map(str, shape))
    array = as_numbers(values, what)
    if array.shape[1:] != shape or array.ndim != len(shape) + 1:
        raise InputError(f"must be N times {size} finite numbers; got an array of shape {array.shape}", argument=what)
    finite = np.isfinite(array)
    if not finite.all():
        k = int(np.argmin(finite.all(axis=tuple(range(1, array.ndim)))))
        raise InputError(f"must be {size} finite numbers; got {array[k].tolist()}", argument=f"{what}[{k}]")
    return array


def as_numbers(values: ArrayLike, what: str) -> Array:
    """`values` as a new float64 array of any shape; InputError for other types."""
    values = as_plain(values, what)
    try:
        array = np.asarray(values)
    except ValueError:
        raise InputError("must be an array of numbers; got rows of different lengths", argument=what) from None
    if array.dtype.kind not in "iuf" or _holds_no_number(values):
        raise InputError(f"must be an array of numbers; got {values!r}", argument=what)
    return _as_float64(array)


def _holds_no_number(values: object) -> bool:
    """Whether nested lists hold something, such as a boolean, that numpy would convert."""
    if type(values) is list:
        return any([type(item) not in (float, int) and _holds_no_number(item) for item in values])
    return isinstance(values, _NO_NUMBERS)


def _as_float64(numbers: NDArray[Any]) -> Array:
    """A new array; wider numbers beyond its range become infinite, which the checks of finiteness report."""
    if numbers.dtype.itemsize <= 8 and numbers.dtype.kind != "O":
        return np.array(numbers, dtype=np.float64, order="C")
    with np.errstate(over="ignore"):
        return np.array(numbers, dtype=np.float64, order="C")


def as_vector(value: ArrayLike, size: int, what: str, of: str = "") -> Array:
    """`value` as a finite vector (size,)."""
    return as_array(value, (size,), what, of)


def as_point(value: ArrayLike, what: str) -> Array:
    """`value` as a point (3,) [m]; InputError also if a coordinate exceeds a million kilometres."""
    point = as_vector(value, 3, what)
    if np.abs(point).max() > FARTHEST:
        raise InputError(f"must be a point within {FARTHEST:g} m of the origin; got {point.tolist()}", argument=what)
    return point


def as_names(value: Iterable[str], what: str) -> tuple[str, ...]:
    """`value` as a tuple; InputError for a single string and for anything that is not iterable."""
    if isinstance(value, (str, memoryview)) or not isinstance(value, Iterable):
        raise InputError(f"must be a list of joint names; got {value!r}", argument=what)
    return tuple(value)


def as_file_name(value: str | os.PathLike[str], what: str, example: str) -> Path:
    """`value` as a path; InputError unless it is the name of a file, as text or as a path."""
    if not isinstance(value, (str, os.PathLike)) or not isinstance(os.fspath(value), str):
        raise InputError(f"must be the name of a file, such as {example!r}; got {value!r}", argument=what)
    return Path(value)


def as_unit_vector(value: ArrayLike, what: str) -> Array:
    """`value` (3,) scaled to unit length; InputError for a zero vector."""
    vector = as_vector(value, 3, what)
    scale = np.abs(vector).max()
    if scale < 1e-300:
        raise InputError(f"must not be zero, as it is a direction; got {vector.tolist()}", argument=what)
    vector = vector / scale
    return np.array(vector / np.linalg.norm(vector))


def as_points(values: ArrayLike, what: str) -> Array:
    """`values` as points (n, 3) [m], each checked as by `as_point`."""
    points = as_many(values, (3,), what)
    _refuse_the_first(np.abs(points).max(axis=1, initial=0.0) > FARTHEST, points, as_point, what)
    return points


def _refuse_the_first(
    wrong: NDArray[np.bool_], values: Array, check: Callable[[ArrayLike, str], object], what: str
) -> None:
    """Run the check of a single value on the first wrong one, which raises the error."""
    for k in np.flatnonzero(wrong)[:1]:
        check(values[k], f"{what}[{k}]")
