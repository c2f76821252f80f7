"""The pace of a session, which a pause does not slow down."""

from __future__ import annotations

import pytest

from pinik.viewer.web.pace import Pace
from stand_ins import Clock


@pytest.fixture
def clock():
    return Clock()


def walk(pace, clock, steps, seconds):
    for _ in range(steps):
        clock.now += seconds
        pace.note_step()


def test_there_is_no_pace_before_the_second_step_and_after_it_is_forgotten(clock):
    pace = Pace(clock)
    assert pace.value is None
    walk(pace, clock, 1, 0.1)
    assert pace.value is None
    walk(pace, clock, 1, 0.1)
    assert pace.value == pytest.approx(10.0)
    pace.forget()
    assert pace.value is None


def test_the_pace_is_that_of_the_last_sixty_steps(clock):
    pace = Pace(clock)
    walk(pace, clock, 100, 0.5)
    walk(pace, clock, 60, 0.02)
    assert pace.value == pytest.approx(50.0)


def test_a_pause_does_not_count(clock):
    pace = Pace(clock)
    walk(pace, clock, 60, 0.02)
    clock.now += 1000.0
    assert pace.value is None
    walk(pace, clock, 11, 0.02)
    assert pace.value == pytest.approx(50.0)
