"""The live view's simulation: instances of one robot that chase the same balls."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from typing import Any

from numpy.typing import ArrayLike

from ...errors import InputError, UnknownNameError
from ...model.home import home_configuration
from ...motion.effectors import principal_frames
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import make_solver
from ...solving.question import check_joint_names
from .ball import MODES
from .balls import Balls
from .contacts import Contacts
from .instance import Instance
from .leading import Leading
from .looks import Looks
from .method_menu import Methods, check_balls, chosen, filled_up, offered
from .misses import Misses
from .motion import MOTIONS, Motion
from .obstacles import Obstacles
from .scoreboard import Scoreboard, terms
from .statistics import Summary
from .step_settings import StepSettings
from .stillness import Stillness

__all__ = ["STEPS_PER_SECOND", "VIEWS", "Session"]

STEPS_PER_SECOND = 60
VIEWS = (1, 2, 4)
# The share of a step's time that the solvers may take; the rest is for drawing and for messages from the page.
_SOLVERS_SHARE = 0.7
_SECONDS_OF_ONE_STEP = 0.25  # of all solvers together, if somebody asks for a single step, which nothing hurries
_DEFAULT_METHODS = ("ccd", "jt", "pinv", "dls")


class Session:
    """One, two or four instances of a robot, the balls that they chase, and the motion of the balls.

    There are always four instances; `view` is the number of them that step and are visible.

    Attributes:
        robot: The robot.
        methods: Short name → class, for every available method.
        instances: All four instances.
        balls: The balls, each with the frame that chases it.
        motion: The automatic motion of the balls.
        contacts: What the instances touch, and whether they avoid it.
        obstacles: What stands around them.
        leading: The instances whose joints lead instead of the balls.
        stillness: How long nothing has moved.
        misses: Whether the session pauses on a miss, and the last one.
        looks: What the picture shows besides robots and balls.
        home: The pose in which the robots begin (nq,).
        running: Whether `tick` takes a step.
        steps: The number of steps since the last reset.
        scores: The statistics of the visible instances.
        notes: What else changed with the last change of robot, in words.
        seed: The seed of the random positions.
        clock: A function that returns the time in seconds.
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
        frames = principal_frames(robot)
        solvers, self.methods = chosen(methods, robot, frames, VIEWS[-1])
        if view is None:
            view = next(count for count in VIEWS if count >= len(solvers))
        solvers = filled_up(solvers, self.methods, robot, frames, VIEWS[-1])
        for solver in solvers:
            check_joint_names(robot, solver)
        self.robot = robot
        self.looks, self.running = Looks(), False
        self.steps = 0
        self.stillness = Stillness()
        self.notes: list[str] = []
        self._offered: tuple[list[str], list[str]] = ([], [])  # for which frames, what
        self.settings = StepSettings()
        self.leading, self.misses = Leading(), Misses()
        self.motion = Motion(robot, seed)
        self.seed, self.clock = seed, clock
        self.home = home_configuration(robot)
        self.contacts, self.obstacles = Contacts(robot), Obstacles()
        self.instances = [Instance(robot, s, self.home, self.settings, clock, self.contacts) for s in solvers]
        self.balls = Balls(robot)
        self.scores = Scoreboard(clock)
        self.set_view(view)

    @property
    def seen(self) -> list[Instance]:
        """The instances that step and are visible."""
        return self.instances[: self.view]

    @property
    def offered(self) -> list[str]:
        """Names of the methods that can chase one of the balls."""
        if self._offered[0] != self.balls.frames:  # kept: every state message needs it, and a check takes milliseconds
            self._offered = self.balls.frames, offered(self.methods, self.robot, self.balls.frames)
        return self._offered[1]

    @property
    def summaries(self) -> list[Summary]:
        """The statistics of the visible instances, refreshed once per second, and empty once their terms changed."""
        self._agree_on_terms()
        return self.scores.summaries

    @property
    def rests(self) -> bool:
        """Whether neither a ball nor a robot has moved for a while."""
        return self.stillness.lasts

    @property
    def sleeps(self) -> bool:
        """Whether nothing will move until somebody asks for something."""
        return not self.running or (self.rests and not self.motion.moves(self.balls))

    def tick(self) -> bool:
        """Take a step if the session is running; return whether it is."""
        was_running = self.running
        if was_running:
            self.step()
        return was_running

    def step(self) -> None:
        """Advance the balls by 1/60 s, and let every visible instance chase them."""
        self._agree_on_terms()
        self.motion.advance(self.balls, 1.0 / STEPS_PER_SECOND)
        share = (_SOLVERS_SHARE / STEPS_PER_SECOND if self.running else _SECONDS_OF_ONE_STEP) / self.view
        targets = self.balls.targets
        led = self.leading.among(targets)
        for index, instance in enumerate(self.seen):
            if index not in led:
                instance.step(targets, share)
        self.steps += 1
        self.scores.count(self.seen, at_once=not self.running)
        self.stillness.note(self.seen, targets)
        if self.misses.look(self.seen, targets, jumped=self.motion.kind == "random"):
            self.running = False

    def reset(self) -> None:
        """Return the robots and balls to where they began, and clear the statistics."""
        for instance in self.instances:
            instance.put(self.home)
        for ball in self.balls:
            ball.go_home()
        self.motion.restart()
        self.leading.hold((), ())
        self.steps = 0
        self.stillness.end()
        self.scores.begin_anew(self.view)

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
        check_balls(solver, self.robot, self.balls.frames)
        self._set_solver(index, solver)

    def set_parameter(self, index: int, name: str, value: Any) -> None:
        """Set one parameter of an instance's method.

        Raises:
            UnknownNameError: There is no such parameter, or it names a joint that the robot does not have.
            InputError: The value is out of range, or there is no such instance.
        """
        solver = self.instance(index).solver
        self._set_solver(index, make_solver(type(solver), **(solver.parameters | {name: value})))

    def apply_settings(self, settings: StepSettings) -> None:
        """Set how the steps of all instances go."""
        if settings != self.settings:
            self.settings = settings
            for instance in self.instances:
                instance.settings = settings

    def change_settings(self, **changes: Any) -> None:
        """Change some of the settings, by their names in `StepSettings`."""
        self.apply_settings(dataclasses.replace(self.settings, **changes))

    def set_motion(self, kind: str) -> None:
        """Set how the balls move: "hand", "curve" or "random"."""
        if kind not in MOTIONS:
            raise UnknownNameError("motion", kind, MOTIONS)
        if kind != self.motion.kind:
            self.motion.kind = kind
            self.motion.restart()

    def set_curve(self, name: str) -> None:
        """Set the curve that the balls follow."""
        self.motion.choose_curve(name)

    def set_contacts(self, on: bool, avoids: bool) -> None:
        """Look for what touches, and let the instances avoid it, which they only do where it is looked for."""
        self.contacts.on, self.contacts.avoids = on, on and avoids
        self.stillness.end()

    def set_obstacles(self, obstacles: Obstacles) -> None:
        """Put these obstacles around the instances, or note that they have changed."""
        self.obstacles = obstacles
        self.contacts.surround(obstacles.solids)
        self.stillness.end()

    def move_ball(self, index: int, position: ArrayLike) -> None:
        """Move a ball to a position (3,) [m], and switch the motion to "hand"."""
        self.balls.number(index).put(position)
        self.set_motion("hand")

    def set_mode(self, index: int, mode: str) -> None:
        """Switch a ball "on", "pinned" or "off"; one that was off appears at its frame on the first instance."""
        ball = self.balls.number(index)
        if mode not in MODES:
            raise UnknownNameError("mode", mode, MODES)
        if ball.mode == "off" and mode != "off":
            ball.put(self.robot.placement(ball.frame, self.instances[0].q).translation)
        ball.mode = mode

    def add_ball(self, frame: str) -> None:
        """Add a ball to a frame that has none yet.

        Raises:
            UnknownNameError: There is no such frame.
            InputError: The frame has a ball already, or there are too many balls.
        """
        self.balls.add(frame, "off")
        self.set_mode(len(self.balls) - 1, "on")

    def _set_solver(self, index: int, solver: Solver) -> None:
        instance = self.instance(index)
        check_joint_names(self.robot, solver)
        if solver != instance.solver:
            instance.solver = solver

    def instance(self, index: int) -> Instance:
        """An instance by its number.

        Raises:
            InputError: There is no such instance.
        """
        if not 0 <= index < len(self.instances):
            raise InputError(f"instances are numbered from 0 to {len(self.instances) - 1}; got {index}")
        return self.instances[index]

    def visible(self, index: int) -> Instance:
        """A visible instance by its number.

        Raises:
            InputError: There is no such visible instance.
        """
        if not 0 <= index < self.view:
            raise InputError(f"the visible instances are numbered from 0 to {self.view - 1}; got {index}")
        return self.instances[index]

    def _agree_on_terms(self) -> None:
        self.scores.agree(terms(self.seen, self.settings, self.motion, self.balls), self.view)
