"""`ReachMap`: a map of what a robot can reach, with its files, its pictures, and where to put the base."""

from __future__ import annotations

import os
from typing import Any

from numpy.typing import ArrayLike

from ..errors import InputError
from ..picture.picture import Picture
from ..robot import Robot
from .bases import Bases, find_bases
from .drawing import draw_map
from .files import load_fields, save_map
from .page import save_page
from .voxel_map import Places, VoxelMap

__all__ = ["ReachMap"]


class ReachMap(VoxelMap):
    """What a robot can reach, cell by cell, as `pinik.reach` finds it."""

    def bases(
        self,
        targets: Places,
        *,
        heights: ArrayLike = (0.0,),
        yaws: int = 24,
        step: float | None = None,
        most: int = 10,
        **options: Any,
    ) -> Bases:
        """Where to put the robot's base for these targets, best first.

        Bases stand upright, anywhere on a grid in x and y, at the given heights and turned about z. They are ordered by
        the number of targets that they reach, then by the mean share of the orientations that are reached in the cells
        of the targets: the larger it is, the farther are targets from the edge of what can be reached. If the map knows
        its robot, the best ones are then solved for, and ordered by what is reached exactly.

        Args:
            targets: Positions (N, 3) [m], homogeneous matrices (N, 4, 4) or N SE3, in the world of the workpiece.
            heights: The heights of the base [m].
            yaws: The number of directions into which the base may look.
            step: The distance between neighbouring bases [m]; the size of the map's cells when None.
            most: How many bases are returned.
            **options: Those of `pinik.solve_many` with which the best bases are solved for, such as `method`, `locked`,
                `limits` and `avoid`: give those with which the map was made.

        Raises:
            InputError: A target is faulty, or another argument has the wrong type or range.
        """
        return find_bases(self, targets, heights=heights, yaws=yaws, step=step, most=most, options=options)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the map to a file: .npz or .parquet, which `ReachMap.load` reads; or .h5 in reuleaux's layout.

        Raises:
            InputError: Another suffix.
            MissingExtraError: The package that writes it is not installed.
            OSError: The file cannot be written.
        """
        save_map(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str], robot: Robot | None = None) -> ReachMap:
        """Read a map from a .npz or .parquet file that `save` wrote.

        Args:
            path: The file.
            robot: The robot, if it is to be drawn, or bases are to be solved for.

        Raises:
            InputError: It is not such a file, or a map of another robot.
            MissingExtraError: The package that reads it is not installed.
        """
        fields = load_fields(path)
        if robot is not None and robot.name != fields["robot"]:
            raise InputError(f"{os.fspath(path)} is a map of {fields['robot']}, and the robot is {robot.name}")
        return cls(**fields, machine=robot)

    def draw(self, robot: Robot | None = None, **options: Any) -> Picture:
        """Draw the robot in what it can reach, cut open: see `workspace.drawing.draw_map`."""
        return draw_map(self, robot, **options)

    def save_page(self, path: str | os.PathLike[str], robot: Robot | None = None) -> None:
        """Write one HTML file that shows the map in 3-D, to turn and to slice; it needs no server."""
        save_page(self, path, robot)
