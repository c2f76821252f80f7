"""The balls of a session: which there are, and in which order."""

from __future__ import annotations

import pinocchio
import pytest

import pinik
from judge import plain_placement
from pinik.model.home import home_configuration
from pinik.viewer.simulation.balls import MOST_BALLS, Balls
from robots import load_quietly


@pytest.fixture(scope="module")
def lion():
    return load_quietly("lion", root="free_flyer")


def test_the_first_ball_is_on_and_the_paws_on_the_ground_are_pinned(lion):
    balls = Balls(lion)
    assert [ball.mode for ball in balls] == ["on", "pinned", "pinned", "pinned", "off", "off"]
    assert [target.frame for target in balls.targets] == balls.frames[:4]
    assert {ball.mode for ball in Balls(load_quietly("lion"))} == {"on", "off"}


def test_a_new_ball_is_at_its_frame_in_the_home_configuration(lion):
    ball = Balls(lion).add("head", "pinned")
    at = plain_placement(lion, "head", home_configuration(lion))
    assert pinocchio.XYZQUATToSE3(ball.placement).isApprox(at, 1e-9)


def test_balls_have_frames_of_their_own_and_are_neither_too_many_nor_none(lion):
    balls = Balls(lion)
    with pytest.raises(pinik.UnknownNameError, match="no frame 'tail'"):
        balls.add("tail", "on")
    with pytest.raises(pinik.InputError, match="already has a ball"):
        balls.add(balls.frames[2], "on")
    for name in [name for name in lion.description.links if name not in balls.frames][: MOST_BALLS - len(balls)]:
        balls.add(name, "off")
    with pytest.raises(pinik.InputError, match=f"at most {MOST_BALLS} balls"):
        balls.add(next(name for name in lion.description.links if name not in balls.frames), "off")
    while len(balls) > 1:
        balls.remove(0)
    with pytest.raises(pinik.InputError, match="last ball cannot be removed"):
        balls.remove(0)


def test_balls_are_arranged_by_frame(lion):
    balls = Balls(lion)
    order = balls.frames[::-1]
    balls.arrange(order)
    assert balls.frames == [ball.frame for ball in balls] == order
    assert balls.number(5).mode == "on"
    with pytest.raises(pinik.InputError, match="from 0 to 5; got 6"):
        balls.number(6)
