"""The columns of a table of answers."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from operator import attrgetter
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.joint import Joint
from ..model.robot_model import RobotModel
from ..solving.attempts import Outcomes
from ..solving.origin import unwound_rows
from ..solving.state import Status
from .tables.table import Column, Contents

__all__ = ["Answers", "columns_of"]

Array = NDArray[np.float64]

_SOLVED = Status.CONVERGED.name
_PARTS = ("x", "y", "z", "qx", "qy", "qz", "qw")


def columns_of(robot: RobotModel, *, whole_ids: bool, times: bool) -> tuple[Column, ...]:
    """The columns of the answers for a robot.

    Args:
        robot: The robot.
        whole_ids: Whether all ids are whole numbers.
        times: Whether there is a column with the duration of each solve.
    """
    return (
        Column("id", "whole" if whole_ids else "text"),
        Column("success", "truth"),
        Column("status", "text"),
        *(Column(f"angle.{name}", "number") for name in robot.joint_names),
        *(Column(f"placement.{joint.name}.{part}", "number") for joint in _placed(robot) for part in _PARTS),
        Column("position_error_m", "number"),
        Column("orientation_error_rad", "number"),
        Column("iterations", "whole"),
        Column("restarts", "whole"),
        *([Column("time_s", "number")] if times else []),
    )


class Answers:
    """The answers to the rows of one chunk, put together from those of its kinds."""

    def __init__(self, robot: RobotModel, count: int) -> None:
        self._robot = robot
        self._q = np.zeros((count, robot.model.nq))
        self._angles = np.zeros((count, len(robot.joint_names)))
        self._figures = np.zeros((count, 3))  # position error, orientation error, time
        self._counts = np.zeros((count, 2), dtype=np.int64)  # iterations, restarts
        self._statuses = np.empty(count, dtype=object)

    def put(self, rows: NDArray[np.intp], outcomes: Outcomes, starts: Array, turned: dict[str, Any]) -> None:
        """Put the answers to some rows into their places.

        Args:
            rows: The indices of the rows (n,).
            outcomes: Their answers.
            starts: Their starts (n, nq), or one for all (1, nq).
            turned: The angles of continuous joints at the start that were given as angles.
        """
        self._q[rows] = outcomes.q
        self._angles[rows] = unwound_rows(self._robot, outcomes.q, starts, turned)
        figures = outcomes.position_error, outcomes.orientation_error, outcomes.time
        self._figures[rows] = np.stack(figures, axis=1)
        self._counts[rows] = np.stack([outcomes.iterations, outcomes.restarts], axis=1)
        self._statuses[rows] = outcomes.status

    @cached_property
    def statuses(self) -> list[str]:
        """The name of each row's status, once all answers are in their places."""
        return list(map(attrgetter("name"), self._statuses.tolist()))

    def contents(self, ids: Sequence[str] | NDArray[np.int64], *, degrees: bool, times: bool) -> Contents:
        """The cells of each column, in the order of `columns_of`; angles in degrees if `degrees`."""
        names = self._robot.joint_names
        angles = self._angles.copy() if degrees else self._angles
        for column, name in zip(angles.T, names, strict=True):
            if degrees and self._robot.joint(name).kind != "prismatic":
                column[:] = np.degrees(column)
        return [
            ids,
            np.array([name == _SOLVED for name in self.statuses], dtype=bool),
            self.statuses,
            *np.ascontiguousarray(angles.T),
            *self._placements(),
            *np.ascontiguousarray(self._figures.T[:2]),
            *np.ascontiguousarray(self._counts.T),
            *([np.ascontiguousarray(self._figures[:, 2])] if times else []),
        ]

    def _placements(self) -> list[Array]:
        """The placements of floating and planar joints: seven columns (N,) for each of them."""
        joints = _placed(self._robot)
        placements = np.array([[_place(joint, q) for joint in joints] for q in self._q])
        return [column.copy() for column in placements.reshape(len(self._q), 7 * len(joints)).T]


def _place(joint: Joint, q: Array) -> Array:
    """A joint's position and quaternion xyzw (7,)."""
    return np.array(pinocchio.SE3ToXYZQUAT(joint.placement(q)))


def _placed(robot: RobotModel) -> list[Joint]:
    """The joints that have a placement instead of an angle."""
    return [joint for joint in robot.joints if not joint.has_one_axis]
