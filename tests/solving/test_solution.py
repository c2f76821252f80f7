"""The answer and its words."""

from __future__ import annotations

import json
import pickle

import numpy as np
import pytest

import pinik
from judge import assert_good, assert_honest
from pinik import Status, Target


def test_a_failure_raises_only_when_asked_and_carries_the_solution(two_link):
    good = two_link.solve("tip", position=[0.5, 0.3, 0.0])
    assert good
    good.raise_for_status()
    bad = two_link.solve("tip", position=[2.0, 0.0, 0.0])
    assert not bad
    with pytest.raises(pinik.SolveError, match="unreachable") as error:
        bad.raise_for_status()
    assert error.value.solution is bad


def test_errors_are_recomputed_and_kept_apart(panda):
    wanted = panda.placement("panda_hand_tcp", panda.random(3))
    s = panda.solve("panda_hand_tcp", placement=wanted)
    assert_good(s, {"frame": "panda_hand_tcp", "placement": wanted})
    only_position = panda.solve("panda_hand_tcp", position=wanted.translation)
    assert only_position.orientation_error is None
    only_rotation = panda.solve("panda_hand_tcp", rotation=wanted.rotation)
    assert only_rotation.position_error is None


def test_the_largest_error_of_several_targets_counts_and_each_is_given(lion):
    targets = [Target("nose", [0.9, 0.1, 1.2]), Target("left_fore_paw", [5.0, 0.0, 0.0])]
    s = lion.solve(targets, max_iterations=40)
    assert s.status is Status.UNREACHABLE
    assert_honest(s, targets)
    assert "left_fore_paw" in s.message


def test_the_json_form_is_plain_and_complete(lion):
    targets = [Target("left_fore_paw", [0.8, 0.2, 0.3]), Target("nose", axis="x", at=[2.0, 0.3, 0.5], weight=0.5)]
    s = lion.solve(targets, method="ccd", max_iterations=30, restarts=1)
    d = json.loads(json.dumps(s.to_dict(), allow_nan=False))
    assert d["schema"] == 1
    assert d["robot"] == "lion"
    assert d["status"] == s.status.name
    assert d["angles"] == s.angles
    assert d["q"] == s.q.tolist()
    assert d["parameters"]["max_step"] is None  # no bound
    assert [t["frame"] for t in d["targets"]] == ["left_fore_paw", "nose"]
    assert d["targets"][1]["position_error_m"] is None
    assert d["targets"][1]["at"] == [2.0, 0.3, 0.5]
    again = [Target.from_dict({k: v for k, v in t.items() if not k.endswith(("_m", "_rad"))}) for t in d["targets"]]
    assert [t.to_dict() for t in again] == [t.to_dict() for t in targets]


def test_every_status_is_its_own_words():
    assert len({str(status) for status in Status}) == len(Status) == 6


def test_errors_travel_to_other_processes():
    for error in (
        pinik.RobotLoadError("no root", source="a.urdf", element="link 'x'"),
        pinik.UnknownNameError("frame", "tipp", ["tip", "base"], "look again"),
        pinik.InputError("words"),
        pinik.SolveError("missed", None),
    ):
        copy = pickle.loads(pickle.dumps(error))
        assert type(copy) is type(error)
        assert str(copy) == str(error)


@pytest.mark.parametrize(
    ("position", "words"),
    [([0.5, 0.3, 0.0], "converged, "), ([3.0, 0.0, 0.0], "2.1 m short"), ([0.91, 0.0, 0.0], "1 cm short")],
)
def test_lengths_are_told_in_the_unit_a_person_would_use(position, words, two_link):
    assert words in two_link.solve("tip", position=position).message


def test_the_trace_is_kept_only_when_asked(arm):
    assert arm.solve("tip", position=[0.3, 0.1, 0.8]).trace is None
    s = arm.solve("tip", position=[0.3, 0.1, 0.8], trace=True)
    assert s.trace[-1].status is Status.CONVERGED
    assert len(s.trace) == s.iterations + s.restarts + 1


def test_a_solution_travels_to_other_processes_with_its_robot(panda):
    s = panda.solve("panda_hand_tcp", position=[0.4, 0.1, 0.5], trace=True)
    copy = pickle.loads(pickle.dumps(s))
    assert copy.to_dict() == s.to_dict()
    again = copy.robot.placement("panda_hand_tcp", copy.q)
    assert np.array_equal(again.homogeneous, panda.placement("panda_hand_tcp", s.q).homogeneous)
