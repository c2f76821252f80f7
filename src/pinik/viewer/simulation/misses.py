"""Pausing where an instance misses its target, so that one can look at what it does there."""

from __future__ import annotations

from collections.abc import Sequence

from ...problem.targets import Target
from ...solving.state import Status
from .instance import Instance, same_objects

__all__ = ["Misses"]

_MISSES = {status.name for status in (Status.STALLED, Status.MAX_ITERATIONS, Status.UNREACHABLE)} | {"FAILED"}


class Misses:
    """Tells when an instance misses a target that it has not missed before.

    A method that was cut off by the time limit goes on in the next step, which is no miss. An instance that misses for
    a long time, as a ball moves out of reach, is told once; so a session that goes on is not paused at each step.

    Attributes:
        pause: Whether a session pauses on a miss.
        last: Which instance missed when the session last paused, in words; None once it goes on.
    """

    def __init__(self) -> None:
        self.pause = False
        self.last: str | None = None
        self._known: set[int] = set()
        self._targets: tuple[Target, ...] = ()

    def look(self, seen: Sequence[Instance], targets: Sequence[Target], jumped: bool) -> bool:
        """Whether to pause now, after a step.

        Args:
            seen: The visible instances.
            targets: The targets of this step.
            jumped: Whether balls that moved have jumped to another place, where a miss is a new one.
        """
        if jumped and not same_objects(targets, self._targets):
            self._known.clear()
        self._targets = tuple(targets)
        missing = {index for index, instance in enumerate(seen) if instance.status in _MISSES}
        fresh, self._known = missing - self._known, missing
        if not (fresh and self.pause):
            return False
        self.last = "; ".join(
            f"robot {index + 1} ({seen[index].solver.name}) missed: {seen[index].verdict().message}"
            for index in sorted(fresh)
        )
        return True
