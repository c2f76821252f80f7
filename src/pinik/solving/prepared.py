"""A kind of question, made ready to be asked many times."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_count, as_names, as_positive_number
from ..errors import EngineError, InputError, UnknownNameError
from ..model.limits import Limits
from ..model.robot_model import Robot
from ..problem.targets import Target, Tolerance, as_targets
from ..solvers.base import Solver
from ..solvers.registry import make_solver
from . import native
from .attempts import Settings, attempt_all
from .run import compiled_for
from .solution import Solution
from .starts import Starts

__all__ = ["ENGINES", "Prepared", "check_joint_names", "prepare"]

Array = NDArray[np.float64]

ENGINES = ("auto", "python", "native")
# Iterations in which the best of the failed attempts is followed to its end, unless the caller allows fewer.
_TO_THE_END_AT_MOST = 5000


def prepare(
    robot: Robot,
    targets: Target | Sequence[Target],
    method: str | type[Solver] | Solver = "dls",
    *,
    limits: bool = True,
    locked: Iterable[str] = (),
    restarts: int | None = None,
    seed: int = 0,
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
    time_limit: float | None = None,
    engine: str = "auto",
    trace: bool = False,
    **solver_parameters: Any,
) -> Prepared:
    """Check and compile a kind of question once, to ask it many times with other places and starts.

    Args:
        robot: The robot.
        targets: What is asked of which frames; where they should be may differ from call to call.
        method: As for `pinik.solve`, and so is everything below.

    Raises:
        UnknownNameError, InputError, EngineError: As `pinik.solve`.
    """
    if not isinstance(robot, Robot):
        raise InputError(f"robot is what pinik.load returns; got {robot!r}")
    solver = make_solver(method, **solver_parameters)
    check_joint_names(robot, solver)
    for name, value in (("limits", limits), ("trace", trace)):
        if not isinstance(value, (bool, np.bool_)):
            raise InputError(f"{name} is True or False; got {value!r}")
    return Prepared(
        robot,
        targets,
        solver,
        limits=bool(limits),
        locked=as_names(locked, "locked"),
        restarts=solver.restarts if restarts is None else as_count(restarts, "restarts", least=0),
        seed=as_count(seed, "seed", least=0),
        max_iterations=None if max_iterations is None else as_count(max_iterations, "max_iterations"),
        tolerance=Tolerance.of(tolerance),
        time_limit=math.inf if time_limit is None else as_positive_number(time_limit, "time_limit", "seconds"),
        engine=engine,
        trace=bool(trace),
    )


def check_joint_names(robot: Robot, solver: Solver) -> None:
    """See that the joints which a solver's parameters name are there, can be set, and have an angle."""
    for parameter, value in solver.parameters.items():
        if isinstance(value, Mapping):
            for name in value:
                joint = robot.settable_joint(name)
                if parameter == "rest_posture" and not joint.has_one_axis:
                    raise InputError(f"rest_posture: joint {name!r} is {joint.kind} and has no angle")


