"""A plan: everything that a map depends on, cut into numbered parts that are done independently of each other."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model.robot_model import RobotModel
from ..problem.reach import reach_bounds
from ..problem.targets import Target
from ..scale.identity import identity_of_options, identity_of_robot
from ..solving.options import Options
from ..solving.sampling import Sampler
from .counts import Counts
from .grid import Grid
from .orientations import Orientations

__all__ = ["Plan", "size_of_parts"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_SAMPLES_OF_A_PART = 2**18
_MOST_PARTS = 256  # of a plan by samples, whose parts each hold cells from everywhere
_POSES_OF_A_PART = 2**14


@dataclass(frozen=True, eq=False)
class Plan:
    """Everything that a map depends on.

    Its parts are numbered from 0. What a part finds does not depend on which other parts are done, when and where.

    Attributes:
        robot: The robot.
        target: The target that names the frame, its tool and its reference.
        grid: The cells.
        orientations: The orientations that are told apart.
        samples: The number of random configurations; 0 for a plan that solves for each cell instead.
        branches: Whether to count the distinct answers for each pose that is reached.
        start: The configuration (nq,) of all joints that do not move the frame, from which solves start.
        options: The options of the solves; samples obey limits, locked joints, seed and what is to be avoided.
        part_size: The number of samples, or of cells, in each part but the last.
    """

    robot: RobotModel
    target: Target
    grid: Grid
    orientations: Orientations
    samples: int
    branches: bool
    start: Array
    options: Options
    part_size: int

    @cached_property
    def sampler(self) -> Sampler:
        """Draws configurations of the joints that move the frame."""
        options = self.options
        return Sampler(
            self.robot, self.target, self.start, locked=options.locked, limits=options.limits, seed=options.seed
        )

    @property
    def rows(self) -> int:
        """The rows of Jacobians that count for the manipulability: 3 if only positions are asked for, else 6."""
        return 6 if self.orientations.directions else 3

    @cached_property
    def unit(self) -> float:
        """The unit in which manipulabilities are counted: a power of the chain's length [m]."""
        columns = int(self.sampler.problem.free.sum())
        return float(self.sampler.problem.size_of_chain ** min(3, columns))

    @cached_property
    def asked(self) -> Indices:
        """The cells that are within the bounds of the frame's reach, as far as these are known."""
        cells = np.arange(len(self.grid), dtype=np.int64)
        bounds = reach_bounds(self.sampler.problem.terms[0], self.sampler.limits)
        if bounds is None:
            return cells
        distance = np.linalg.norm(self.grid.centers(cells) - bounds.base, axis=1)
        margin = 0.0 if not self.samples else 0.5 * np.sqrt(3.0) * self.grid.size
        return np.asarray(cells[distance <= bounds.reach + margin + 1e-9 * (1.0 + bounds.reach)])

    @property
    def parts(self) -> int:
        """The number of parts."""
        return -(-(self.samples or len(self.asked)) // self.part_size)

    @property
    def fingerprint(self) -> dict[str, Any]:
        """What the map depends on, by name, as JSON."""
        return {
            "robot": identity_of_robot(self.robot, self.options),
            "options": identity_of_options(self.options),
            "target": self.target.to_dict(),
            "grid": {"origin": self.grid.origin, "cell": self.grid.size, "shape": self.grid.shape},
            "orientations": {
                "directions": self.orientations.directions,
                "rolls": self.orientations.rolls,
                "axis": self.orientations.axis.tolist(),
            },
            "samples": self.samples,
            "part_size": self.part_size,
            "branches": self.branches,
            "q0": self.start.tolist(),
        }

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle only the fields; what is compiled from them belongs to this process."""
        return Plan, tuple(getattr(self, own.name) for own in fields(self))

    def empty(self) -> Counts:
        """Counts for all parts, in which nothing has been found yet."""
        return Counts.empty(self.asked, len(self.orientations))


def size_of_parts(samples: int, orientations: int) -> int:
    """A good size of parts: seconds of work, and not so many that the parts of large plans fill the disk."""
    if not samples:
        return max(1, _POSES_OF_A_PART // orientations)
    return _SAMPLES_OF_A_PART * max(-(-samples // (_MOST_PARTS * _SAMPLES_OF_A_PART)), 1)
