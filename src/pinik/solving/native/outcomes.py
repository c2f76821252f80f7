"""The outcomes of the compiled engine as Python objects."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...engine import load
from ...problem.reach import Shortfall
from ...problem.targets import Target
from ...problem.tolerance import TargetError
from ..attempts import Outcomes
from ..starts import NEAREST
from ..state import State, Status
from .codec import targets_of

__all__ = ["NativeOutcome", "attempt_many", "follow", "state_of"]

if TYPE_CHECKING:
    from ... import _native
    from ..._native import Engine

Array = NDArray[np.float64]


@functools.cache
def _statuses() -> dict[_native.Status, Status | None]:
    """Map the engine's own enumeration to `Status` by name, and RUNNING to None."""
    return {own: None if own.name == "RUNNING" else Status[own.name] for own in load().Status}


@functools.cache
def _numbered() -> NDArray[np.object_]:
    """The same in an array, by the numbers that the engine gives its statuses."""
    statuses = _statuses()
    numbered = np.empty(len(statuses), dtype=object)
    for own, status in statuses.items():
        numbered[own.value] = status
    return numbered


def attempt_many(engine: Engine, goals: Array, starts: Array, nearest: bool, threads: int, numbered: bool) -> Outcomes:
    """Solve for goals (N, n, 18) from starts (N or 1, nq).

    If they are numbered, the number of a question seeds its restarts; otherwise each is answered as if it were alone.
    """
    columns: tuple[Any, ...] = engine.solve_many(starts, goals, nearest, threads)
    if not numbered:
        restarts = columns[6]
        for k in np.flatnonzero(restarts >= NEAREST):  # the number seeds only restarts that the table does not give
            own = starts if len(starts) == 1 else starts[k : k + 1]
            alone: tuple[Any, ...] = engine.solve_many(own, goals[k : k + 1], nearest, 1)
            for column, answer in zip(columns, alone, strict=True):
                column[k] = answer[0]
    return _outcomes(*columns)


def follow(engine: Engine, goals: Array, start: Array, on_miss: str) -> Outcomes:
    """Follow a path of goals (N, n, 18) from a start (nq,); fewer than N outcomes if the path stops at a miss."""
    module = load()
    return _outcomes(*module.Track(engine).follow(start, goals, module.OnMiss[on_miss]))


def _outcomes(q: Array, status: NDArray[np.int32], *columns: Any) -> Outcomes:
    """The engine's columns, in the order of the fields of `Outcomes`."""
    return Outcomes(q, _numbered()[status], *columns)


class NativeOutcome:
    """An `attempts.Outcome` of the compiled engine: each attribute is converted to Python when it is read.

    Attributes:
        pattern: The targets of the prepared problem, whose numbers this solve replaced.
    """

    __slots__ = ("_answer", "pattern")

    engine = "native"

    def __init__(self, answer: _native.Answer, pattern: tuple[Target, ...]) -> None:
        self._answer = answer
        self.pattern = pattern

    @property
    def targets(self) -> tuple[Target, ...]:
        """The targets."""
        return targets_of(self.pattern, self._answer.goals)

    @property
    def time(self) -> float:
        """The duration of the solve [s]."""
        return self._answer.seconds

    @property
    def status(self) -> Status:
        """Why the solve ended."""
        status = _statuses()[self._answer.status]
        assert status is not None  # a solve that has returned has ended
        return status

    @property
    def q(self) -> Array:
        """A new copy of the best configuration (nq,)."""
        return self._answer.q

    @property
    def start(self) -> Array:
        """The start (nq,), moved inside the limits; empty if no joint of the robot is (cos, sin) in q."""
        return self._answer.start

    @property
    def errors(self) -> tuple[TargetError, ...]:
        """The error of each target at `q`."""
        return _errors(self._answer.errors)

    @property
    def iterations(self) -> int:
        """Iterations of all attempts."""
        return self._answer.iterations

    @property
    def joint_updates(self) -> int:
        """Joint updates of all attempts."""
        return self._answer.joint_updates

    @property
    def restarts(self) -> int:
        """The number of attempts after the first."""
        return self._answer.restarts

    @property
    def chosen_from(self) -> int:
        """The number of distinct answers that `q` was chosen from."""
        return self._answer.chosen_from

    @property
    def proof(self) -> Shortfall | None:
        """The proof that a target is out of reach, if there is one."""
        proof = self._answer.proof
        return None if proof is None else Shortfall(*proof)

    @property
    def states(self) -> tuple[State, ...]:
        """Every state, if a trace was requested."""
        return tuple([state_of(*state) for state in self._answer.states])


def _errors(pairs: Any) -> tuple[TargetError, ...]:
    return tuple([TargetError(*error) for error in pairs])


def state_of(q: Array, iteration: int, updates: int, errors: Any, residual: float, attempt: int, status: Any) -> State:
    """A state from the engine's own tuple."""
    q.setflags(write=False)
    return State(q, iteration, updates, _errors(errors), residual, attempt, _statuses()[status])
