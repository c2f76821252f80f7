"""What a solver is: a frozen set of validated parameters and one rule for the next step."""

from __future__ import annotations

import contextlib
import dataclasses
import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, UnknownNameError

if TYPE_CHECKING:
    from ..closed_form.robot_bones import OffPlane
    from ..model.limits import Limits
    from ..model.robot_model import Robot
    from ..problem.kinematics import Kinematics, Linearization
    from ..problem.targets import Target, Tolerance

__all__ = [
    "JacobianSolver",
    "Patience",
    "Solver",
    "SweepingSolver",
    "max_step_parameter",
    "parameter",
    "stiffness_parameter",
    "without_motion",
]

Array = NDArray[np.float64]


def parameter(
    default: Any,
    help: str,
    *,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    slider: tuple[float, float] | None = None,
    choices: tuple[str, ...] = (),
    optional: bool = False,
    unbounded: bool = False,
) -> Any:
    """A dataclass field that knows its range, unit and meaning; help texts and sliders are made from it.

    Args:
        default: Its value when nothing is said; its type is the parameter's.
        help: One line.
        unit: Such as "rad".
        low, high: The range, ends included.
        slider: The part of the range worth trying, which a slider offers; the whole range when None.
        choices: The words allowed, for a choice.
        optional: Whether None is allowed and means something of its own.
        unbounded: Whether infinity is allowed; None stands for it, as JSON has none.
    """
    metadata = {
        "help": help,
        "unit": unit,
        "low": low,
        "high": high,
        "slider": slider,
        "choices": choices,
        "optional": optional,
        "unbounded": unbounded,
    }
    if isinstance(default, dict):
        return dataclasses.field(default_factory=dict, metadata=metadata)
    return dataclasses.field(default=default, metadata=metadata)


def max_step_parameter(default: float) -> Any:
    """The clamp on a step, which methods set differently."""
    help_ = "largest change of one joint in one step"
    return parameter(default, help_, unit="rad or m", low=1e-6, slider=(0.01, 3.2), unbounded=True)


def stiffness_parameter(help: str) -> Any:
    """How willingly each joint moves, as a part of 1."""
    return parameter({}, help, low=0.0, high=1.0)


def without_motion(stiffness: Mapping[str, float]) -> tuple[str, ...]:
    """Joints of stiffness 0, which no restart may move either."""
    return tuple(name for name, part in stiffness.items() if part == 0.0)


@dataclass(frozen=True)
class Patience:
    """When a run has stalled: fewer than `progress` of the residual gone within `iterations`."""

    iterations: int
    progress: float


@dataclass(frozen=True, kw_only=True)
class Solver:
    """Parameters of an iterative method. State lives in the loop; instances are immutable and comparable.

    Subclass `JacobianSolver` or `SweepingSolver`.
    """

    name: ClassVar[str] = ""
    """Its short name in tables, on the command line and in `pinik.SOLVERS`."""
    title: ClassVar[str] = ""
    """Its name in full; the short one where it has none."""
    about: ClassVar[str] = ""
    """What it is good for, in one line."""
    max_iterations: ClassVar[int] = 100
    """Iterations of one attempt, unless `solve` is told otherwise."""
    restarts: ClassVar[int] = 30
    """Fresh starts after the first attempt, unless `solve` is told otherwise."""
    patience: ClassVar[Patience] = Patience(5, 0.05)
    """When an attempt counts as stalled."""

    max_step: float = max_step_parameter(math.inf)
    max_residual: float = parameter(
        math.inf,
        "D_max: the part of a position residual used",
        unit="m",
        low=1e-6,
        slider=(0.01, 1.0),
        unbounded=True,
    )

    def __init_subclass__(cls) -> None:
        """Give a class without a name of its own its Python name."""
        super().__init_subclass__()
        if not cls.name and "name" not in vars(cls):
            cls.name = cls.__name__
        if "name" in vars(cls) and "title" not in vars(cls):
            cls.title, cls.about = cls.name, ""

    def __post_init__(self) -> None:
        """Check every parameter against its field's range.

        Raises:
            InputError: A parameter of the wrong kind or outside its range.
        """
        for field in dataclasses.fields(self):
            object.__setattr__(self, field.name, _checked(self.name, field, getattr(self, field.name)))

    @classmethod
    def make(cls, **parameters: Any) -> Solver:
        """An instance with these parameters.

        Raises:
            UnknownNameError: A parameter that this method does not have.
            InputError: A value of the wrong kind or outside its range.
        """
        names = [field.name for field in dataclasses.fields(cls)]
        for name in parameters:
            if name not in names:
                raise UnknownNameError("parameter", name, names, f"the method is {cls.name!r}")
        return cls(**parameters)

    @property
    def parameters(self) -> dict[str, Any]:
        """Name → value."""
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    def check(self, kinematics: Kinematics) -> None:
        """See that this method can do what is asked; most can do anything.

        Raises:
            InputError: It cannot; the message says why.
        """

    def off_plane(self, robot: Robot, targets: Sequence[Target]) -> OffPlane | None:
        """What the target lies beside a plane that its frame cannot leave, where the method knows of one."""
        return None

    @property
    def exact(self) -> bool:
        """Whether it comes to rest only as near to the targets as can be, to 1e-5 of the chain's length."""
        return False

    @property
    def held(self) -> tuple[str, ...]:
        """Names of joints that this method never moves."""
        return ()


