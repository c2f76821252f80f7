"""Self-motion: how the joints may move while the frames stay at their targets."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_count, as_positive_number
from ..errors import InputError
from ..model.robot_model import RobotModel
from ..problem.target_values import Position
from ..problem.targets import Target
from ..problem.tolerance import Tolerance, largest_of
from .configuration import Given, as_configuration
from .data_frame import data_frame
from .freedom.arcs import Arc, arcs_of
from .freedom.beginning import beginning
from .freedom.dimension import Lone, regular_place
from .freedom.family import Family
from .freedom.settling import settle
from .freedom.solution_set import SolutionSet
from .freedom.spreading import Tree
from .joint_bars import joint_bars
from .options import Options
from .origin import unwound_path
from .question import Question
from .verdict import measure_errors
from .words import UNWEIGHTED, asked_targets

if TYPE_CHECKING:
    from pandas import DataFrame

__all__ = ["SelfMotion", "self_motion"]

Array = NDArray[np.float64]

_GROWN = 3
"""The number of configurations that a tree grows for each one that is asked for."""


def self_motion(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    q: Given,
    *,
    position: Position | None = None,
    rotation: ArrayLike | None = None,
    rpy: ArrayLike | None = None,
    quat_xyzw: ArrayLike | None = None,
    quat_wxyz: ArrayLike | None = None,
    placement: pinocchio.SE3 | ArrayLike | None = None,
    axis: str | ArrayLike | None = None,
    direction: ArrayLike | None = None,
    at: ArrayLike | None = None,
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    weight: float = UNWEIGHTED,
    points: int = 200,
    limits: bool = True,
    locked: Iterable[str] = (),
    tolerance: Tolerance | ArrayLike | None = None,
    seed: int = 0,
) -> SelfMotion:
    """Find how the joints may move from `q` while the frames stay at their targets.

    The answer is exact: every configuration reaches the targets to 1e-8 m and 1e-8 rad by plain Pinocchio, whatever the
    tolerance. Lengths and distances are Euclidean in the joints that can move a frame: in radians, with metres counted
    per length of the chain.

    * No freedom: q alone.
    * One: the whole curve through q is traced, also where it leaves the limits, and cut into its arcs inside them.
    * More: configurations far from each other, of a tree that grows over the set from q, inside the limits. They cover
      what the tree has reached; a part that is reached only through a narrow gap may be missing.

    Args:
        robot: The robot.
        targets: The name of a frame, with its target in the keywords from `position` to `weight`, or without any of
            them for the place where the frame is at `q`; or one or several Target objects.
        q: A configuration that reaches the targets: a `Solution`; a configuration (nq,); or angles by joint name, with
            all other joints neutral.
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight: As for
            `Target`.
        points: The number of configurations: of the arc through `q`, or of a set of more dimensions; at least 2.
        limits: Whether to keep the joint limits; `q` is moved inside them first, by whole turns where that helps.
        locked: Names of joints that must not move.
        tolerance: How far `q` may be from the targets (metres, radians); 1e-4 m and 1e-3 rad when None.
        seed: Where the sequence of the tree's goals begins.

    Raises:
        UnknownNameError: A frame, joint or keyword does not exist.
        InputError: `q` does not reach the targets inside the limits, or an argument has the wrong shape, type or range.
    """
    if not isinstance(robot, RobotModel):
        raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
    given = as_configuration(robot, q)
    wanted = (
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
    )  # fmt: skip
    if isinstance(targets, str) and all(value is None or value is UNWEIGHTED for value in wanted):
        targets = Target(targets, placement=robot.placement(targets, given))
    asked = asked_targets(targets, wanted, "dls", {})
    options = Options.of(limits=limits, locked=locked, tolerance=tolerance, seed=seed)
    question = Question.of(robot, asked, options)
    return _explored(question, given, as_count(points, "points", least=2))


@dataclass(frozen=True, eq=False, repr=False)
class SelfMotion:
    """The configurations that reach the targets, around one of them.

    Attributes:
        robot: The robot.
        targets: The targets.
        dimension: The dimension of the set around `start`: 0 if `start` is isolated, 1 for a curve, and so on. It is
            that of the kernel of the Jacobian, in which singular values below 1e-6 of the largest count as 0; at a
            singular place, that of the set beside it.
        start: The configuration (nq,) that it was found from, moved onto the set.
        q: The configurations (n, nq). Those of a curve are the arc through `start`, or the arc nearest to it: at equal
            distances, in their order. There are none if no part of the curve is inside the limits.
        length: The arc length of that arc [rad]; 0 if the set is not a curve.
        closed: Whether that arc comes back to its first configuration, up to whole turns.
        arcs: All arcs of the curve inside the limits, the one in `q` first; empty if the set is not a curve. Limits
            that leave a hinge more than one turn allow arcs at several turns; those nearest to `start` are given.
        turns: Joint → how many whole turns it makes while the whole curve comes round once, for those that do.
        complete: Whether the whole set connected with `start` is known: of a curve, if it closed or ended; never in
            more dimensions, nor of a set whose kernel is larger than itself everywhere, which is not explored.
        gap: The largest distance [rad] from a configuration known to be in the set to the nearest one of `q`, if the
            set has more dimensions than one; else None.
        known: For pinik itself: what was explored: the place alone, the curves, or the tree.
    """

    robot: RobotModel
    targets: tuple[Target, ...]
    dimension: int
    start: Array
    q: Array
    length: float = 0.0
    closed: bool = False
    arcs: tuple[Arc, ...] = ()
    turns: dict[str, int] = field(default_factory=dict)
    complete: bool = True
    gap: float | None = None
    known: Lone | Family | Tree = field(kw_only=True)

    def __len__(self) -> int:
        return len(self.q)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The names of the joints, in the order of the columns of `angles`."""
        return self.robot.joint_names

    @property
    def angles(self) -> Array:
        """The angles (n, n_joints) of `q` [rad or m]; those of continuous joints along a curve go on beyond ±π."""
        if self.arcs:
            return self.arcs[0].angles
        return np.array([unwound_path(self.robot, q[np.newaxis], self.start)[0] for q in self.q])

    @property
    def position_error(self) -> Array:
        """The largest position error (n,) of the targets at each of `q` [m], by plain Pinocchio; NaN without one."""
        return self._errors[:, 0]

    @property
    def orientation_error(self) -> Array:
        """The largest orientation error (n,), likewise [rad]."""
        return self._errors[:, 1]

    @property
    def _errors(self) -> Array:
        errors = [largest_of(measure_errors(self.robot, self.targets, q, Tolerance())) for q in self.q]
        return np.array(errors, dtype=np.float64).reshape(-1, 2)

    def contains(self, q: Given, within: float = 1e-3) -> bool:
        """Whether a configuration belongs to the same family: the set of solutions connected with `start`.

        Whole turns of hinges do not count, nor do the limits for a curve, which may leave them and come back. In more
        than one dimension the way stays inside them, and an answer of False is no proof: the way may only have been
        missed.

        Args:
            q: The configuration (nq,); angles by joint name, with all other joints neutral; or a `Solution`.
            within: The largest distance from the set [rad].

        Raises:
            UnknownNameError: There is no such joint.
            InputError: `q` is not a configuration of the robot, or `within` is not a positive number.
        """
        asked = as_configuration(self.robot, q)
        within = as_positive_number(within, "within", "radians")
        return self.known.reaches(asked, within)

    def _repr_html_(self) -> str:
        """The joints as bars between their limits, each with the band that `q` covers, as notebooks show them."""
        return joint_bars(self.robot, str(self), len(self) > 0, self.angles.reshape(len(self), len(self.joint_names)))

    def to_frame(self) -> DataFrame:
        """A data frame of pandas with one row for each of `q`: the joints' `angles`, then the errors.

        Raises:
            MissingExtraError: pandas is not installed.
        """
        others = {"position_error_m": self.position_error, "orientation_error_rad": self.orientation_error}
        return data_frame(self.joint_names, self.angles.reshape(len(self), len(self.joint_names)), others)

    def to_dict(self) -> dict[str, Any]:
        """A dictionary for JSON, as in the `families` of `pinik solve-all --json --families`."""
        return {
            "schema": 1,
            "robot": self.robot.name,
            "dimension": self.dimension,
            "message": str(self),
            "complete": self.complete,
            "gap": self.gap,
            "turns": dict(self.turns),
            "joint_names": list(self.joint_names),
            "angles": [] if self.dimension == 1 else self.angles.tolist(),
            "arcs": [arc.to_dict() for arc in self.arcs],
        }

    def __repr__(self) -> str:
        return f"SelfMotion({self})"

    def __str__(self) -> str:
        if self.dimension == 0:
            return "the configuration is isolated: no joint can move while the targets are kept"
        if isinstance(self.known, Lone):
            return (
                f"a configuration of a set of dimension {self.dimension} that is singular everywhere, and not explored"
            )
        if self.dimension > 1:
            return (
                f"{len(self)} configurations of a set of dimension {self.dimension}, at most {self.gap:.2g} rad from "
                "any other that was found; others may be missing"
            )
        if not self.arcs:
            return "the targets leave a curve of configurations, but no part of it is inside the limits"
        others = len(self.arcs) - 1
        beside = f"; {others} other {'arc' if others == 1 else 'arcs'}" if others else ""
        return f"{self.arcs[0]}{beside}"


