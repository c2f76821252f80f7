"""The report of an attack: how many inputs ended how, and the first input of each kind of fault as a file."""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

from .mutations import Case
from .outcome import FAULTS, Outcome

__all__ = ["Report"]

SHOWN = 12
EVERY = 10_000


class Report:
    """Counts outcomes, and keeps the inputs that show a fault.

    Attributes:
        kinds: The number of outcomes of each kind.
        folder: Where inputs are kept.
    """

    def __init__(self, title: str, folder: Path) -> None:
        self.kinds: Counter[str] = Counter()
        self._signatures: dict[str, Counter[str]] = {}
        self.folder = folder
        self._title, self._start = title, time.monotonic()

    @property
    def minutes(self) -> float:
        """The time since the attack began [min]."""
        return (time.monotonic() - self._start) / 60

    @property
    def faults(self) -> int:
        """The number of inputs that showed a fault."""
        return sum(self.kinds[kind] for kind in FAULTS)

    def is_new(self, outcome: Outcome) -> bool:
        """Count an outcome; say whether it is the first of its kind of fault."""
        self.kinds[outcome.kind] += 1
        found = self._signatures.setdefault(outcome.kind, Counter())
        found[outcome.signature] += 1
        done = self.kinds.total()
        if done % EVERY == 0:
            print(self._progress(), file=sys.stderr)
        return outcome.is_fault and found[outcome.signature] == 1

    def keep(self, number: int, case: Case, outcome: Outcome) -> None:
        """Write an input and what became of it into the folder."""
        self.folder.mkdir(parents=True, exist_ok=True)
        name = self.folder / f"{outcome.kind}-{number}"
        name.with_suffix(".urdf").write_bytes(case.written)
        name.with_suffix(".meant").write_bytes(case.meant)
        name.with_suffix(".txt").write_text(f"{outcome.words}\n{outcome.signature}\nas text: {case.as_text}\n")

    def __str__(self) -> str:
        lines = [f"{self._title}, {self.minutes:.1f} min: {self._progress()}"]
        for kind, found in self._signatures.items():
            lines += [f"{times:>9,} {kind}: {signature}" for signature, times in found.most_common(SHOWN) if signature]
        return "\n".join(lines)

    def _progress(self) -> str:
        done = self.kinds.total()
        counts = ", ".join(f"{count:,} {kind}" for kind, count in self.kinds.most_common())
        return f"{done:,} inputs, {done / (self.minutes * 60):.0f} a second: {counts}"
