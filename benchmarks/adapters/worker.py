"""Runs one adapter inside its peer's environment; speaks JSON lines with `comparison.workers` over pipes.

    python worker.py ADAPTER_FILE CLASS

Requests: {"load": arm, "options": …, "packages": […], "core": …, "warm_up": […]} once, then {"solve": targets,
"starts": …, "seconds": …} again and again; with "carry" each start is the last answer, and "starts" has the first one
or is null. Arrays travel as `wire` packs them.
"""

from __future__ import annotations

import contextlib
import gc
import importlib.metadata
import importlib.util
import json
import os
import sys
import time
from typing import Any, TextIO

import numpy as np
from wire import pack, unpack


def main() -> None:
    """Answer requests until the pipe closes."""
    replies = _own_stdout()
    # The folder of this file comes first in sys.path, and holds no module that anybody should find.
    sys.path.pop(0)
    worker = Worker(*sys.argv[1:])
    for line in sys.stdin:
        request = json.loads(line)
        try:
            reply = worker.load(**request) if "load" in request else worker.solve(**request)
        except Exception as error:
            reply = {"error": f"{type(error).__name__}: {error}"}
        replies.write(json.dumps(reply) + "\n")
        replies.flush()


class Worker:
    """An adapter at work."""

    def __init__(self, adapter_file: str, class_name: str) -> None:
        self._file, self._class = adapter_file, class_name
        self._adapter: Any = None
        self._warm_up: list[tuple[np.ndarray, np.ndarray]] = []
        self._last: np.ndarray = np.empty(0)
        self._lower = self._upper = np.empty(0)

    def load(
        self, load: dict[str, Any], options: dict[str, Any], packages: list[str], core: int | None, warm_up: list[Any]
    ) -> dict[str, Any]:
        """Stay on one core if there is one given, make the adapter, and let it solve a few problems."""
        if core is not None:
            os.sched_setaffinity(0, {core})
        specification = importlib.util.spec_from_file_location("adapter", self._file)
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
        self._adapter = getattr(module, self._class)(load, **options)
        self._lower, self._upper = np.array(load["lower"]), np.array(load["upper"])
        self._warm_up = list(zip(*map(unpack, warm_up), strict=True))
        self._run_warm_up(seconds=2.0)
        return {"versions": {package: importlib.metadata.version(package) for package in packages}}

    def solve(
        self, solve: dict[str, Any], starts: dict[str, Any] | None, seconds: float, carry: bool = False
    ) -> dict[str, Any]:
        """Solve as many of the targets as the time allows, at least one; a batch is solved whole.

        The times are those of the single targets [ns], none where a batch reports none, and of all together. An
        answer that is none is a row of NaN.
        """
        targets, first = unpack(solve), None if starts is None else unpack(starts)
        if first is not None:
            self._last = first[0]
        gc.collect()
        gc.disable()
        try:
            self._run_warm_up(seconds=0.02)
            if hasattr(self._adapter, "solve_all"):
                return self._solve_batch(targets, first)
            return self._solve_one_by_one(targets, None if carry else first, seconds)
        finally:
            gc.enable()

    def _solve_one_by_one(self, matrices: np.ndarray, starts: np.ndarray | None, seconds: float) -> dict[str, Any]:
        adapter, clock = self._adapter, time.perf_counter_ns
        answers, nanoseconds, errors, wall = [], [], [], 0
        for number, matrix in enumerate(matrices):
            target = adapter.target(matrix)
            start = adapter.start(self._last.copy() if starts is None else starts[number])
            answer = solved = None
            began = clock()
            try:
                solved = adapter.solve(target, start)
            except Exception as error:
                errors.append(f"{type(error).__name__}: {error}")
            nanoseconds.append(clock() - began)
            wall += nanoseconds[-1]
            if solved is not None:
                answer = adapter.answer(solved)
            answers.append(np.full(len(self._last), np.nan) if answer is None else np.array(answer, dtype=np.float64))
            if starts is None and np.isfinite(answers[-1]).all():
                self._last = np.clip(answers[-1], self._lower, self._upper)
            if wall > 1e9 * seconds:
                break
        return {"answers": pack(answers), "nanoseconds": nanoseconds, "wall": wall, "errors": errors[:1]}

    def _solve_batch(self, matrices: np.ndarray, starts: np.ndarray) -> dict[str, Any]:
        adapter = self._adapter
        targets, first = adapter.targets(matrices), adapter.starts(starts)
        began = time.perf_counter_ns()
        solved = adapter.solve_all(targets, first)
        wall = time.perf_counter_ns() - began
        answers, seconds = adapter.answers(solved)
        nanoseconds = [] if seconds is None else [int(1e9 * value) for value in seconds]
        return {"answers": pack(answers), "nanoseconds": nanoseconds, "wall": wall, "errors": []}

    def _run_warm_up(self, seconds: float) -> None:
        adapter, until = self._adapter, time.perf_counter() + seconds
        if hasattr(adapter, "solve_all"):
            targets, starts = zip(*self._warm_up, strict=True)
            adapter.solve_all(adapter.targets(np.array(targets)), adapter.starts(np.array(starts)))
            return
        for target, start in self._warm_up:
            # One that fails here is of no concern; those that count are counted.
            with contextlib.suppress(Exception):
                adapter.solve(adapter.target(target), adapter.start(start))
            if time.perf_counter() > until:
                break


def _own_stdout() -> TextIO:
    """The pipe to the parent; whatever a peer prints goes to stderr instead."""
    pipe = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    return pipe


if __name__ == "__main__":
    main()
