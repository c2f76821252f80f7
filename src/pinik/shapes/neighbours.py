"""The files that a mesh refers to: colours and numbers, from its own folder and those below it, and no textures."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from trimesh.resolvers import Resolver

from ..files import FileError, read_within
from .mesh_checks import MOST_BYTES
from .referred import REFERRED

__all__ = ["Neighbours"]


class Neighbours(Resolver):
    """Gives a mesh the files beside it, up to the size of one mesh file.

    Attributes:
        file_name: The name of the mesh file, as trimesh asks for it.
    """

    def __init__(self, mesh: Path) -> None:
        self.file_name = mesh.name
        self._folder = os.path.realpath(mesh.parent)
        self._left = MOST_BYTES

    def get(self, name: str) -> bytes:
        """The contents of a file beside the mesh, or in a folder beside it.

        Raises:
            FileNotFoundError: There is no such file, it is not of a kind that pinik uses, or it lies elsewhere.
        """
        path = os.path.realpath(os.path.join(self._folder, unquote(name.strip()).replace("\\", "/")))
        if not path.startswith(self._folder.rstrip(os.sep) + os.sep) or not path.lower().endswith(REFERRED):
            raise FileNotFoundError(name)
        try:
            contents = read_within(Path(path), self._left, "a part of a mesh")
        except FileError as fault:
            raise FileNotFoundError(f"{name}: {fault}") from None
        self._left -= len(contents)
        return contents

    def keys(self) -> Iterator[str]:
        """No names: trimesh asks for each file that it needs."""
        return iter(())

    def write(self, name: str, data: object) -> None:
        """Refused: nothing is written beside a mesh."""
        raise PermissionError(name)

    def namespaced(self, namespace: str) -> Neighbours:
        """The same files, as no archive is read."""
        return self
