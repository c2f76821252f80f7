"""Processes that judge inputs one after the other; one that crashes or hangs is told apart and replaced."""

from __future__ import annotations

import contextlib
import functools
import multiprocessing
import os
import shutil
import tempfile
from collections.abc import Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from random import Random

from .corpus import robots
from .document import Node
from .mutations import Case, mutated
from .outcome import Outcome
from .sandbox import Sandbox

__all__ = ["PATIENCE", "Worker", "case_of"]

PATIENCE = 5.0  # [s] of processor time that an input may take
MACHINE = 120  # times as long may pass on a busy machine
START = 300.0  # [s]


def case_of(seed: int, index: int) -> Case:
    """The input with this number."""
    return mutated(Random(f"{seed}/{index}"), _robots())


@functools.cache
def _robots() -> list[Node]:
    return robots()


class Worker:
    """A process that judges inputs."""

    def __init__(self) -> None:
        memory = Path("/dev/shm")
        self._folder = Path(tempfile.mkdtemp(prefix="pinik-attack-", dir=memory if memory.is_dir() else None))
        self._sandbox = Sandbox(self._folder)
        self._start()

    @property
    def process_id(self) -> int:
        """The process that judges the next input."""
        assert self._process.pid is not None
        return self._process.pid

    def judged(self, case: Case) -> Outcome:
        """What became of one input."""
        with contextlib.suppress(ConnectionError):  # the process has ended, as the lack of an answer will tell
            self._pipe.send(case)
        return self._answer()

    def judged_range(self, seed: int, numbers: range) -> Iterator[tuple[int, Outcome]]:
        """Number and outcome of each input with one of these numbers."""
        while numbers:
            self._pipe.send((seed, numbers))
            for number in numbers:
                outcome = self._answer()
                yield number, outcome
                if outcome.kind in ("crashed", "hung"):
                    numbers = numbers[numbers.index(number) + 1 :]
                    break
            else:
                return

    def close(self) -> None:
        """End the process and remove its folder."""
        self._process.kill()
        self._process.join()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(theirs, self._sandbox), daemon=True)
        self._process.start()
        theirs.close()
        if not self._pipe.poll(START):
            raise TimeoutError("a worker did not start")
        self._pipe.recv()

    def _answer(self) -> Outcome:
        waited = 0
        try:
            if not self._pipe.poll(PATIENCE * MACHINE):
                return self._replaced("hung", "the input was not even made")
            self._pipe.recv()  # it is made, which may take longer than reading it
            before = self._processor_time()
            while not self._pipe.poll(PATIENCE):
                waited += 1
                if self._processor_time() - before >= PATIENCE or waited >= MACHINE:
                    return self._replaced("hung", f"no answer after {PATIENCE:g} s")
            return self._pipe.recv()
        except (EOFError, ConnectionError):
            self._process.join(PATIENCE)
            return self._replaced("crashed", f"the process ended with {self._process.exitcode}")

    def _processor_time(self) -> float:
        try:
            fields = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()
        except OSError:
            return 0.0
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def _replaced(self, kind: str, words: str) -> Outcome:
        self._process.kill()
        self._process.join()
        self._start()
        return Outcome(kind, words, kind)


def _serve(pipe: Connection, sandbox: Sandbox) -> None:
    silent = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silent, 1)  # Pinocchio prints what it thinks of a file
    os.dup2(silent, 2)
    from .judge import Judge

    _robots()
    judge = Judge(sandbox)
    pipe.send("ready")
    while True:
        try:
            asked = pipe.recv()
        except EOFError:
            return
        cases = [asked] if isinstance(asked, Case) else (case_of(asked[0], number) for number in asked[1])
        for case in cases:
            pipe.send("made")
            pipe.send(judge(case))
