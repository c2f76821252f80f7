"""A job without robots for the tests of `pinik.scale.jobs`: chunk k is a text about k, slowly made."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from pinik.scale.jobs.job import Job, Pause, Result
from pinik.scale.jobs.parts import Parts


@dataclass(frozen=True)
class Work:
    """Chunk k, and a line in the file `log` for each chunk that was worked on."""

    log: Path | None = None
    seconds: float = 0.0
    fails_at: int = -1

    def __call__(self, payload: int, pause: Pause) -> Result:
        if payload == self.fails_at:
            raise ValueError(f"chunk {payload} is no good")
        until = time.monotonic() + self.seconds
        while time.monotonic() < until:
            pause()
            time.sleep(0.001)
        if self.log is not None:
            with open(self.log, "a") as file:
                file.write(f"{payload} {os.getpid()}\n")
        return Result(expected(payload), {"rows": payload, "odd": payload % 2})


def expected(number: int) -> bytes:
    return f"chunk {number}\n".encode() * (number % 3 + 1)


def toy(chunks: int, work: Work | None = None, **fingerprint: object) -> Job:
    return Job({"seed": 0, **fingerprint}, chunks, lambda number: number, work or Work())


def whole(chunks: int) -> bytes:
    return b"".join(map(expected, range(chunks)))


def join(parts: Parts, file: BinaryIO) -> None:
    for content in parts:
        file.write(content)
