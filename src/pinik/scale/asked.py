"""What the rows of a table ask: targets as rows of numbers, and starts; each row is checked as `Target` checks it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..checks import FARTHEST
from ..errors import PinikError
from ..model.robot_model import RobotModel
from ..problem.targets import Target
from ..problem.tolerance import Tolerance
from ..rotations import rotations_of_quaternions, rotations_of_rpy, rpy_like_degrees
from ..solving.origin import Origin
from .columns import POSITION, TOLERANCES, Columns
from .kinds import Kind, kinds_of
from .tables.table import Fault, Table

__all__ = ["Asked", "Reading"]

Array = NDArray[np.float64]
Truths = NDArray[np.bool_]


@dataclass
class Asked:
    """What the good rows of a table ask.

    Attributes:
        rows: The indices of the good rows in the table (N,).
        goals: The numbers of their targets, as `goals_of` encodes them (N, 18).
        kinds: The kinds of targets, and the index of each row's kind (N,).
        starts: Their starts (N, nq), or one start for all (1, nq).
        turned: The angles of continuous joints at the start that were given as angles: one, or one for each row (N,).
        faults: What is wrong with the other rows, at most one fault for each cell.
    """

    rows: NDArray[np.intp]
    goals: Array
    kinds: list[Kind]
    kind_of_row: NDArray[np.intp]
    starts: Array
    turned: dict[str, Any]
    faults: list[Fault]


@dataclass(frozen=True)
class Reading:
    """How the rows of a table are read.

    Attributes:
        robot: The robot.
        columns: The columns of the table.
        frame: The frame to move in rows that name none.
        tool, relative_to: As for `Target`, in all rows.
        tolerance: The tolerance of rows that give none.
        origin: The start of rows and joints that give none.
        degrees: Whether angles in the table are in degrees.
    """

    robot: RobotModel
    columns: Columns
    frame: str | None
    tool: pinocchio.SE3 | None
    relative_to: str | None
    tolerance: Tolerance
    origin: Origin
    degrees: bool = False
    _frames: dict[str, str] = field(default_factory=dict, repr=False, compare=False)

    def pattern(self, kind: Kind) -> Target:
        """A target of this kind."""
        position = [0.0 if known else None for known in kind.along] if any(kind.along) else None
        rotation = np.eye(3) if kind.rotated else None
        return Target(
            kind.frame,
            position,
            rotation=rotation,
            tool=self.tool,
            relative_to=self.relative_to,
            tolerance=kind.tolerance,
        )

    def read(self, table: Table) -> Asked:
        """Read the rows of a table."""
        faults = _Faults(table)
        goals = np.zeros((len(table), 18))
        along = self._read_positions(table, goals, faults)
        rotated = self._read_rotations(table, goals, faults)
        faults.add(~along.any(axis=1) & ~rotated, None, "nothing is asked for; give a position or an orientation")
        tolerances = self._read_tolerances(table, faults)
        if "id" in self.columns:
            faults.add(np.array([name is None for name in table.texts["id"]], dtype=bool), "id", "must not be empty")
        frames = self._read_frames(table, faults)
        starts, turned = self._read_starts(table, faults)
        rows = np.flatnonzero(~faults.faulty)
        kinds, kind_of_row = kinds_of(frames, along, rotated, tolerances, rows, self.tolerance)
        return Asked(
            rows,
            goals[rows],
            kinds,
            kind_of_row,
            starts if len(starts) == 1 else starts[rows],
            {name: value if np.ndim(value) == 0 else value[rows] for name, value in turned.items()},
            faults.sorted(),
        )

    def like_degrees(self, table: Table) -> int | None:
        """The first row whose roll, pitch and yaw are taken as radians and look like degrees."""
        if len(self.columns.turned) != 3 or self.degrees:
            return None
        numbers = np.stack([table.numbers[name] for name in self.columns.turned], axis=1)
        beyond = np.flatnonzero(np.abs(numbers).max(axis=1, initial=0.0) > 2.0 * math.pi)
        return next((row for row in beyond.tolist() if rpy_like_degrees(numbers[row].tolist())), None)

    def _read_positions(self, table: Table, goals: Array, faults: _Faults) -> Truths:
        along = np.zeros((len(table), 3), dtype=bool)
        for axis, name in enumerate(POSITION):
            if name in self.columns:
                numbers = table.numbers[name]
                along[:, axis] = ~np.isnan(numbers)
                goals[:, axis] = np.nan_to_num(numbers)
                faults.add(np.abs(goals[:, axis]) > FARTHEST, name, f"must be within ±{FARTHEST:g} m")
        return along

    def _read_rotations(self, table: Table, goals: Array, faults: _Faults) -> Truths:
        names = self.columns.turned
        if not names:
            return np.zeros(len(table), dtype=bool)
        numbers = np.stack([table.numbers[name] for name in names], axis=1)
        known = ~np.isnan(numbers)
        rotated = known.any(axis=1)
        for column, name in enumerate(names):
            others = ", ".join(other for other in names if other != name)
            faults.add(rotated & ~known[:, column], name, f"must be a number, as there is one of {others}")
        rotated = np.array(known.all(axis=1))
        if len(names) == 4:
            zero = rotated & (np.abs(np.nan_to_num(numbers)).max(axis=1, initial=0.0) < 1e-9)
            faults.add(zero, ",".join(names), "a quaternion must not be zero")
            rotated &= ~zero
            rotations = rotations_of_quaternions(numbers[rotated])
        else:
            rotations = rotations_of_rpy(np.radians(numbers[rotated]) if self.degrees else numbers[rotated])
        goals[rotated, 3:12] = rotations.reshape(-1, 9)
        return rotated

    def _read_tolerances(self, table: Table, faults: _Faults) -> Array | None:
        """The tolerances (N, 2), NaN where a row gives none; None where no row does."""
        if not any(name in self.columns for name in TOLERANCES):
            return None
        none = np.full(len(table), math.nan)
        tolerances = np.stack([table.numbers.get(name, none) for name in TOLERANCES], axis=1)
        for column, name in enumerate(TOLERANCES):
            faults.add(tolerances[:, column] <= 0.0, name, "must be positive")
        return tolerances

    def _read_frames(self, table: Table, faults: _Faults) -> list[str]:
        if self.frame is not None and "frame" not in self.columns:
            return [self.frame] * len(table)
        named = table.texts.get("frame", [None] * len(table))
        frames = [self.frame if name is None else str(name) for name in named]
        if None in frames:
            missing = np.array([frame is None for frame in frames])
            column = "frame" if "frame" in self.columns else None
            faults.add(missing, column, "there is no frame to move; give one for all rows by --frame F (frame=)")
        for frame in {frame for frame in frames if frame is not None}:
            words = self._fault_of_frame(frame)
            if words:
                faults.add(np.array([other == frame for other in frames]), "frame", words)
        return [frame or "" for frame in frames]

    def _fault_of_frame(self, frame: str) -> str:
        if frame not in self._frames:
            try:
                self.robot.frame_id(frame)
                self._frames[frame] = ""
            except PinikError as error:
                self._frames[frame] = str(error)
        return self._frames[frame]

    def _read_starts(self, table: Table, faults: _Faults) -> tuple[Array, dict[str, Any]]:
        origin = self.origin
        turned: dict[str, Any] = dict(origin.turned)
        if not self.columns.starts:
            return origin.q[np.newaxis], turned
        starts = np.tile(origin.q, (len(table), 1))
        for name in self.columns.starts:
            joint, column = self.robot.joint(name), self.columns.of_start(name)
            angles = table.numbers[column]
            given = ~np.isnan(angles)
            faults.add(given & (np.abs(np.nan_to_num(angles)) > FARTHEST), column, f"must be within ±{FARTHEST:g}")
            if self.degrees and joint.kind != "prismatic":
                angles = np.radians(angles)
            if joint.nq == 1:
                starts[given, joint.idx_q] = angles[given]
            else:
                starts[given, joint.idx_q] = np.cos(angles[given])
                starts[given, joint.idx_q + 1] = np.sin(angles[given])
                turned[name] = np.where(given, angles, turned.get(name, joint.angle(origin.q)))
        return starts, turned


class _Faults:
    """The faults of a table, to which more are added, and the rows that have any."""

    def __init__(self, table: Table) -> None:
        self._all = list(table.faults)
        self.faulty = np.zeros(len(table), dtype=bool)
        self.faulty[[fault.row for fault in self._all]] = True
        self._broken = self.faulty.copy()  # whose other cells may be empty because of the fault

    def add(self, wrong: Truths, column: str | None, reason: str) -> None:
        """Add a fault for these rows, unless it may follow from one that was found when the row was read."""
        for row in np.flatnonzero(wrong & ~self._broken):
            self._all.append(Fault(int(row), column, reason))
            self.faulty[row] = True

    def sorted(self) -> list[Fault]:
        """All faults, by row."""
        return sorted(self._all, key=lambda fault: fault.row)
