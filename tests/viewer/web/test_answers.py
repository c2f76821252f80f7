"""All answers and self-motions for the page: found in another thread, shown, and taken by their number."""

from __future__ import annotations

import json

import numpy as np
import pinocchio
import pytest

import pinik
from judge import plain_placement
from pinik.viewer.simulation.by_hand import set_angles
from pinik.viewer.simulation.session import Session
from pinik.viewer.web.answers import Answers
from robots import load_quietly
from stand_ins import Clock, Later

UR5, PANDA = load_quietly("ur5"), load_quietly("panda")


class Scene:
    """A session, and the messages that its answers sent."""

    def __init__(self, robot, **asked):
        self.session = Session(robot, ["dls", "pinv"], clock=Clock())
        for index, (position, rpy) in asked.get("balls", {}).items():
            self.session.balls[index].put(position)
            self.session.balls[index].orient(True, rpy)
        self.session.set_motion("hand")
        for _ in range(20):
            self.session.step()
        self.later, self.sent = Later(), []
        self.answers = Answers(self.later, lambda text: self.sent.append(json.loads(text)))


def pose_of(robot, frame, seed):
    at = robot.placement(frame, robot.random(np.random.default_rng(seed)))
    return at.translation, pinocchio.rpy.matrixToRpy(at.rotation)


@pytest.fixture
def scene():
    frame = Session(UR5, ["dls"], clock=Clock()).balls[0].frame
    return Scene(UR5, balls={0: pose_of(UR5, frame, 2)})


def test_every_answer_reaches_the_ball_and_can_be_taken(scene):
    session, answers = scene.session, scene.answers
    answers.find(session, 3)
    scene.later.do_all()
    (told,) = scene.sent
    assert (told["type"], told["generation"]) == ("answers", 3)
    assert len(told["placements"]) == len(told["distance"]) >= 4
    assert told["distance"] == sorted(told["distance"])
    assert len(told["placements"][0]) == 7 * UR5.model.njoints
    ball = session.balls[0]
    for index in range(len(told["placements"])):
        answers.choose(session, index, 1)
        at = plain_placement(UR5, ball.frame, session.instances[1].q)
        assert at.translation == pytest.approx(ball.position, abs=1e-5)
        before = session.instances[1].q
        session.step()
        assert session.instances[1].status == "CONVERGED"
        assert np.abs(session.instances[1].q - before).max() < 1e-3  # it stays there
    with pytest.raises(pinik.InputError, match="no answer"):
        answers.choose(session, len(told["placements"]), 1)


def test_the_balls_stop_while_answers_are_looked_at(scene):
    scene.session.set_motion("curve")
    scene.answers.find(scene.session, 1)
    assert scene.session.motion.kind == "hand"


