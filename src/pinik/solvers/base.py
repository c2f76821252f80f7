"""The base classes of solvers: checked parameters and a rule for the next step."""

from __future__ import annotations

import dataclasses
import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..errors import UnknownNameError
from .parameter import max_step_parameter, parameter, parameters_of, stiffness_parameter

if TYPE_CHECKING:
    from ..closed_form.robot_bones import OffPlane
    from ..model.limits import Limits
    from ..model.robot_model import RobotModel
    from ..problem.kinematics import Kinematics, Linearization
    from ..problem.problem import Problem
    from ..problem.targets import Target
    from ..problem.tolerance import Tolerance

__all__ = ["JacobianSolver", "Patience", "Solver", "SweepingSolver", "field_names", "without_motion"]

Array = NDArray[np.float64]


def without_motion(stiffness: Mapping[str, float]) -> tuple[str, ...]:
    """The joints of stiffness 0, which restarts do not move either."""
    return tuple(name for name, part in stiffness.items() if part == 0.0)


def field_names(solver: type[Solver]) -> list[str]:
    """The names of a method's parameters."""
    return [field.name for field in dataclasses.fields(solver)]


@dataclass(frozen=True)
class Patience:
    """A run has stalled if the residual fell by less than the fraction `progress` within `iterations` iterations."""

    iterations: int
    progress: float


@dataclass(frozen=True, kw_only=True)
class Solver:
    """Parameters of an iterative method.

    Instances are immutable, comparable and hashable; they hold no state of a run. To write a new method, derive it from
    `JacobianSolver` or `SweepingSolver`.
    """

    name: ClassVar[str] = ""
    """The short name used in tables, on the command line and in `pinik.SOLVERS`."""
    title: ClassVar[str] = ""
    """The full name; the short name if a class defines none."""
    about: ClassVar[str] = ""
    """The strengths and weaknesses of the method, in one line."""
    max_iterations: ClassVar[int] = 100
    """The default maximum number of iterations per attempt."""
    restarts: ClassVar[int] = 30
    """The default maximum number of restarts after the first attempt."""
    patience: ClassVar[Patience] = Patience(5, 0.05)
    """The condition under which an attempt counts as stalled."""
    converges_quadratically: ClassVar[bool] = False
    """Whether steps near a reachable target gain so much that runs go on within the tolerance (option `polish`)."""

    max_step: float = max_step_parameter(math.inf)
    max_residual: float = parameter(
        math.inf,
        "longest position residual that a step uses",
        unit="m",
        low=1e-6,
        slider=(0.01, 1.0),
        unbounded=True,
        symbol="D_max",
    )

    def __init_subclass__(cls) -> None:
        """Give a class without a `name` the name of the Python class."""
        super().__init_subclass__()
        if not cls.name and "name" not in vars(cls):
            cls.name = cls.__name__
        if "name" in vars(cls) and "title" not in vars(cls):
            cls.title, cls.about = cls.name, ""

    def __post_init__(self) -> None:
        """Check every parameter against its range.

        Raises:
            InputError: A parameter has the wrong type or is out of range.
        """
        for own in parameters_of(type(self)):
            value = getattr(self, own.name)
            if value is not own.default:
                object.__setattr__(self, own.name, own.check(value, self.name))

    @classmethod
    def make(cls, **parameters: Any) -> Solver:
        """An instance with these parameters.

        Raises:
            UnknownNameError: The method has no such parameter.
            InputError: A value has the wrong type or is out of range.
        """
        names = field_names(cls)
        for name in parameters:
            if name not in names:
                raise UnknownNameError("parameter", name, names, f"the method is {cls.name!r}")
        return cls(**parameters)

    @property
    def parameters(self) -> dict[str, Any]:
        """Name → value."""
        return {name: getattr(self, name) for name in field_names(type(self))}

    def check(self, problem: Problem) -> None:
        """For pinik itself: check that this method can solve a problem. Most methods can solve any.

        Raises:
            InputError: It cannot; the message says why.
        """

    def off_plane(self, robot: RobotModel, targets: Sequence[Target]) -> OffPlane | None:
        """For pinik itself: how far the target lies off the plane of its frame; None if the method knows no plane."""
        return None

    @property
    def exact(self) -> bool:
        """For pinik itself: whether it stops only at the nearest reachable point, to 1e-5 of the chain's length."""
        return False

    @property
    def held(self) -> tuple[str, ...]:
        """For pinik itself: the names of the joints that this method never moves."""
        return ()


@dataclass(frozen=True, kw_only=True)
class JacobianSolver(Solver, ABC):
    r"""A method whose step is a function of the Jacobian and the residual. A subclass must define only `direction`.

    With stiffness weights, $W = \operatorname{diag}(w_i)$ scaled so that the largest is 1, the step is
    $\sqrt W\,\text{direction}(J\sqrt W, e)$. For the transpose this is $\alpha W J^\top e$; the other two methods then
    minimise the sum of the squared joint changes divided by $w_i$.
    """

    name = ""

    stiffness: Mapping[str, float] = stiffness_parameter(
        "weight of a joint's motion, from 0 (fixed) to 1; 1 for joints not named"
    )
    step_size: float = parameter(
        1.0, "factor on the clamped step", low=1e-6, high=2.0, slider=(0.01, 2.0), symbol="α in the thesis", level=3
    )
    target_jacobian: bool = parameter(
        False, "compute the Jacobian at the target instead of the effector (eq. 3.9)", level=3
    )

    @abstractmethod
    def direction(self, J: Array, e: Array) -> Array:
        """The step dq (nv,) for a Jacobian J (m, nv) and a residual e (m,) with J dq ≈ e.

        All rows are in metres; orientation rows are radians times the chain's length, so that the steps do not depend
        on the size of the robot.
        """

    def step(self, at: Linearization, kinematics: Kinematics) -> Array:
        """The step at a configuration: `direction(J, e)`. A method that needs more than J and e overrides this."""
        return self.direction(at.J, at.e)

    @property
    def held(self) -> tuple[str, ...]:
        """For pinik itself: the joints of stiffness 0."""
        return without_motion(self.stiffness)

    def roots(self, problem: Problem) -> Array | None:
        """For pinik itself: √w_i for each tangent coordinate (nv,), the largest free one 1; None without weights."""
        if not self.stiffness:
            return None
        weights = np.ones(problem.model.nv)
        for name, part in self.stiffness.items():
            joint = problem.robot.settable_joint(name)
            weights[joint.idx_v : joint.idx_v + joint.nv] = part
        return np.asarray(np.sqrt(weights / weights.max(where=problem.free, initial=1e-300)))


@dataclass(frozen=True, kw_only=True)
class SweepingSolver(Solver, ABC):
    """A method that changes one joint after another."""

    name = ""

    @abstractmethod
    def sweep(self, q: Array, kinematics: Kinematics, limits: Limits, tolerance: Tolerance) -> tuple[Array, int]:
        """Make one pass over the joints, and stop early once every target is within tolerance.

        Returns:
            The new configuration (nq,), inside the limits, and the number of joints that were updated.
        """
