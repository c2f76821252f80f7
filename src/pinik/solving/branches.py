"""All answers to one question, and how complete they are."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..model.robot_model import RobotModel
from ..problem.coordinates import Coordinate
from ..problem.targets import Target
from ..problem.tolerance import TargetError
from .changes import farthest_coordinate
from .completeness import estimate_missing, words_of
from .data_frame import data_frame
from .findings import Findings
from .joint_bars import joint_bars
from .origin import unwound
from .question import Question
from .self_motion import SelfMotion, self_motion
from .state import Status
from .verdict import measure_errors
from .windings import winding_ranges, wound

if TYPE_CHECKING:
    from pandas import DataFrame

__all__ = ["Branches"]

Array = NDArray[np.float64]

_FROM_THE_QUESTION = ("robot", "method", "joint_names", "windings", "errors", "_farthest", "_conditions")


@dataclass(frozen=True, eq=False, repr=False)
class Branches:
    """The distinct configurations that reach the targets inside the limits, each checked by plain Pinocchio.

    Two configurations are distinct if a joint differs by more than 0.01 rad, or by more than 0.01 of the chain's length
    for prismatic joints, after whole turns of hinges. Those that differ by whole turns only are one branch: `q` has the
    one nearest to the start, and `windings` tells how far the joints can turn from there.

    Attributes:
        is_complete: Whether these are proved to be all; only a closed form proves it.
        status: `Status.CONVERGED` if there is an answer; else why there is none.
    """

    is_complete: bool
    status: Status
    _found: Findings
    _question: Question
    _targets: tuple[Target, ...]
    _start: Array
    _turned: Mapping[str, float]
    _engine: str
    _words: str | None

    @property
    def q(self) -> Array:
        """The configurations (n, nq), ordered by `distance`; at distances equal to 1e-6, by their entries."""
        return self._found.q

    @property
    def distance(self) -> Array:
        """The largest change of a joint from the start to each (n,), in `distance_unit`; a metre counts as a radian."""
        return self._found.distance

    @property
    def position_error(self) -> Array:
        """The largest position error of each (n,) [m], by plain Pinocchio; NaN without positions."""
        return self._found.position_error

    @property
    def orientation_error(self) -> Array:
        """The largest orientation error of each (n,) [rad], likewise."""
        return self._found.orientation_error

    @property
    def found_at(self) -> NDArray[np.int64]:
        """The number of the start from which each was found (n,); 0 is the given start."""
        return self._found.found_at

    @property
    def hits(self) -> NDArray[np.int64]:
        """How many starts led to each (n,).

        Where answers are usually isolated, one of a continuum stands for all within 0.5 rad, so that a start that led
        to one of these counts for it.
        """
        return self._found.hits

    @property
    def dimension(self) -> NDArray[np.int64]:
        """The dimension of the set of answers around each (n,): 0 for an isolated one, 1 for one of a curve.

        It is −1 where it is not known: for the one answer of a solve after a search that found nothing.
        """
        return self._found.dimension

    @property
    def starts(self) -> int:
        """The number of starts tried."""
        return self._found.starts

    @property
    def arrived(self) -> int:
        """How many of the starts led to an answer, inside the limits or not; the others came to nothing."""
        return self._found.arrived

    @property
    def redundancy(self) -> int | None:
        """The largest dimension of the set of answers; None if the search found no answer that tells it.

        If it is 0, all that were found are isolated; if not, there are infinitely many, and `q` has a sample of them,
        with all isolated ones that were found.
        """
        return self._found.redundancy

    @property
    def colliding(self) -> int:
        """The number of answers that were left out because something touches that is to be avoided."""
        return self._found.colliding

    @property
    def ended_early(self) -> bool:
        """Whether the time limit ended the search."""
        return self._found.ended_early

    @property
    def time(self) -> float:
        """The duration of the search [s], with that of the solve after a search that found nothing."""
        return self._found.time

    def __getstate__(self) -> dict[str, Any]:
        """Pickle the results only, without the compiled problem."""
        state = {name: getattr(self, name) for name in self.__dataclass_fields__ if name != "_question"}
        return state | {name: getattr(self, name) for name in _FROM_THE_QUESTION}

    @cached_property
    def robot(self) -> RobotModel:
        """The robot."""
        return self._question.robot

    @cached_property
    def method(self) -> str:
        """The method's short name."""
        return self._question.solver.name

    @cached_property
    def joint_names(self) -> list[str]:
        """The joints that the search moves, in the order of `robot.joint_names`."""
        moving = {coordinate.joint.name for coordinate in self._question.problem.coordinates}
        return [name for name in self.robot.joint_names if name in moving]

    @property
    def farthest_joint(self) -> list[str | None]:
        """The joint that changes most from the start to each branch, by its `distance`; None if no joint can move."""
        return [name for name, _ in self._farthest]

    @property
    def distance_unit(self) -> list[str]:
        """The unit of each `distance`: "m" where the joint that changes most slides, else "rad"."""
        return [unit for _, unit in self._farthest]

    @cached_property
    def _farthest(self) -> list[tuple[str | None, str]]:
        ones = [farthest_coordinate(self._question.problem, self._start, q) for q in self.q]
        return [(None, "rad") if one is None else (one.joint.name, _unit(one)) for one in ones]

    @property
    def targets(self) -> tuple[Target, ...]:
        """The targets."""
        return self._targets

    @property
    def engine(self) -> str:
        """The engine that was used: "python" or "native"."""
        return self._engine

    @property
    def success(self) -> bool:
        """Whether there is an answer."""
        return len(self.q) > 0

    @property
    def message(self) -> str:
        """One sentence on what was found and what may be missing, or why there is no answer."""
        return words_of(self._found, self.is_complete, self.method) if self._words is None else self._words

    @property
    def estimate_missing(self) -> float:
        """An estimate of how many branches are missing; 0 if these are all.

        It is infinite if there are infinitely many, and if nothing can be told: after fewer starts than the search
        makes by itself, because of `restarts` or the time limit; if less than half of the starts arrived at an answer;
        and with "ccd" and "jt", which do not lead to every answer.

        It is Chao's lower bound (1984), f₁ (f₁ − 1) / (2 (f₂ + 1)), where f₁ branches were found by one start and f₂ by
        two. As Good and Turing saw (Good 1953), what was seen once tells how much was not seen. The bound knows nothing
        of branches that no start leads to.
        """
        return estimate_missing(self._found, self.is_complete, self.method)

    @cached_property
    def angles(self) -> list[dict[str, float]]:
        """The angles by joint name [rad or m] of each branch; continuous joints at the turn nearest to the start."""
        return [unwound(self.robot, q, self._start, self._turned) for q in self.q]

    @cached_property
    def windings(self) -> NDArray[np.int64]:
        """By how many whole turns each joint of each branch can turn without leaving the limits (n, n_joints, 2).

        The last axis has the fewest turns, at most 0, and the most, at least 0, in the order of `robot.joint_names`. A
        joint without limits, which can turn for ever, has (0, 0).
        """
        return winding_ranges(self._question.limits, self._question.problem, self.q)

    @cached_property
    def families(self) -> tuple[SelfMotion, ...]:
        """The curves on which the branches of dimension 1 lie. They may collide.

        Each is the self-motion through one of the branches, so that no two are the same. They are traced when they are
        first read, which takes some 20 ms for each.
        """
        found: list[SelfMotion] = []
        for q in self.q[self.dimension == 1]:
            if not any(family.contains(q) for family in found):
                motion = self_motion(self.robot, self._targets, q, **self._conditions)
                found += [motion] * bool(motion.arcs)
        return tuple(found)

    @cached_property
    def _conditions(self) -> dict[str, Any]:
        """The options that a self-motion has too."""
        options = self._question.options
        return {name: getattr(options, name) for name in ("limits", "locked", "tolerance", "seed")}

    def wound(self, index: int) -> Iterator[Array]:
        """Every configuration (nq,) of branch `index` inside the limits, whole turns included; the branch itself first.

        There may be very many: 64 for an arm of six joints with two turns each.
        """
        return wound(self.robot, self.q[index], self.windings[index])

    @cached_property
    def errors(self) -> list[tuple[TargetError, ...]]:
        """The error of each target at each branch, by plain Pinocchio."""
        tolerance = self._question.options.tolerance
        return [measure_errors(self.robot, self._targets, q, tolerance) for q in self.q]

    def __len__(self) -> int:
        return len(self.q)

    def __bool__(self) -> bool:
        return self.success

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def __getitem__(self, index: int) -> Array:
        return np.asarray(self.q[index])

    def __repr__(self) -> str:
        return f"Branches({self})"

    def __str__(self) -> str:
        return self.message

    def _repr_html_(self) -> str:
        """The joints as bars between their limits, with a mark for each branch, as notebooks show them."""
        return joint_bars(self.robot, self.message, self.success, self._rows)

    def to_frame(self) -> DataFrame:
        """A data frame of pandas with one row for each branch: the joints' `angles`, then what is known of it.

        Raises:
            MissingExtraError: pandas is not installed.
        """
        others = {
            "distance": self.distance,
            "position_error_m": self.position_error,
            "orientation_error_rad": self.orientation_error,
            "found_at": self.found_at,
            "hits": self.hits,
            "dimension": self.dimension,
        }
        return data_frame(self.robot.joint_names, self._rows, others)

    @property
    def _rows(self) -> Array:
        """The angles (n, n_joints) in the order of `robot.joint_names`."""
        names = self.robot.joint_names
        return np.array([[angles[name] for name in names] for angles in self.angles]).reshape(len(self), len(names))

    def to_dict(self, families: bool = False) -> dict[str, Any]:
        """A dictionary for JSON, as `pinik solve-all --json` prints it.

        Args:
            families: Whether to trace the families as well, as with `--families`.
        """
        missing = self.estimate_missing
        traced = {"families": [family.to_dict() for family in self.families]} if families else {}
        return {
            "schema": 1,
            "robot": self.robot.name,
            "success": self.success,
            "status": self.status.name,
            "message": self.message,
            "branches": [self._branch(index) for index in range(len(self))],
            **traced,
            "complete": self.is_complete,
            "estimate_missing": None if math.isinf(missing) else missing,
            "redundancy": self.redundancy,
            "colliding": self.colliding,
            "starts": self.starts,
            "arrived": self.arrived,
            "time_s": self.time,
            "method": self.method,
            "engine": self._engine,
        }

    def _branch(self, index: int) -> dict[str, Any]:
        """One branch for JSON."""
        turns = zip(self.robot.joint_names, self.windings[index], strict=True)
        return {
            "angles": self.angles[index],
            "q": self.q[index].tolist(),
            "distance": float(self.distance[index]),
            "farthest_joint": self.farthest_joint[index],
            "distance_unit": self.distance_unit[index],
            "position_error_m": _number(self.position_error[index]),
            "orientation_error_rad": _number(self.orientation_error[index]),
            "found_at": int(self.found_at[index]),
            "hits": int(self.hits[index]),
            "dimension": None if self.dimension[index] < 0 else int(self.dimension[index]),
            "windings": {name: own.tolist() for name, own in turns if own.any()},
        }


def _unit(coordinate: Coordinate) -> str:
    return "m" if coordinate.joint.slides(coordinate.index) else "rad"


def _number(value: float) -> float | None:
    return None if math.isnan(value) else float(value)
