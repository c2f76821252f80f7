"""A compiled problem that can be solved many times, and the choice of its engine."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..engine import load
from ..errors import InputError
from ..model.robot_model import RobotModel
from ..problem.targets import Target, as_targets
from ..solvers.base import Solver
from .attempts import Attempts
from .native.codec import goals_of
from .native.compiling import make_engine
from .native.module import engine_for
from .native.recalling import make_call, note
from .options import Options
from .origin import Origin
from .question import Question
from .search import Search
from .solution import Solution

__all__ = ["Prepared"]

if TYPE_CHECKING:
    from .._native import Searcher

Array = NDArray[np.float64]


class Prepared:
    """A problem with its frames, method and options, made by `pinik.prepare`.

    Everything is checked and compiled once; only the target positions and orientations and the start differ from call
    to call. Each thread needs its own instance.

    Attributes:
        robot: The robot.
        targets: The targets that it was prepared with.
        options: The options; `options.method` is the solver with its parameters.
        question: For pinik itself: the compiled problem; any thread may read it.
        engine: "python" or "native".
        native: For pinik itself: the object of the compiled engine, if that engine is used.
    """

    def __init__(self, robot: RobotModel, targets: Target | Sequence[Target], options: Options) -> None:
        """Compile the problem."""
        self.engine = engine_for(options.method, options.engine)
        self.question = Question.of(robot, targets, options)
        self.robot, self.options = robot, options
        self.targets = self.question.problem.targets
        self._neutral = robot.neutral()
        self.native = make_engine(self.question) if self.engine == "native" else None
        self._call = None if self.native is None else make_call(self.native, self._neutral, Solution, self.question)
        self._attempts: Attempts | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle only the inputs; the copy is compiled again, because compiled objects belong to this process."""
        return Prepared, (self.robot, self.targets, self.options)

    @property
    def solver(self) -> Solver:
        """The method with its parameters."""
        return self.options.method

    @property
    def attempts(self) -> Attempts:
        """For pinik itself: the Python engine for this problem."""
        if self._attempts is None:
            self._attempts = Attempts(self.question)
        return self._attempts

    @cached_property
    def search(self) -> Search:
        """For pinik itself: the Python engine's search for all answers to this problem."""
        return Search(self.question)

    @cached_property
    def searcher(self) -> Searcher | None:
        """For pinik itself: the compiled engine's search, if that engine is used and there is a joint to move."""
        searches = self.native is not None and self.question.problem.free.any()
        return load().Searcher(self.native) if searches else None

    def __call__(
        self,
        targets: Target | Sequence[Target] | pinocchio.SE3 | ArrayLike | None = None,
        q0: ArrayLike | Mapping[str, float] | str | None = None,
    ) -> Solution:
        """Solve.

        Args:
            targets: The new target: an SE3 or 4×4 matrix, or a position (3,) [m] if the target has no orientation; or
                Target objects of the same kinds as those that it was prepared with. The original targets when None.
            q0: Start (nq,); angles by joint name, with all other joints neutral; neutral when None; "nearest" for a
                start near the targets, from a table.

        Raises:
            InputError: The targets differ in kind from those it was prepared with, or the start has the wrong shape.
        """
        if self._call is not None:
            quick: Solution | None = self._call.solve(targets, q0)
            if quick is not None:
                return quick
        began = time.perf_counter()
        return self.answer(self.targets if targets is None else self.as_asked(targets), q0, began)

    def answer(
        self,
        asked: tuple[Target, ...],
        q0: ArrayLike | Mapping[str, float] | str | Origin | None = None,
        began: float | None = None,
    ) -> Solution:
        """For pinik itself: solve for targets of exactly the same kinds as those that it was prepared with.

        Args:
            asked: The targets.
            q0: Start, as for a call, or as `Origin.of` reads it.
            began: When the solve and its time limit began, from `time.perf_counter` [s]; now when None.
        """
        began = time.perf_counter() if began is None else began
        start, nearest, turned = Origin.of(self.robot, q0)
        if self.native is not None:
            spent = time.perf_counter() - began
            return Solution(self.native.solve(start, goals_of(asked), nearest, spent), self.question, turned)
        return Solution(self.attempts(asked, start, nearest=nearest, began=began), self.question, turned)

    def at(self, place: object, q0: object = None) -> Solution | None:
        """Solve for one frame with minimal overhead, if the compiled engine accepts the arguments without conversion.

        Args:
            place: A float64 array (4, 4) or an SE3; (3,) [m] if the target has no orientation.
            q0: A float64 array (nq,), None or "nearest".

        Returns:
            The solution; None if the engine does not accept the arguments. A normal call converts and checks them.
        """
        return None if self._call is None else self._call.solve(place, q0)

    def recall(self) -> None:
        """For pinik itself: let the function that is called answer the next equal call at once (`native.recalling`)."""
        if self._call is not None:
            note(self._call)

    def as_asked(self, targets: Target | Sequence[Target] | pinocchio.SE3 | ArrayLike) -> tuple[Target, ...]:
        """For pinik itself: the targets of a call, checked to be of the same kinds as the prepared ones.

        Raises:
            InputError: The targets differ in kind from those it was prepared with.
        """
        if isinstance(targets, (pinocchio.SE3, np.ndarray)) or not _are_targets(targets):
            if len(self.targets) != 1:
                raise InputError(f"targets must be {len(self.targets)} Target objects, as when this was prepared")
            return (self.targets[0].moved_to(targets),)
        asked = as_targets(targets)  # type: ignore[arg-type]
        if [target.shape for target in asked] != self.question.problem.kinds:
            frames = ", ".join(target.frame for target in self.targets)
            raise InputError(
                f"targets must be of the same kinds as when this was prepared (for {frames}); "
                "call prepare again for other kinds"
            )
        return asked


def _are_targets(value: object) -> bool:
    if isinstance(value, memoryview):
        return False  # iterating over some raises an error
    return isinstance(value, Target) or (isinstance(value, Sequence) and any(isinstance(v, Target) for v in value))
