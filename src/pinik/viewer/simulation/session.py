"""The live view's simulation: instances of one robot that chase the same balls."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from typing import Any

from numpy.typing import ArrayLike

from ...errors import UnknownNameError
from ...model.home import home_configuration
from ...robot import Robot
from ...solvers.base import Solver
from .ball import MODES
from .balls import Balls
from .contacts import Contacts
from .instance import Instance
from .instances import Instances
from .leading import Leading
from .looks import Looks
from .method_menu import Methods
from .misses import Misses
from .motion import MOTIONS, Motion
from .obstacles import Obstacles
from .scoreboard import Scoreboard, terms
from .statistics import Summary
from .step_settings import StepSettings
from .stillness import Stillness

__all__ = ["STEPS_PER_SECOND", "Session"]

STEPS_PER_SECOND = 60
# The share of a step's time that the solvers may compute for; the rest is for drawing and for messages from the page.
_SOLVERS_SHARE = 0.7
_SECONDS_OF_ONE_STEP = 0.25  # of all solvers together, if somebody asks for a single step, which nothing hurries
_DEFAULT_METHODS = ("ccd", "jt", "pinv", "dls")


class Session:
    """One, two or four instances of a robot, the balls that they chase, and the motion of the balls.

    Attributes:
        robot: The robot.
        instances: All four instances, of which some step and are visible.
        balls: The balls, each with the frame that chases it.
        motion: The automatic motion of the balls.
        contacts: What the instances touch, and whether they avoid it.
        obstacles: What stands around them.
        leading: The instances whose joints lead instead of the balls.
        stillness: How long nothing has moved.
        misses: Whether the session pauses on a miss, and the last one.
        looks: What the picture shows besides robots and balls.
        home: The pose in which the robots begin (nq,).
        steps: The number of steps since the last reset.
        scores: The statistics of the visible instances.
        notes: What else changed with the last change of robot, in words.
        seed: The seed of the random positions.
        clock: A function that returns the time in seconds that solvers have spent.
    """

    def __init__(
        self,
        robot: Robot,
        methods: Methods = _DEFAULT_METHODS,
        *,
        view: int | None = None,
        seed: int = 0,
        clock: Callable[[], float] = time.thread_time,
    ) -> None:
        """Create the instances and the balls.

        Args:
            robot: The robot.
            methods: One to four methods, as names, classes or instances. Further instances use the remaining methods,
                in the order of `pinik.SOLVERS`, then of `pinik.CLOSED_FORMS`.
            view: The number of visible instances: 1, 2 or 4; enough for `methods` when None.
            seed: The seed of the random positions.
            clock: A function that returns the time in seconds that solvers have spent. By default, it is the processor
                time of the thread: what else the machine does meanwhile is not the method's doing.

        Raises:
            UnknownNameError: There is no such method, or its parameters name a joint that the robot does not have.
            InputError: There are no methods or more than four, one of them cannot chase any ball of this robot, or
                the view is not 1, 2 or 4.
        """
        self.robot = robot
        self.looks, self._running = Looks(), False
        self.steps = 0
        self.stillness = Stillness()
        self.notes: list[str] = []
        self.leading, self.misses = Leading(), Misses()
        self.motion = Motion(robot, seed)
        self.seed, self.clock = seed, clock
        self.home = home_configuration(robot)
        self.contacts, self.obstacles = Contacts(robot), Obstacles()
        self.instances = Instances(robot, methods, view, self.home, clock, self.contacts)
        self.balls = Balls(robot)
        self.scores = Scoreboard(STEPS_PER_SECOND)

    @property
    def running(self) -> bool:
        """Whether `tick` takes a step. Once it does not, the statistics cover the last step too."""
        return self._running

    @running.setter
    def running(self, on: bool) -> None:
        self._running = on
        if not on:
            self.scores.refresh()

    @property
    def methods(self) -> dict[str, type[Solver]]:
        """Short name → class, for every available method."""
        return self.instances.methods

    @property
    def settings(self) -> StepSettings:
        """How the steps of all instances go."""
        return self.instances.settings

    @property
    def view(self) -> int:
        """The number of instances that step and are visible."""
        return self.instances.view

    @property
    def seen(self) -> list[Instance]:
        """The instances that step and are visible."""
        return self.instances.seen

    @property
    def offered(self) -> list[str]:
        """Names of the methods that can chase one of the balls."""
        return self.instances.offered(self.balls.frames)

    @property
    def summaries(self) -> list[Summary]:
        """The statistics of the visible instances, refreshed every 60 steps and when the session stops.

        They are empty once their terms changed.
        """
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
        """Show 1, 2 or 4 instances. Those that are hidden lead no more."""
        self.instances.show(count)
        self.leading.show(count)

    def set_method(self, index: int, method: str, **parameters: Any) -> None:
        """Change the method of an instance, as `Instances.set_method` does."""
        self.instances.set_method(index, method, self.balls.frames, parameters)

    def set_parameter(self, index: int, name: str, value: Any) -> None:
        """Set one parameter of an instance's method, as `Instances.set_parameter` does."""
        self.instances.set_parameter(index, name, value)

    def apply_settings(self, settings: StepSettings) -> None:
        """Set how the steps of all instances go."""
        self.instances.apply_settings(settings)

    def change_settings(self, **changes: Any) -> None:
        """Change some of the settings, by their names in `StepSettings`."""
        self.apply_settings(dataclasses.replace(self.settings, **changes))

    def set_motion(self, kind: str) -> None:
        """Set how the balls move: "hand", "curve" or "random". Balls that move by themselves lead."""
        if kind not in MOTIONS:
            raise UnknownNameError("motion", kind, MOTIONS)
        if kind != "hand":
            self.leading.hold((), ())
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

    def _agree_on_terms(self) -> None:
        self.scores.agree(terms(self.seen, self.settings, self.motion, self.balls), self.view)
