"""Budgets: how much a client may ask for in a second, and how much of the time all clients together take."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

__all__ = ["Budget", "Turns"]

_SHARE = 0.25
_AT_ONCE = 0.005  # [s]


class Budget:
    """An amount that grows steadily up to a most, and that every request reduces. It may become a debt."""

    def __init__(self, per_second: float, most: float, clock: Callable[[], float] = time.monotonic) -> None:
        """Start with the most that there can be.

        Args:
            per_second: How much is added each second.
            most: How much there is at most, and so how much can be spent at once.
            clock: A function that returns the time in seconds.
        """
        self._per_second, self._most, self._clock = per_second, most, clock
        self._left, self._at = most, clock()

    def _now(self) -> float:
        now = self._clock()
        self._left = min(self._most, self._left + (now - self._at) * self._per_second)
        self._at = now
        return self._left

    @property
    def is_full(self) -> bool:
        """Whether nothing has been spent lately."""
        return self._now() >= self._most

    @property
    def delay(self) -> float:
        """How long it takes until the debt is gone [s]; 0 if there is none."""
        return max(0.0, -self._now() / self._per_second)

    def spend(self, amount: float) -> None:
        """Reduce the budget by an amount, even if less is left."""
        self._left = self._now() - amount


class Turns:
    """Does the work of all clients one piece after the other, in the order in which they ask for it.

    All of it together takes a quarter of the time at most, so that the session has the rest.
    """

    def __init__(
        self,
        clock: Callable[[], float] = time.monotonic,
        work_clock: Callable[[], float] = time.thread_time,
    ) -> None:
        """Start with nothing to do.

        Args:
            clock: A function that returns the time in seconds.
            work_clock: A function that returns how long this thread has worked, in seconds; on a busy machine, less
                than the time that has passed.
        """
        self._work_clock = work_clock
        self._one = asyncio.Lock()
        self._budget = Budget(_SHARE, _AT_ONCE, clock)

    async def take(self, work: Callable[[], None]) -> float:
        """Wait for a turn, do the work, and return how long it took [s]."""
        async with self._one:
            while delay := self._budget.delay:
                await asyncio.sleep(delay)
            began = self._work_clock()
            try:
                work()
            finally:
                spent = self._work_clock() - began
                self._budget.spend(spent)
            return spent
