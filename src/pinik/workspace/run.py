"""A plan as a job: in this process or on a cluster, and with a file that it can be resumed to."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO

from ..scale.jobs.fingerprint import versions
from ..scale.jobs.job import Job, Pause, Result, Runner
from ..scale.jobs.parts import Parts
from ..scale.jobs.run import OnProgress, run, stream
from .by_sampling import sample_part
from .by_solving import SolvedParts
from .counts import Counts
from .plan import Plan

__all__ = ["run_plan", "run_plan_to"]


class _Work:
    """Does parts of a plan, in several threads."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._local = threading.local()

    def __reduce__(self) -> tuple[Any, ...]:
        return _Work, (self._plan,)

    def __call__(self, part: int, pause: Pause) -> Result:
        counts = self._counts(part, pause)
        return Result(counts.to_bytes(), {"found": int(counts.found.sum())})

    def _counts(self, part: int, pause: Pause) -> Counts:
        if self._plan.samples:
            return sample_part(self._plan, part, pause)
        if not hasattr(self._local, "solved"):
            self._local.solved = SolvedParts(self._plan)
        solved: SolvedParts = self._local.solved
        return solved(part, pause)


def job_of(plan: Plan) -> Job:
    """The plan as a job, whose chunks are its parts."""
    return Job({**plan.fingerprint, "versions": versions()}, plan.parts, lambda part: part, _Work(plan))


def run_plan(plan: Plan, runner: Runner, on_progress: OnProgress | None = None) -> Counts:
    """Do all parts of a plan, and return what they found.

    Raises:
        ClusterError: The cluster cannot be used.
    """
    counts, orientations = plan.empty(), len(plan.orientations)
    stream(
        job_of(plan),
        lambda content: counts.merge(Counts.from_bytes(content, orientations)),
        runner,
        on_progress=on_progress,
    )
    return counts


def run_plan_to(
    plan: Plan,
    output: Path,
    write: Callable[[Counts], bytes],
    runner: Runner,
    *,
    resume: bool = False,
    on_progress: OnProgress | None = None,
) -> Counts | None:
    """Do all parts of a plan, and write a file, which appears when it is whole.

    Args:
        plan: The plan.
        output: The file. What is finished before it is whole is kept in the folder OUTPUT.parts.
        write: Makes the content of the file.
        runner: Where to work.
        resume: Whether to go on with an earlier run.
        on_progress: Is told how far the job is.

    Returns:
        What was found; None if the file of the earlier run was whole already.

    Raises:
        InputError, OSError, ClusterError: As `scale.jobs.run.run`.
    """
    whole: list[Counts] = []

    def assemble(parts: Parts, file: BinaryIO) -> None:
        counts = plan.empty()
        for content in parts:
            counts.merge(Counts.from_bytes(content, len(plan.orientations)))
        whole.append(counts)
        file.write(write(counts))

    run(job_of(plan), output, assemble, runner, resume=resume, on_progress=on_progress)
    return whole[0] if whole else None
