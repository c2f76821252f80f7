"""Maps are the same bytes however the work is cut, interrupted, resumed or distributed."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import pinik
from pinik.scale.jobs.threads import Threads
from pinik.solving.sampling import Sampler, uniform_rows
from pinik.workspace import plan as plans
from pinik.workspace.run import run_plan

FRAME = "tool0"
SAMPLED = {"cell": 0.2, "samples": 30_000, "directions": 12, "rolls": 4}
SOLVED = {"by": "solving", "cell": 0.2, "directions": 6, "rolls": 2, "box": [(0.2, -0.3, 0.1), (0.8, 0.3, 0.5)]}


@pytest.fixture(autouse=True)
def small_parts(monkeypatch):
    monkeypatch.setattr(plans, "_SAMPLES_OF_A_PART", 2**12)
    monkeypatch.setattr(plans, "_POSES_OF_A_PART", 48)


class StoppedError(Exception):
    pass


def interrupt_after(parts):
    def tell(tally):
        if tally.finished - tally.resumed >= parts:
            raise StoppedError

    return tell


@pytest.mark.parametrize("options", [SAMPLED, SOLVED], ids=["sampling", "solving"])
def test_an_interrupted_map_resumes_to_the_same_bytes(ur5, options, tmp_path):
    whole = tmp_path / "whole.npz"
    pinik.reach(ur5, FRAME, output=whole, **options)
    assert [path.name for path in tmp_path.iterdir()] == ["whole.npz"]
    part = tmp_path / "part.npz"
    for _ in range(2):
        with pytest.raises(StoppedError):
            pinik.reach(ur5, FRAME, output=part, resume=True, on_progress=interrupt_after(2), **options)
        assert not part.exists()
    with pytest.raises(pinik.InputError, match="--resume"):
        pinik.reach(ur5, FRAME, output=part, **options)
    with pytest.raises(pinik.InputError, match=r"options\.seed was 0 and is 1"):
        pinik.reach(ur5, FRAME, output=part, resume=True, seed=1, **options)
    told = []
    resumed = pinik.reach(
        ur5, FRAME, output=part, resume=True, on_progress=lambda tally: told.append(tally.resumed), **options
    )
    assert max(told) >= 4
    assert part.read_bytes() == whole.read_bytes()
    assert str(resumed) == str(pinik.ReachMap.load(whole))


@pytest.mark.parametrize("options", [SAMPLED, SOLVED], ids=["sampling", "solving"])
def test_the_number_of_threads_changes_nothing(ur5, options):
    one = pinik.reach(ur5, FRAME, **options)
    plan = plans.Plan(
        ur5,
        pinik.Target(FRAME, (0.0, 0.0, 0.0)),
        one.grid,
        one.orientations,
        one.samples,
        False,
        ur5.neutral(),
        pinik.Options.of("dls", restarts=16, max_iterations=20, polish=False),
        plans.size_of_parts(one.samples, len(one.orientations)),
    )
    assert plan.parts > 4
    for threads in (1, 3):
        assert run_plan(plan, Threads(threads)).to_bytes() == one.counts.to_bytes()
    again = pickle.loads(pickle.dumps(plan))
    assert again.fingerprint == plan.fingerprint
    assert run_plan(again, Threads(1)).to_bytes() == one.counts.to_bytes()


@pytest.mark.filterwarnings("ignore")  # of libraries, in threads that Dask ends
def test_workers_find_the_same(ur5):
    told = []
    here = pinik.reach(ur5, FRAME, **SAMPLED)
    there = pinik.reach(ur5, FRAME, workers=2, on_progress=lambda tally: told.append(tally.finished), **SAMPLED)
    assert here.counts.to_bytes() == there.counts.to_bytes()
    assert told == list(range(9))


def test_random_numbers_do_not_depend_on_how_many_are_drawn():
    whole = uniform_rows(3, 0, 1000, 4)
    parts = np.hstack([uniform_rows(3, 0, 137, 4), uniform_rows(3, 137, 863, 4)])
    np.testing.assert_array_equal(whole, parts)
    assert (whole != uniform_rows(4, 0, 1000, 4)).all()
    many = uniform_rows(0, 10**12, 50_000, 3)
    assert np.abs(many.mean(axis=1) - 0.5).max() < 0.01
    assert np.abs(np.corrcoef(many) - np.eye(3)).max() < 0.02
    counts = np.bincount((many[0] * 50).astype(int), minlength=50)
    assert ((counts - 1000) ** 2 / 1000).sum() < 95  # χ² with 49 degrees of freedom: 1 in 10,000


def test_samples_are_inside_the_limits_and_move_only_the_chain(tiago):
    frame = "arm_tool_link"
    start = tiago.random(3)
    sampler = Sampler(tiago, pinik.Target(frame, (0.0, 0.0, 0.0)), start)
    q = sampler.configurations(0, 500)
    assert (q >= tiago.lower_q - 1e-12).all()
    assert (q <= tiago.upper_q + 1e-12).all()
    tiago.check_configurations(q)
    moving = np.ptp(q, axis=0) > 0
    names = {joint.name for joint in tiago.joints if moving[joint.idx_q]}
    assert "arm_1_joint" in names
    assert not {name for name in names if "head" in name or "wheel" in name}
    place = tiago.placement(frame, q[7])
    np.testing.assert_allclose(sampler.placements(q)[7], place.homogeneous, atol=1e-12)
