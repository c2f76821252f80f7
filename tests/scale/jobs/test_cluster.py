"""Jobs on Dask: the bytes of this process, with a worker killed in the middle; unfit workers are named in words."""

from __future__ import annotations

import os
import signal

import pytest
from distributed import Client, LocalCluster

from pinik import InputError
from pinik.scale.jobs import fingerprint
from pinik.scale.jobs.cluster import Cluster, ClusterError
from pinik.scale.jobs.run import run
from toy_jobs import Work, join, toy, whole

pytestmark = pytest.mark.filterwarnings("ignore")  # of libraries, in threads that Dask ends


@pytest.fixture(scope="module")
def local():
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        yield cluster


def test_a_lost_workers_chunks_are_done_again(tmp_path, local):
    log = tmp_path / "log"
    killed: list[int] = []

    def kill_one(tally):
        if tally.finished >= 5 and not killed:
            killed.append(int(log.read_text().split()[-1]))
            os.kill(killed[0], signal.SIGKILL)

    job = toy(40, Work(log, 0.02))
    tally = run(job, tmp_path / "out", join, Cluster(scheduler=local.scheduler_address), on_progress=kill_one)
    assert (tmp_path / "out").read_bytes() == whole(40)
    assert (tally.finished, tally.notes["rows"]) == (40, sum(range(40)))
    workers = {int(line.split()[1]) for line in log.read_text().splitlines()}
    assert len(killed) == 1
    assert os.getpid() not in workers
    assert len(workers) >= 2, "others went on"


def test_a_failing_chunk_is_the_error_that_it_was(tmp_path, local):
    with pytest.raises(ValueError, match="chunk 3 is no good"):
        run(toy(8, Work(fails_at=3)), tmp_path / "out", join, Cluster(scheduler=local.scheduler_address))


def test_workers_of_another_version_are_refused_before_any_work(tmp_path, local, monkeypatch):
    with Client(local, set_as_default=False) as client:
        worker = next(iter(client.nthreads()))
    ours = dict(fingerprint.versions()) | {"pinik": "9.9"}
    monkeypatch.setattr("pinik.scale.jobs.cluster.versions", lambda: ours)
    log = tmp_path / "log"
    with pytest.raises(ClusterError) as raised:
        run(toy(4, Work(log)), tmp_path / "out", join, Cluster(scheduler=local.scheduler_address))
    assert f"{worker}: it has pinik 0.1.0 instead of 9.9" in str(raised.value)
    assert not log.exists()


def test_a_scheduler_that_is_not_there_is_said_in_words(tmp_path, monkeypatch):
    monkeypatch.setattr("pinik.scale.jobs.cluster._SECONDS_TO_CONNECT", 0.3)
    with pytest.raises(ClusterError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9"):
        run(toy(1), tmp_path / "out", join, Cluster(scheduler="tcp://127.0.0.1:9"))


@pytest.mark.parametrize("given", [{}, {"scheduler": "tcp://h:1", "workers": 2}, {"workers": 0}])
def test_a_cluster_is_a_scheduler_or_a_number_of_workers(given):
    with pytest.raises(InputError):
        Cluster(**given)
