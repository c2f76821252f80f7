"""`choose="nearest"`: of the distinct answers that the attempts find, the one nearest to the start."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from judge import judge
from pinik import Target
from pinik.solvers.parameter import JointValues
from robots import load_quietly

TURN = 2.0 * math.pi
ENGINES = ["python", pytest.param("native", marks=needs_native)]
NATIVE = [pytest.param("native", marks=needs_native)]


@pytest.fixture(scope="module")
def ur5():
    return load_quietly("ur5")


def largest_change(robot, start, q, weights=None):
    change = np.abs(pinocchio.difference(robot.model, start, q))
    for name, weight in (weights or {}).items():
        joint = robot.joint(name)
        change[joint.idx_v : joint.idx_v + joint.nv] *= weight
    return change.max()


def branches(robot, frame, pose, start, count=150):
    """Many answers to one pose, found one by one from random starts and turned towards the start by hand."""
    rng = np.random.default_rng(1)
    for _ in range(count):
        s = robot.solve(frame, placement=pose, q0=robot.random(rng), polish=True)
        if s.success:
            q = s.q.copy()
            for name, low, high in zip(robot.joint_names, robot.lower, robot.upper, strict=True):
                k = robot.joint(name).idx_q
                inside = [x for x in (q[k] + n * TURN for n in range(-3, 4)) if low <= x <= high]
                q[k] = min(inside, key=lambda x, k=k: abs(x - start[k]))
            yield q


@needs_native
def test_no_branch_found_otherwise_is_nearer(ur5):
    rng = np.random.default_rng(2)
    for _ in range(4):
        start, pose = ur5.random(rng), ur5.placement("tool0", ur5.random(rng))
        s = ur5.solve("tool0", placement=pose, q0=start, choose="nearest")
        least = min(largest_change(ur5, start, q) for q in branches(ur5, "tool0", pose, start))
        assert largest_change(ur5, start, s.q) <= least + 1e-6
        assert 1 < s.chosen_from <= 8 * 2**6
        assert judge(ur5, Target("tool0", placement=pose), s.q).are_within()


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "ccd"])
def test_is_never_farther_than_the_first_answer(engine, method, ur5):
    rng = np.random.default_rng(3)
    for _ in range(3):
        start, pose = ur5.random(rng), ur5.placement("tool0", ur5.random(rng))
        asked = {"placement": pose, "q0": start, "method": method, "engine": engine, "restarts": 12}
        first, nearest = ur5.solve("tool0", **asked), ur5.solve("tool0", **asked, choose="nearest")
        assert first.chosen_from == 1
        assert nearest.success >= first.success
        if first.success:
            assert largest_change(ur5, start, nearest.q) <= largest_change(ur5, start, first.q) + 1e-12
            assert nearest.restarts >= first.restarts


@pytest.mark.parametrize("engine", ENGINES)
def test_weights_decide_which_joint_should_rest(engine, two_link):
    """Both elbows of two links reach the place; whichever joint is heavy decides which of them is nearer."""
    frame = two_link.frame_names[-1]
    start = two_link.configuration(dict(zip(two_link.joint_names, (0.2, 0.3), strict=True)))
    place = two_link.placement(frame, two_link.configuration(dict(zip(two_link.joint_names, (0.5, 1.2), strict=True))))
    shoulder, elbow = two_link.joint_names[:2]
    both = []
    for weights in ({shoulder: 100.0}, {elbow: 100.0}, {shoulder: 0.0}):
        s = two_link.solve(
            frame, place.translation, q0=start, engine=engine, choose="nearest", choose_weights=weights, restarts=40
        )
        assert s.chosen_from == 2
        assert "nearest of 2 answers" in s.message
        both.append((weights, s.q))
    for weights, q in both:
        least = min(largest_change(two_link, start, other, weights) for _, other in both)
        assert largest_change(two_link, start, q, weights) <= least + 1e-6


@pytest.mark.parametrize("engine", ENGINES)
def test_ends_after_a_quarter_of_the_restarts_without_a_new_answer(engine, two_link):
    frame = two_link.frame_names[-1]
    place = two_link.placement(frame, two_link.random(4)).translation
    s = two_link.solve(frame, place, engine=engine, choose="nearest", restarts=40)
    assert s.success
    assert 10 <= s.restarts < 40
    alone = two_link.solve(frame, place, engine=engine, choose="nearest", restarts=0)
    assert (alone.restarts, alone.chosen_from) == (0, 1)


@pytest.mark.parametrize("engine", ENGINES)
def test_depends_on_the_seed_alone(engine, panda):
    rng = np.random.default_rng(6)
    poses = np.array([panda.placement("panda_hand_tcp", panda.random(rng)).homogeneous for _ in range(3)])
    asked = {"engine": engine, "choose": "nearest", "restarts": 8, "seed": 3}
    a = pinik.solve_many(panda, "panda_hand_tcp", poses, threads=1, **asked)
    b = pinik.solve_many(panda, "panda_hand_tcp", poses, threads=3, **asked)
    np.testing.assert_array_equal(a.q, b.q)
    np.testing.assert_array_equal(a.chosen_from, b.chosen_from)
    assert [s.chosen_from for s in a] == a.chosen_from.tolist()
    assert a.chosen_from.max() > 1
    ask = pinik.prepare(panda, "panda_hand_tcp", placement=np.eye(4), **asked)
    assert ask(poses[0]).chosen_from == a.chosen_from[0]
    np.testing.assert_array_equal(ask(poses[0]).q, a.q[0])


@needs_native
def test_both_engines_choose_alike(ur5):
    rng = np.random.default_rng(7)
    for _ in range(3):
        start, pose = ur5.random(rng), ur5.placement("tool0", ur5.random(rng))
        a, b = (
            ur5.solve("tool0", placement=pose, q0=start, choose="nearest", engine=engine, restarts=10)
            for engine in ("python", "native")
        )
        assert a.chosen_from == b.chosen_from
        np.testing.assert_allclose(a.q, b.q, atol=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_floating_root_counts_too(engine, lion):
    loaded = load_quietly("lion", root="free_flyer")
    frame = "nose"
    start = loaded.neutral()
    place = loaded.placement(frame, start).translation + np.array([0.2, 0.1, 0.0])
    s = loaded.solve(frame, place, q0=start, engine=engine, choose="nearest", restarts=4)
    assert s.success
    assert s.chosen_from > 1
    first = loaded.solve(frame, place, q0=start, engine=engine, restarts=4)
    assert largest_change(loaded, start, s.q) <= largest_change(loaded, start, first.q) + 1e-9


@pytest.mark.parametrize("engine", ENGINES)
def test_a_missed_target_counts_as_one(engine, ur5):
    s = ur5.solve("tool0", [5.0, 0.0, 0.0], engine=engine, choose="nearest", restarts=3)
    assert not s.success
    assert s.chosen_from == 1
    assert s.to_dict()["chosen_from"] == 1


def test_weights_are_checked(ur5):
    ask = {"position": [0.3, 0.2, 0.4], "choose": "nearest"}
    with pytest.raises(pinik.UnknownNameError, match="elbow_joint"):
        ur5.solve("tool0", **ask, choose_weights={"elbow": 1.0})
    with pytest.raises(pinik.InputError, match=r"choose_weights\['elbow_joint'\] must be at least 0; got -1"):
        ur5.solve("tool0", **ask, choose_weights={"elbow_joint": -1.0})
    with pytest.raises(pinik.InputError, match=r"choose_weights must map joint names to numbers; got \[1\]"):
        ur5.solve("tool0", **ask, choose_weights=[1])
    with pytest.raises(pinik.UnknownNameError, match="nearest"):
        ur5.solve("tool0", position=[0.3, 0.2, 0.4], choose="nearst")


def test_calls_with_other_weights_are_other_questions(two_link):
    """A mapping that was changed after a call asks another question in the next one."""
    frame = two_link.frame_names[-1]
    place = two_link.placement(frame, two_link.random(4)).translation
    weights = {two_link.joint_names[0]: 2.0}
    for value in (2.0, 5.0):
        weights[two_link.joint_names[0]] = value
        s = two_link.solve(frame, place, choose="nearest", choose_weights=weights, engine="python")
        assert s._question.options.choose_weights == JointValues({two_link.joint_names[0]: value})
