"""The choice of where a job is worked on: threads of this process, or a Dask cluster."""

from __future__ import annotations

from ...checks import as_count
from ...errors import InputError
from .cluster import Cluster
from .job import Runner
from .threads import Threads

__all__ = ["runner_of"]


def runner_of(workers: int | None, scheduler: str | None, threads: int | None = None) -> Runner:
    """Where to work.

    Args:
        workers: The number of worker processes of a Dask cluster on this machine.
        scheduler: The address of the scheduler of a Dask cluster.
        threads: The number of threads if neither is given; one for each processor available to this process when None.

    Raises:
        InputError: A number is not one, or more than one place is given.
    """
    if workers is None and scheduler is None:
        return Threads() if threads is None else Threads(as_count(threads, "threads"))
    if threads is not None:
        raise InputError("is for this process; it does not go with workers or a scheduler", argument="threads")
    return Cluster(scheduler, workers)
