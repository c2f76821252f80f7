"""A frame that follows a moving target, one call a tick: joint speeds and limits are kept, and so is the branch."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from enum import Enum
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_positive_number
from ..engine import load
from ..errors import InputError
from ..model.robot_model import RobotModel
from ..problem.targets import Target
from ..problem.tolerance import Tolerance, largest_of
from ..shapes.avoid import Avoided
from ..shapes.collisions import Collision
from ..solvers.registry import Method
from .detour import kept_free
from .message import overlap
from .native.codec import goals_of
from .options import OPTION_NAMES, Options
from .origin import Origin, turned_near
from .path import careful
from .prepared import Prepared
from .verdict import all_within, measure_errors
from .walk import Walk
from .words import check_words

__all__ = ["Tracker", "TrackerStatus"]

if TYPE_CHECKING:
    from .. import _native

Array = NDArray[np.float64]

_MISSING = ("trace", "restarts", "seed", "polish", "choose", "choose_weights")
_KEYWORDS = ("q0", "rate", "velocity", *(name for name in OPTION_NAMES if name not in _MISSING))

_TOLERANCE = Tolerance(1e-6, 1e-5)


class TrackerStatus(Enum):
    """How a tick went; `str()` describes it.

    OK: the target is within tolerance. LIMITED: it is not yet, and further ticks will bring the frame nearer; the
    joints are at their speeds, or the iterations of one tick did not suffice, as is usual for `jt` and `ccd`. HELD:
    further ticks will not bring the frame nearer, as a limit, the arm's length or a singular place is in the way; the
    frame stays at the nearest point that it found. BLOCKED: something would touch that is to be avoided, and the joints
    stay before it, or it touches already. If the target moves, the next tick decides anew.
    """

    OK = "the target is reached"
    LIMITED = "on the way: the speeds of the joints or the iterations of one tick do not allow more"
    HELD = "the target is out of reach from here: as near to it as this branch allows"
    BLOCKED = "what must not touch is in the way"

    def __str__(self) -> str:
        return self.value


class Tracker:
    """A frame that follows a moving target, as in teleoperation: `q = tracker(target)` once a tick.

    Each call moves the joints towards the target, by no more than their speeds allow within one tick, inside the
    limits, and never to another branch. If the target is out of reach, the frame stays at the nearest point. If
    something is to be avoided, no tick ends where it touches; where it touches at the start already, it never gets
    deeper, and the target does not count as reached. Each thread needs its own instance.

    Attributes:
        robot: The robot.
        rate: The number of ticks per second [Hz].
        velocity: The largest velocities of the joints (n_joints,) [rad/s or m/s], in the order of `robot.joint_names`.
        targets: The targets that it was made with, whose kinds every target must have.
        status: How the last tick went: OK, LIMITED, HELD or BLOCKED.
        position_error: The largest position error after the last tick [m]; None without a position.
        orientation_error: The largest orientation error, likewise [rad].
        engine: "python" or "native".
    """

    def __init__(
        self,
        robot: RobotModel,
        targets: str | Target | Sequence[Target],
        q0: ArrayLike | Mapping[str, float] | None = None,
        rate: float = 100.0,
        velocity: float | Mapping[str, float] | None = None,
        method: Method = "dls",
        *,
        limits: bool = True,
        locked: Iterable[str] = (),
        max_iterations: int | None = None,
        tolerance: Tolerance | ArrayLike | None = None,
        time_limit: float | None = None,
        engine: str = "auto",
        avoid: Avoided = None,
        **solver_parameters: Any,
    ) -> None:
        """Compile the problem.

        Args:
            robot: The robot.
            targets: The name of a frame, whose position and orientation will be given; or one or several Targets, which
                say what each call gives.
            q0: The start, moved inside the limits: a configuration (nq,), or angles by joint name; neutral when None.
            rate: The number of calls per second [Hz].
            velocity: The largest joint velocity [rad/s or m/s]: one number for all joints, or one for each joint by
                name, where the others keep that of the file; infinite for no limit; `robot.velocity_limits` when None.
            method: As for `pinik.solve`.
            limits, locked, max_iterations, engine: As for `pinik.solve`.
            tolerance: The errors that count as reached (metres, radians); 1e-6 m and 1e-5 rad when None, so that slow
                motions are followed smoothly.
            time_limit: Time limit for one tick [s].
            avoid: What must not touch, as for `pinik.solve`; a World as it is now. Each tick's end is checked. What
                lies between two ticks is not looked at.
            **solver_parameters: Parameters of the solver.

        Raises:
            UnknownNameError, InputError, EngineError: As for `pinik.solve`.
        """
        if not isinstance(robot, RobotModel):
            raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
        check_words(method, solver_parameters, _KEYWORDS)
        options = Options.of(
            method, solver_parameters, limits=limits, locked=locked, max_iterations=max_iterations,
            tolerance=_TOLERANCE if tolerance is None else tolerance, time_limit=time_limit, engine=engine, restarts=0,
            avoid=avoid,
        )  # fmt: skip
        if isinstance(targets, str):
            targets = Target(targets, placement=robot.placement(targets, robot.neutral()))
        self.robot, self.rate = robot, as_positive_number(rate, "rate", "ticks per second")
        self.velocity = _velocities(robot, velocity)
        self._prepared = Prepared(robot, targets, careful(options))
        self.targets = self._prepared.targets
        self.engine = self._prepared.engine
        self._most = np.full(robot.model.nv, math.inf)
        for name, speed in zip(robot.joint_names, self.velocity, strict=True):
            self._most[robot.joint(name).idx_v] = speed / self.rate
        native = self._prepared.native
        self._track: _native.Track | None = None if native is None else load().Track(native)
        self._walk = Walk(self._prepared.question) if native is None else None
        self._continuous = [joint for joint in robot.joints if joint.nq == 2 and joint.has_one_axis]
        self.reset(q0)

    @property
    def q(self) -> Array:
        """The present configuration (nq,), as the last call or `reset` left it; a copy."""
        return self._q.copy()

    @property
    def angles(self) -> dict[str, float]:
        """The present angles by joint name [rad or m]; continuous joints are unwound, from the angles of the start."""
        return self.robot.angles(self._q) | self._turned

    @property
    def collisions(self) -> tuple[Collision, ...]:
        """What is in the way if the status is BLOCKED, the deepest first; empty otherwise.

        It is what touches at `q`, or if nothing touches there, what would touch at the end of the whole tick.
        """
        guard = self._prepared.question.guard
        return () if guard is None or self._touching is None else tuple(guard.collisions(self._touching))

    @property
    def message(self) -> str:
        """How the last tick went, in words; it names what is in the way."""
        collisions = self.collisions
        return f"{self.status}: {overlap(collisions)}" if collisions else str(self.status)

    def reset(self, q: ArrayLike | Mapping[str, float] | None) -> None:
        """Go on from another configuration, such as a measured one; it is moved inside the limits.

        The status is OK afterwards, and there are no errors until the next tick.

        Args:
            q: The configuration (nq,); or angles by joint name, with all other joints neutral; neutral when None.

        Raises:
            UnknownNameError: There is no such joint.
            InputError: `q` is not a configuration of the robot.
        """
        origin = Origin.of(self.robot, q, searches=False)
        self._turned = dict(origin.turned)
        self._keep(self._prepared.question.limits.wrap(origin.q))
        self.status = TrackerStatus.OK
        self._touching: Array | None = None
        self.position_error: float | None = None
        self.orientation_error: float | None = None

    def _keep(self, q: Array) -> None:
        """Set the present configuration, and unwind the continuous joints."""
        self._q = q
        for joint in self._continuous:
            angle = joint.angle(q)
            self._turned[joint.name] = turned_near(angle, self._turned.get(joint.name, angle))

    def __call__(self, target: Target | Sequence[Target] | pinocchio.SE3 | ArrayLike) -> Array:
        """Move towards the target within one tick.

        Args:
            target: An SE3 or a 4×4 matrix, or a position (3,) [m] if the target has no orientation; or Target objects
                of the same kinds as those that it was made with.

        Returns:
            The configuration for this tick (nq,). `status` says how it went, and the errors how far behind it is.

        Raises:
            InputError: The target differs in kind from the one that the tracker was made with.
        """
        if self._track is None:
            self._tick(self._prepared.as_asked(target))
            return self._q.copy()
        place = target.homogeneous if isinstance(target, pinocchio.SE3) else target
        came_to = self._track.tick_at(self._q, self._most, place)
        if came_to is None:  # the engine does not accept the target without conversion
            came_to = self._track.tick(self._q, self._most, goals_of(self._prepared.as_asked(target)))
        q, reached, approaches, touching, position, orientation = came_to
        self._keep(q)
        self._judge(reached, approaches, touching)
        self.position_error = None if math.isnan(position) else position
        self.orientation_error = None if math.isnan(orientation) else orientation
        return self._q.copy()

    def _tick(self, asked: tuple[Target, ...]) -> None:
        """One tick of the Python engine."""
        assert self._walk is not None
        question = self._prepared.question
        stride = kept_free(self._walk, asked, self._walk.tick(asked, self._q, self._most), self._q, self._most)
        self._keep(stride.q.copy())
        errors = measure_errors(self.robot, asked, self._q, self._prepared.options.tolerance)
        reached = all_within(errors, question) and not question.touches(self._q)
        self._judge(reached, stride.approaches, stride.touching)
        self.position_error, self.orientation_error = largest_of(errors)

    def _judge(self, reached: bool, approaches: bool, touching: Array | None) -> None:
        self._touching = None if reached else touching
        if reached:
            self.status = TrackerStatus.OK
        elif touching is not None:
            self.status = TrackerStatus.BLOCKED
        else:
            self.status = TrackerStatus.LIMITED if approaches else TrackerStatus.HELD


def _velocities(robot: RobotModel, velocity: float | Mapping[str, float] | None) -> Array:
    """The largest velocities (n_joints,) [rad/s or m/s]."""
    if velocity is None:
        return np.array(robot.velocity_limits)
    if not isinstance(velocity, Mapping):
        return np.full(len(robot.joint_names), _speed(velocity, "velocity"))
    speeds = np.array(robot.velocity_limits)
    for name, speed in velocity.items():
        joint = robot.settable_joint(name)
        if not joint.has_one_axis:
            raise InputError(f"velocity: joint {name!r} must have one axis; it is {joint.kind}")
        speeds[robot.joint_names.index(name)] = _speed(speed, f"velocity of {name!r}")
    return speeds


def _speed(value: object, what: str) -> float:
    unlimited = isinstance(value, (float, np.floating)) and value == math.inf
    return math.inf if unlimited else as_positive_number(value, what, "rad/s or m/s")
