"""Who is connected: the open connections of each address, and the budgets of requests."""

from __future__ import annotations

import time
from collections.abc import Callable

from .budget import Budget

__all__ = ["Guests"]

_PER_ADDRESS = 64  # connections; a browser opens about six, and one more for each tab
_IN_ALL = 128
_REQUESTS_PER_SECOND = 100.0  # the page, meshcat's script and the tab's socket count as twelve
_REQUESTS_AT_ONCE = 400.0
_ALL_REQUESTS_PER_SECOND = 300.0
_ALL_REQUESTS_AT_ONCE = 1200.0
_REMEMBERED = 256  # addresses


class _Guest:
    def __init__(self, clock: Callable[[], float]) -> None:
        self.connections = 0
        self.budget = Budget(_REQUESTS_PER_SECOND, _REQUESTS_AT_ONCE, clock)


class Guests:
    """Counts the connections of each address, and keeps one budget of requests for each.

    Attributes:
        all_requests: The budget of the requests of all addresses together.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._guests: dict[str, _Guest] = {}
        self._connections = 0
        self.all_requests = Budget(_ALL_REQUESTS_PER_SECOND, _ALL_REQUESTS_AT_ONCE, clock)

    def __len__(self) -> int:
        return self._connections

    def enter(self, address: str) -> str:
        """Count one more connection of an address, or return the reason why there cannot be one more."""
        guest = self._guest(address)
        if guest.connections >= _PER_ADDRESS:
            return f"at most {_PER_ADDRESS} connections may be open from one address"
        if self._connections >= _IN_ALL:
            return f"at most {_IN_ALL} connections may be open"
        guest.connections += 1
        self._connections += 1
        return ""

    def leave(self, address: str) -> None:
        """Count one connection less."""
        self._guest(address).connections -= 1
        self._connections -= 1

    def budget(self, address: str) -> Budget:
        """The budget of requests of an address, over all its connections."""
        return self._guest(address).budget

    def _guest(self, address: str) -> _Guest:
        if address not in self._guests:
            if len(self._guests) >= _REMEMBERED:
                kept = {name: one for name, one in self._guests.items() if one.connections or not one.budget.is_full}
                self._guests = kept
            self._guests[address] = _Guest(self._clock)
        return self._guests[address]
