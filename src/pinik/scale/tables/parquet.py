"""Tables as Parquet, by pyarrow."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ...extras import needed_by
from .table import Cells, Column, Contents, Fault, Pieces, Table, not_a_name, not_a_number

__all__ = ["ParquetSource", "ParquetWriter", "load_pyarrow", "pyarrow_version"]

_ROWS_IN_A_GROUP = 131_072


def load_pyarrow() -> Any:
    """pyarrow with its Parquet reader.

    Raises:
        MissingExtraError: It is not installed.
    """
    with needed_by("Parquet", "batch"):
        import pyarrow
        import pyarrow.parquet
    return pyarrow


def pyarrow_version() -> str:
    """The version of pyarrow, on which the bytes of a file depend."""
    return str(load_pyarrow().__version__)


class ParquetSource:
    """A Parquet file. Nulls are empty cells; NaN is a fault."""

    place = "row"

    def __init__(self, path: Path, rows: int) -> None:
        """Open it; `ValueError` says which column cannot be used."""
        arrow = load_pyarrow()
        try:
            self._file = arrow.parquet.ParquetFile(path)
        except arrow.ArrowInvalid as error:
            raise ValueError(f"not a Parquet file: {error}") from None
        self.names = tuple(self._file.schema_arrow.names)
        self._rows = rows
        # The chunks of each row group: the group, and the chunk's number in it.
        counts = [self._file.metadata.row_group(group).num_rows for group in range(self._file.metadata.num_row_groups)]
        self._places = [(group, k) for group, count in enumerate(counts) for k in range(-(-count // rows))]
        self._firsts = list(itertools.accumulate(counts, initial=0))
        self._reading: tuple[int, int, Iterator[Any]] | None = None  # the group, the next chunk in it, the batches

    @property
    def chunks(self) -> int:
        """The number of chunks."""
        return len(self._places)

    def raw(self, number: int) -> tuple[int, Any]:
        """The first row of one chunk, and its record batch."""
        group, k = self._places[number]
        if self._reading is None or self._reading[0] != group or self._reading[1] > k:
            self._reading = group, 0, self._file.iter_batches(self._rows, [group], use_threads=False)
        _, following, batches = self._reading
        try:
            batch = next(itertools.islice(batches, k - following, None))
        except (load_pyarrow().ArrowException, OSError) as error:
            raise ValueError(f"the file is damaged: {' '.join(str(error).split())}") from None
        self._reading = group, k + 1, batches
        return self._firsts[group] + k * self._rows, batch

    @staticmethod
    def decode(raw: tuple[int, Any], cells: Cells) -> Table:
        """Read a chunk."""
        arrow = load_pyarrow()
        begin, batch = raw
        table = Table(np.arange(begin, begin + batch.num_rows))
        for name in cells.names:
            column = batch.column(name)
            if arrow.types.is_dictionary(column.type):
                column = column.dictionary_decode()
            known = column.is_valid().to_numpy(zero_copy_only=False)
            if name in cells.texts:
                table.texts[name] = _names(arrow, column, name, table.faults)
            elif arrow.types.is_floating(column.type) or arrow.types.is_integer(column.type):
                numbers = column.cast("float64", safe=False).to_numpy(zero_copy_only=False).copy()
                for row in np.flatnonzero(known & ~np.isfinite(numbers)):
                    table.faults.append(Fault(int(row), name, not_a_number(float(numbers[row]))))
                    numbers[row] = math.nan
                table.numbers[name] = numbers
            else:
                table.numbers[name] = np.full(batch.num_rows, math.nan)
                for row in np.flatnonzero(known):
                    table.faults.append(Fault(int(row), name, not_a_number(column[int(row)].as_py())))
        return table

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _names(arrow: Any, column: Any, name: str, faults: list[Fault]) -> list[str | int | None]:
    types = arrow.types
    texts = types.is_string, types.is_large_string, types.is_string_view
    usable = types.is_integer(column.type) or any(is_text(column.type) for is_text in texts)
    names: list[str | int | None] = [value if value != "" else None for value in column.to_pylist()]
    if usable:
        return names
    faults += [Fault(row, name, not_a_name(value)) for row, value in enumerate(names) if value is not None]
    return [None] * len(names)


class ParquetWriter:
    """Writes a Parquet file, with null for a number that does not exist. A part is an Arrow stream of its rows."""

    streams = False

    def encode(self, columns: Sequence[Column], contents: Contents) -> bytes:
        """The rows as an Arrow stream."""
        arrow = load_pyarrow()
        schema = _schema(arrow, columns)
        arrays = [
            arrow.array(content, field.type, from_pandas=True) for field, content in zip(schema, contents, strict=True)
        ]
        sink = arrow.BufferOutputStream()
        with arrow.ipc.new_stream(sink, schema) as stream:
            stream.write_batch(arrow.record_batch(arrays, schema=schema))
        content: bytes = sink.getvalue().to_pybytes()
        return content

    def start(self, columns: Sequence[Column]) -> bytes:
        """Nothing that could be written before the end."""
        return b""

    def assemble(self, columns: Sequence[Column], parts: Pieces, file: BinaryIO) -> None:
        """All rows, in groups of a fixed number of them."""
        arrow = load_pyarrow()
        schema = _schema(arrow, columns)
        texts = [column.name for column in columns if column.name == "status"]
        with arrow.parquet.ParquetWriter(file, schema, use_dictionary=texts, compression="snappy") as writer:
            waiting: list[Any] = []
            count = 0
            for part in parts:
                for batch in arrow.ipc.open_stream(part):
                    waiting.append(batch)
                    count += batch.num_rows
                if count >= _ROWS_IN_A_GROUP:
                    writer.write_table(arrow.Table.from_batches(waiting, schema), row_group_size=count)
                    waiting, count = [], 0
            if waiting or not len(parts):
                writer.write_table(arrow.Table.from_batches(waiting, schema), row_group_size=max(count, 1))


def _schema(arrow: Any, columns: Sequence[Column]) -> Any:
    types = {"text": arrow.string(), "whole": arrow.int64(), "number": arrow.float64(), "truth": arrow.bool_()}
    return arrow.schema([(column.name, types[column.kind]) for column in columns])
