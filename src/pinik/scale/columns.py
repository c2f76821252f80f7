"""The columns of a table of targets: which there may be, and what they mean for a robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..errors import InputError, PinikError, UnknownNameError
from ..model.robot_model import RobotModel
from .tables.table import Cells

__all__ = ["POSITION", "QUATERNION", "ROLL_PITCH_YAW", "TEXTS", "TOLERANCES", "Columns"]

POSITION = ("x", "y", "z")
QUATERNION = ("qx", "qy", "qz", "qw")
ROLL_PITCH_YAW = ("roll", "pitch", "yaw")
TOLERANCES = ("tolerance_m", "tolerance_rad")
TEXTS = ("id", "frame")
_START = "start."
_OTHERS = (*TEXTS, *POSITION, *QUATERNION, *ROLL_PITCH_YAW, *TOLERANCES)


@dataclass(frozen=True)
class Columns:
    """The columns that a table of targets has.

    Attributes:
        cells: Their names, and which of them hold names.
        turned: The columns of the orientation; none if positions alone are asked for.
        starts: The joints whose start the rows give.
    """

    cells: Cells
    turned: tuple[str, ...]
    starts: tuple[str, ...]

    @classmethod
    def of(cls, names: Sequence[str], robot: RobotModel) -> Columns:
        """Check the names of the columns.

        Raises:
            InputError: A column is missing, comes twice, or belongs to another orientation; or a joint cannot start
                anywhere.
            UnknownNameError: There is no such column, or no such joint.
        """
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"the column {name!r} comes twice")
            if name not in _OTHERS and not name.startswith(_START):
                joints = [_START + joint.name for joint in robot.joints if joint.has_one_axis and joint.leader is None]
                raise UnknownNameError("column", name, [*_OTHERS, *joints])
        both = [group for group in (QUATERNION, ROLL_PITCH_YAW) if any(name in names for name in group)]
        if len(both) == 2:
            raise InputError("give the orientation once, in qx,qy,qz,qw or in roll,pitch,yaw")
        turned = both[0] if both else ()
        wanted = POSITION if any(name in names for name in POSITION) or not turned else ()
        missing = [name for name in (*wanted, *turned) if name not in names]
        if missing:
            raise InputError(
                f"there is no column {missing[0]!r}; a table of targets has the columns x,y,z, and qx,qy,qz,qw or "
                f"roll,pitch,yaw if there are orientations; got {','.join(names) or 'none'}"
            )
        starts = tuple(name.removeprefix(_START) for name in names if name.startswith(_START))
        for joint in starts:
            _check_start(robot, joint)
        return cls(Cells(tuple(names), frozenset(TEXTS)), turned, starts)

    def __contains__(self, name: str) -> bool:
        return name in self.cells.names

    @staticmethod
    def of_start(joint: str) -> str:
        """The name of the column with a joint's start."""
        return _START + joint


def _check_start(robot: RobotModel, name: str) -> None:
    try:
        joint = robot.settable_joint(name)
    except PinikError as error:
        raise InputError(f"the column {_START + name!r}: {error}") from None
    if not joint.has_one_axis:
        raise InputError(f"the column {_START + name!r}: joint {name!r} is {joint.kind}, and has no angle")
