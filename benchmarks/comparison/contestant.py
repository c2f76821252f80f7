"""One peer with one arm and task, at work in turns with the others."""

from __future__ import annotations

import math
import statistics
import textwrap
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pinocchio

from .arms import Arm
from .machine import Yardstick
from .peer import Peer
from .problems import Problems
from .tables import Measured, Row, row_of
from .verdicts import Verdict, verdict_on, verdict_on_placement
from .workers import Worker, WorkerError

__all__ = ["compare", "one_line"]

BATCH_ROUNDS = 5


class Contestant:
    """What a peer has answered so far, and how much of its time is left."""

    def __init__(self, peer: Peer, arm: Arm, problems: Problems, budget: float) -> None:
        self.peer = peer
        self.measured = Measured([], [])
        self._arm, self._problems = arm, problems
        self._left = budget
        self._worker: Worker | None = None
        self._batches: list[dict[str, Any]] = []

    def start(self, python: Path | str, core: int | None, processes: ExitStack) -> dict[str, str]:
        """Load the arm and check the conventions; the versions of the packages, none when the peer cannot take part."""
        if isinstance(python, str):
            self.measured.reason = python
            return {}
        try:
            pinned = core if self.peer.threads == 1 else None
            worker = processes.enter_context(Worker(python, self.peer, self._arm, self._problems.warm_up, pinned))
            self._check(worker)
        except WorkerError as error:
            self.measured.reason = one_line(error)
            return {}
        self._worker = worker
        return worker.versions

    def work(self, rounds_left: int, chunk: int) -> None:
        """One round: the next targets, as many as the time allows; all of them for a batch."""
        if self._worker is None or self._left <= 0:
            return
        try:
            if self.peer.batch:
                self._solve_batch(self._worker)
            else:
                self._solve_next(self._worker, chunk, self._left / rounds_left)
        except WorkerError as error:
            self._worker = None
            self.measured.reason, self.measured.note = one_line(error), f"stopped early: {one_line(error)}"

    def finish(self) -> None:
        """Judge a batch's answers; of its rounds the one that took the median time counts."""
        if self._batches:
            median = statistics.median_low(batch["wall"] for batch in self._batches)
            self._take(next(batch for batch in self._batches if batch["wall"] == median))

    def _check(self, worker: Worker) -> None:
        """Let the judge see that the peer means the same frames and joints, before its time counts."""
        targets, starts = self._problems.check
        reply = worker.solve(targets, starts, carry=False, seconds=10.0)
        if max(self._verdicts(targets, reply["answers"]), default=Verdict.MISSED) == Verdict.MISSED:
            said = f": {reply['errors'][0]}" if reply["errors"] else ""
            raise WorkerError(f"it places the tip at none of {len(targets)} targets next to their starts{said}")

    def _solve_next(self, worker: Worker, chunk: int, seconds: float) -> None:
        begin = len(self.measured.verdicts)
        targets, starts = self._problems.targets[begin : begin + chunk], self._problems.starts[begin : begin + chunk]
        if targets:
            carry = self._problems.task == "path"
            first = None if carry and begin else starts
            reply = worker.solve(targets, first, carry=carry, seconds=seconds)
            self._take(reply)
            self._left -= reply["wall"] / 1e9

    def _solve_batch(self, worker: Worker) -> None:
        reply = worker.solve(self._problems.targets, self._problems.starts, carry=False, seconds=self._left)
        self._batches.append(reply)
        self._left -= reply["wall"] / 1e9

    def _take(self, reply: dict[str, Any]) -> None:
        measured = self.measured
        measured.verdicts += self._verdicts(self._problems.targets[len(measured.verdicts) :], reply["answers"])
        measured.nanoseconds += reply["nanoseconds"]
        measured.wall += reply["wall"]
        if reply["errors"] and not measured.note:
            measured.note = f"some raised {one_line(reply['errors'][0])}"

    def _verdicts(self, targets: Sequence[pinocchio.SE3], answers: Any) -> list[Verdict]:
        pairs = zip(targets, answers, strict=False)
        if self._problems.task == "forward":
            return [verdict_on_placement(target, answer) for target, answer in pairs]
        strict = (self.peer.tolerance, 10 * self.peer.tolerance)
        return [verdict_on(self._arm, target, answer, strict) for target, answer in pairs]


def compare(
    arm: Arm,
    problems: Problems,
    pythons: Sequence[tuple[Peer, Path | str]],
    rounds: int,
    budget: float,
    core: int | None,
    yardstick: Yardstick,
) -> tuple[list[Row], dict[str, dict[str, str]]]:
    """Let the peers work in turns, one at a time, so that whatever disturbs the machine disturbs all of them.

    Returns:
        A row for each peer, and the versions of each peer's packages.
    """
    contestants = [Contestant(peer, arm, problems, budget) for peer, _ in pythons]
    if all(peer.batch for peer, _ in pythons):
        rounds = min(rounds, BATCH_ROUNDS)
    chunk = math.ceil(len(problems.targets) / rounds)
    versions = {}
    with ExitStack() as processes:
        for contestant, (_, python) in zip(contestants, pythons, strict=True):
            versions[contestant.peer.key] = contestant.start(python, core, processes)
        for done in range(rounds):
            for contestant in contestants:
                yardstick.measure()
                contestant.work(rounds - done, chunk)
    for contestant in contestants:
        contestant.finish()
    rows = [row_of(arm.name, problems.task, contestant.peer, contestant.measured) for contestant in contestants]
    return rows, versions


def one_line(words: object) -> str:
    """Words shortened to one line of a table."""
    return textwrap.shorten(str(words), 200, placeholder=" …")
