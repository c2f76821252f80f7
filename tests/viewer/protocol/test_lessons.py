"""Each lesson's scene shows what its two sentences claim: seen in a session, without a browser."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from judge import plain_placement
from pinik.viewer.protocol.lessons import LESSONS, setup_text
from pinik.viewer.protocol.setup import apply_setup, read_setup, write_setup
from pinik.viewer.simulation.session import Session
from robots import load_quietly
from stand_ins import Clock


class Lecture:
    """A lesson's session, and the figures of each instance in each step."""

    def __init__(self, name):
        setup = read_setup(LESSONS[name].setup)
        robot = load_quietly(setup["robot"], root=setup["root"])
        self.session = Session(robot, "ccd,dls", clock=Clock())
        apply_setup(self.session, setup)
        self.figures = [[] for _ in self.session.seen]

    def watch(self, steps):
        for own in self.figures:
            own.clear()
        for _ in range(steps):
            self.session.step()
            for own, instance in zip(self.figures, self.session.seen, strict=True):
                own.append(instance.last)
        return self

    def each(self, name):
        """A figure (steps,) of each instance."""
        return [np.array([getattr(step, name) for step in own], dtype=float) for own in self.figures]

    @property
    def statuses(self):
        return [instance.status for instance in self.session.seen]


@pytest.mark.parametrize("name", LESSONS)
def test_every_lesson_opens_as_it_is_written(name):
    lecture = Lecture(name)
    assert lecture.session.running
    again = read_setup(write_setup(lecture.session))
    asked = read_setup(LESSONS[name].setup)
    assert {part: again[part] for part in asked if part not in ("balls", "parameters")} == {
        part: text for part, text in asked.items() if part not in ("balls", "parameters")
    }
    assert [instance.solver.name for instance in lecture.session.seen] == asked["methods"].split(",")
    lecture.watch(5)
    assert "REFUSED" not in lecture.statuses
    assert "FAILED" not in lecture.statuses


@pytest.mark.parametrize("name", LESSONS)
def test_every_text_has_two_sentences(name):
    assert len(re.findall(r"[.!?](?= [A-Z]|$)", LESSONS[name].text)) == 2


def test_set_up_text_is_as_a_link_writes_it():
    assert setup_text(robot="a b", view=4, balls=[["tip", "on"]]) == "robot=a%20b&view=4&balls=[[%22tip%22,%22on%22]]"


def test_only_ccd_leaves_the_straight_arm():
    lecture = Lecture("straight")
    home = lecture.session.home
    lecture.watch(60)
    ccd, *others = lecture.session.seen
    assert ccd.last.error == pytest.approx(0.05, abs=1e-6)  # the bones are 0.1 and 0.2 m long, the ball is 0.05 m away
    assert abs(ccd.q - home).max() == pytest.approx(math.pi, abs=0.01)
    for other in others:
        np.testing.assert_allclose(other.q, home, atol=1e-6)
        assert other.status == "STALLED"


def test_the_pseudo_inverse_jitters_out_of_reach_and_damping_rests():
    lecture = Lecture("out-of-reach").watch(300)
    ball = lecture.session.balls[0].position
    shoulder = plain_placement(lecture.session.robot, "bone1", lecture.session.home).translation
    assert np.linalg.norm(ball - shoulder) - 1.2 == pytest.approx(0.24, abs=0.01)
    pinv, dls = lecture.each("jump")
    assert pinv[-60:].max() > math.radians(20)
    assert pinv[-120:-60].max() > math.radians(20)
    assert dls[-60:].max() < math.radians(0.1)
    assert lecture.each("error")[1][-1] == pytest.approx(0.24, abs=0.01)


def test_a_larger_lambda_jumps_less_and_takes_more_iterations():
    lecture = Lecture("damping").watch(900)
    jumps = [own.max() for own in lecture.each("jump")]
    assert min(jumps[:2]) > math.pi
    assert math.pi > jumps[2] > 2 * jumps[3]
    taken = [own.sum() for own in lecture.each("iterations")]
    assert taken == sorted(taken)
    assert taken[3] > 3 * taken[0]


def test_ccd_curls_at_the_end():
    lecture = Lecture("curl").watch(1)
    lecture.watch(1)
    shares = []
    for instance in lecture.session.seen:
        change = abs(instance.q - lecture.session.home)
        shares.append(change[-4:].sum() / change.sum())
    assert shares[0] > 0.5
    assert shares[1] < 0.3


def test_limits_cost_both_methods_the_ball():
    lecture = Lecture("limits").watch(200)
    for instance, error in zip(lecture.session.seen, lecture.each("error"), strict=True):
        assert error[-1] == pytest.approx(0.13, abs=0.01)
        assert len(instance.verdict().active_limits) >= 3
    lecture.session.change_settings(limits=False)
    lecture.watch(100)
    assert lecture.statuses == ["CONVERGED", "CONVERGED"]


def test_three_paws_stay_planted_while_the_fourth_reaches():
    lecture = Lecture("paws")
    session = lecture.session
    modes = [ball.mode for ball in session.balls]
    assert modes == ["on", "pinned", "pinned", "pinned"]
    home = [plain_placement(session.robot, ball.frame, session.home).translation for ball in session.balls]
    (lion,) = session.seen
    for step in range(20):
        session.step()
        if step < 10:
            continue
        for ball, at in zip(session.balls, home, strict=True):
            off = np.linalg.norm(plain_placement(session.robot, ball.frame, lion.q).translation - ball.position)
            assert off <= 1e-4
            if ball.mode == "pinned":
                np.testing.assert_allclose(ball.position, at, atol=1e-9)
    assert np.linalg.norm(session.balls[0].position - home[0]) > 0.2


def test_two_bones_need_one_step_and_the_iteration_several():
    lecture = Lecture("two-bones").watch(600)
    bones, iteration = lecture.each("iterations")
    assert bones.max() == 1
    assert iteration.max() >= 3
    exact, approached = lecture.each("reached")
    assert exact.all()
    assert not approached.all()
