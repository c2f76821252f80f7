"""Answers near to their start: no hinge makes a whole turn that its limits do not demand."""

from __future__ import annotations

import math

import numpy as np
import pytest

import pinik
from engines import needs_native
from robots import load_quietly
from urdf_texts import joint, link, robot

TURN = 2.0 * math.pi
ENGINES = ["python", pytest.param("native", marks=needs_native)]
HANDSTAND = {"position": [-0.6, -0.4, 0.3], "rpy": [math.pi, 0.0, 0.0]}


def assert_nearest(loaded, q, start, limits=True):
    """No other whole turn of a hinge is nearer to the start and inside the limits; only hinges are looked at."""
    for name, low, high in zip(loaded.joint_names, loaded.lower, loaded.upper, strict=True):
        own = loaded.joint(name)
        if own.kind != "revolute" or own.nq != 1:
            continue
        angle, at = q[own.idx_q], start[own.idx_q]
        if not limits:
            low, high = -math.inf, math.inf
        assert low <= angle <= high, name
        inside = [x for x in (angle + k * TURN for k in range(-6, 7)) if low <= x <= high]
        assert abs(angle - at) <= min(abs(x - at) for x in inside) + 1e-9, name


def chain(limit):
    """Six hinges with alternating axes, all with the same limits."""
    links = [f"l{k}" for k in range(7)]
    joints = [
        joint(f"j{k}", links[k], links[k + 1], f'<origin xyz="0 0 0.3"/><axis xyz="{axis}"/>', limit=limit)
        for k, axis in enumerate(("0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"))
    ]
    return load_quietly(robot(*map(link, links), *joints))


@pytest.fixture(scope="module")
def ur5():
    return load_quietly("ur5")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd"])
def test_far_poses_take_no_whole_turns(engine, method, ur5):
    rng = np.random.default_rng(3)
    for k in range(12):
        pose = ur5.placement("tool0", ur5.random(rng))
        start = ur5.neutral() if k % 2 else ur5.random(rng)
        s = ur5.solve("tool0", placement=pose, q0=start, method=method, engine=engine, restarts=20)
        assert_nearest(ur5, s.q, start)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_handstand_from_neutral_turns_no_joint_beyond_half_a_turn(engine, ur5):
    s = ur5.solve("tool0", **HANDSTAND, engine=engine)
    assert s.success
    assert np.abs(s.q).max() <= math.pi


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("limits", [True, False])
def test_answers_to_targets_out_of_reach_are_nearest_too(engine, limits):
    loaded = chain('<limit lower="-6.2" upper="5" effort="1" velocity="1"/>')
    rng = np.random.default_rng(5)
    for _ in range(8):
        start = loaded.random(rng)
        s = loaded.solve("l6", rng.uniform(3.0, 4.0, 3), q0=start, engine=engine, restarts=3, limits=limits)
        assert not s.success
        assert_nearest(loaded, s.q, start, limits)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("limits", [True, False])
def test_solve_many_and_prepare_are_nearest_too(engine, limits, ur5):
    rng = np.random.default_rng(6)
    poses = np.array([ur5.placement("tool0", ur5.random(rng)).homogeneous for _ in range(20)])
    starts = np.array([ur5.random(rng) for _ in poses])
    many = pinik.solve_many(ur5, "tool0", poses, q0=starts, engine=engine, threads=1, limits=limits)
    ask = pinik.prepare(ur5, "tool0", placement=np.eye(4), engine=engine, limits=limits)
    assert many.success.all()
    for q, pose, start in zip(many.q, poses, starts, strict=True):
        assert_nearest(ur5, q, start, limits)
        assert_nearest(ur5, ask(pose, start).q, start, limits)


def test_two_bones_at_once_and_one_by_one_are_nearest(two_link):
    rng = np.random.default_rng(8)
    frame = two_link.frame_names[-1]
    starts = np.array([two_link.random(rng) for _ in range(30)]) + rng.choice([-TURN, 0.0, TURN], (30, 1))
    places = np.array([two_link.placement(frame, two_link.random(rng)).translation for _ in starts])
    many = pinik.solve_many(two_link, frame, places, "two_bone", q0=starts, limits=False)
    assert many.success.all()
    for q, place, start in zip(many.q, places, starts, strict=True):
        assert_nearest(two_link, q, start, limits=False)
        one = two_link.solve(frame, place, method="two_bone", q0=start, limits=False)
        np.testing.assert_allclose(one.q, q, atol=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "pinv", "jt"])
def test_a_start_a_hair_beyond_a_limit_answers_at_the_limit(engine, method, ur5):
    """The elbow stands half a milliradian beyond π; a whole turn would bring it inside."""
    start = np.array([0.3, -1.2, 3.1420, 0.5, 0.7, 0.2])
    s = ur5.solve("tool0", placement=ur5.placement("tool0", start), q0=start, engine=engine, method=method)
    assert s.success
    assert s.q[2] == pytest.approx(3.14159, abs=1e-4)
    assert np.abs(s.q - start).max() < 0.02


@pytest.mark.parametrize("engine", ENGINES)
def test_a_start_far_beyond_a_limit_begins_at_its_nearest_representative(engine, ur5):
    start = np.array([20.0, -1.2, 1.0, 0.5, 0.7, -9.0])
    inside = np.array([20.0 - 3 * TURN, -1.2, 1.0, 0.5, 0.7, -9.0 + TURN])
    assert (np.abs(inside[[0, 5]]) < TURN).all()
    s = ur5.solve("tool0", placement=ur5.placement("tool0", start), q0=start, engine=engine, trace=True)
    np.testing.assert_allclose(s.trace[0].q, inside, atol=1e-12)
    np.testing.assert_allclose(s.q, inside, atol=1e-6)
