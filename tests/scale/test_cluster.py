"""`pinik.batch.run` on a Dask cluster: the bytes of this process, with a worker killed in the middle."""

from __future__ import annotations

import os
import signal

import numpy as np
import pytest
from distributed import Client, LocalCluster

import pinik
from pinik import InputError
from pinik.scale.jobs.parts import parts_folder

pytestmark = pytest.mark.filterwarnings("ignore")  # of libraries, in threads that Dask ends

TIP = "panda_hand_tcp"


def test_a_cluster_that_loses_a_worker_writes_the_same_bytes_and_can_be_resumed_without_one(panda, tmp_path):
    rng = np.random.default_rng(11)
    points = np.array([panda.placement(TIP, panda.random(rng)).translation for _ in range(600)])
    path = tmp_path / "poses.csv"
    path.write_text("x,y,z\n" + "\n".join(",".join(map(repr, point)) for point in points.tolist()))
    given = {"targets": path, "frame": TIP, "chunk": 10, "seed": 4}
    pinik.batch.run(panda, output=tmp_path / "here.csv", **given)
    expected = (tmp_path / "here.csv").read_bytes()
    killed: list[int] = []
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        scheduler = cluster.scheduler_address
        victim = next(iter(client.run(os.getpid).values()))

        def kill_one(tally, rows):
            if tally.finished == 8:
                killed.append(victim)
                os.kill(victim, signal.SIGKILL)

        def interrupt(tally, rows):
            if tally.finished == 5:
                raise KeyboardInterrupt

        there = tmp_path / "there.csv"
        summary = pinik.batch.run(panda, output=there, scheduler=scheduler, on_progress=kill_one, **given)
        assert killed == [victim]
        assert (summary.rows, there.read_bytes()) == (600, expected)
        begun = tmp_path / "begun.csv"
        with pytest.raises(KeyboardInterrupt):
            pinik.batch.run(panda, output=begun, scheduler=scheduler, on_progress=interrupt, **given)
    assert any(parts_folder(begun).glob("*.part"))
    with pytest.raises(InputError, match=r"options\.seed was 4 and is 5"):
        pinik.batch.run(panda, output=begun, resume=True, **given | {"seed": 5})
    assert pinik.batch.run(panda, output=begun, resume=True, **given).resumed >= 40
    assert begun.read_bytes() == expected
