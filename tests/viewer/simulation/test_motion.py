"""How balls move by themselves, at hand-computed times."""

from __future__ import annotations

import math

import numpy as np
import pytest

import pinik
from judge import is_inside, plain_placement
from pinik.model.home import home_configuration, lowest_point
from pinik.viewer.simulation.ball import Ball
from pinik.viewer.simulation.motion import Motion
from robots import load_quietly

SECOND = 60  # steps


def ball_on(robot, frame, mode="on"):
    return Ball(frame, plain_placement(robot, frame, home_configuration(robot)), mode)


def advanced(motion, ball, steps):
    for _ in range(steps):
        motion.advance([ball], 1 / 60)
    return ball.position


def chain_length(robot, frame):
    """From the first joint over the others that move the frame to the frame, by the model's own numbers."""
    model = robot.model
    at = model.frames[robot.frame_id(frame)]
    links = [np.linalg.norm(model.jointPlacements[j].translation) for j in list(model.supports[at.parentJoint])[2:]]
    return sum(links) + np.linalg.norm(at.placement.translation)


def test_by_hand_nothing_moves(arm):
    motion, ball = Motion(arm), ball_on(arm, "tip")
    ball.put([0.1, 0.2, 0.3])
    assert advanced(motion, ball, 100).tolist() == [0.1, 0.2, 0.3]
    assert motion.path(ball).shape == (0, 3)


def test_an_eight_is_gone_round_in_eight_seconds(arm):
    """At phase ¼ the lemniscate is at its centre; at ⅛ it is at (√2/3, √2/3); the size is 0.25·0.6ᵏ of the chain's."""
    motion, ball = Motion(arm), ball_on(arm, "tip")
    motion.kind = "curve"
    home = ball.home.copy()
    assert np.allclose(advanced(motion, ball, 2 * SECOND), home, atol=1e-9)
    quarter = advanced(motion, ball, 2 * SECOND) - home  # phase ½: the far left
    size = -quarter[1]
    assert quarter == pytest.approx([0, -size, 0], abs=1e-9)
    shrunk = math.log(size / (0.25 * chain_length(arm, "tip"))) / math.log(0.6)
    assert shrunk == pytest.approx(round(shrunk), abs=1e-6)
    assert 0 <= round(shrunk) <= 4
    at_five_eighths = advanced(motion, ball, SECOND) - home
    third = math.sqrt(2) / 3
    assert at_five_eighths == pytest.approx([0, -third * size, third * size], abs=1e-9)
    assert advanced(motion, ball, 3 * SECOND) == pytest.approx(home + np.array([0, size, 0]), abs=1e-9)  # once round


@pytest.mark.parametrize("speed", [0.25, 3.0])
def test_speed_is_a_factor_on_time(arm, speed):
    motion, ball = Motion(arm), ball_on(arm, "tip")
    motion.kind, motion.curve, motion.speed = "curve", "circle", speed
    at = advanced(motion, ball, 60) - ball.home
    assert math.atan2(at[2], at[1]) == pytest.approx(2 * math.pi * speed / 8)


def test_the_path_is_what_the_ball_follows(arm):
    motion, ball = Motion(arm), ball_on(arm, "tip")
    motion.kind, motion.curve = "curve", "knot"
    path = motion.path(ball)
    assert path.shape == (128, 3)
    for k in range(1, 4):
        motion.advance([ball], 8 / 128)
        assert np.allclose(ball.position, path[k], atol=1e-12)
    ball.mode = "pinned"
    assert motion.path(ball).shape == (0, 3)


@pytest.mark.parametrize("kind", ["curve", "random"])
@pytest.mark.parametrize("mode", ["pinned", "off"])
def test_only_balls_that_lead_are_moved(lion, kind, mode):
    motion, led, other = Motion(lion), ball_on(lion, "nose"), ball_on(lion, "tail_tip", mode)
    motion.kind = kind
    before = other.position.copy()
    motion.advance([other, led], 1.6)
    assert other.position.tolist() == before.tolist()
    assert np.linalg.norm(led.position - led.home) > 1e-3


@pytest.mark.parametrize("curve", ["circle", "square", "knot"])
def test_no_curve_dips_into_the_ground(curve):
    lion = load_quietly("lion", root="free_flyer")
    motion = Motion(lion)
    motion.kind, motion.curve = "curve", curve
    ground = lowest_point(lion, home_configuration(lion))
    for frame in ("left_fore_paw", "nose"):
        path = motion.path(ball_on(lion, frame))
        assert path[:, 2].min() >= ground - 1e-9
    paw = ball_on(lion, "left_fore_paw")
    assert motion.path(paw)[:, 2].min() == pytest.approx(ground, abs=1e-2)


def random_places(robot, frame, seed, count=6, steps=100):
    motion, ball = Motion(robot, seed), ball_on(robot, frame)
    motion.kind = "random"
    places = []
    for _ in range(steps * count):
        motion.advance([ball], 1 / 60)
        if not places or places[-1].tolist() != ball.position.tolist():
            places.append(ball.position.copy())
    return places


def test_random_places_are_the_same_for_the_same_seed_only(arm):
    first, again, other = (random_places(arm, "tip", seed) for seed in (5, 5, 6))
    assert np.array_equal(first, again)
    assert not np.allclose(first[0], other[0])


def test_a_random_place_comes_at_once_and_then_every_second_and_a_half(arm):
    motion, ball = Motion(arm), ball_on(arm, "tip")
    motion.kind = "random"
    changes = []
    for step in range(1, 301):
        before = ball.position.tolist()
        motion.advance([ball], 1 / 60)
        if ball.position.tolist() != before:
            changes.append(step)
    gaps = np.diff(changes)
    assert changes[0] == 1
    assert len(changes) >= 3
    assert set(gaps.tolist()) <= {90, 91}
    motion.speed = 3.0
    quick = advanced(motion, ball, 31).tolist()
    assert advanced(motion, ball, 31).tolist() != quick


@pytest.mark.parametrize(("name", "frame"), [("arm", "tip"), ("panda", "panda_hand_tcp"), ("tiago", "arm_tool_link")])
def test_random_places_can_be_reached_inside_the_limits(name, frame):
    robot = load_quietly(name)
    for place in random_places(robot, frame, seed=1, count=4):
        solution = pinik.solve(robot, pinik.Target(frame, place))
        assert is_inside(robot, solution.q)
        assert np.linalg.norm(plain_placement(robot, frame, solution.q).translation - place) <= 1e-4


def test_all_balls_get_places_of_one_configuration():
    """Two ends of one link keep their distance."""
    lion = load_quietly("lion", root="free_flyer")
    motion = Motion(lion)
    motion.kind = "random"
    balls = [ball_on(lion, "nose"), ball_on(lion, "head")]
    apart = np.linalg.norm(balls[0].position - balls[1].position)
    for _ in range(5):
        motion.advance(balls, 1.6)
        assert np.linalg.norm(balls[0].position - balls[1].position) == pytest.approx(apart)


@pytest.mark.parametrize("kind", ["curve", "random"])
def test_a_restart_repeats_what_was(arm, kind):
    motion, ball = Motion(arm, seed=2), ball_on(arm, "tip")
    motion.kind = kind
    first = [advanced(motion, ball, 50).tolist() for _ in range(5)]
    motion.restart()
    assert [advanced(motion, ball, 50).tolist() for _ in range(5)] == first