class Prepared:
    """What is asked of which frames, by which method and with which settings; `pinik.prepare` makes it.

    Only where the frames should be, and where the solver starts, differ from one call to the next; all else was
    checked and compiled once. For one thread.

    Attributes:
        robot: The robot.
        targets: What it was prepared with.
        solver: The method with its parameters.
        engine: "python" or "native".
        settings: The same and the rest, as the attempts take it.
        native: The compiled engine's own object, where it is used.
    """

    def __init__(
        self,
        robot: Robot,
        targets: Target | Sequence[Target],
        solver: Solver,
        *,
        limits: bool,
        locked: Iterable[str],
        restarts: int,
        seed: int,
        max_iterations: int | None,
        tolerance: Tolerance,
        time_limit: float,
        engine: str,
        trace: bool,
    ) -> None:
        """Compile; every argument but `locked` and `targets` is checked already."""
        self._options = {
            "limits": limits, "locked": locked, "restarts": restarts, "seed": seed, "max_iterations": max_iterations,
            "tolerance": tolerance, "time_limit": time_limit, "engine": engine, "trace": trace,
        }  # fmt: skip
        self.engine = _chosen(engine, solver)
        self.robot = robot
        self.solver = solver
        self._kinematics = compiled_for(solver, robot, targets, locked)
        self.targets = self._kinematics.targets
        self._shape = [target.shape for target in self.targets]
        box = Limits.of(robot, limits)
        self.settings = Settings(
            solver,
            self._kinematics,
            box,
            Starts(self._kinematics, box, seed),
            start=robot.neutral(),
            restarts=restarts,
            seed=seed,
            max_iterations=solver.max_iterations if max_iterations is None else max_iterations,
            iterations_to_the_end=_TO_THE_END_AT_MOST if max_iterations is None else max_iterations,
            tolerance=tolerance,
            time_limit=time_limit,
            trace=trace,
        )
        self.native = native.make_engine(self.settings) if self.engine == "native" else None

    def __reduce__(self) -> tuple[Any, ...]:
        """Compile it anew elsewhere: what was compiled holds memory of this process."""
        return _again, (self.robot, self.targets, self.solver, self._options)

    def __call__(
        self,
        targets: Target | Sequence[Target] | pinocchio.SE3 | ArrayLike | None = None,
        q0: ArrayLike | str | None = None,
    ) -> Solution:
        """Solve.

        Args:
            targets: Where the frame should be: an SE3 or 4×4 matrix, or a position (3,) [m], as far as that was asked
                for; or Target objects like those it was prepared with. Those themselves when None.
            q0: Start (nq,); neutral when None; "nearest" for one whose frames are near the targets, from a table.

        Raises:
            InputError: Targets that ask for something else than it was prepared for; a start of the wrong shape.
        """
        began = time.perf_counter()
        quick = self.at(targets, q0)
        if quick is not None:
            return quick
        asked = self.targets if targets is None else self._as_asked(targets)
        nearest = isinstance(q0, str) and q0 == "nearest"
        start = self.settings.start if q0 is None or nearest else self.robot.check_configuration(q0, "q0")
        if self.native is not None:
            return Solution(self.native.solve(start, native.goals_of(asked), nearest), self.settings)
        self._kinematics.retarget(asked)
        return Solution(attempt_all(self.settings._replace(start=start, nearest=nearest), began), self.settings)

    def at(self, place: object, q0: object = None) -> Solution | None:
        """The same for one frame, in the fewest microseconds, where the compiled engine finds nothing to object to.

        Args:
            place: A float64 array (4, 4) or an SE3; where only a position was asked for, (3,) does [m].
            q0: A float64 array (nq,), None or "nearest".

        Returns:
            None where it is not so: a call finds out why, and takes more kinds of things.
        """
        if self.native is None:
            return None
        nearest = False
        if q0 is None:
            q0 = self.settings.start
        elif type(q0) is str and q0 == "nearest":
            q0, nearest = self.settings.start, True
        if isinstance(place, pinocchio.SE3):
            place = place.homogeneous
        answer = self.native.solve_at(place, q0, nearest)
        return None if answer is None else Solution(answer, self.settings)

    def _as_asked(self, targets: Target | Sequence[Target] | pinocchio.SE3 | ArrayLike) -> tuple[Target, ...]:
        if isinstance(targets, (pinocchio.SE3, np.ndarray)) or not _are_targets(targets):
            if len(self.targets) != 1:
                raise InputError(f"it was prepared for {len(self.targets)} targets; give that many Target objects")
            return (self.targets[0].moved_to(targets),)
        asked = as_targets(targets)  # type: ignore[arg-type]
        if [target.shape for target in asked] != self._shape:
            frames = ", ".join(target.frame for target in self.targets)
            raise InputError(
                f"it was prepared for other targets (of {frames}); only where they are may differ, else prepare anew"
            )
        return asked


def _again(robot: Robot, targets: tuple[Target, ...], solver: Solver, options: dict[str, Any]) -> Prepared:
    return Prepared(robot, targets, solver, **options)


def _are_targets(value: object) -> bool:
    return isinstance(value, Target) or (isinstance(value, Sequence) and any(isinstance(v, Target) for v in value))


def _chosen(engine: str, solver: Solver) -> str:
    """The engine that will be used: "auto" takes the compiled one where it can.

    Raises:
        UnknownNameError: No such engine.
        EngineError: The compiled one was asked for, and cannot be used.
    """
    if engine not in ENGINES:
        raise UnknownNameError("engine", engine, ENGINES)
    why_not = native.why_not(solver)
    if engine == "native" and why_not:
        raise EngineError(f"the compiled engine cannot be used: {why_not}; engine='auto' or 'python' can")
    return "python" if engine == "python" or why_not else "native"
