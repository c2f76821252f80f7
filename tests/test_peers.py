"""What `benchmarks/peers.py` does with its peers, and what it writes about them."""

from __future__ import annotations

import math
import sys
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from adapters.wire import pack, unpack
from comparison.arms import Arm, write_arm
from comparison.contestant import Contestant, compare
from comparison.machine import Yardstick
from comparison.markdown import BEGIN, END, as_markdown, replace_part
from comparison.peer import Peer
from comparison.peer_list import PEERS
from comparison.problems import TASKS, make_problems
from comparison.summary import batches_of, ratios_of
from comparison.tables import Row

ADAPTER = """
import numpy as np
import pinocchio


class Adapter:
    def __init__(self, arm, order=1, steps=20):
        self._model = pinocchio.buildModelFromUrdf(arm["chain"])
        self._data = self._model.createData()
        self._frame = self._model.getFrameId(arm["tip"])
        self._order, self._steps = order, steps

    def target(self, matrix):
        return pinocchio.SE3(matrix)

    def start(self, q):
        return q

    def solve(self, target, start):
        q = start
        for _ in range(self._steps):
            J = pinocchio.computeFrameJacobian(self._model, self._data, q, self._frame)
            pinocchio.framesForwardKinematics(self._model, self._data, q)
            q = q + np.linalg.pinv(J) @ pinocchio.log6(self._data.oMf[self._frame].inverse() * target).vector
        return q if self._steps else None

    def answer(self, solved):
        return solved[:: self._order]
"""


@pytest.fixture(scope="module")
def arm(tmp_path_factory) -> Arm:
    return write_arm("ur5", tmp_path_factory.mktemp("arms"))


@pytest.fixture
def peer(tmp_path) -> Peer:
    adapter = tmp_path / "adapter.py"
    adapter.write_text(ADAPTER)
    return Peer("mine", "mine", (str(adapter), "Adapter"), ())


def ran(arm, task, *peers):
    """The rows of peers with a few problems."""
    problems = make_problems(arm, task, 7, 0)
    pythons = [(each, Path(sys.executable)) for each in peers]
    rows, _ = compare(arm, problems, pythons, 3, 10.0, None, Yardstick(None))
    return rows


def test_poses_that_need_no_iteration_are_solved_and_timed_one_by_one(arm, peer):
    (row,) = ran(arm, "still", peer)
    assert (row.count, row.strict, row.reason) == (7, 100.0, "")
    assert 0.0 < row.median <= row.p99


def test_the_points_of_a_path_are_reached_from_the_ones_before(arm, peer):
    # Two steps of Newton's method reach a point from the one before, and from no point far away.
    (row,) = ran(arm, "path", replace(peer, options={"steps": 2}))
    assert (row.count, row.strict) == (7, 100.0)


@pytest.mark.parametrize("options", [{"order": -1}, {"steps": 0}])
def test_a_peer_that_means_other_joints_or_never_answers_is_not_timed(arm, peer, options):
    (row,) = ran(arm, "still", replace(peer, options=options))
    assert row.count == 0
    assert "places the tip at none of 10 targets" in row.reason


def test_a_peer_that_cannot_be_installed_keeps_its_row_with_the_reason(arm, peer):
    contestant = Contestant(peer, arm, make_problems(arm, "still", 1, 0), 1.0)
    with ExitStack() as processes:
        assert contestant.start("cannot be installed: no such wheel", None, processes) == {}
    assert contestant.measured.reason == "cannot be installed: no such wheel"


def test_the_targets_next_to_their_starts_are_next_to_them_on_every_task(arm):
    for task in TASKS:
        targets, starts = make_problems(arm, task, 3, 0).check
        for target, start in zip(targets, starts, strict=True):
            assert np.linalg.norm(target.translation - arm.placement(start).translation) < 0.02


def test_arrays_come_through_the_pipe_unchanged():
    for array in (np.array([[math.pi, math.nan], [-0.0, math.inf]]), np.empty((0, 6))):
        assert np.array_equal(unpack(pack(array)), array, equal_nan=True)


def test_every_row_has_a_key_and_a_table_of_its_own():
    assert len({peer.key for peer in PEERS}) == len(PEERS)
    for peer in PEERS:
        assert peer.tasks
        assert set(peer.tasks) <= set(TASKS)
        pinned = all("==" in each or each == "numpy" for each in peer.requirements)
        assert pinned, f"{peer.key} installs {peer.requirements}"


def row(robot, peer, median, task="poses"):
    return Row(robot, task, peer, peer, "", 1e-4, 5, 100.0, 100.0, 100.0, median, median, median, median)


def test_the_summary_names_the_worst_and_the_best_robot():
    rows = [row("panda", "pinik", 2.0), row("panda", "rtb", 30.0), row("ur5", "pinik", 4.0), row("ur5", "rtb", 44.0)]
    heading, poses = ratios_of(rows)
    assert poses[heading.index("Robotics Toolbox ik_LM")] == "11 to 15"
    assert poses[heading.index("EAIK, first answer")] == "–"


def test_two_threads_are_compared_with_one_by_the_time_of_all_targets():
    one, two = row("ur5", "pinik-many-1", 3.0, "batch"), row("ur5", "pinik-many-2", 3.0, "batch")
    two.mean = 1.5  # each target takes as long, and two are solved at a time
    heading, gains, placements = batches_of([one, two])
    assert gains[heading.index("ur5")] == "2.00"
    assert placements[heading.index("ur5")] == "–"


def test_a_document_keeps_what_stands_around_the_tables(tmp_path):
    document = tmp_path / "page.md"
    document.write_text(f"before\n\n{BEGIN}\nold\n{END}\n\nafter\n", encoding="utf-8")
    skipped = replace(row("panda", "eaik", math.nan), count=0, reason="seven joints")
    text = as_markdown(["a point"], [[["a"], ["b"]]], [row("panda", "pinik", 2.0), skipped], "python peers.py")
    for _ in range(2):  # the second time replaces the first
        replace_part(document, text)
    written = document.read_text(encoding="utf-8")
    assert written.startswith("before\n")
    assert written.endswith("after\n")
    assert "old" not in written
    assert written.count("| pinik | 100 %, 2 / 2 / 2 |") == 1
    assert "eaik (panda): seven joints" in written


def test_a_document_without_the_marks_is_refused(tmp_path):
    document = tmp_path / "page.md"
    document.write_text("before\n", encoding="utf-8")
    with pytest.raises(ValueError, match="must have the lines"):
        replace_part(document, "text")
