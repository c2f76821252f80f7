"""What a batch came to, in numbers and in one sentence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..solving.state import Status
from .jobs.job import Tally

__all__ = ["Summary"]


@dataclass(frozen=True)
class Summary:
    """What a batch came to.

    Attributes:
        rows: The number of rows in the table of targets.
        by_status: How many rows ended with each status, by its name; only those that occurred.
        skipped: The number of faulty rows that were left out.
        resumed: The number of rows whose answers were taken over from an earlier run.
        time: The duration of this run, without the survey of the table [s].
    """

    rows: int
    by_status: Mapping[str, int]
    skipped: int
    resumed: int
    time: float

    @classmethod
    def of(cls, rows: int, skipped: int, tally: Tally, seconds: float) -> Summary:
        """For pinik itself: the summary of a tally."""
        names = [status.name for status in Status]
        by_status = {name: int(tally.notes[name]) for name in names if name in tally.notes}
        return cls(rows, by_status, skipped, int(tally.earlier.get("rows", 0)), seconds)

    @property
    def solved(self) -> int:
        """The number of rows whose target was reached."""
        return self.by_status.get(Status.CONVERGED.name, 0)

    @property
    def success(self) -> bool:
        """Whether all rows were solved, and none was left out."""
        return self.solved == self.rows

    @property
    def rate(self) -> float:
        """The number of rows that this run answered in a second."""
        return (sum(self.by_status.values()) - self.resumed) / self.time if self.time > 0.0 else 0.0

    def __str__(self) -> str:
        words = f"{self.solved:,} of {self.rows:,} rows solved"
        missed = [f"{count:,} {name}" for name, count in self.by_status.items() if name != Status.CONVERGED.name]
        if self.skipped:
            missed.append(f"{self.skipped:,} faulty and left out")
        if missed:
            words += f" ({', '.join(missed)})"
        if self.resumed:
            words += f", {self.resumed:,} of them in an earlier run"
        return f"{words}; {self.rate:,.0f} rows/s in {self.time:.3g} s"

    def to_dict(self) -> dict[str, Any]:
        """The JSON form."""
        return {
            "schema": 1,
            "success": self.success,
            "rows": self.rows,
            "solved": self.solved,
            "by_status": dict(self.by_status),
            "skipped": self.skipped,
            "resumed": self.resumed,
            "time_s": self.time,
        }
