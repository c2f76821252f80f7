"""The live view's simulation: instances of one robot that chase the same balls."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Iterable
from typing import Any

from numpy.typing import ArrayLike

from ...errors import InputError, UnknownNameError
from ...model.home import home_configuration, lowest_point
from ...motion.curves import CURVES
from ...motion.effectors import principal_frames
from ...problem.tolerance import Tolerance
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import Method, known_methods, make_solver
from ...solving.question import check_joint_names
from .balls import MODES, Ball, Mode
from .instance import Instance, StepSettings
from .method_menu import check_balls, fitting, offered
from .motion import MOTIONS, Motion
from .statistics import Summary

__all__ = ["MOST_BALLS", "STEPS_PER_SECOND", "VIEWS", "Methods", "Session"]

STEPS_PER_SECOND = 60
VIEWS = (1, 2, 4)
MOST_BALLS = 12
# The share of a step's time that the solvers may take; the rest is for drawing and for messages from the page.
_SOLVERS_SHARE = 0.7
_ON_THE_GROUND = 0.12  # [m] above the lowest frame
_DEFAULT_METHODS = ("ccd", "jt", "pinv", "dls")


Methods = Method | Iterable[Method]
"""One method or several, as names (also "ccd,dls"), classes or instances."""


class Session:
    """One, two or four instances of a robot, the balls that they chase, and the motion of the balls.

    There are always four instances; `view` is the number of them that step and are visible.

    Attributes:
        robot: The robot.
        methods: Short name → class, for every available method.
        instances: All four instances.
        balls: The balls, each with the frame that chases it.
        motion: The automatic motion of the balls.
        running: Whether `tick` takes a step.
        steps: The number of steps since the last reset.
        notes: What else changed with the last change of robot, in words.
    """

    def __init__(
        self,
        robot: Robot,
        methods: Methods = _DEFAULT_METHODS,
        *,
        view: int | None = None,
        seed: int = 0,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Create the instances and the balls.

        Args:
            robot: The robot.
            methods: One to four methods, as names, classes or instances. Further instances use the remaining methods,
                in the order of `pinik.SOLVERS`, then of `pinik.CLOSED_FORMS`.
            view: The number of visible instances: 1, 2 or 4; enough for `methods` when None.
            seed: The seed of the random positions.
            clock: A function that returns the time in seconds, for the statistics and for the time limit of a step.

        Raises:
            UnknownNameError: There is no such method, or its parameters name a joint that the robot does not have.
            InputError: There are no methods or more than four, one of them cannot chase any ball of this robot, or
                the view is not 1, 2 or 4.
        """
        if isinstance(methods, (str, type, Solver)):
            methods = methods.split(",") if isinstance(methods, str) else [methods]
        solvers = [make_solver(method.strip() if isinstance(method, str) else method) for method in methods]
        if not 1 <= len(solvers) <= VIEWS[-1]:
            raise InputError(f"a live view has one to four methods; got {len(solvers)}")
        if view is None:
            view = next(count for count in VIEWS if count >= len(solvers))
        self.methods: dict[str, type[Solver]] = known_methods()
        for made in solvers:
            known = self.methods.setdefault(made.name, type(made))
            if known is not type(made) or "," in made.name:
                raise InputError(f"a method's name must be unique and must not contain a comma; got {made.name!r}")
        frames = principal_frames(robot)
        for made in solvers:
            check_balls(made, robot, frames)
        others = [name for name in offered(self.methods, robot, frames) if name not in {s.name for s in solvers}]
        solvers += [make_solver(self.methods[name]) for name in others[: VIEWS[-1] - len(solvers)]]
        for solver in solvers:
            check_joint_names(robot, solver)
        self.robot = robot
        self.running = False
        self.steps = 0
        self.notes: list[str] = []
        self._offered: tuple[list[str], list[str]] = ([], [])  # for which frames, what
        self.settings = StepSettings()
        self.motion = Motion(robot, seed)
        self._seed = seed
        self._clock = clock
        self._home = home_configuration(robot)
        self.instances = [Instance(robot, s, self._home, self.settings, clock) for s in solvers]
        self.balls: list[Ball] = []
        for frame in frames:
            self._place_ball(frame, "pinned" if self._is_planted(frame) else "off")
        self.balls[0].mode = "on"
        self.set_view(view)
        self._refresh_statistics()

    def with_robot(self, robot: Robot) -> Session:
        """A session with another robot and the same settings, as far as they apply to that robot."""
        solvers, notes = fitting(
            [instance.solver for instance in self.instances], self.methods, robot, principal_frames(robot)
        )
        other = Session(robot, solvers, view=self.view, seed=self._seed, clock=self._clock)
        other.methods = self.methods
        other.notes = notes
        other.running = self.running
        other.apply_settings(self.settings)
        other.motion.kind, other.motion.curve = self.motion.kind, self.motion.curve
        other.motion.speed = self.motion.speed
        return other

    @property
    def seen(self) -> list[Instance]:
        """The instances that step and are visible."""
        return self.instances[: self.view]

    @property
    def offered(self) -> list[str]:
        """Names of the methods that can chase one of the balls."""
        if self._offered[0] != self._frames:  # kept: every state message needs it, and a check takes milliseconds
            self._offered = self._frames, offered(self.methods, self.robot, self._frames)
        return self._offered[1]

    @property
    def summaries(self) -> list[Summary]:
        """The statistics of the visible instances, refreshed once per second."""
        return self._summaries[: self.view]

    def tick(self) -> bool:
        """Take a step if the session is running; return whether it is."""
        if self.running:
            self.step()
        return self.running

    def step(self) -> None:
        """Advance the balls by 1/60 s, and let every visible instance chase them."""
        self.motion.advance(self.balls, 1.0 / STEPS_PER_SECOND)
        targets = [ball.target for ball in self.balls if ball.mode != "off"]
        share = _SOLVERS_SHARE / STEPS_PER_SECOND / self.view
        for instance in self.seen:
            instance.step(targets, share)
        self.steps += 1
        if not self.running or self._clock() - self._refreshed >= 1.0:
            self._refresh_statistics()

    def reset(self) -> None:
        """Return the robots and balls to where they began, and clear the statistics."""
        for instance in self.instances:
            instance.put(self._home)
        for ball in self.balls:
            ball.go_home()
        self.motion.restart()
        self.steps = 0
        self._refresh_statistics()

    def set_view(self, count: int) -> None:
        """Show 1, 2 or 4 instances."""
        if type(count) is not int or count not in VIEWS:
            raise InputError(f"a view must have 1, 2 or 4 instances; got {count!r}")
        self.view = count

    def set_method(self, index: int, method: str, **parameters: Any) -> None:
        """Change the method of an instance, by short name; parameters that are not given have their defaults.

        Raises:
            UnknownNameError: There is no such method, or it has no such parameter.
            InputError: A value is out of range, the method cannot chase any of the balls, or there is no such instance.
        """
        if method not in self.methods:
            raise UnknownNameError("method", method, self.methods)
        try:
            solver = make_solver(self.methods[method], **parameters)
        except TypeError as error:  # a custom class with a field that has no default
            raise InputError(f"method {method!r} cannot be created from its defaults: {error}") from None
        check_balls(solver, self.robot, self._frames)
        self._set_solver(index, solver)

    def set_parameter(self, index: int, name: str, value: Any) -> None:
        """Set one parameter of an instance's method.

        Raises:
            UnknownNameError: There is no such parameter, or it names a joint that the robot does not have.
            InputError: The value is out of range, or there is no such instance.
        """
        solver = self._instance(index).solver
        self._set_solver(index, make_solver(type(solver), **(solver.parameters | {name: value})))

    def apply_settings(self, settings: StepSettings) -> None:
        """Set the limits, the tolerance and how far a step goes, for all instances."""
        if settings == self.settings:
            return
        self.settings = settings
        for instance in self.instances:
            instance.settings = settings

    def set_limits(self, on: bool) -> None:
        """Joint limits on or off."""
        self.apply_settings(dataclasses.replace(self.settings, limits=on))

    def set_polish(self, on: bool) -> None:
        """Whether methods that converge quadratically go on within the tolerance."""
        self.apply_settings(dataclasses.replace(self.settings, polish=on))

    def set_tolerance(self, position: float, orientation: float) -> None:
        """What counts as reached [m], [rad]."""
        self.apply_settings(dataclasses.replace(self.settings, tolerance=Tolerance.of((position, orientation))))

    def set_motion(self, kind: str) -> None:
        """Set how the balls move: "hand", "curve" or "random"."""
        if kind not in MOTIONS:
            raise UnknownNameError("motion", kind, MOTIONS)
        if kind != self.motion.kind:
            self.motion.kind = kind
            self.motion.restart()

    def set_curve(self, name: str) -> None:
        """Set the curve that the balls follow."""
        if name not in CURVES:
            raise UnknownNameError("curve", name, CURVES)
        self.motion.curve = name

    def move_ball(self, index: int, position: ArrayLike) -> None:
        """Move a ball to a position (3,) [m], and switch the motion to "hand"."""
        self._ball(index).put(position)
        self.set_motion("hand")

    def orient_ball(self, index: int, on: bool, rpy: ArrayLike) -> None:
        """Turn a ball's orientation target on or off; `rpy` is roll, pitch, yaw (3,) [rad]."""
        self._ball(index).orient(on, rpy)

    def set_mode(self, index: int, mode: str) -> None:
        """Switch a ball "on", "pinned" or "off"; one that was off appears at its frame on the first instance."""
        ball = self._ball(index)
        match mode:
            case "on" | "pinned" | "off":
                if ball.mode == "off" and mode != "off":
                    ball.put(self.robot.placement(ball.frame, self.instances[0].q).translation)
                ball.mode = mode
            case _:
                raise UnknownNameError("mode", mode, MODES)

    def add_ball(self, frame: str) -> None:
        """Add a ball to a frame that has none yet.

        Raises:
            UnknownNameError: There is no such frame.
            InputError: The frame has a ball already, or there are too many balls.
        """
        self.robot.frame_id(frame)
        if frame in self._frames:
            raise InputError(f"frame {frame!r} already has a ball")
        if len(self.balls) >= MOST_BALLS:
            raise InputError(f"a session can have at most {MOST_BALLS} balls; remove one first")
        self._place_ball(frame, "off")
        self.set_mode(len(self.balls) - 1, "on")

    def remove_ball(self, index: int) -> None:
        """Remove a ball, but not the last one.

        Raises:
            InputError: There is no such ball, or it is the last one.
        """
        ball = self._ball(index)
        if len(self.balls) == 1:
            raise InputError("the last ball cannot be removed; switch it off instead")
        self.balls.remove(ball)

    @property
    def _frames(self) -> list[str]:
        return [ball.frame for ball in self.balls]

    def _is_planted(self, frame: str) -> bool:
        """Whether the robot stands on this frame: its root is not fixed, and the frame is near the ground."""
        if self.robot.root == "fixed":
            return False
        height = self.robot.placement(frame, self._home).translation[2] - lowest_point(self.robot, self._home)
        return bool(height < _ON_THE_GROUND)

    def _place_ball(self, frame: str, mode: Mode) -> None:
        self.balls.append(Ball(frame, self.robot.placement(frame, self._home), mode))

    def _set_solver(self, index: int, solver: Solver) -> None:
        instance = self._instance(index)
        check_joint_names(self.robot, solver)
        if solver != instance.solver:
            instance.solver = solver
            self._refresh_statistics()

    def _instance(self, index: int) -> Instance:
        if not 0 <= index < len(self.instances):
            raise InputError(f"instances are numbered from 0 to {len(self.instances) - 1}; got {index}")
        return self.instances[index]

    def _ball(self, index: int) -> Ball:
        if not 0 <= index < len(self.balls):
            raise InputError(f"balls are numbered from 0 to {len(self.balls) - 1}; got {index}")
        return self.balls[index]

    def _refresh_statistics(self) -> None:
        self._summaries = [instance.statistics.summary() for instance in self.instances]
        self._refreshed = self._clock()
