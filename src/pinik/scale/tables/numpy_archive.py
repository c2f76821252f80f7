"""Tables as NPZ: one array for each column, in numpy's archive of arrays."""

from __future__ import annotations

import contextlib
import io
import math
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from .table import Cells, Column, Contents, Fault, Pieces, Table, not_a_name, not_a_number

__all__ = ["NpzSource", "NpzWriter"]

_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the same bytes whenever they are written
_KINDS = {"whole": np.dtype(np.int64), "number": np.dtype(np.float64), "truth": np.dtype(np.bool_)}


class NpzSource:
    """An NPZ file whose arrays have one entry for each row. There are no empty cells: NaN is a fault."""

    place = "row"

    def __init__(self, path: Path, rows: int) -> None:
        """Open it; `ValueError` says which array cannot be a column."""
        try:
            self._archive = zipfile.ZipFile(path)
        except zipfile.BadZipFile as error:
            raise ValueError(f"not an NPZ file: {error}") from None
        self._rows = rows
        try:
            with _damage_in_words():
                self._count = self._open_arrays()
        except BaseException:
            self.close()
            raise

    def _open_arrays(self) -> int:
        """Open all arrays, and return the number of their entries."""
        self._arrays = {
            name.removesuffix(".npy"): _Entries(name, self._archive.open(name)) for name in self._archive.namelist()
        }
        self.names = tuple(self._arrays)
        lengths = {name: array.count for name, array in self._arrays.items()}
        if len(set(lengths.values())) > 1:
            raise ValueError(
                "all arrays must have as many entries; got " + ", ".join(f"{n}: {k}" for n, k in lengths.items())
            )
        return max(lengths.values(), default=0)

    @property
    def chunks(self) -> int:
        """The number of chunks."""
        return -(-self._count // self._rows)

    def raw(self, number: int) -> tuple[int, dict[str, NDArray[Any]]]:
        """The first row of one chunk, and the entries of all arrays."""
        begin = number * self._rows
        end = min(begin + self._rows, self._count)
        with _damage_in_words():
            return begin, {name: array.read(begin, end) for name, array in self._arrays.items()}

    @staticmethod
    def decode(raw: tuple[int, dict[str, NDArray[Any]]], cells: Cells) -> Table:
        """Read a chunk."""
        begin, arrays = raw
        count = len(next(iter(arrays.values()), ()))
        table = Table(np.arange(begin, begin + count))
        for name in cells.names:
            array = arrays[name]
            if name in cells.texts:
                table.texts[name] = _names(array, name, table.faults)
            elif array.dtype.kind == "U":
                table.numbers[name] = np.full(count, math.nan)
                table.faults += [Fault(row, name, not_a_number(cell)) for row, cell in enumerate(array.tolist())]
            else:
                numbers = table.numbers[name] = array.astype(np.float64)
                for row in np.flatnonzero(~np.isfinite(numbers)):
                    table.faults.append(Fault(int(row), name, not_a_number(float(numbers[row]))))
                    numbers[row] = math.nan
        return table

    def close(self) -> None:
        """Close the file."""
        self._archive.close()


@contextlib.contextmanager
def _damage_in_words() -> Iterator[None]:
    """Let the archive's errors be a `ValueError` that says what is wrong with the file."""
    try:
        yield
    except (EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise ValueError(f"the file is damaged: {error}") from None


def _names(array: NDArray[Any], column: str, faults: list[Fault]) -> list[str | int | None]:
    if array.dtype.kind == "f":
        faults += [Fault(row, column, not_a_name(value)) for row, value in enumerate(array.tolist())]
        return [None] * len(array)
    return [value if value != "" else None for value in array.tolist()]


class _Entries:
    """The entries of one array, read forwards."""

    def __init__(self, name: str, file: IO[bytes]) -> None:
        try:
            version = np.lib.format.read_magic(file)
            read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
            shape, _, self._dtype = read(file)
        except ValueError as error:
            raise ValueError(f"{name}: not an array: {error}") from None
        if len(shape) != 1 or self._dtype.kind not in "fiuU":
            raise ValueError(f"{name}: must be an array (N,) of numbers or texts; got {self._dtype} {shape}")
        self.count = shape[0]
        self._file, self._start = file, file.tell()

    def read(self, begin: int, end: int) -> NDArray[Any]:
        """The entries from `begin` to before `end`."""
        size = self._dtype.itemsize
        self._file.seek(self._start + begin * size)
        content = self._file.read((end - begin) * size)
        if len(content) < (end - begin) * size:
            raise EOFError("an array ends early")
        return np.frombuffer(content, dtype=self._dtype)


class NpzWriter:
    """Writes an NPZ file, with NaN for a number that does not exist. A part is an NPZ file of its rows."""

    streams = False

    def encode(self, columns: Sequence[Column], contents: Contents) -> bytes:
        """The rows as an NPZ file."""
        file = io.BytesIO()
        np.savez(file, *[_array(column, content) for column, content in zip(columns, contents, strict=True)])
        return file.getvalue()

    def start(self, columns: Sequence[Column]) -> bytes:
        """Nothing that could be written before the end."""
        return b""

    def assemble(self, columns: Sequence[Column], parts: Pieces, file: BinaryIO) -> None:
        """One array after the other, each from all parts."""
        with zipfile.ZipFile(file, "w") as archive:
            for k, column in enumerate(columns):
                shapes = [(len(array), array.dtype) for array in _entries(parts, k)]
                dtype = max((dtype for _, dtype in shapes), key=lambda dtype: dtype.itemsize, default=np.dtype("U1"))
                header: dict[str, Any] = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False}
                header["shape"] = (sum(count for count, _ in shapes),)
                with archive.open(zipfile.ZipInfo(f"{column.name}.npy", _LONG_AGO), "w", force_zip64=True) as entry:
                    np.lib.format.write_array_header_1_0(entry, header)
                    for array in _entries(parts, k):
                        entry.write(array.astype(dtype).tobytes())


def _array(column: Column, content: Any) -> NDArray[Any]:
    if column.kind == "text":
        return np.array(content, dtype=np.str_) if content else np.zeros(0, "U1")
    return np.asarray(content, dtype=_KINDS[column.kind])


def _entries(parts: Pieces, column: int) -> Iterator[NDArray[Any]]:
    """The entries of one column, part by part."""
    for number in range(len(parts)):
        with parts.open(number) as file, np.load(file) as part:
            yield part[f"arr_{column}"]
