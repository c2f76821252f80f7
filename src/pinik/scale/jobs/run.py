"""Run a job: to a file that appears once it is whole, or as a stream."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from .job import Deliver, Job, Result, Runner, Tally
from .parts import Parts, parts_folder

__all__ = ["OnProgress", "run", "stream"]

OnProgress = Callable[[Tally], None]
"""Called after each finished chunk, in any thread, but one call at a time; and once at the beginning."""


def run(
    job: Job,
    output: Path,
    assemble: Callable[[Parts, BinaryIO], None],
    runner: Runner,
    *,
    resume: bool = False,
    on_progress: OnProgress | None = None,
) -> Tally:
    """Work on all chunks that are not finished yet, and write the output from them.

    Until the output is whole, finished chunks are kept in the folder OUTPUT.parts. If the run ends early, in whatever
    way, another one with `resume` goes on with them: it repeats none, and the output has the same bytes.

    Args:
        job: The job.
        output: The file to write; one that exists is replaced when the new one is whole.
        assemble: Writes the output from the finished chunks.
        runner: Where to work.
        resume: Whether to go on with an earlier run, if there is one.
        on_progress: Is told how far the job is.

    Returns:
        The tally of all chunks, those of an earlier run included.

    Raises:
        InputError: The folder of an earlier run is there, and it is not to be resumed or is one of another job.
        OSError: Something cannot be written, for example because the disk is full.
    """
    with Parts(parts_folder(output), job, resume=resume) as parts:
        if parts.done is not None and output.exists():
            tally = Tally(**parts.done)
            parts.remove()
            return tally
        tally = Tally(job.chunks)
        for notes in parts.finished.values():
            tally.add(notes, resumed=True)
        missing = [number for number in range(job.chunks) if number not in parts.finished]
        runner.run(job, missing, _counting(parts.write, tally, on_progress))
        with open(parts.unpublished, "wb") as file:
            assemble(parts, file)
            file.flush()
            os.fsync(file.fileno())
        whole = {"chunks": tally.chunks, "finished": tally.chunks, "resumed": tally.chunks}
        parts.publish(output, whole | {"notes": tally.notes, "earlier": tally.notes})
        parts.remove()
    return tally


def stream(job: Job, put: Callable[[bytes], None], runner: Runner, *, on_progress: OnProgress | None = None) -> Tally:
    """Work on all chunks, and hand their contents on in order as soon as possible.

    Args:
        job: The job.
        put: Takes the content of the next chunk, in any thread, one call at a time.
        runner: Where to work. It works on few chunks at a time, and so few have to wait for those before them.
        on_progress: Is told how far the job is.
    """
    tally = Tally(job.chunks)
    lock = threading.Lock()
    early: dict[int, bytes] = {}
    following = 0

    def hand_on(number: int, result: Result) -> None:
        nonlocal following
        with lock:
            early[number] = result.content
            while following in early:
                put(early.pop(following))
                following += 1

    runner.run(job, range(job.chunks), _counting(hand_on, tally, on_progress))
    return tally


def _counting(deliver: Deliver, tally: Tally, on_progress: OnProgress | None) -> Deliver:
    """Deliver, count and tell."""
    telling = threading.Lock()
    if on_progress is not None:
        on_progress(tally)

    def counted(number: int, result: Result) -> None:
        deliver(number, result)
        tally.add(result.notes)
        if on_progress is not None:
            with telling:
                on_progress(tally)

    return counted
