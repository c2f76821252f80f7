"""Chunks as tasks of a Dask cluster: one that runs somewhere, or one that is started on this machine for the job."""

from __future__ import annotations

import contextlib
import functools
import logging
import pickle
import queue
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ...checks import as_count
from ...errors import InputError, PinikError
from ...extras import needed_by
from .fingerprint import versions
from .job import Deliver, Job, Result, Work, never_pause

__all__ = ["Cluster", "ClusterError"]

_TASKS_PER_THREAD = 3  # under way at once: one that runs, and others that need not wait for this process
_AHEAD = 64
_SECONDS_TO_CONNECT = 30
_MOST_SHOWN = 3


class ClusterError(PinikError, RuntimeError):
    """A Dask cluster cannot be used: it does not answer, or its workers are not fit for the job."""


@dataclass(frozen=True)
class Cluster:
    """Works on chunks as tasks of Dask. If a worker is lost, Dask has its chunks worked on again by the others.

    Attributes:
        scheduler: The address of a scheduler that runs, such as "tcp://10.0.0.1:8786".
        workers: The number of worker processes of a cluster on this machine, which lasts as long as the job.
    """

    scheduler: str | None = None
    workers: int | None = None

    def __post_init__(self) -> None:
        """Check that one of both is given."""
        if (self.scheduler is None) == (self.workers is None):
            raise InputError("give the address of a scheduler, or a number of workers, and not both")
        if self.workers is not None:
            as_count(self.workers, "workers")

    def run(self, job: Job, numbers: Iterable[int], deliver: Deliver) -> None:
        """As `Runner.run`.

        Raises:
            MissingExtraError: dask and distributed are not installed.
            ClusterError: The scheduler does not answer, it has no workers, or a worker has another version of
                something; the message names the worker.
        """
        with needed_by("a Dask cluster", "cluster"):
            import cloudpickle
            import distributed
        with self._client(distributed) as client:
            threads = _checked(client)
            tasks = _Tasks(distributed, client, job, cloudpickle.dumps(job.work), threads * _TASKS_PER_THREAD)
            tasks.run(numbers, deliver)

    @contextlib.contextmanager
    def _client(self, distributed: Any) -> Iterator[Any]:
        if self.scheduler is not None:
            try:
                client = distributed.Client(self.scheduler, timeout=_SECONDS_TO_CONNECT, set_as_default=False)
            except (OSError, ValueError, TypeError) as error:
                raise ClusterError(f"no Dask scheduler answers at {self.scheduler}: {error}") from None
            with client:
                yield client
            return
        with (
            distributed.LocalCluster(
                n_workers=self.workers,
                threads_per_worker=1,
                dashboard_address=None,
                memory_limit=0,
                silence_logs=logging.CRITICAL,  # what fails is raised here
            ) as cluster,
            distributed.Client(cluster, set_as_default=False) as client,
        ):
            yield client


class _Tasks:
    """The chunks that are under way as tasks, at most `most` at once."""

    def __init__(self, distributed: Any, client: Any, job: Job, work: bytes, most: int) -> None:
        self._killed = distributed.KilledWorker
        self._finished: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._client, self._job, self._work, self._most = client, job, work, most
        self._under_way: dict[Any, tuple[int, int]] = {}  # task → the chunk's place in the order, and its number

    def run(self, numbers: Iterable[int], deliver: Deliver) -> None:
        """Work on all chunks, and deliver them."""
        waiting = enumerate(numbers)
        upcoming = next(waiting, None)
        try:
            while upcoming is not None or self._under_way:
                while upcoming is not None and self._has_room(upcoming[0]):
                    self._begin(*upcoming)
                    upcoming = next(waiting, None)
                future = self._finished.get()
                _, number = self._under_way.pop(future)
                deliver(number, self._result(future, number))
        finally:
            self._client.cancel(list(self._under_way))

    def _has_room(self, place: int) -> bool:
        """Whether the next chunk may begin: not too many are under way, or finished before an earlier one."""
        first = min((own for own, _ in self._under_way.values()), default=place)
        return len(self._under_way) < self._most and place - first < _AHEAD + self._most

    def _begin(self, place: int, number: int) -> None:
        payload = self._job.payload(number)
        future = self._client.submit(_task, self._work, payload, versions(), pure=False)
        self._under_way[future] = place, number
        future.add_done_callback(self._finished.put)

    def _result(self, future: Any, number: int) -> Result:
        try:
            result: Result = future.result()
        except self._killed as error:
            raise ClusterError(f"chunk {number} ended each worker that worked on it: {error}") from None
        return result


def _task(work: bytes, payload: Any, expected: Mapping[str, str]) -> Result:
    """Work on one chunk; in a worker."""
    differing = _differing(expected, versions())
    if differing:  # of a worker that has joined since the others were checked
        raise ClusterError(f"a worker differs from the process that runs the job: {differing}")
    result: Result = _loaded(work)(payload, never_pause)
    return result


@functools.lru_cache(maxsize=1)
def _loaded(work: bytes) -> Work:
    """The work of a job, which a worker unpacks once."""
    unpacked: Work = pickle.loads(work)
    return unpacked


def _versions_here() -> dict[str, str]:
    """The versions in a worker."""
    return versions()


def _differing(expected: Mapping[str, str], found: Mapping[str, str]) -> str:
    """The versions that are not as expected, in words."""
    return ", ".join(
        f"it has {name} {found.get(name, 'none')} instead of {version}"
        for name, version in expected.items()
        if found.get(name) != version
    )


def _checked(client: Any) -> int:
    """The number of threads of all workers, once each of them has the versions of this process."""
    answers = client.run(_versions_here, on_error="return")
    if not answers:
        raise ClusterError("the Dask scheduler has no workers yet; start some with 'dask worker ADDRESS'")
    faults = []
    for worker, found in answers.items():
        if isinstance(found, BaseException):
            faults.append(f"{worker}: it cannot run pinik: {found}")
        elif differing := _differing(versions(), found):
            faults.append(f"{worker}: {differing}")
    if faults:
        more = f"; and {len(faults) - _MOST_SHOWN} more" if len(faults) > _MOST_SHOWN else ""
        raise ClusterError(
            "the answers of these workers could differ, so install the same versions on all machines: "
            f"{'; '.join(faults[:_MOST_SHOWN])}{more}"
        )
    return sum(client.nthreads().values())
