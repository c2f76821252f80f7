"""The live view's simulation: instances of one robot that chase the same balls; no socket, no drawing."""

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
from ...problem.targets import Tolerance
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
# The part of a step's time that the solvers may take; the rest is for drawing and for the people's messages.
_SOLVERS_SHARE = 0.7
_ON_THE_GROUND = 0.12  # [m] above the lowest frame
_DEFAULT_METHODS = ("ccd", "jt", "pinv", "dls")


Methods = Method | Iterable[Method]
"""One method or several, by name (also "ccd,dls"), class or instance."""


class Session:
    """One, two or four instances of a robot, the balls they chase, and how the balls move.

    There are always four instances; `view` says how many of them step and are seen.

    Attributes:
        robot: The robot.
        methods: Short name → class, of every method that there is.
        instances: All four.
        balls: The balls, each with the frame that chases it.
        motion: How balls move by themselves.
        running: Whether `tick` steps.
        steps: How many were made since the last reset.
        notes: What another robot has changed besides, in words.
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
        """Set the scene.

        Args:
            robot: The robot.
            methods: One to four methods, by name, class or instance; a view of more instances than that takes the
                others in the order of `pinik.SOLVERS`, then of `pinik.CLOSED_FORMS`.
            view: How many instances are seen: 1, 2 or 4; enough for `methods` when None.
            seed: Of the random places.
            clock: Seconds that pass, for the statistics and for steps that would take too long.

        Raises:
            UnknownNameError: No such method, or a joint in its parameters that the robot does not have.
            InputError: More than four methods, none, one that cannot chase any ball of this robot, or another view.
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
                raise InputError(f"methods have names of their own, without a comma; {made.name!r} is none")
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
        """A session with another robot and the same settings, as far as they fit that robot."""
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
        """The instances that step and are seen."""
        return self.instances[: self.view]

    @property
    def offered(self) -> list[str]:
        """Names of the methods that can chase one of the balls."""
        if self._offered[0] != self._frames:  # compiling a question takes milliseconds, and a state tells this
            self._offered = self._frames, offered(self.methods, self.robot, self._frames)
        return self._offered[1]

    @property
    def summaries(self) -> list[Summary]:
        """The statistics of those, as they stood at the last full second."""
        return self._summaries[: self.view]

    def tick(self) -> bool:
        """One step while it runs; whether there was one."""
        if self.running:
            self.step()
        return self.running

    def step(self) -> None:
        """Move the balls on by a 60th of a second, and let every instance that is seen chase them."""
        self.motion.advance(self.balls, 1.0 / STEPS_PER_SECOND)
        targets = [ball.target for ball in self.balls if ball.mode != "off"]
        share = _SOLVERS_SHARE / STEPS_PER_SECOND / self.view
        for instance in self.seen:
            instance.step(targets, share)
        self.steps += 1
        if not self.running or self._clock() - self._refreshed >= 1.0:
            self._refresh_statistics()

    def reset(self) -> None:
        """Robots and balls back where they began, the statistics emptied."""
        for instance in self.instances:
            instance.put(self._home)
        for ball in self.balls:
            ball.go_home()
        self.motion.restart()
        self.steps = 0
        self._refresh_statistics()

    def set_view(self, count: int) -> None:
        """Let 1, 2 or 4 instances be seen."""
        if type(count) is not int or count not in VIEWS:
            raise InputError(f"a view has 1, 2 or 4 instances; got {count!r}")
        self.view = count

    def set_method(self, index: int, method: str, **parameters: Any) -> None:
        """Another method in an instance, by its short name; its parameters are the defaults but for those given.

        Raises:
            UnknownNameError: No such method, or parameter of it.
            InputError: A value out of its range, a method that cannot chase any of the balls, or no such instance.
        """
        if method not in self.methods:
            raise UnknownNameError("method", method, self.methods)
        try:
            solver = make_solver(self.methods[method], **parameters)
        except TypeError as error:  # a class of the user's own, with a field that has no default
            raise InputError(f"method {method!r} cannot be made anew: {error}") from None
        check_balls(solver, self.robot, self._frames)
        self._set_solver(index, solver)

    def set_parameter(self, index: int, name: str, value: Any) -> None:
        """One parameter of an instance's method.

        Raises:
            UnknownNameError: No such parameter, or a joint in it that the robot does not have.
            InputError: A value out of its range, or no such instance.
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

    def set_tolerance(self, position: float, orientation: float) -> None:
        """What counts as reached [m], [rad]."""
        self.apply_settings(dataclasses.replace(self.settings, tolerance=Tolerance.of((position, orientation))))

    def set_motion(self, kind: str) -> None:
        """How balls move: "hand", "curve" or "random"."""
        if kind not in MOTIONS:
            raise UnknownNameError("motion", kind, MOTIONS)
        if kind != self.motion.kind:
            self.motion.kind = kind
            self.motion.restart()

    def set_curve(self, name: str) -> None:
        """Which curve they follow."""
        if name not in CURVES:
            raise UnknownNameError("curve", name, CURVES)
        self.motion.curve = name

    def move_ball(self, index: int, position: ArrayLike) -> None:
        """Put a ball somewhere (3,) [m]; from then on balls move by hand."""
        self._ball(index).put(position)
        self.set_motion("hand")

    def orient_ball(self, index: int, on: bool, rpy: ArrayLike) -> None:
        """Ask for an orientation at a ball (roll, pitch, yaw (3,) [rad]), or for none."""
        self._ball(index).orient(on, rpy)

    def set_mode(self, index: int, mode: str) -> None:
        """Switch a ball "on", "pinned" or "off"; one that was off appears where the first robot's frame is."""
        ball = self._ball(index)
        match mode:
            case "on" | "pinned" | "off":
                if ball.mode == "off" and mode != "off":
                    ball.put(self.robot.placement(ball.frame, self.instances[0].q).translation)
                ball.mode = mode
            case _:
                raise UnknownNameError("mode", mode, MODES)

    def add_ball(self, frame: str) -> None:
        """One more ball, on a frame that has none yet.

        Raises:
            UnknownNameError: No such frame.
            InputError: It has a ball already, or there are too many.
        """
        self.robot.frame_id(frame)
        if frame in self._frames:
            raise InputError(f"frame {frame!r} has a ball already")
        if len(self.balls) >= MOST_BALLS:
            raise InputError(f"there are {MOST_BALLS} balls at most; remove one first")
        self._place_ball(frame, "off")
        self.set_mode(len(self.balls) - 1, "on")

    def remove_ball(self, index: int) -> None:
        """One ball less; the last one stays.

        Raises:
            InputError: No such ball, or it is the last.
        """
        ball = self._ball(index)
        if len(self.balls) == 1:
            raise InputError("the last ball stays; switch it off instead")
        self.balls.remove(ball)

    @property
    def _frames(self) -> list[str]:
        return [ball.frame for ball in self.balls]

    def _is_planted(self, frame: str) -> bool:
        """Whether the robot stands on this frame: it does not hang in the world, and the frame is on the ground."""
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
