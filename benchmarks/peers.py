"""pinik beside other inverse kinematics: the same arms, targets and starts, judged by plain Pinocchio.

Each peer works in an environment of its own, made once in the user's cache folder. `docs/peers.md` says what is
asked, how each peer is set, and how to read the tables.

    python benchmarks/peers.py --robots panda,ur5 --peers pinik,rtb,tracik --count 1000
"""

from __future__ import annotations

import argparse
import datetime
import json
import math
import platform
import statistics
import sys
import tempfile
import textwrap
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "tests"))  # the judge

from comparison.arms import ARMS, Arm, write_arm
from comparison.environments import CannotInstallError, python_with
from comparison.peer_list import PEERS, Peer, pinik_by
from comparison.problems import TASKS, Problems, make_problems
from comparison.tables import Measured, Row, as_json, as_text, row_of
from comparison.verdicts import NEAR, STRICT, verdict_on
from comparison.workers import Worker, WorkerError


class Contestant:
    """One peer with one arm and task: what it has answered so far, and how much of its time is left."""

    def __init__(self, peer: Peer, arm: Arm, problems: Problems, budget: float) -> None:
        self.peer = peer
        self.measured = Measured([], [])
        self._arm, self._problems = arm, problems
        self._left = budget
        self._worker: Worker | None = None
        self._batches: list[dict[str, Any]] = []

    def start(self, python: Path | str, processes: ExitStack) -> dict[str, str]:
        """Load the arm; the versions of the peer's packages, none when it cannot take part."""
        if isinstance(python, str):
            self.measured.reason = python
        elif self._problems.task == "path" and self.peer.not_on_path:
            self.measured.reason = f"not on a path: {self.peer.not_on_path}"
        else:
            try:
                self._worker = processes.enter_context(Worker(python, self.peer, self._arm, self._problems.warm_up))
                return self._worker.versions
            except WorkerError as error:
                self.measured.reason = _one_line(error)
        return {}

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
            self.measured.reason, self.measured.note = _one_line(error), f"stopped early: {_one_line(error)}"

    def finish(self) -> None:
        """Judge a batch's answers; of its rounds the one that took the median time counts."""
        if self._batches:
            median = statistics.median_low(batch["wall"] for batch in self._batches)
            self._take(next(batch for batch in self._batches if batch["wall"] == median))

    def _solve_next(self, worker: Worker, chunk: int, seconds: float) -> None:
        begin = len(self.measured.nanoseconds)
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
        begin = len(measured.verdicts)
        for target, answer in zip(self._problems.targets[begin:], reply["answers"], strict=False):
            measured.verdicts.append(verdict_on(self._arm, target, answer))
        measured.nanoseconds += reply["nanoseconds"]
        measured.wall += reply["wall"]
        if reply["errors"] and not measured.note:
            measured.note = f"some raised {_one_line(reply['errors'][0])}"


def compare(
    arm: Arm, problems: Problems, pythons: list[tuple[Peer, Path | str]], rounds: int, budget: float
) -> tuple[list[Row], dict[str, dict[str, str]]]:
    """Let the peers work in turns, one at a time, so that whatever disturbs the machine disturbs all of them.

    Returns:
        A row for each peer, and the versions of each peer's packages.
    """
    contestants = [Contestant(peer, arm, problems, budget) for peer, _ in pythons]
    chunk = math.ceil(len(problems.targets) / rounds)
    versions = {}
    with ExitStack() as processes:
        for contestant, (_, python) in zip(contestants, pythons, strict=True):
            versions[contestant.peer.key] = contestant.start(python, processes)
        for done in range(rounds):
            for contestant in contestants:
                contestant.work(rounds - done, chunk)
    for contestant in contestants:
        contestant.finish()
    rows = [row_of(arm.name, problems.task, contestant.peer, contestant.measured) for contestant in contestants]
    return rows, versions


def main() -> None:
    """Run what was asked for, print the tables, write the JSON."""
    arguments = _arguments()
    pythons = [(peer, _python_or_reason(peer)) for peer in _chosen_peers(arguments)]
    about = {
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "processor": _processor(),
        "python": platform.python_version(),
        "count": arguments.count,
        "seed": arguments.seed,
        "rounds": arguments.rounds,
        "budget_seconds": arguments.budget,
        "solved_within": {"metres": NEAR[0], "radians": NEAR[1]},
        "strict_within": {"metres": STRICT[0], "radians": STRICT[1]},
    }
    print(f"# {about['date']}, {about['processor']}, Python {about['python']}, seed {arguments.seed}")
    rows: list[Row] = []
    versions: dict[str, dict[str, str]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.robots:
            arm = write_arm(name, Path(folder))
            for task in TASKS if arguments.task == "both" else (arguments.task,):
                problems = make_problems(arm, task, arguments.count, arguments.seed)
                found, known = compare(arm, problems, pythons, arguments.rounds, arguments.budget)
                versions.update({key: those for key, those in known.items() if those})
                rows += found
                print(f"\n{as_text(found)}", flush=True)
    packages = {f"{package} {version}" for those in versions.values() for package, version in those.items()}
    print("\n# " + ", ".join(sorted(packages)))
    if arguments.json:
        text = json.dumps({"schema": 1, **about, "versions": versions, "rows": as_json(rows)}, indent=2)
        arguments.json.write_text(text + "\n", encoding="utf-8")


def _arguments() -> argparse.Namespace:
    keys = [peer.key for peer in PEERS]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robots", type=_names(list(ARMS)), default=list(ARMS), help=f"of {','.join(ARMS)}")
    parser.add_argument("--peers", type=_names(keys), default=keys, help=f"of {','.join(keys)}")
    parser.add_argument("--methods", type=_names(["pinv", "jt", "ccd"]), default=[], help="further rows of pinik's")
    parser.add_argument("--task", choices=[*TASKS, "both"], default="both")
    parser.add_argument("--count", type=_positive(int), default=1000, help="targets per robot and task")
    parser.add_argument("--rounds", type=_positive(int), default=20, help="turns that the peers take")
    parser.add_argument("--budget", type=_positive(float), default=20.0, help="seconds per peer, robot and task")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all figures there, too")
    return parser.parse_args()


def _names(known: list[str]) -> Any:
    def read(text: str) -> list[str]:
        names = text.split(",")
        for name in names:
            if name not in known:
                raise argparse.ArgumentTypeError(f"{name!r} is none of {', '.join(known)}")
        return names

    return read


def _positive(kind: type) -> Any:
    def read(text: str) -> Any:
        value = kind(text)
        if not value > 0 or not np.isfinite(value):
            raise argparse.ArgumentTypeError(f"{text} is not positive")
        return value

    return read


def _chosen_peers(arguments: argparse.Namespace) -> list[Peer]:
    chosen = [peer for peer in PEERS if peer.key in arguments.peers]
    return [*chosen, *map(pinik_by, arguments.methods)]


def _python_or_reason(peer: Peer) -> Path | str:
    try:
        return python_with(peer.requirements, peer.key)
    except CannotInstallError as error:
        return f"cannot be installed: {_one_line(error)}"


def _one_line(words: object) -> str:
    return textwrap.shorten(str(words), 200, placeholder=" …")


def _processor() -> str:
    """The processor's name, as far as the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


if __name__ == "__main__":
    main()
