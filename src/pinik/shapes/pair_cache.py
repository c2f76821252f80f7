"""Which pairs of links touch at rest, always or never, kept in the user's cache folder: to find out takes seconds."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from ..caches import cache_folder, digest, keep
from ..files import FileError, read_within
from ..model.robot_model import RobotModel
from ..version import __version__
from .disabled_pairs import LinkPair
from .solids import Solid

__all__ = ["key_of", "read", "write"]

_FORMAT = 2  # raise this whenever pinik finds out in another way, or writes another format
_MOST_BYTES = 20_000_000
_REASONS = ("at rest", "always", "never")


def key_of(robot: RobotModel, solids: Sequence[Solid]) -> str:
    """A file name that depends on the URDF, the root, the meshes' triangles, and the version of pinik."""
    kind = json.dumps([_FORMAT, __version__, robot.root, sorted(robot.mimics)])
    pieces = [kind.encode(), robot.description.document]
    for solid in solids:
        pieces.append(repr((solid.owner, solid.kind, solid.size)).encode())
        if solid.surface is not None:
            pieces += [solid.surface.vertices.tobytes(), solid.surface.faces.tobytes()]
    return digest(*pieces)


def read(key: str, pairs: Collection[LinkPair]) -> dict[LinkPair, Any] | None:
    """The reasons that were found for some of these pairs; None if there is no file, or if it is damaged."""
    folder = cache_folder("pairs")
    if folder is None:
        return None
    try:
        kept = json.loads(read_within(folder / f"{key}.json", _MOST_BYTES, "a file of pairs"))
        found = {(first, second): reason for first, second, reason in kept["left_out"]}
        intact = kept["digest"] == digest(json.dumps(kept["left_out"]).encode())
    except (FileError, ValueError, TypeError, KeyError, RecursionError):
        return None
    return found if intact and found.keys() <= set(pairs) and {*found.values()} <= {*_REASONS} else None


def write(key: str, found: Mapping[LinkPair, str]) -> None:
    """Keep what was found. If that fails, it is found again the next time."""
    folder = cache_folder("pairs")
    if folder is None:
        return
    left_out = [[first, second, reason] for (first, second), reason in found.items()]
    content = json.dumps({"digest": digest(json.dumps(left_out).encode()), "left_out": left_out})
    with contextlib.suppress(OSError, ValueError):
        keep(folder / f"{key}.json", content.encode())
