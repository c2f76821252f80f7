"""The tabs that have an explanation open, each of one instance."""

from __future__ import annotations

import json
from collections.abc import Callable

from ..protocol.explanation import explanation_message
from ..simulation.explainer import Explainer
from ..simulation.session import Session
from .seats import Tab

__all__ = ["Readers"]


class Readers:
    """Sends explanations, only to tabs that have one open and have drawn what they were sent."""

    def __init__(self, is_late: Callable[[Tab], bool]) -> None:
        self._is_late = is_late
        self._open: dict[Tab, int] = {}
        self._waiting: set[Tab] = set()
        self._explainer = Explainer()

    def open(self, tab: Tab, index: int | None) -> None:
        """Note which instance a tab wants explained; none when None."""
        self._open.pop(tab, None)
        self._waiting.discard(tab)
        if index is not None:
            self._open[tab] = index

    def send(self, session: Session, generation: int) -> None:
        """Send every tab its explanation, if it is not late."""
        late = {tab for tab in self._open if self._is_late(tab)}
        self._waiting |= late
        self._send([tab for tab in self._open if tab not in late], session, generation)

    def catch_up(self, tab: Tab, session: Session, generation: int) -> None:
        """Send a tab that has just answered the explanation that it was too late for."""
        if tab in self._waiting:
            self._send([tab], session, generation)

    def _send(self, tabs: list[Tab], session: Session, generation: int) -> None:
        texts: dict[int, str] = {}
        for tab in tabs:
            self._waiting.discard(tab)
            index = self._open[tab]
            if index >= len(session.seen):
                continue
            if index not in texts:
                explained = self._explainer.explain(session.seen[index], session.balls.targets)
                texts[index] = json.dumps(explanation_message(index, generation, explained))
            tab.send(texts[index])
