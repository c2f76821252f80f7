"""The files that meshes may refer to: colours and numbers, in the folder of a mesh and those below it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

__all__ = ["REFERRED", "referred_by"]

REFERRED = (".mtl", ".bin")
"""The endings of the files that a mesh may refer to."""
_REFERRING = (".obj", ".gltf", ".glb")
_MOST = 20_000  # files and folders that are looked at


def referred_by(meshes: Iterable[Path]) -> list[Path]:
    """The files that any of these meshes may refer to.

    Raises:
        OSError: The folders of the meshes hold too many files to look through.
    """
    folders = dict.fromkeys(mesh.parent for mesh in meshes if mesh.suffix.lower() in _REFERRING)
    return list(dict.fromkeys(file for folder in folders for file in _below(folder)))


def _below(folder: Path) -> Iterator[Path]:
    count = 0
    for place, folders, names in os.walk(folder):
        count += len(folders) + len(names)
        if count > _MOST:
            raise OSError(f"{folder} holds more than {_MOST:,} files")
        folders.sort()
        yield from (Path(place) / name for name in sorted(names) if name.lower().endswith(REFERRED))
