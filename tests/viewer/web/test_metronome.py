"""The metronome: as many beats as time asks for, whatever else the loop does."""

from __future__ import annotations

import asyncio
import time

import pytest

from pinik.viewer.web.metronome import Metronome
from stand_ins import PATIENCE, Clock


def talk(conversation):
    return asyncio.run(asyncio.wait_for(conversation(), PATIENCE))


@pytest.mark.parametrize(("busy", "free"), [(0.0, 0.005), (0.03, 0.0), (0.1, 0.005), (0.2, 0.0)])
def test_other_work_in_the_loop_takes_no_beat_away(busy, free):
    """Work that blocks the loop for much longer than a period delays beats, and their number stays that of the time."""

    async def conversation():
        beats = []
        metronome = Metronome(lambda: beats.append(1), 50.0)
        metronome.start()
        began = time.monotonic()
        while time.monotonic() < began + 1.0:
            time.sleep(busy)
            await asyncio.sleep(free)
        await asyncio.sleep(0.05)
        metronome.stop()
        return len(beats) / (time.monotonic() - began)

    assert talk(conversation) == pytest.approx(50.0, abs=3.0)


class Scene:
    """A metronome of ten beats a second whose clock the test advances, and the times of its beats."""

    def __init__(self, costs=0.0):
        self.clock, self.at, self.costs = Clock(), [], costs
        self.metronome = Metronome(self.beat, 10.0, self.clock)
        self.metronome.start()

    def beat(self):
        self.at.append(self.clock.now)
        self.clock.now += self.costs

    async def beats_again(self):
        known = len(self.at)
        while len(self.at) == known:
            await asyncio.sleep(0.0)
        return len(self.at) - known


def test_missed_beats_come_at_once_and_those_of_long_ago_never():
    async def conversation():
        scene = Scene()
        scene.clock.now += 0.35
        first = await scene.beats_again()
        scene.clock.now += 1000.0
        later = await scene.beats_again()
        scene.metronome.stop()
        return first, later

    first, later = talk(conversation)
    assert first == 3  # those of 0.1, 0.2 and 0.3 s
    assert later in (5, 6)  # those of the last half a second


def test_slow_beats_leave_the_loop_its_turn_between_two_of_them():
    """A beat that takes longer than a period would otherwise keep everything else waiting for good."""

    async def conversation():
        scene = Scene(costs=0.15)
        turns = []
        while len(scene.at) < 6:
            turns.append(await scene.beats_again())
        scene.metronome.stop()
        return turns

    assert talk(conversation) == [1] * 6


def test_beats_get_as_much_time_as_the_other_work_takes():
    """Other work of 0.45 s is followed by beats of 0.15 s: three of them, though each is longer than a period."""

    async def conversation():
        scene = Scene(costs=0.15)
        counts = []
        for _ in range(5):
            scene.clock.now += 0.45
            counts.append(await scene.beats_again())
        scene.metronome.stop()
        return counts

    assert set(talk(conversation)) <= {3, 4}  # 4 if the sum of three is rounded to less


def test_a_beat_that_raises_is_not_the_last(caplog):
    async def conversation():
        scene = Scene()

        def fail():
            scene.at.append(scene.clock.now)
            raise ArithmeticError("a beat has failed")

        scene.metronome._beat = fail
        for _ in range(3):
            scene.clock.now += 0.1
            await scene.beats_again()
        scene.metronome.stop()

    talk(conversation)
    failures = [record.exc_info[1] for record in caplog.records if record.exc_info]
    assert [str(failure) for failure in failures] == ["a beat has failed"] * 3


def test_it_can_be_stopped_by_a_beat_and_started_anew():
    async def conversation():
        scene = Scene()
        count = []

        def last():
            count.append(1)
            scene.metronome.stop()

        scene.metronome._beat = last
        scene.clock.now += 0.5
        await asyncio.sleep(0.3)
        assert (len(count), scene.metronome.runs) == (1, False)
        scene.metronome.start()
        scene.metronome.start()
        await asyncio.sleep(0.3)
        return len(count)

    assert talk(conversation) == 2


def test_a_beat_that_starts_it_anew_leaves_one_timer_that_stop_takes_away():
    async def conversation():
        scene = Scene()
        count = []

        def anew():
            count.append(1)
            scene.metronome.stop()
            scene.metronome.start()

        scene.metronome._beat = anew
        scene.clock.now += 0.1
        while not count:
            await asyncio.sleep(0.0)
        scene.metronome.stop()
        await asyncio.sleep(0.3)
        return len(count)

    assert talk(conversation) == 1
