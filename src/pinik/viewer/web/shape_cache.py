"""Converted shapes in the user's cache folder: converting a Panda's takes two seconds, reading them back 20 ms."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Iterator
from pathlib import Path

import umsgpack

from ...caches import cache_folder, digest, keep
from ...files import FileError, read_within
from ...robot import Robot
from ...shapes.referred import referred_by
from .scene import Shapes, make_shapes

__all__ = ["LIMIT", "shapes_of"]

FORMAT = 1  # raise this whenever the format or the content of the files changes
LIMIT = 500_000_000
"""The most bytes that all files together may take."""

_DIGEST_SIZE = 32
# The code that makes the shapes; changing it invalidates the cache.
_MAKERS = [
    Path(__file__).parents[2] / room / module
    for room, module in (
        ("description", "materials.py"),
        ("description", "numbers.py"),
        ("description", "part.py"),
        ("description", "shape_tags.py"),
        ("shapes", "mesh_checks.py"),
        ("shapes", "mesh_files.py"),
        ("shapes", "meshes.py"),
        ("shapes", "neighbours.py"),
        ("shapes", "quiet.py"),
        ("shapes", "referred.py"),
        ("shapes", "simplified.py"),
        ("shapes", "triangles.py"),
        ("viewer/web", "scene.py"),
    )
]


def shapes_of(robot: Robot) -> Shapes:
    """Return a robot's shapes from the cache, or make and cache them, which takes seconds for some robots.

    This never raises. A cache that cannot be used only costs time. If the shapes cannot be made, the result has none,
    and a warning that says why.
    """
    try:
        path = _path(robot)
        shapes = None if path is None else _read(path)
        if shapes is None:
            shapes = make_shapes(robot)
            if path is not None:
                _write(path, shapes)
        return shapes
    except Exception as fault:
        return Shapes((), (), (f"the robot is drawn without shapes: {str(fault) or type(fault).__name__}",))


def _path(robot: Robot) -> Path | None:
    """The robot's file; None without a home folder, or if its meshes cannot be looked at."""
    try:
        folder = cache_folder("shapes")
        return None if folder is None else folder / f"{_key(robot)}.shapes"
    except (OSError, ValueError):
        return None


def _key(robot: Robot) -> str:
    """Return a file name that depends on the URDF, its mesh files and the code that reads them."""
    makers = [maker.read_bytes() for maker in _MAKERS]
    texts = [str(FORMAT), *_mesh_files(robot)]
    return digest(robot.description.document, *makers, *map(os.fsencode, texts))


def _mesh_files(robot: Robot) -> Iterator[str]:
    """Yield path, size and modification time of each mesh file, and of the files that one may refer to."""
    surroundings = robot.surroundings
    meshes = []
    for address in robot.description.meshes:
        mesh = surroundings.find(address).path
        yield f"{address} {mesh}"
        if mesh is not None:
            meshes.append(mesh)
    for file in (*meshes, *referred_by(meshes)):
        status = file.stat()
        yield f"{file.absolute()} {status.st_size} {status.st_mtime_ns}"


def _read(path: Path) -> Shapes | None:
    """Read the shapes from a file; None if it is missing or damaged. Reading counts as use."""
    try:
        content = read_within(path, LIMIT, "a file of shapes")
        body = memoryview(content)[_DIGEST_SIZE:]
        if hashlib.sha256(body).digest() != content[:_DIGEST_SIZE]:
            return None
        parts, commands, warnings = umsgpack.unpackb(bytes(body))
        shapes = Shapes(tuple((link, where) for link, where in parts), tuple(commands), tuple(warnings))
    except (FileError, ValueError, TypeError, RecursionError, umsgpack.UnpackException):
        return None
    with contextlib.suppress(OSError):
        os.utime(path)
    return shapes


def _write(path: Path, shapes: Shapes) -> None:
    """Write shapes to a file, and make room. If that fails, the next start just takes longer."""
    # ValueError: a warning may quote a file name that is not valid Unicode.
    with contextlib.suppress(OSError, ValueError):
        body = umsgpack.packb([shapes.parts, shapes.commands, shapes.warnings])
        keep(path, hashlib.sha256(body).digest() + body)
        _make_room(path.parent)


def _make_room(folder: Path) -> None:
    """Remove the least recently used files until the rest fits into `LIMIT`."""
    kept = 0
    with os.scandir(folder) as entries:
        files = [(entry.stat(), entry.path) for entry in entries if entry.is_file()]
    for status, path in sorted(files, key=lambda file: file[0].st_mtime_ns, reverse=True):
        kept += status.st_size
        if kept > LIMIT:
            kept -= status.st_size
            with contextlib.suppress(OSError):
                os.unlink(path)
