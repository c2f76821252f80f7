"""The obstacles of a session: boxes and spheres that can be put down and dragged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import overload

from numpy.typing import ArrayLike

from ...checks import as_point, as_positive_number
from ...errors import InputError, UnknownNameError
from ...shapes.solids import Solid
from ...shapes.world import World

__all__ = ["KINDS", "LARGEST", "MOST_OBSTACLES", "Obstacle", "Obstacles"]

KINDS = {"box": 3, "sphere": 1}
"""The kinds of obstacles, and how many numbers the size of each has: the edges of a box, the radius of a sphere."""

MOST_OBSTACLES = 8
LARGEST = 10.0
"""The largest edge or radius [m]."""


@dataclass(frozen=True)
class Obstacle:
    """An obstacle.

    Attributes:
        kind: One of `KINDS`.
        size: The edges of a box along the world's axes (3,), or the radius of a sphere (1,) [m].
        position: Its centre (3,) [m].
    """

    kind: str
    size: tuple[float, ...]
    position: tuple[float, float, float]


class Obstacles(Sequence[Obstacle]):
    """The obstacles in the order in which pages number them."""

    def __init__(self) -> None:
        self._obstacles: list[Obstacle] = []
        self._solids: tuple[Solid, ...] = ()

    @overload
    def __getitem__(self, index: int) -> Obstacle: ...
    @overload
    def __getitem__(self, index: slice) -> list[Obstacle]: ...
    def __getitem__(self, index: int | slice) -> Obstacle | list[Obstacle]:
        """The obstacle with a number, or several."""
        return self._obstacles[index]

    def __len__(self) -> int:
        return len(self._obstacles)

    @property
    def solids(self) -> tuple[Solid, ...]:
        """Their shapes, whose owners are `name(index)`; a new tuple after each change."""
        return self._solids

    @staticmethod
    def name(index: int) -> str:
        """What messages call an obstacle."""
        return f"obstacle {index + 1}"

    def add(self, kind: str, size: ArrayLike, position: ArrayLike) -> None:
        """Put an obstacle down; the arguments are the attributes of `Obstacle`.

        Raises:
            UnknownNameError: There is no such kind.
            InputError: A size is not positive or too large, the position is not a point, or there are too many.
        """
        if len(self) >= MOST_OBSTACLES:
            raise InputError(f"a session can have at most {MOST_OBSTACLES} obstacles; remove one first")
        made = Obstacle(kind, _size(kind, size), _position(position))
        self._change([*self._obstacles, made])

    def put(self, index: int, position: ArrayLike) -> None:
        """Move an obstacle.

        Raises:
            InputError: There is no such obstacle, or the position is not a point.
        """
        moved = replace(self._number(index), position=_position(position))
        self._change([*self._obstacles[:index], moved, *self._obstacles[index + 1 :]])

    def resize(self, index: int, size: ArrayLike) -> None:
        """Change an obstacle's size.

        Raises:
            InputError: There is no such obstacle, or the size is none.
        """
        old = self._number(index)
        resized = replace(old, size=_size(old.kind, size))
        self._change([*self._obstacles[:index], resized, *self._obstacles[index + 1 :]])

    def remove(self, index: int) -> None:
        """Remove an obstacle.

        Raises:
            InputError: There is no such obstacle.
        """
        self._number(index)
        self._change([*self._obstacles[:index], *self._obstacles[index + 1 :]])

    def _number(self, index: int) -> Obstacle:
        if not 0 <= index < len(self):
            raise InputError(f"there is no obstacle {index}; there are {len(self)}, numbered from 0")
        return self._obstacles[index]

    def _change(self, obstacles: list[Obstacle]) -> None:
        world = World()
        for index, (kind, size, position) in enumerate((o.kind, o.size, o.position) for o in obstacles):
            if kind == "box":
                world.add_box(self.name(index), size, position)
            else:
                world.add_sphere(self.name(index), size[0], position)
        self._obstacles, self._solids = obstacles, world.solids


def _size(kind: str, size: ArrayLike) -> tuple[float, ...]:
    if kind not in KINDS:
        raise UnknownNameError("kind of obstacle", kind, KINDS)
    given = list(size) if isinstance(size, Sequence) else [size]
    if len(given) != KINDS[kind]:
        raise InputError(f"the size of a {kind} must be {KINDS[kind]} number{'s' * (KINDS[kind] > 1)}; got {given!r}")
    numbers = tuple([as_positive_number(number, "the size of an obstacle", "m") for number in given])
    if max(numbers) > LARGEST:
        raise InputError(f"the size of an obstacle must be at most {LARGEST:g} m; got {max(numbers):g}")
    return numbers


def _position(position: ArrayLike) -> tuple[float, float, float]:
    x, y, z = as_point(position, "the position of an obstacle").tolist()
    return x, y, z
