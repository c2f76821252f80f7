"""Starts given as angles, and continuous joints whose angles are unwound from them."""

from __future__ import annotations

import json
import math
import pickle

import numpy as np
import pytest

import pinik
from engines import needs_native
from pinik import Target
from robots import load_quietly
from urdf_texts import joint, link, robot

TURN = 2.0 * math.pi
ENGINES = ["python", pytest.param("native", marks=needs_native)]
ARM = robot(
    *map(link, ("base", "upper", "fore", "tip")),
    joint("shoulder", "base", "upper", '<axis xyz="0 0 1"/>', kind="continuous"),
    joint("elbow", "upper", "fore", '<origin xyz="1 0 0"/><axis xyz="0 0 1"/>', kind="continuous"),
    joint("end", "fore", "tip", '<origin xyz="0.8 0 0"/>', kind="fixed"),
)


@pytest.fixture(scope="module")
def arm2():
    return load_quietly(ARM)


def place_at(loaded, shoulder, elbow):
    return loaded.placement("tip", loaded.configuration({"shoulder": shoulder, "elbow": elbow})).translation


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("turns", [0, 1, -3])
def test_angles_go_on_from_the_start_without_a_jump(engine, turns, arm2):
    start = {"shoulder": 3.3 + turns * TURN, "elbow": -0.9}
    place = place_at(arm2, 3.35, -0.95)
    s = arm2.solve("tip", place, q0=start, engine=engine)
    assert s.success
    assert s.angles["shoulder"] == pytest.approx(3.35 + turns * TURN, abs=1e-6)
    assert s.angles["elbow"] == pytest.approx(-0.95, abs=1e-6)
    shoulder = arm2.joint("shoulder")
    np.testing.assert_allclose(s.q[shoulder.idx_q : shoulder.idx_q + 2], [math.cos(3.35), math.sin(3.35)], atol=1e-6)
    assert s.to_dict()["angles"] == s.angles
    assert json.loads(json.dumps(s.to_dict()))["angles"]["shoulder"] == s.angles["shoulder"]
    assert pickle.loads(pickle.dumps(s)).angles == s.angles


@pytest.mark.parametrize("engine", ENGINES)
def test_a_vector_starts_between_minus_pi_and_pi(engine, arm2):
    q0 = arm2.configuration({"shoulder": 3.3, "elbow": -0.9})
    s = arm2.solve("tip", place_at(arm2, 3.05, -0.95), q0=q0, engine=engine)
    assert s.angles["shoulder"] == pytest.approx(3.05 - TURN, abs=1e-6)  # the start is at 3.3 − 2π
    again = pickle.loads(pickle.dumps(s))
    assert again.angles == s.angles


@pytest.mark.parametrize("engine", ENGINES)
def test_prepare_solve_many_and_iterate_take_angles_too(engine, arm2):
    start = {"shoulder": 3.3 + TURN, "elbow": -0.9}
    place = place_at(arm2, 3.35, -0.95)
    ask = pinik.prepare(arm2, "tip", position=[0, 0, 0], engine=engine)
    many = pinik.solve_many(arm2, "tip", [place, place], q0=start, engine=engine)
    for s in (ask(place, start), many[0], many[-1]):
        assert s.angles["shoulder"] == pytest.approx(3.35 + TURN, abs=1e-6)
    rows = pinik.solve_many(
        arm2, "tip", [place] * 2, q0=[arm2.configuration({"shoulder": x}) for x in (3.0, -3.0)], engine=engine
    )
    assert [s.angles["shoulder"] > 0.0 for s in rows] == [True, False]
    *_, last = pinik.iterate(arm2, "tip", q0=start, position=place)
    np.testing.assert_allclose(last.q, ask(place, start).q, atol=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_joints_that_are_not_named_start_neutral(engine, panda):
    s = panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], q0={"panda_joint2": 0.5}, engine=engine)
    same = panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], q0=panda.configuration({"panda_joint2": 0.5}), engine=engine)
    np.testing.assert_array_equal(s.q, same.q)


def test_a_locked_joint_keeps_its_turns(arm2):
    place = place_at(arm2, 10.0, -0.95)
    s = arm2.solve("tip", place, q0={"shoulder": 10.0, "elbow": -0.9}, locked=["shoulder"])
    assert s.success
    assert s.angles["shoulder"] == pytest.approx(10.0, abs=1e-12)


def test_faulty_starts_are_refused(arm2):
    with pytest.raises(pinik.UnknownNameError, match="shoulder"):
        arm2.solve("tip", [1, 0, 0], q0={"sholder": 1.0})
    with pytest.raises(pinik.InputError):
        arm2.solve("tip", [1, 0, 0], q0={"shoulder": math.inf})
    with pytest.raises(pinik.InputError, match="only solve starts 'nearest'"):
        pinik.iterate(arm2, Target("tip", [1, 0, 0]), q0="nearest")


def test_the_angles_of_many_solutions_are_those_of_each():
    robot = load_quietly("kinova")
    frame, first = "j2s6s200_end_effector", "j2s6s200_joint_1"
    start = {first: 9.6, "j2s6s200_joint_2": 2.5, "j2s6s200_joint_3": 2.0}
    places = np.array([robot.placement(frame, robot.random(seed)).homogeneous for seed in range(8)])
    many = pinik.solve_many(robot, frame, places, q0=start)
    assert many.angles.shape == (8, len(robot.joint_names))
    column = robot.joint_names.index(first)
    for row, solution, q in zip(many.angles, many, many.q, strict=True):
        assert abs(row[column] - 9.6) <= math.pi + 1e-9
        plain = robot.angles(q)
        for angle, name in zip(row, robot.joint_names, strict=True):
            assert math.isclose(math.cos(angle), math.cos(plain[name]), abs_tol=1e-9)
            assert math.isclose(angle, solution.angles[name], abs_tol=1e-9)


@pytest.mark.parametrize(
    ("loaded", "given", "hint"),
    [
        ("panda", "default", "the pose of this name is robot.poses['default']"),
        ("arm", "home", "the robot's poses are given as robot.poses['relaxed'], and likewise 'reach'"),
        (ARM, "home", "this robot has no named poses"),
    ],
)
def test_a_pose_that_is_given_by_its_name_is_refused_with_what_would_be_right(loaded, given, hint):
    machine = load_quietly(loaded)
    frame, place = machine.frame_names[-1], [0.3, 0.0, 0.3]
    asked = [
        lambda: machine.solve(frame, place, q0=given),
        lambda: pinik.solve_many(machine, frame, [place], q0=given),
        lambda: pinik.track(machine, frame, [place], q0=given),
        lambda: machine.collisions(given),
    ]
    for ask in asked:
        with pytest.raises(pinik.InputError) as refused:
            ask()
        assert f"got {given!r} ({hint})" in str(refused.value)


def test_poses_that_cannot_be_read_do_not_hide_that_q0_is_no_name(tmp_path):
    (tmp_path / "a.urdf").write_text(ARM)
    (tmp_path / "a.srdf").write_text("<robot><group_state></robot>")
    with pytest.raises(pinik.InputError, match=r"q0 must be a configuration.*no named poses"):
        load_quietly(tmp_path / "a.urdf").solve("tip", [1, 0, 0], q0="home")
