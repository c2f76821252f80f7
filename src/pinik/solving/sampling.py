"""Random configurations of the joints that move a frame, by number: none depends on how many are drawn with it."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..model.joint import Joint
from ..model.limits import Limits
from ..model.robot_model import RobotModel
from ..problem.problem import Problem
from ..problem.targets import Target
from .frame_arrays import placements
from .table import drawn_joints, range_of

__all__ = ["Sampler", "uniform_rows"]

Array = NDArray[np.float64]

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1, _MIX_2 = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_30, _27, _31, _11 = (np.uint64(bits) for bits in (30, 27, 31, 11))


class Sampler:
    """Random configurations of a robot that differ only in the joints that move a frame relative to a reference.

    Angles are uniform between their limits; `Joint.range_to_draw_from` says from where if there are none. Joints of
    more than one axis, such as a floating root, stay as they are at the start.

    Attributes:
        robot: The robot.
        problem: The target that names the frame, compiled; it knows the joints that move the frame.
        start: The configuration (nq,) from which all other joints take their values, inside the limits.
        limits: The limits.
        seed: The seed.
    """

    def __init__(
        self,
        robot: RobotModel,
        target: Target,
        start: Array,
        *,
        locked: Iterable[str] = (),
        limits: bool = True,
        seed: int = 0,
    ) -> None:
        """Prepare to draw.

        Raises:
            UnknownNameError: There is no such frame or joint.
        """
        self.robot, self.seed = robot, seed
        self.problem = Problem(robot, target, locked=locked)
        self.limits = Limits.of(robot, limits)
        self.start = self.limits.wrap(start)
        self._ranges = [(joint, *range_of(joint, self.problem, self.limits, self.start)) for joint in self.drawn]

    @property
    def drawn(self) -> list[Joint]:
        """The joints that are drawn."""
        return drawn_joints(self.problem)

    def configurations(self, first: int, count: int) -> Array:
        """Configurations number `first` to `first + count - 1`, (count, nq)."""
        q = np.tile(self.start, (count, 1))
        shares = uniform_rows(self.seed, first, count, len(self._ranges))
        for share, (joint, low, high) in zip(shares, self._ranges, strict=True):
            angle = low + share * (high - low)
            if joint.nq == 2:
                np.cos(angle, out=q[:, joint.idx_q])
                np.sin(angle, out=q[:, joint.idx_q + 1])
            else:
                q[:, joint.idx_q] = angle
        return q

    def placements(self, q: Array) -> Array:
        """The placements (N, 4, 4) of the frame, or of the tool in it, at configurations (N, nq)."""
        target = self.problem.targets[0]
        places = placements(self.robot, target.frame, q, target.relative_to)
        return places if target.tool is None else places @ np.array(target.tool.homogeneous)


def uniform_rows(seed: int, first: int, count: int, rows: int) -> Array:
    """Random numbers in [0, 1), (rows, count): from number `first` on in each row, by SplitMix64 (see `starts`)."""
    numbers = np.arange(first, first + count, dtype=np.uint64)
    with np.errstate(over="ignore"):
        keys = _mixed(np.uint64(seed & 0xFFFFFFFFFFFFFFFF) + _GOLDEN * (numbers + np.uint64(1)))
        drawn = [_mixed(keys + _GOLDEN * np.uint64(row + 1)) for row in range(rows)]
    return np.asarray((np.array(drawn, dtype=np.uint64).reshape(rows, count) >> _11) * 2.0**-53, dtype=np.float64)


def _mixed(z: NDArray[np.uint64]) -> NDArray[np.uint64]:
    z = (z ^ (z >> _30)) * _MIX_1
    z = (z ^ (z >> _27)) * _MIX_2
    return z ^ (z >> _31)
