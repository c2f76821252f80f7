"""What a solve must not touch: the robot itself, a world, or both."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Self

from ..errors import InputError
from ..model.robot_model import RobotModel
from .collisions import Guard, shapes_of
from .solids import Solid
from .world import World

__all__ = ["Avoid", "Avoided"]


@dataclass(frozen=True)
class Avoid:
    """What a solve must not touch. It never changes: of a world it holds the shapes of one version.

    Attributes:
        itself: Whether the links of the robot must not touch each other.
        around: For pinik itself: the shapes around the robot.
    """

    itself: bool = False
    around: tuple[Solid, ...] = field(default=(), repr=False)

    @classmethod
    def of(cls, value: Avoided) -> Self:
        """Read the value of `avoid=`.

        Raises:
            InputError: It is not "self", a World, or a list of these.
        """
        if isinstance(value, cls):
            return value
        parts = [] if value is None else [value] if isinstance(value, (str, World)) else value
        if not isinstance(parts, Iterable):
            raise _error(value)
        itself = False
        around: list[Solid] = []
        for part in parts:
            if isinstance(part, World):
                around += part.solids
            elif isinstance(part, str) and part == "self":
                itself = True
            else:
                raise _error(part)
        return cls(itself, tuple(around))

    def __bool__(self) -> bool:
        return self.itself or bool(self.around)

    def guard(self, robot: RobotModel, engine: str) -> Guard | None:
        """For pinik itself: the checker for a robot; None if nothing is to be avoided.

        Args:
            robot: The robot.
            engine: "native", "python", or "auto" for the compiled engine where there is one.

        Raises:
            InputError: The robot has no collision shapes.
            MissingExtraError: There are meshes, and trimesh, which reads them, is not installed.
        """
        return shapes_of(robot).guard(robot, self.around, itself=self.itself, engine=engine) if self else None


Avoided = str | World | Iterable[str | World] | Avoid | None
"""What `avoid=` takes: "self", a World, several of these, or None."""


def _error(value: object) -> InputError:
    return InputError(f'must be "self", a pinik.World, or a list of these; got {value!r}', argument="avoid")
