"""What a session's picture can show besides robots and balls, switched on and off one by one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ...errors import UnknownNameError

__all__ = ["LOOKS", "Look", "Looks"]


class Look(NamedTuple):
    """One thing that a picture can show.

    Attributes:
        title: Its name for people.
        about: What one sees, in one sentence.
    """

    title: str
    about: str


LOOKS = {
    "overlay": Look("Overlay", "All robots stand in one place, as ghosts in their methods' colours."),
    "axes": Look("Frames' axes", "The x, y and z axes of every link, in red, green and blue."),
    "joint_axes": Look("Joint axes", "The axis that each joint turns about or slides along."),
    "names": Look("Names", "The names of the links, where there is room for them."),
    "transparent": Look("See-through", "The robots are drawn see-through."),
    "collisions": Look("Collision shapes", "The shapes that count when collisions are looked for."),
    "ellipsoid": Look(
        "Manipulability",
        "How far the effector moves in each direction for joint speeds of length one, with the singular values.",
    ),
    "reach": Look("Reach", "Where the effectors can be, for random angles of the joints inside their limits."),
}
"""Name → what it shows."""


class Looks:
    """The looks of a session that are switched on."""

    def __init__(self) -> None:
        self._on: set[str] = set()

    def __contains__(self, name: str) -> bool:
        return name in self._on

    def __iter__(self) -> Iterator[str]:
        """Their names, in the order of `LOOKS`."""
        return (name for name in LOOKS if name in self._on)

    def switch(self, name: str, on: bool) -> None:
        """Switch one of them on or off.

        Raises:
            UnknownNameError: There is no such look.
        """
        if name not in LOOKS:
            raise UnknownNameError("look", name, LOOKS)
        (self._on.add if on else self._on.discard)(name)
