"""A kind of question, prepared to be asked many times; the choice of the engine."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..errors import EngineError, InputError
from ..model.robot_model import RobotModel
from ..problem.targets import Target, as_targets
from ..solvers.base import Solver
from .attempts import Attempts
from .native.codec import goals_of
from .native.compiling import make_engine
from .native.module import why_not
from .options import Options
from .question import Question
from .solution import Solution

__all__ = ["Prepared", "is_nearest"]

Array = NDArray[np.float64]


class Prepared:
    """What is asked of which frames, by which method and with which options; `pinik.prepare` makes it.

    Everything is checked and compiled once; only where the frames should be, and where the solver starts, differ from
    one call to the next. Each thread needs its own.

    Attributes:
        robot: The robot.
        targets: The targets that it was prepared with.
        options: The options; `options.method` is the solver with its parameters.
        question: All of this, compiled; any thread may read it.
        engine: "python" or "native".
        native: The compiled engine's own object, where it is used.
    """

    def __init__(self, robot: RobotModel, targets: Target | Sequence[Target], options: Options) -> None:
        """Compile the question."""
        self.engine = _chosen(options.engine, options.method)
        self.question = Question.of(robot, targets, options)
        self.robot, self.options = robot, options
        self.targets = self.question.problem.targets
        self._neutral = robot.neutral()
        self.native = make_engine(self.question) if self.engine == "native" else None
        self._attempts: Attempts | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        """Compile it anew elsewhere: what was compiled holds memory of this process."""
        return Prepared, (self.robot, self.targets, self.options)

    @property
    def solver(self) -> Solver:
        """The method with its parameters."""
        return self.options.method

    @property
    def attempts(self) -> Attempts:
        """The Python engine for this question."""
        if self._attempts is None:
            self._attempts = Attempts(self.question)
        return self._attempts

    def __call__(
        self,
        targets: Target | Sequence[Target] | pinocchio.SE3 | ArrayLike | None = None,
        q0: ArrayLike | str | None = None,
    ) -> Solution:
        """Solve.

        Args:
            targets: Where the frame should be: an SE3 or 4×4 matrix, or a position (3,) [m] if only that was asked for;
                or Target objects like those it was prepared with. Those themselves when None.
            q0: Start (nq,); neutral when None; "nearest" for a start from a table whose frames are near the targets.

        Raises:
            InputError: The targets ask for something other than it was prepared for, or the start has the wrong shape.
        """
        began = time.perf_counter()
        quick = self.at(targets, q0)
        if quick is not None:
            return quick
        return self.answer(self.targets if targets is None else self._as_asked(targets), q0, began)

    def answer(
        self, asked: tuple[Target, ...], q0: ArrayLike | str | None = None, began: float | None = None
    ) -> Solution:
        """Solve for targets of the very kinds that it was prepared with.

        Args:
            asked: The targets.
            q0: Start, as for a call.
            began: When the time limit began to run; now when None.
        """
        began = time.perf_counter() if began is None else began
        nearest = is_nearest(q0)
        start = self._neutral if q0 is None or nearest else self.robot.check_configuration(q0, "q0")
        if self.native is not None:
            return Solution(self.native.solve(start, goals_of(asked), nearest), self.question)
        return Solution(self.attempts(asked, start, nearest=nearest, began=began), self.question)

    def at(self, place: object, q0: object = None) -> Solution | None:
        """Solve for one frame in the fewest microseconds, if the compiled engine takes the arguments as they are.

        Args:
            place: A float64 array (4, 4) or an SE3; (3,) [m] where only a position was asked for.
            q0: A float64 array (nq,), None or "nearest".

        Returns:
            None where it does not; a call takes more kinds of arguments, and says what is wrong with them.
        """
        if self.native is None:
            return None
        nearest = False
        if q0 is None:
            q0 = self._neutral
        elif type(q0) is str and q0 == "nearest":
            q0, nearest = self._neutral, True
        if isinstance(place, pinocchio.SE3):
            place = place.homogeneous
        answer = self.native.solve_at(place, q0, nearest)
        return None if answer is None else Solution(answer, self.question)

    def _as_asked(self, targets: Target | Sequence[Target] | pinocchio.SE3 | ArrayLike) -> tuple[Target, ...]:
        if isinstance(targets, (pinocchio.SE3, np.ndarray)) or not _are_targets(targets):
            if len(self.targets) != 1:
                raise InputError(f"this was prepared for {len(self.targets)} targets; give that many Target objects")
            return (self.targets[0].moved_to(targets),)
        asked = as_targets(targets)  # type: ignore[arg-type]
        if [target.shape for target in asked] != self.question.problem.kinds:
            frames = ", ".join(target.frame for target in self.targets)
            raise InputError(
                f"this was prepared for other targets (of {frames}): only the places may differ; prepare these anew"
            )
        return asked


def is_nearest(q0: object) -> bool:
    """Whether a start is the word "nearest"."""
    return isinstance(q0, str) and q0 == "nearest"


def _are_targets(value: object) -> bool:
    return isinstance(value, Target) or (isinstance(value, Sequence) and any(isinstance(v, Target) for v in value))


def _chosen(engine: str, solver: Solver) -> str:
    """The engine that will be used; "auto" is the compiled one where it can be used.

    Raises:
        EngineError: The compiled engine was asked for, and cannot be used.
    """
    why = why_not(solver)
    if engine == "native" and why:
        raise EngineError(f"the compiled engine cannot be used: {why}; engine='auto' or 'python' can")
    return "python" if engine == "python" or why else "native"
