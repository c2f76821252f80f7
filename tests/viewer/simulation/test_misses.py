"""Pausing on a miss: at the step at which an instance misses, once for each miss."""

from __future__ import annotations

from pinik.viewer.protocol.messages import apply
from pinik.viewer.simulation.session import Session
from stand_ins import Clock

NEAR, FAR, FARTHER = [0.4, 0.2, 0.8], [3.0, 0.0, 0.5], [3.5, 0.0, 0.5]


def running(arm, methods=("dls",)):
    shown = Session(arm, methods, clock=Clock())
    apply(shown, {"type": "pause_on_miss", "on": True})
    apply(shown, {"type": "run", "on": True})
    return shown


def ticks(shown, count=30):
    return sum(shown.tick() for _ in range(count))


def test_it_runs_on_while_targets_are_reached_and_pauses_where_one_is_missed(arm):
    shown = running(arm, ("ccd", "dls"))
    shown.move_ball(0, NEAR)
    assert ticks(shown) == 30
    shown.move_ball(0, FAR)
    assert 0 < ticks(shown) < 30
    assert not shown.running
    assert "(ccd) missed: " in shown.misses.last
    assert "beyond its chain's reach" in shown.misses.last


def test_a_session_that_goes_on_is_not_paused_again_by_the_same_miss(arm):
    shown = running(arm)
    shown.move_ball(0, FAR)
    ticks(shown)
    apply(shown, {"type": "run", "on": True})
    assert shown.misses.last is None
    shown.move_ball(0, FARTHER)
    assert ticks(shown) == 30
    shown.move_ball(0, NEAR)
    assert ticks(shown) == 30
    shown.move_ball(0, FAR)
    assert ticks(shown) < 30


def test_without_the_switch_nothing_pauses(arm):
    shown = running(arm)
    apply(shown, {"type": "pause_on_miss", "on": False})
    shown.move_ball(0, FAR)
    assert ticks(shown) == 30
    assert shown.misses.last is None
