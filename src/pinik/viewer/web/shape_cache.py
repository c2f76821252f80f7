"""Finished shapes, kept in the user's cache folder: a Panda's meshes take two seconds to convert, its file 20 ms."""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

import platformdirs
import umsgpack

from ...description.packages import resolve
from ...robot import Robot
from .scene import Shapes, make_shapes

__all__ = ["LIMIT", "cache_folder", "shapes_of"]

FORMAT = 1  # of the files here; raise it whenever they, or what is in them, change
LIMIT = 500_000_000
"""Bytes that all files together may take."""

_DIGEST_SIZE = 32
# What decides about the shapes besides the robot.
_MAKERS = [Path(__file__).with_name("scene.py"), Path(__file__).parents[2] / "shapes" / "meshes.py"]


def shapes_of(robot: Robot) -> Shapes:
    """A robot's shapes, from the cache if they are there, else made (seconds, for some robots) and kept.

    Shapes are never worth an error: where they cannot be had there are none, and a warning.
    """
    try:
        path = cache_folder() / f"{_key(robot)}.shapes"
        shapes = _read(path)
        if shapes is None:
            shapes = make_shapes(robot)
            _write(path, shapes)
        return shapes
    except Exception as fault:
        return Shapes((), (), (f"the robot is drawn without shapes: {str(fault) or type(fault).__name__}",))


def cache_folder() -> Path:
    """Where the files are: `shapes` in the user's cache folder for pinik, or in PINIK_CACHE_DIR if that is set."""
    chosen = os.environ.get("PINIK_CACHE_DIR") or platformdirs.user_cache_dir("pinik", appauthor=False)
    return Path(chosen) / "shapes"


def _key(robot: Robot) -> str:
    """A name that changes with all that the shapes depend on: the URDF, its mesh files, the code that reads them."""
    digest = hashlib.sha256()
    makers = [maker.read_bytes() for maker in _MAKERS]
    texts = [str(FORMAT), *_mesh_files(robot)]
    for piece in (robot.description.document, *makers, *map(os.fsencode, texts)):
        digest.update(len(piece).to_bytes(8, "little") + piece)
    return digest.hexdigest()


def _mesh_files(robot: Robot) -> Iterator[str]:
    """Path, size and time of change of each mesh's file, and of the material files that an OBJ may name."""
    for address in robot.description.meshes:
        mesh = resolve(address, urdf_path=robot.description.path, package_dirs=robot.package_dirs)
        yield address
        if mesh is not None:
            materials = sorted(mesh.parent.glob("*.mtl")) if mesh.suffix.lower() == ".obj" else []
            for file in (mesh, *materials):
                status = file.stat()
                yield f"{file.absolute()} {status.st_size} {status.st_mtime_ns}"


def _read(path: Path) -> Shapes | None:
    """The shapes in a file; None where there is none, or it is not whole. A file that is read counts as used."""
    try:
        content = path.read_bytes()
        body = memoryview(content)[_DIGEST_SIZE:]
        if hashlib.sha256(body).digest() != content[:_DIGEST_SIZE]:
            return None
        parts, commands, warnings = umsgpack.unpackb(bytes(body))
    except OSError:
        return None
    with contextlib.suppress(OSError):
        os.utime(path)
    return Shapes(tuple((link, where) for link, where in parts), tuple(commands), tuple(warnings))


def _write(path: Path, shapes: Shapes) -> None:
    """Keep shapes in a file, whole or not at all, and make room; where that cannot be, the next start takes longer."""
    with contextlib.suppress(OSError, ValueError):  # ValueError: a file's name in a warning may be no Unicode
        body = umsgpack.packb([shapes.parts, shapes.commands, shapes.warnings])
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, unfinished = tempfile.mkstemp(suffix=".unfinished", dir=path.parent)
        try:
            with open(handle, "wb") as file:
                file.write(hashlib.sha256(body).digest() + body)
            os.replace(unfinished, path)
        except BaseException:
            os.unlink(unfinished)
            raise
        _make_room(path.parent)


def _make_room(folder: Path) -> None:
    """Remove the files used longest ago until the rest fits into `LIMIT`."""
    kept = 0
    with os.scandir(folder) as entries:
        files = [(entry.stat(), entry.path) for entry in entries if entry.is_file()]
    for status, path in sorted(files, key=lambda file: file[0].st_mtime_ns, reverse=True):
        kept += status.st_size
        if kept > LIMIT:
            kept -= status.st_size
            with contextlib.suppress(OSError):
                os.unlink(path)