def _explored(question: Question, given: Array, points: int) -> SelfMotion:
    """The self-motion from a configuration.

    Args:
        question: The targets and the options.
        given: The configuration (nq,).
        points: The number of configurations.
    """
    robot, targets = question.robot, question.problem.targets
    solutions = SolutionSet(question)
    start = beginning(solutions, given)
    found = regular_place(solutions, start)
    if isinstance(found, Lone):
        alone = start.q[np.newaxis]
        return SelfMotion(robot, targets, found.dimension, start.q, alone, complete=found.dimension == 0, known=found)
    solutions, place = found
    dimension = solutions.n - solutions.rank
    if dimension == 1:
        family = Family(solutions, place)
        arcs = tuple([arc for curve in family.curves for arc in arcs_of(curve, start.q, points)])
        first = arcs[0] if arcs else None
        q = np.zeros((0, robot.model.nq)) if first is None else first.q
        return SelfMotion(
            robot, targets, 1, start.q, q, first.length if first else 0.0, bool(first and first.closed), arcs,
            family.whole_turns, family.complete, known=family,
        )  # fmt: skip
    tree = Tree(solutions, place, question.options.seed)
    tree.grow(_GROWN * points)
    chosen, gap = tree.farthest(points)
    near = np.array([tree.places[k].q for k in chosen])
    q = np.array(settle(solutions, near, np.array([tree.tangents[k] for k in chosen])))
    return SelfMotion(robot, targets, dimension, start.q, q, complete=False, gap=gap, known=tree)
