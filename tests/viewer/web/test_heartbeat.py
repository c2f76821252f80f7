"""The heartbeat: it rests when nobody watches or asks, and goes on when somebody does."""

from __future__ import annotations

import asyncio
import time

import pytest

import pinik
from judge import plain_placement
from pinik.viewer.web import heartbeat as heartbeat_module
from pinik.viewer.web.heartbeat import Heartbeat
from stand_ins import PATIENCE, Clock


def wait_until(condition):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, "the condition never held"
        time.sleep(0.01)


class Scene:
    """A heartbeat whose clock the test advances, and whose ticks it counts."""

    def __init__(self):
        self.clock, self.ticks, self.watched = Clock(), 0, False
        self.heartbeat = Heartbeat(self.tick, lambda: self.watched, self.clock)

    def tick(self):
        self.ticks += 1

    async def ticks_again(self):
        known = self.ticks
        while self.ticks == known:
            await asyncio.sleep(0.005)

    async def until_it_rests(self):
        while not self.heartbeat.rests:
            await asyncio.sleep(0.005)


def in_loop(test):
    """Run an async test with a new scene."""

    def run():
        async def held():
            scene = Scene()
            await test(scene)
            scene.heartbeat.stop()

        asyncio.run(asyncio.wait_for(held(), PATIENCE))

    run.__name__ = test.__name__
    return run


@in_loop
async def test_it_beats_until_nobody_has_asked_for_ten_seconds(scene):
    await scene.ticks_again()
    scene.clock.now += 9.9
    await scene.ticks_again()
    scene.clock.now += 0.2
    await scene.until_it_rests()
    known = scene.ticks
    await asyncio.sleep(0.1)
    assert scene.ticks == known


@in_loop
async def test_it_beats_as_long_as_somebody_watches_and_ten_seconds_more(scene):
    scene.watched = True
    for _ in range(5):
        scene.clock.now += 100.0
        await scene.ticks_again()
    scene.watched = False
    scene.clock.now += 9.9
    await scene.ticks_again()
    scene.clock.now += 0.2
    await scene.until_it_rests()


@in_loop
async def test_whoever_asks_wakes_it(scene):
    scene.clock.now += 11.0
    await scene.until_it_rests()
    scene.heartbeat.wake()
    await scene.ticks_again()


@pytest.fixture
def resting(arm, monkeypatch):
    """A view whose session has begun, and rests."""
    monkeypatch.setattr(heartbeat_module, "_AWAKE", 0.3)
    with pinik.live(arm, ["dls"], port=0, motion="curve") as view:
        wait_until(lambda: view._heartbeat.rests)
        yield view


def test_a_view_that_rests_takes_no_step(resting):
    step = resting._show.session.steps
    assert step > 0
    time.sleep(0.3)
    assert resting._show.session.steps == step


def test_a_view_that_rests_answers_its_handle_and_goes_on(resting):
    step = resting._show.session.steps
    first = resting.state
    assert (first["step"], first["running"]) == (step, True)
    wait_until(lambda: resting.state["step"] > step + 5)
    later = resting.state
    assert later["instances"][0]["statistics"]["steps"] <= later["step"]


def test_a_ball_that_a_handle_moves_is_followed_after_a_rest(resting):
    step = resting._show.session.steps
    resting.move_ball([0.3, 0.1, 0.8])
    wait_until(lambda: resting.state["step"] > step and resting.state["instances"][0]["status"] == "CONVERGED")
    tip = plain_placement(resting.robot, "tip", resting.configurations[0]).translation
    assert tip == pytest.approx([0.3, 0.1, 0.8], abs=2e-4)
