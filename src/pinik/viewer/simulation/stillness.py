"""How long nothing has moved: neither a ball nor a robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...problem.targets import Target
from .instance import Instance, same_objects

__all__ = ["Stillness"]

_STEPS = 90  # a second and a half, which is longer than random motion pauses


class Stillness:
    """Counts the steps in a row in which nothing moved."""

    def __init__(self) -> None:
        self._steps = 0
        self._targets: Sequence[Target] = ()

    @property
    def lasts(self) -> bool:
        """Whether nothing has moved for a while."""
        return self._steps > _STEPS

    def note(self, instances: Iterable[Instance], targets: Sequence[Target]) -> None:
        """Note a step of the instances towards the targets."""
        is_still = not any([instance.moves for instance in instances]) and same_objects(targets, self._targets)
        self._steps = self._steps + 1 if is_still else 0
        self._targets = targets

    def end(self) -> None:
        """Something is about to move."""
        self._steps = 0