@dataclass(frozen=True, kw_only=True)
class JacobianSolver(Solver, ABC):
    r"""A method whose step is a function of Jacobian and residual; subclasses write `direction` and are complete.

    With stiffness weights, $W = \operatorname{diag}(w_i)$ and the largest made 1, the loop takes $\sqrt
    W\,\text{direction}(J\sqrt W, e)$: the transpose becomes $\alpha W J^\top e$, and in the other two a joint's change
    counts by its square over $w_i$.
    """

    name = ""

    stiffness: Mapping[str, float] = stiffness_parameter(
        "w_i: how willingly a joint moves beside the others; 1 where none is named"
    )
    step_size: float = parameter(
        1.0, "factor on the step, after its clamp (the thesis's α)", low=1e-6, high=2.0, slider=(0.01, 2.0)
    )
    target_jacobian: bool = parameter(False, "take the Jacobian at the target instead of the effector (eq. 3.9)")

    @abstractmethod
    def direction(self, J: Array, e: Array) -> Array:
        """The step dq (nv,) for a Jacobian J (m, nv) and a residual e (m,): J dq ≈ e [m, rad]."""

    def step(self, at: Linearization, kinematics: Kinematics) -> Array:
        """`direction` at a configuration; a method that looks at more than J and e overrides this."""
        return self.direction(at.J, at.e)

    @property
    def held(self) -> tuple[str, ...]:
        """Joints of stiffness 0."""
        return without_motion(self.stiffness)

    def roots(self, kinematics: Kinematics) -> Array | None:
        """√w_i of every tangent coordinate (nv,), the most willing that moves a target made 1; None without weights."""
        if not self.stiffness:
            return None
        weights = np.ones(kinematics.model.nv)
        for name, part in self.stiffness.items():
            joint = kinematics.robot.settable_joint(name)
            weights[joint.idx_v : joint.idx_v + joint.nv] = part
        return np.asarray(np.sqrt(weights / weights.max(where=kinematics.free, initial=1e-300)))


@dataclass(frozen=True, kw_only=True)
class SweepingSolver(Solver, ABC):
    """A method that changes joint after joint."""

    name = ""

    @abstractmethod
    def sweep(self, q: Array, kinematics: Kinematics, limits: Limits, tolerance: Tolerance) -> tuple[Array, int]:
        """One pass over the joints, which ends as soon as every target is within tolerance.

        Returns:
            The new configuration, inside the limits, and the number of joints that were updated.
        """


def _checked(method: str, field: dataclasses.Field[Any], value: Any) -> Any:
    about = field.metadata
    if not about:  # a field of a user's own, made without `parameter`: nothing is known about it
        return value
    what = f"{method}: {field.name}"
    default = field.default if field.default is not dataclasses.MISSING else {}
    if value is None and about["optional"]:
        return None
    if value is None and about["unbounded"]:
        return math.inf
    if about["choices"]:
        if not isinstance(value, str) or value not in about["choices"]:
            raise InputError(f"{what} is one of {', '.join(map(repr, about['choices']))}; got {value!r}")
        return value
    if isinstance(default, bool):
        if not isinstance(value, (bool, np.bool_)):
            raise InputError(f"{what} is true or false; got {value!r}")
        return bool(value)
    if isinstance(default, dict):
        if not isinstance(value, Mapping):
            raise InputError(f"{what} maps joint names to numbers; got {value!r}")
        return {str(name): _number(f"{what}[{name!r}]", number, about) for name, number in value.items()}
    number = _number(what, value, about)
    return int(number) if isinstance(default, int) and number.is_integer() else number


def _number(what: str, value: Any, about: Mapping[str, Any]) -> float:
    low = -math.inf if about["low"] is None else about["low"]
    high = math.inf if about["high"] is None else about["high"]
    number = math.nan
    if isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
        with contextlib.suppress(OverflowError):
            number = float(value)
    if not low <= number <= high or not (about["unbounded"] or math.isfinite(number)):
        bounds = "a number" if about["unbounded"] else "a finite number"
        if math.isfinite(high):
            bounds += f" from {low:g} to {high:g}"
        elif math.isfinite(low):
            bounds += f" of at least {low:g}"
        unit = f" [{about['unit']}]" if about["unit"] else ""
        raise InputError(f"{what} is {bounds}{unit}{' or None' if about['optional'] else ''}; got {value!r}")
    return number
