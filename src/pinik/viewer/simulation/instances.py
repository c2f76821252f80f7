"""The instances of a session: always four, of which one, two or four are visible, each with its method."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, overload

from numpy.typing import NDArray

from ...errors import InputError, UnknownNameError
from ...motion.effectors import principal_frames
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import make_solver
from ...solving.question import check_joint_names
from .contacts import Contacts
from .instance import Instance
from .method_menu import Methods, check_balls, chosen, filled_up, offered
from .step_settings import StepSettings

__all__ = ["VIEWS", "Instances"]

VIEWS = (1, 2, 4)


class Instances(Sequence[Instance]):
    """The instances in the order in which pages number them.

    Attributes:
        methods: Short name → class, for every available method.
        view: The number of those that step and are visible.
        settings: How their steps go.
    """

    def __init__(
        self,
        robot: Robot,
        methods: Methods,
        view: int | None,
        home: NDArray[Any],
        clock: Callable[[], float],
        contacts: Contacts,
    ) -> None:
        """Create them.

        Args:
            robot: The robot.
            methods: One to four methods; further instances use the remaining ones.
            view: The number of visible instances; enough for `methods` when None.
            home: The pose in which they begin (nq,).
            clock: A function that returns the time in seconds that solvers have spent.
            contacts: What they touch.

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
        self._robot = robot
        self._offered: tuple[list[str], list[str]] = ([], [])  # for which frames, what
        self.settings = StepSettings()
        self._instances = [Instance(robot, solver, home, self.settings, clock, contacts) for solver in solvers]
        self.show(view)

    @overload
    def __getitem__(self, index: int) -> Instance: ...
    @overload
    def __getitem__(self, index: slice) -> list[Instance]: ...
    def __getitem__(self, index: int | slice) -> Instance | list[Instance]:
        """The instance with a number, or several."""
        return self._instances[index]

    def __len__(self) -> int:
        return len(self._instances)

    @property
    def seen(self) -> list[Instance]:
        """The visible ones."""
        return self._instances[: self.view]

    def number(self, index: int) -> Instance:
        """The instance with a number that a page has given.

        Raises:
            InputError: There is no such instance.
        """
        if not 0 <= index < len(self):
            raise InputError(f"instances are numbered from 0 to {len(self) - 1}; got {index}")
        return self._instances[index]

    def visible(self, index: int) -> Instance:
        """The visible instance with a number that a page has given.

        Raises:
            InputError: There is no such visible instance.
        """
        if not 0 <= index < self.view:
            raise InputError(f"the visible instances are numbered from 0 to {self.view - 1}; got {index}")
        return self._instances[index]

    def show(self, count: int) -> None:
        """Let 1, 2 or 4 of them be visible.

        Raises:
            InputError: It is another number.
        """
        if type(count) is not int or count not in VIEWS:
            raise InputError(f"a view must have 1, 2 or 4 instances; got {count!r}")
        self.view = count

    def offered(self, frames: list[str]) -> list[str]:
        """Names of the methods that can chase a ball of one of these frames."""
        if self._offered[0] != frames:  # kept: every state message needs it, and a check takes milliseconds
            self._offered = frames, offered(self.methods, self._robot, frames)
        return self._offered[1]

    def set_method(self, index: int, method: str, frames: Sequence[str], parameters: dict[str, Any]) -> None:
        """Change the method of an instance, by short name; parameters that are not given have their defaults.

        Args:
            index: The number of the instance.
            method: The short name.
            frames: The frames of the balls, of which the method must be able to chase one.
            parameters: The method's parameters by name.

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
        check_balls(solver, self._robot, frames)
        self._set_solver(index, solver)

    def set_parameter(self, index: int, name: str, value: Any) -> None:
        """Set one parameter of an instance's method.

        Raises:
            UnknownNameError: There is no such parameter, or it names a joint that the robot does not have.
            InputError: The value is out of range, or there is no such instance.
        """
        solver = self.number(index).solver
        self._set_solver(index, make_solver(type(solver), **(solver.parameters | {name: value})))

    def _set_solver(self, index: int, solver: Solver) -> None:
        instance = self.number(index)
        check_joint_names(self._robot, solver)
        if solver != instance.solver:
            instance.solver = solver

    def apply_settings(self, settings: StepSettings) -> None:
        """Set how the steps of all of them go."""
        if settings != self.settings:
            self.settings = settings
            for instance in self:
                instance.settings = settings
