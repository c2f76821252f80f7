"""Joints moved by hand, against plain Pinocchio: the robots take the pose, and the balls follow."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from judge import plain_placement
from pinik.viewer.protocol.setup import apply_setup, read_setup, write_setup
from pinik.viewer.simulation.by_hand import set_angles
from pinik.viewer.simulation.session import Session
from robots import load_quietly
from stand_ins import Clock


def session(robot, methods=("ccd", "dls"), **options):
    return Session(robot, methods, clock=Clock(), **options)


def led(of):
    return sorted(of.leading.among(of.balls.targets))


def test_all_take_the_pose_and_the_ball_follows_until_it_is_moved(arm):
    shown = session(arm)
    shown.move_ball(0, [0.4, 0.2, 0.8])
    shown.step()
    shown.set_motion("curve")
    before = arm.angles(shown.instances[0].q)
    set_angles(shown, None, {"bone2_x": 0.7})
    wanted = arm.configuration(before | {"bone2_x": 0.7})
    for one in shown.seen:
        np.testing.assert_allclose(one.q, wanted, atol=1e-12)
        assert one.verdict().message == "its joints lead, and the balls follow"
    place = plain_placement(arm, "tip", wanted)
    np.testing.assert_allclose(shown.balls[0].position, place.translation, atol=1e-12)
    assert (shown.motion.kind, led(shown)) == ("hand", [0, 1])
    shown.step()
    np.testing.assert_allclose(shown.instances[0].q, wanted, atol=1e-12)
    shown.move_ball(0, [0.3, 0.3, 0.8])
    assert led(shown) == []
    shown.step()
    for one in shown.seen:
        there = plain_placement(arm, "tip", one.q).translation
        assert np.linalg.norm(there - [0.3, 0.3, 0.8]) < 1e-4


def test_one_leads_and_the_others_chase_its_ball(arm):
    shown = session(arm)
    set_angles(shown, 1, {"bone1_x": 0.5, "bone3_x": -0.3})
    held = shown.instances[1].q.copy()
    shown.step()
    assert led(shown) == [1]
    np.testing.assert_array_equal(shown.instances[1].q, held)
    there = [plain_placement(arm, "tip", one.q).translation for one in shown.seen]
    assert np.linalg.norm(there[0] - there[1]) < 1e-4, "the first one has solved for where the second one is"


@pytest.mark.parametrize(
    "change",
    [
        lambda shown: shown.balls[0].orient(True, [0, 0, 0]),
        lambda shown: shown.balls[0].release("x"),
        lambda shown: shown.set_mode(0, "off"),
        lambda shown: shown.add_ball("bone2"),
        lambda shown: shown.set_motion("curve"),
        lambda shown: shown.reset(),
        lambda shown: shown.leading.hold((), ()),
    ],
    ids=["orientation", "free", "off", "another", "curve", "reset", "asked"],
)
def test_what_changes_a_ball_makes_the_balls_lead(arm, change):
    shown = session(arm)
    set_angles(shown, None, {"bone1_x": 0.5})
    change(shown)
    assert led(shown) == []


def test_pinned_and_turned_balls_follow_and_those_that_are_off_stay():
    lion = load_quietly("lion", root="free_flyer")
    shown = session(lion, ("dls",))
    shown.balls[0].orient(True, [0.0, 0.0, 0.0])
    off = [ball.position.copy() for ball in shown.balls if ball.mode == "off"]
    name = next(n for n in lion.joint_names if "fore" in n)
    set_angles(shown, None, {name: lion.angles(shown.instances[0].q)[name] + 0.1})
    for ball in shown.balls:
        place = plain_placement(lion, ball.frame, shown.instances[0].q)
        if ball.mode == "off":
            continue
        np.testing.assert_allclose(ball.position, place.translation, atol=1e-12)
        np.testing.assert_allclose(pinocchio.rpy.rpyToMatrix(ball.rpy), place.rotation, atol=1e-9)
    assert all(np.array_equal(a, b.position) for a, b in zip(off, (b for b in shown.balls if b.mode == "off")))  # noqa: B905


def test_limits_hold_while_they_are_on_and_followers_and_roots_are_not_set():
    panda = load_quietly("panda", root="free_flyer")
    shown = session(panda, ("dls",))
    before = shown.instances[0].q.copy()
    for angles, words in [
        (
            {"panda_joint4": math.radians(500)},
            r"cannot be at 8.72665 rad \(500°\): its limits are from -3.0718 to -0.0698 rad \(-176° to -3.999°\)$",
        ),
        ({"panda_finger_joint1": 1.0}, "cannot be at 1 m: its limits are from 0 to 0.04 m$"),
        ({"panda_finger_joint2": 0.01}, "mimics 'panda_finger_joint1'"),
        ({"panda_joint1": 0.1, "panda_joint4": 1.0}, "panda_joint4"),
        ({"root_joint": 0.1}, "has no angle"),
        ({"root_joint": [0, 0, 1]}, r"\(7,\)|7"),
        ({"root_joint": [0, 0, 1, 0, 0, 0, 0]}, "must not be zero"),
        ({"panda_joint1": [0, 0, 1, 0, 0, 0, 1]}, "panda_joint1"),
        ({"panda_joint44": 0.1}, "panda_joint4"),
        ({"panda_joint1": float("nan")}, "finite"),
        ({}, "no joint"),
    ]:
        with pytest.raises(pinik.PinikError, match=words):
            set_angles(shown, None, angles)
    with pytest.raises(pinik.InputError, match="from 0 to 0; got 1"):
        set_angles(shown, 1, {"panda_joint1": 0.1})
    np.testing.assert_array_equal(shown.instances[0].q, before)
    shown.change_settings(limits=False)
    set_angles(shown, 0, {"panda_joint4": 1.0, "panda_finger_joint1": 0.03})
    found = panda.angles(shown.instances[0].q)
    assert (found["panda_joint4"], found["panda_finger_joint2"]) == (1.0, 0.03)


def test_a_link_keeps_a_pose_that_leads_and_can_give_one_in_which_the_balls_lead(arm):
    shown = session(arm)
    set_angles(shown, 1, {"bone1_x": 0.5})
    other = session(arm)
    apply_setup(other, read_setup(write_setup(shown)))
    assert led(other) == [1]
    np.testing.assert_allclose(other.instances[1].q, shown.instances[1].q, atol=1e-8)
    np.testing.assert_allclose(other.balls[0].position, shown.balls[0].position, atol=1e-8)
    apply_setup(other, read_setup(write_setup(session(arm))))
    assert led(other) == []
    begin = '&angles={"all":{"bone1_x":0.4,"bone2_x":-0.2}}&lead=balls'
    apply_setup(other, read_setup(write_setup(session(arm)) + begin))
    assert led(other) == []
    np.testing.assert_allclose(other.balls[0].position, session(arm).balls[0].position, atol=1e-4)
    for one in other.seen:
        found = arm.angles(one.q)
        assert (found["bone1_x"], found["bone2_x"]) == pytest.approx((0.4, -0.2))


@pytest.mark.parametrize("root", ["free_flyer", "planar"])
def test_a_link_keeps_where_a_root_that_can_move_leads(root):
    two_link = load_quietly("two_link", root=root)
    shown = session(two_link)
    turn = [0.0, 0.0, math.sin(0.2), math.cos(0.2)]
    set_angles(shown, None, {"joint1": 0.3, "root_joint": [0.4, -0.2, 0.0, *turn]})
    q = shown.instances[0].q
    data = two_link.model.createData()
    pinocchio.forwardKinematics(two_link.model, data, q)
    place = data.oMi[two_link.model.getJointId("root_joint")]
    np.testing.assert_allclose(place.translation, [0.4, -0.2, 0.0], atol=1e-12)
    np.testing.assert_allclose(place.rotation, pinocchio.rpy.rpyToMatrix(0.0, 0.0, 0.4), atol=1e-12)
    other = session(two_link)
    apply_setup(other, read_setup(write_setup(shown)))
    np.testing.assert_allclose(other.instances[1].q, q, atol=1e-8)
    assert led(other) == [0, 1]
    with pytest.raises(pinik.InputError, match="plane"):
        set_angles(session(load_quietly("two_link", root="planar")), None, {"root_joint": [0, 0, 1, 0, 0, 0, 1]})
