"""The attack guided by coverage: atheris chooses the inputs, and keeps those that reach new branches of pinik."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from pathlib import Path
from random import Random

import atheris

from .report import Report

__all__ = ["attack"]


class _Guided(Random):
    """Random numbers that are read from the bytes which atheris chose; always the same ones after their end."""

    def __init__(self, data: bytes) -> None:
        self._bytes = atheris.FuzzedDataProvider(data)
        self._rest = Random(0)
        super().__init__(0)

    def random(self) -> float:
        return self.getrandbits(53) * 2.0**-53  # ConsumeProbability may return 1.0

    def getrandbits(self, k: int, /) -> int:
        if not self._bytes.remaining_bytes():
            return self._rest.getrandbits(k)
        return int(self._bytes.ConsumeUInt((k + 7) // 8)) & ((1 << k) - 1)

    def seed(self, *_: object, **__: object) -> None:
        """There is nothing to seed."""


def attack(count: int, seed: int, minutes: float, report: Report) -> None:
    """Attack with `count` inputs, or for so many minutes; does not return.

    Args:
        count: The number of inputs.
        seed: The seed of atheris.
        minutes: The time after which it ends.
        report: Counts the outcomes.
    """
    with atheris.instrument_imports(include=["pinik.description", "pinik.model", "pinik.shapes", "pinik.loading"]):
        from .corpus import robots
        from .judge import Judge
    from .mutations import mutated
    from .sandbox import Sandbox

    known = robots()
    folder = Path(tempfile.mkdtemp(prefix="pinik-attack-"))
    judge = Judge(Sandbox(folder))
    number = 0

    def one(data: bytes) -> None:
        nonlocal number
        number += 1
        case = mutated(_Guided(data), known)
        outcome = judge(case)
        if report.is_new(outcome):
            report.keep(number, case, outcome)
        if number == count or report.minutes > minutes:
            print(report, flush=True)
            shutil.rmtree(folder, ignore_errors=True)
            os._exit(1 if report.faults else 0)  # atheris ends the process without Python's own clean-up

    # If an input takes too long or too much memory, libFuzzer ends the process, and names the file with its bytes.
    limits = [
        f"-runs={count}",
        f"-seed={seed + 1}",
        "-timeout=10",
        "-rss_limit_mb=4096",
        "-max_len=400",
        "-len_control=0",
    ]
    atheris.Setup([sys.argv[0], *limits, "-verbosity=0", f"-artifact_prefix={folder}/"], one)
    atheris.Fuzz()
