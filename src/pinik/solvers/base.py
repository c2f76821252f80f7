"""What a solver is: a frozen set of checked parameters and one rule for the next step."""

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
    from ..problem.targets import Target, Tolerance

__all__ = ["JacobianSolver", "Patience", "Solver", "SweepingSolver", "field_names", "without_motion"]

Array = NDArray[np.float64]


def without_motion(stiffness: Mapping[str, float]) -> tuple[str, ...]:
    """The joints of stiffness 0, which restarts leave alone as well."""
    return tuple(name for name, part in stiffness.items() if part == 0.0)


def field_names(solver: type[Solver]) -> list[str]:
    """The names of a method's parameters."""
    return [field.name for field in dataclasses.fields(solver)]


@dataclass(frozen=True)
class Patience:
    """A run has stalled when the residual fell by less than the share `progress` within `iterations`."""

    iterations: int
    progress: float


@dataclass(frozen=True, kw_only=True)
class Solver:
    """Parameters of an iterative method.

    Instances are immutable, comparable and hashable; state lives in the loop. Subclass `JacobianSolver` or
    `SweepingSolver`.
    """

    name: ClassVar[str] = ""
    """The short name used in tables, on the command line and in `pinik.SOLVERS`."""
    title: ClassVar[str] = ""
    """The full name; the short one where a class gives none."""
    about: ClassVar[str] = ""
    """What the method is good for, in one line."""
    max_iterations: ClassVar[int] = 100
    """Iterations of one attempt, unless `solve` is told otherwise."""
    restarts: ClassVar[int] = 30
    """Fresh starts after the first attempt, unless `solve` is told otherwise."""
    patience: ClassVar[Patience] = Patience(5, 0.05)
    """When an attempt counts as stalled."""

    max_step: float = max_step_parameter(math.inf)
    max_residual: float = parameter(
        math.inf,
        "D_max: longest position residual that one step works on",
        unit="m",
        low=1e-6,
        slider=(0.01, 1.0),
        unbounded=True,
    )

    def __init_subclass__(cls) -> None:
        """Name a class that has no name of its own after its Python name."""
        super().__init_subclass__()
        if not cls.name and "name" not in vars(cls):
            cls.name = cls.__name__
        if "name" in vars(cls) and "title" not in vars(cls):
            cls.title, cls.about = cls.name, ""

    def __post_init__(self) -> None:
        """Check every parameter against its range.

        Raises:
            InputError: A parameter has the wrong kind or lies outside its range.
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
            InputError: A value has the wrong kind or lies outside its range.
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
        """Check that this method can solve a problem. Most methods can solve any.

        Raises:
            InputError: It cannot; the message says why.
        """

    def off_plane(self, robot: RobotModel, targets: Sequence[Target]) -> OffPlane | None:
        """How far the target lies off the plane that its frame cannot leave, where the method knows such a plane."""
        return None

    @property
    def exact(self) -> bool:
        """Whether the method comes to rest only at the nearest point that there is, to 1e-5 of the chain's length."""
        return False

    @property
    def held(self) -> tuple[str, ...]:
        """The joints that this method never moves, by name."""
        return ()


@dataclass(frozen=True, kw_only=True)
class JacobianSolver(Solver, ABC):
    r"""A method whose step is a function of the Jacobian and the residual. A subclass needs only `direction`.

    With stiffness weights, $W = \operatorname{diag}(w_i)$ scaled so that the largest is 1, the loop takes
    $\sqrt W\,\text{direction}(J\sqrt W, e)$: the transpose becomes $\alpha W J^\top e$, and the other two minimise
    each joint's squared change divided by $w_i$.
    """

    name = ""

    stiffness: Mapping[str, float] = stiffness_parameter(
        "w_i: how willingly a joint moves compared with the others; 1 for joints not named"
    )
    step_size: float = parameter(
        1.0, "factor on the step, after its clamp (the thesis's α)", low=1e-6, high=2.0, slider=(0.01, 2.0)
    )
    target_jacobian: bool = parameter(False, "take the Jacobian at the target instead of the effector (eq. 3.9)")

    @abstractmethod
    def direction(self, J: Array, e: Array) -> Array:
        """The step dq (nv,) for a Jacobian J (m, nv) and a residual e (m,) with J dq ≈ e.

        All rows are in metres: those of an orientation are radians times the chain's length, so that a robot of
        another size takes the same steps.
        """

    def step(self, at: Linearization, kinematics: Kinematics) -> Array:
        """`direction` at a configuration. A method that needs more than J and e overrides this."""
        return self.direction(at.J, at.e)

    @property
    def held(self) -> tuple[str, ...]:
        """The joints of stiffness 0."""
        return without_motion(self.stiffness)

    def roots(self, problem: Problem) -> Array | None:
        """√w_i of every tangent coordinate (nv,), scaled so that the largest free one is 1; None without weights."""
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
        """One pass over the joints. It ends as soon as every target is within tolerance.

        Returns:
            The new configuration, inside the limits, and the number of joints that were updated.
        """
