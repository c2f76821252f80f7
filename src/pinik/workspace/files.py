"""Files of maps: NPZ and Parquet, which hold all of a map, and HDF5 in the layout of reuleaux."""

from __future__ import annotations

import io
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..files import FileError, read_within, write_whole
from ..scale.tables.parquet import load_pyarrow
from .counts import Counts
from .grid import Grid
from .orientations import Orientations
from .reuleaux import reuleaux_file
from .voxel_map import VoxelMap

__all__ = ["SUFFIXES", "check_suffix", "content_of", "load_fields", "save_map"]

SUFFIXES = (".npz", ".parquet", ".h5")
"""The suffixes of the files that hold a map."""

_SCHEMA = 1
_KEY = b"pinik.reach"
_MOST_BYTES = 4 * 1024**3


def check_suffix(path: str | os.PathLike[str], allowed: tuple[str, ...] = SUFFIXES) -> str:
    """The suffix of a file's name; InputError unless it is an allowed one."""
    suffix = Path(path).suffix.lower()
    if suffix not in allowed:
        raise InputError(f"a map's file must end in {', '.join(allowed)}; got {os.fspath(path)!r}")
    return suffix


def save_map(reach: VoxelMap, path: str | os.PathLike[str]) -> None:
    """See `ReachMap.save`."""
    write_whole(path, content_of(reach, path))


def content_of(reach: VoxelMap, path: str | os.PathLike[str]) -> bytes:
    """The bytes of a map's file, whose kind the suffix of its name tells."""
    make = {".npz": _npz, ".parquet": _parquet, ".h5": reuleaux_file}[check_suffix(path)]
    return make(reach)


def load_fields(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The fields of a `VoxelMap` from a file; see `ReachMap.load`."""
    from zipfile import BadZipFile  # slow to import

    suffix = check_suffix(path, SUFFIXES[:2])
    try:
        content = read_within(Path(path), _MOST_BYTES, "a map")
    except FileError as error:
        raise InputError(f"{os.fspath(path)}: {error}") from None
    try:
        head, arrays = (_read_npz if suffix == ".npz" else _read_parquet)(content)
        if head["schema"] != _SCHEMA:
            raise ValueError(f"its schema is {head['schema']}, and this pinik reads {_SCHEMA}")
        orientations = Orientations(head["directions"], head["rolls"], head["axis"])
        grid = Grid(tuple(head["origin"]), head["cell"], tuple(head["shape"]))
        counts = Counts.from_arrays(arrays, len(orientations))
    except (ValueError, KeyError, TypeError, OSError, BadZipFile, EOFError) as error:
        raise InputError(f"{os.fspath(path)}: not a map of pinik: {error}") from None
    tool = None if head["tool"] is None else np.array(head["tool"])
    plain = ("robot", "frame", "relative_to", "samples", "counts_branches", "unit")
    return {name: head[name] for name in plain} | {
        "tool": tool, "grid": grid, "orientations": orientations, "counts": counts
    }  # fmt: skip


def _head(reach: VoxelMap) -> dict[str, Any]:
    """All of a map but its counts, as JSON."""
    return {
        "schema": _SCHEMA,
        "robot": reach.robot,
        "frame": reach.frame,
        "relative_to": reach.relative_to,
        "tool": None if reach.tool is None else reach.tool.tolist(),
        "origin": list(reach.grid.origin),
        "cell": reach.grid.size,
        "shape": list(reach.grid.shape),
        "directions": reach.orientations.directions,
        "rolls": reach.orientations.rolls,
        "axis": reach.orientations.axis.tolist(),
        "samples": reach.samples,
        "counts_branches": reach.counts_branches,
        "unit": reach.unit,
    }


def _npz(reach: VoxelMap) -> bytes:
    """The counts's arrays, the description, and what most readers want: the centres and the means of each cell."""
    file = io.BytesIO()
    head = np.frombuffer(json.dumps(_head(reach)).encode(), dtype=np.uint8)
    np.savez_compressed(file, head=head, **_columns(reach), **reach.counts.to_arrays())  # type: ignore[arg-type]
    return file.getvalue()


def _read_npz(content: bytes) -> tuple[dict[str, Any], dict[str, NDArray[np.generic]]]:
    with np.load(io.BytesIO(content), allow_pickle=False) as file:
        return json.loads(bytes(file["head"])), {name: file[name] for name in file.files if name != "head"}


def _columns(reach: VoxelMap) -> dict[str, NDArray[np.generic]]:
    """The centres and the means of the cells that were asked for."""
    cells = reach.counts.cells
    x, y, z = reach.grid.centers(cells).T
    means = {"share": reach.share, "mean_manipulability": reach.manipulability, "mean_room": reach.room}
    if reach.counts_branches:
        means["mean_branches"] = reach.branches
    return {"x": x, "y": y, "z": z} | {name: values.ravel()[cells] for name, values in means.items()}


def _parquet(reach: VoxelMap) -> bytes:
    pyarrow = load_pyarrow()
    arrays = reach.counts.to_arrays()
    bits = np.asarray(arrays.pop("reached"))
    columns = {name: pyarrow.array(values) for name, values in (_columns(reach) | arrays).items()}
    columns["reached"] = pyarrow.FixedSizeBinaryArray.from_buffers(
        pyarrow.binary(bits.shape[1]), len(bits), [None, pyarrow.py_buffer(np.ascontiguousarray(bits))]
    )
    table = pyarrow.table(columns).replace_schema_metadata({_KEY: json.dumps(_head(reach))})
    file = io.BytesIO()
    pyarrow.parquet.write_table(table, file, compression="zstd")
    return file.getvalue()


def _read_parquet(content: bytes) -> tuple[dict[str, Any], dict[str, NDArray[np.generic]]]:
    pyarrow = load_pyarrow()
    table = pyarrow.parquet.read_table(pyarrow.BufferReader(content))
    head = json.loads((table.schema.metadata or {})[_KEY])
    arrays = {name: table[name].to_numpy() for name in table.column_names if name != "reached"}
    rows = b"".join(table["reached"].to_pylist())
    width = table.schema.field("reached").type.byte_width
    return head, arrays | {"reached": np.frombuffer(rows, dtype=np.uint8).reshape(len(table), width)}