def test_an_instance_moves_along_its_self_motion_and_the_hand_stays():
    frame = Session(PANDA, ["dls"], clock=Clock()).balls[0].frame
    scene = Scene(PANDA, balls={0: pose_of(PANDA, frame, 1)})
    session, answers = scene.session, scene.answers
    assert session.instances[0].status == "CONVERGED"
    answers.follow(session, 1, 0)
    scene.later.do_all()
    told = scene.sent[-1]
    assert (told["type"], told["instance"]) == ("self_motion", 0)
    count = len(told["placements"])
    assert count > 30
    seen = []
    for index in (0, count // 2, count - 1):
        answers.move_along(session, index)
        q = session.instances[0].q
        at = plain_placement(PANDA, frame, q)
        assert at.translation == pytest.approx(session.balls[0].position, abs=1e-6)
        seen.append(q)
    assert np.abs(seen[0] - seen[1]).max() > 0.05
    with pytest.raises(pinik.InputError, match="no place along"):
        answers.move_along(session, count)


def test_a_place_without_self_motion_says_so(scene):
    scene.answers.follow(scene.session, 1, 0)
    scene.later.do_all()
    told = scene.sent[-1]
    assert told["placements"] == []
    assert "isolated" in told["message"]


def self_motion_words(scene, instance=0):
    """What the page is told of a self-motion that there is not."""
    scene.answers.follow(scene.session, 1, instance)
    scene.later.do_all()
    told = scene.sent[-1]
    assert (told["type"], told["placements"], told["closed"]) == ("self_motion", [], False)
    return told["message"]


def test_a_robot_that_misses_its_ball_says_which_by_how_much_and_what_to_do(scene):
    ball = scene.session.balls[0]
    scene.session.move_ball(0, [3.0, 0.0, 0.0])
    words = self_motion_words(scene, 1)
    at = plain_placement(UR5, ball.frame, scene.session.instances[1].q).translation
    away = float(np.linalg.norm(at - ball.position))
    assert words.startswith(f"robot 2 (pinv) misses the ball of {ball.frame} by {away:.3g} m"), words
    assert words.endswith("let the robot arrive first (Start), or move the ball to where it can")
    assert "limits=" not in words
    assert "pinik" not in words


def test_a_robot_that_reaches_its_ball_beyond_its_limits_says_which_joint_is_beyond():
    scene, joint = Scene(PANDA), "panda_joint4"  # which has to stay below -0.07
    scene.session.change_settings(limits=False)
    set_angles(scene.session, None, {joint: 0.4})
    scene.session.change_settings(limits=True)
    words = self_motion_words(scene)
    assert f"robot 1 (dls) reaches every ball only with {joint} beyond the joint limits" in words
    assert "switch Joint limits off" in words


def test_a_robot_that_is_near_a_ball_that_it_cannot_reach_exactly_says_so(two_link):
    scene = Scene(two_link)
    reach = np.linalg.norm(two_link.placement(scene.session.balls[0].frame, np.zeros(2)).translation)
    scene.session.move_ball(0, [reach + 0.5e-4, 0.0, 0.0])
    set_angles(scene.session, None, dict.fromkeys(two_link.joint_names, 0.0))
    scene.session.move_ball(0, [reach + 0.5e-4, 0.0, 0.0])
    assert "robot 1 (dls) is within the tolerance of every ball, but" in self_motion_words(scene)


def test_what_was_asked_before_another_robot_came_is_told_to_nobody(scene):
    scene.answers.find(scene.session, 1)
    scene.answers.forget()
    scene.later.do_all()
    assert scene.sent == []


def test_of_many_requests_one_is_searched_for_at_a_time_and_the_newest_follows(scene):
    for generation in range(1, 100):
        scene.answers.find(scene.session, generation)
        assert len(scene.later.waiting) == 1
    scene.later.do()
    assert (scene.sent, len(scene.later.waiting)) == ([], 1)
    scene.later.do()
    assert [told["generation"] for told in scene.sent] == [99]
    assert scene.later.waiting == []


def test_a_request_that_waits_when_another_robot_comes_is_dropped(scene):
    for _ in range(2):
        scene.answers.find(scene.session, 1)
    scene.answers.forget()
    scene.later.do()
    assert (scene.sent, scene.later.waiting) == ([], [])
    scene.answers.find(scene.session, 2)
    scene.later.do()
    assert [told["generation"] for told in scene.sent] == [2]


@pytest.mark.parametrize("instance", [-1, 2, 4])
def test_instances_are_counted(scene, instance):
    with pytest.raises(pinik.InputError, match="numbered from 0 to 1"):
        scene.answers.follow(scene.session, 1, instance)


@pytest.mark.parametrize("look", [Answers.find, lambda *args: Answers.follow(*args, 0)], ids=["answers", "self-motion"])
def test_answers_for_a_place_where_a_ball_no_longer_is_are_not_shown(scene, look):
    look(scene.answers, scene.session, 3)
    scene.session.move_ball(0, [0.3, 0.2, 0.5])
    scene.later.do_all()
    (told,) = scene.sent
    assert told == {"type": "error", "message": "a ball has changed during the search; search again"}
    with pytest.raises(pinik.InputError, match="0 were found"):
        scene.answers.choose(scene.session, 0, 0)
