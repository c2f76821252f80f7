"""Which instances hold a pose that was set joint by joint, so that the balls follow them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...problem.targets import Target
from .instance import same_objects

__all__ = ["Leading"]


class Leading:
    """The instances whose joints lead.

    They lead until a ball asks for something else than what it was given to follow them: a ball that is dragged, moves
    along a curve or is switched on makes the balls lead again.
    """

    def __init__(self) -> None:
        self._held: frozenset[int] = frozenset()
        self._targets: tuple[Target, ...] = ()

    def hold(self, indices: Iterable[int], targets: Sequence[Target]) -> None:
        """Let these instances lead, once the balls have followed them and ask for these targets."""
        self._held, self._targets = frozenset(indices), tuple(targets)

    def show(self, count: int) -> None:
        """Let go of all but the first `count` instances."""
        self._held = self._held & frozenset(range(count))

    def among(self, targets: Sequence[Target]) -> frozenset[int]:
        """The instances that lead while the balls ask for these targets, the same objects as when they began to."""
        if self._held and not same_objects(targets, self._targets):
            self._held = frozenset()
        return self._held
