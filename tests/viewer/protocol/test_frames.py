"""Frames, read as the documentation lays them out, against plain forward kinematics."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

from by_hand import axis, limit, origin
from judge import plain_placement
from pinik.viewer.protocol.frames import FrameMaker
from pinik.viewer.simulation.session import Session
from pinik.viewer.simulation.standing import STATUSES
from robots import load_quietly
from stand_ins import Clock, read_frame
from urdf_texts import joint, link
from urdf_texts import robot as robot_text


def shown(name, root="fixed", methods=("ccd", "jt", "pinv", "dls")):
    session = Session(load_quietly(name, root=root), methods, clock=Clock(each=0.0001))
    session.set_motion("random")
    for _ in range(4):
        session.step()
    return session


@pytest.mark.parametrize(
    ("name", "root"), [("arm", "fixed"), ("lion", "free_flyer"), ("tiago", "planar"), ("hector", "fixed")]
)
def test_a_frame_shows_where_everything_is(name, root):
    session = shown(name, root)
    robot = session.robot
    frame = read_frame(FrameMaker(robot, 7).frame(session))
    assert (frame.generation, frame.step, len(frame.blocks), len(frame.balls)) == (7, 4, 4, len(session.balls))
    for place, ball in zip(frame.balls, session.balls, strict=True):
        assert np.allclose(place, ball.placement, atol=1e-6)
    data = robot.model.createData()
    for block, one in zip(frame.blocks, session.seen, strict=True):
        pinocchio.forwardKinematics(robot.model, data, one.q)
        expected = [pinocchio.SE3ToXYZQUAT(data.oMi[k]) for k in range(robot.model.njoints)]
        assert block.joints.shape == (robot.model.njoints, 7)
        assert np.allclose(block.joints, expected, atol=1e-5)
        points = [plain_placement(robot, ball.frame, one.q).translation for ball in session.balls]
        assert np.allclose(block.points, points, atol=1e-5)


def test_the_figures_are_those_of_the_last_step(arm):
    session = shown("arm")
    frame = read_frame(FrameMaker(arm, 1).frame(session))
    for block, one in zip(frame.blocks, session.seen, strict=True):
        assert STATUSES[block.status] == one.status
        missed = np.linalg.norm(plain_placement(arm, "tip", one.q).translation - session.balls[0].position)
        assert block.position_error == pytest.approx(missed, abs=1e-6)
        assert math.isnan(block.orientation_error)
        assert block.time == pytest.approx(one.last.time)
        assert (block.iterations, block.joint_updates) == (one.last.iterations, one.last.joint_updates)
        assert block.jump == pytest.approx(one.last.jump)
        assert block.counted == one.counted


def test_an_orientation_error_is_told_where_it_is_asked_for(panda):
    session = Session(panda, ["dls"], clock=Clock())
    session.balls[0].orient(True, [1.0, 0.5, 0.2])
    session.apply_settings(session.settings.__class__(until_reached=False, at_most=1))
    session.step()
    (block,) = read_frame(FrameMaker(panda, 1).frame(session)).blocks
    wanted = pinocchio.rpy.rpyToMatrix(1.0, 0.5, 0.2)
    turn = wanted @ plain_placement(panda, "panda_hand_tcp", session.instances[0].q).rotation.T
    assert block.orientation_error == pytest.approx(math.acos((np.trace(turn) - 1) / 2), abs=1e-5)


def test_before_the_first_step_and_with_nothing_asked_for_there_are_no_errors(lion):
    session = Session(lion, ["dls", "ccd"], clock=Clock())
    maker = FrameMaker(lion, 1)

    def check_idle():
        for block in read_frame(maker.frame(session)).blocks:
            assert (block.status, block.counted, block.iterations, block.jump, block.time) == (0, 0, 0, 0, 0)
            assert math.isnan(block.position_error)
            assert math.isnan(block.orientation_error)

    check_idle()
    session.move_ball(0, [0.5, 0.2, 0.1])
    session.step()
    assert all(block.counted for block in read_frame(maker.frame(session)).blocks)
    session.set_mode(0, "off")
    session.step()
    check_idle()


def test_sides_say_at_which_limit_a_joint_sits():
    text = robot_text(
        *map(link, ("base", "upper", "fore", "hand")),
        joint("shoulder", "base", "upper", axis(0, 0, 1), limit=limit(-2, 2)),
        joint("elbow", "upper", "fore", origin((1, 0, 0)), axis(0, 0, 1), limit=limit(-1, 1)),
        joint("held", "fore", "hand", origin((1, 0, 0)), axis(0, 0, 1), limit=limit(0, 0)),
    )
    robot = load_quietly(text)
    session = Session(robot, ["dls"], clock=Clock())
    joints = ["universe", *robot.model.names[1:]]
    for shoulder, elbow, sides in (
        (-2.0, 0.3, (-1, 0)),
        (2.0, -1.0, (1, -1)),
        (0.0, 1.0, (0, 1)),
        (2.5, -1.5, (1, -1)),
    ):
        session.instances[0].put(robot.configuration({"shoulder": shoulder, "elbow": elbow}))
        (block,) = read_frame(FrameMaker(robot, 1).frame(session)).blocks
        told = dict(zip(joints, block.sides.tolist(), strict=True))
        assert told == {"universe": 0, "shoulder": sides[0], "elbow": sides[1], "held": 2}


def test_a_frame_of_fewer_instances_is_shorter(arm):
    session = shown("arm")
    maker = FrameMaker(arm, 1)
    lengths = []
    for view in (1, 2, 4):
        session.set_view(view)
        lengths.append(len(maker.frame(session)))
        assert lengths[-1] == 4 + 4 * (5 + 7 + view * (8 + 8 * 13 + 3))
