"""One peer: its packages, its adapter, the tables that it has a row in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from .verdicts import STRICT

__all__ = ["ONE_BY_ONE", "WITH_TOLERANCE", "Peer"]

ONE_BY_ONE = ("poses", "path", "still")
WITH_TOLERANCE = (*ONE_BY_ONE, "tolerance")


@dataclass(frozen=True)
class Peer:
    """One row of the tables.

    Attributes:
        key: Its name on the command line.
        label: Its name in the tables.
        adapter: File in `benchmarks/adapters/` and class in it.
        packages: The packages whose versions are reported.
        requirements: What its environment gets, pinned; none for what runs in pinik's own.
        options: Keyword arguments of the adapter.
        tasks: The tables that it has a row in.
        lacks: What it does not do, or not by itself, for whoever reads its row.
        batch: Whether it gets all targets at once.
        threads: How many it works in; who uses more than one is not kept on one core.
        tolerance: What it is asked for [m]; ten times that in radians.
    """

    key: str
    label: str
    adapter: tuple[str, str]
    packages: tuple[str, ...]
    requirements: tuple[str, ...] = ()
    options: Mapping[str, object] = field(default_factory=dict)
    tasks: tuple[str, ...] = ONE_BY_ONE
    lacks: str = ""
    batch: bool = False
    threads: int = 1
    tolerance: float = STRICT[0]

    @property
    def environment(self) -> str:
        """What its environment is called after: the rows of one library share it."""
        return self.key.partition("-")[0]

    def at(self, tolerance: float) -> Peer:
        """The same peer asked for a tolerance [m]."""
        return replace(
            self,
            key=f"{self.key}-{tolerance:g}",
            label=f"{self.label}, {tolerance:g} m",
            options={**self.options, "tolerance": tolerance},
            tolerance=tolerance,
        )
