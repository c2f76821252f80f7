"""One HTML file that shows a map, to turn and to slice, without a server."""

from __future__ import annotations

import os

from ..robot import Robot
from .voxel_map import VoxelMap

__all__ = ["save_page"]


def save_page(reach: VoxelMap, path: str | os.PathLike[str], robot: Robot | None = None) -> None:
    """See `ReachMap.save_page`."""
    raise NotImplementedError
