"""What a user holds: read-only, comparable, and right from whatever thread reads it."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pinocchio
import pytest

import pinik
from pinik import Target


def test_many_answers_are_read_right_from_many_threads(arm):
    """Targets out of reach by different distances, whose sentences say by how much."""
    places = np.array([[2.0 + 0.01 * k, 0.1, 0.5] for k in range(64)])
    many = pinik.solve_many(arm, "tip", places, restarts=1, max_iterations=20)
    first = arm.placement("bone1", arm.neutral()).translation  # the chain's first joint stands where bone 1 begins
    alone = [many[k].message for k in range(len(many))]
    assert len(set(alone)) > 50
    assert all(message.startswith("unreachable: the target of tip lies ") for message in alone)
    assert np.linalg.norm(places - first, axis=1).min() > 1.2
    with ThreadPoolExecutor(8) as pool:
        for _ in range(5):
            order = np.random.default_rng(0).permutation(len(many))
            told = dict(zip(order, pool.map(lambda k: many[int(k)].message, order), strict=True))
            assert [told[k] for k in range(len(many))] == alone


def test_a_solution_is_read_only(arm):
    for engine in ("python", "auto"):
        s = arm.solve("tip", [0.2, 0.1, 0.9], engine=engine)
        with pytest.raises(ValueError, match="read-only"):
            s.q[0] = 1.0
        assert s.q is s.q
        again = pickle.loads(pickle.dumps(s))
        np.testing.assert_array_equal(again.q, s.q)


SAME = [
    (Target("tip", [0.1, 0.2, 0.3]), Target("tip", position=np.array([0.1, 0.2, 0.3]))),
    (Target("tip", [0.0, 0.2, 0.3]), Target("tip", [-0.0, 0.2, 0.3])),
    (Target("tip", rpy=[0, 0, np.pi]), Target("tip", rotation=pinocchio.rpy.rpyToMatrix(0, 0, np.pi))),
    (Target("tip", axis="z", direction=[0, 0, 2]), Target("tip", axis=[0, 0, 1], direction=[0, 0, 1])),
    (
        Target("tip", [1, 0, 0], tool=[0, 0, 0.1]),
        Target("tip", [1, 0, 0], tool=pinocchio.SE3(np.eye(3), np.array([0, 0, 0.1]))),
    ),
]
OTHER = [
    Target("tip", [0.1, 0.2, 0.3]),
    Target("base", [0.1, 0.2, 0.3]),
    Target("tip", [0.1, 0.2, 0.30001]),
    Target("tip", [0.1, 0.2, 0.3], weight=2.0),
    Target("tip", [0.1, 0.2, 0.3], relative_to="base"),
    Target("tip", [0.1, 0.2, 0.3], tool=[0, 0, 0.1]),
    Target("tip", [0.1, 0.2, 0.3], rpy=[0, 0, 0]),
    Target("tip", [0.1, 0.2, 0.3], axis="z", direction=[0, 0, 1]),
    Target("tip", [0.1, 0.2, 0.3], axis="z", at=[0, 0, 1]),
]


@pytest.mark.parametrize(("one", "other"), SAME)
def test_targets_that_ask_the_same_are_equal(one, other):
    assert one == other
    assert hash(one) == hash(other)
    assert pickle.loads(pickle.dumps(one)) == other


def test_targets_that_ask_something_else_are_not():
    assert len(set(OTHER)) == len(OTHER)
    assert Target("tip", [0, 0, 1]) != "tip"


def test_a_tool_that_was_handed_out_does_not_change_the_target():
    target = Target("tip", [0.4, 0.1, 0.5], tool=[0, 0, 0.1])
    before = hash(target)
    target.tool.translation = np.array([0.0, 0.0, 0.2])
    np.testing.assert_array_equal(target.tool.translation, [0.0, 0.0, 0.1])
    assert hash(target) == before


@pytest.mark.parametrize("engine", ["python", "auto"])
def test_no_questions_have_no_answers(arm, engine):
    for many in (
        pinik.solve_many(arm, [], engine=engine),
        pinik.solve_many(arm, "tip", [], engine=engine),
        pinik.solve_many(arm, "tip", np.zeros((0, 3)), engine=engine),
        pinik.solve_many(arm, "tip", np.zeros((0, 4, 4)), engine=engine),
        pinik.solve_many(arm, Target("tip", [0, 0, 1]), np.zeros((0, 3)), engine=engine),
    ):
        assert len(many) == 0
        assert list(many) == []
        assert many.q.shape == (0, arm.model.nq)
        assert many.success.shape == many.position_error.shape == many.time.shape == (0,)
        assert str(many).startswith("0 of 0 solved")
        with pytest.raises(IndexError):
            many[0]


def test_a_change_of_the_parameters_that_were_read_changes_no_solution(arm):
    solution = arm.solve("tip", [0.3, 0.2, 0.9], damping=0.5)
    solution.parameters["damping"] = 9.0
    assert solution.parameters["damping"] == solution.to_dict()["parameters"]["damping"] == 0.5
