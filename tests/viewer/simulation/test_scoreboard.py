"""All methods are counted over the same steps, and their figures begin anew whenever what is compared changes."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from judge import plain_placement
from pinik.problem.tolerance import Tolerance
from pinik.viewer.protocol.messages import apply
from pinik.viewer.simulation.another_robot import with_robot
from pinik.viewer.simulation.session import Session
from stand_ins import Clock

ELSEWHERE = [0.3, 0.1, 0.8]


SLOW = pinik.DampedLeastSquares(step_size=0.1)
"""It needs several steps where others need one."""


class Own(pinik.DampedLeastSquares):
    """A method of one's own, which the engine in Python steps: it looks at the clock before every iteration."""

    name = "own"


def race(robot, methods=("dls", SLOW), **options):
    shown = Session(robot, methods, clock=Clock(), **options)
    shown.change_settings(until_reached=False, at_most=10)
    return shown


def missed(shown, one):
    ball = shown.balls[0]
    return float(np.linalg.norm(plain_placement(shown.robot, ball.frame, one.q).translation - ball.position))


def counts(shown):
    return [summary.steps for summary in shown.summaries]


def test_a_step_counts_for_all_as_soon_as_it_counts_for_one(arm):
    """The errors are averaged by hand over every step in which one of the two still had to go."""
    shown = race(arm)
    shown.move_ball(0, ELSEWHERE)
    errors, worked = [], []
    for _ in range(60):
        shown.step()
        if any(one.counted for one in shown.seen):
            errors.append([missed(shown, one) for one in shown.seen])
            worked.append([one.counted for one in shown.seen])
    quick, slow = shown.summaries
    assert [one.status for one in shown.seen] == ["CONVERGED"] * 2
    assert quick.steps == slow.steps == len(errors) < 60
    assert [quick.busy, slow.busy] == np.sum(worked, axis=0).tolist()
    assert quick.busy < slow.busy == slow.steps
    assert [quick.mean_error, slow.mean_error] == pytest.approx(np.mean(errors, axis=0))
    assert quick.mean_error < slow.mean_error
    assert quick.efficiency == pytest.approx(np.mean([error[0] <= 1e-4 for error in errors]))
    assert quick.mean_time * quick.steps <= slow.mean_time * slow.steps


def test_a_method_that_waits_shares_no_step(two_link):
    shown = Session(two_link, ["dls", "two_bone"], clock=Clock())
    shown.set_motion("curve")
    shown.add_ball("link2")
    for _ in range(4):
        shown.step()
    assert counts(shown) == [4, 0]
    shown.balls.remove(1)
    for _ in range(3):
        shown.step()
    assert counts(shown) == [3, 3]


CHANGES = {
    "method": lambda s: s.set_method(0, "ccd"),
    "parameter": lambda s: s.set_parameter(1, "damping", 0.3),
    "motion": lambda s: s.set_motion("random"),
    "curve": lambda s: s.set_curve("square"),
    "speed": lambda s: setattr(s.motion, "speed", 2.0),
    "view": lambda s: s.set_view(4),
    "limits": lambda s: s.change_settings(limits=False),
    "tolerance": lambda s: s.change_settings(tolerance=Tolerance(0.01, 0.01)),
    "polish": lambda s: s.change_settings(polish=True),
    "iterations": lambda s: s.change_settings(at_most=3),
    "mode": lambda s: s.set_mode(0, "pinned"),
    "free": lambda s: s.balls[0].release("x"),
    "orientation": lambda s: s.balls[0].orient(True, [0, 0, 0]),
    "ball's tolerance": lambda s: s.balls[0].tolerate(Tolerance(0.02, 0.1)),
    "another ball": lambda s: s.add_ball("bone3"),
    "by hand": lambda s: s.move_ball(0, ELSEWHERE),
    "reset": lambda s: s.reset(),
    "begin anew": lambda s: s.scores.begin_anew(s.view),
}


@pytest.mark.parametrize("change", CHANGES)
def test_whatever_changes_what_is_compared_begins_anew_for_all(arm, change):
    shown = race(arm)
    shown.set_motion("curve")
    for _ in range(5):
        shown.step()
    assert counts(shown) == [5, 5]
    where = [one.q for one in shown.seen]
    CHANGES[change](shown)
    assert set(counts(shown)) == {0}
    if change != "reset":
        assert all(one.q is q for one, q in zip(shown.seen, where, strict=False))
    shown.step()
    assert set(counts(shown)) == {1}


def test_a_ball_moved_by_hand_and_a_setting_that_does_not_apply_go_on_counting(arm):
    shown = race(arm)
    for x in (0.3, 0.31, 0.32):
        shown.move_ball(0, [x, 0.1, 0.8])
        shown.step()
    shown.set_curve("square")
    shown.motion.speed = 3.0
    shown.scores.cover("all")
    assert counts(shown) == [3, 3]


def test_the_figures_cover_the_last_thousand_steps_or_all(arm):
    shown = race(arm, ["dls"])
    shown.set_motion("curve")
    for _ in range(1010):
        shown.step()
    assert counts(shown) == [1000]
    shown.scores.cover("all")
    assert counts(shown) == [1010]
    assert with_robot(shown, arm).scores.window == "all"
    with pytest.raises(pinik.UnknownNameError, match="window of the statistics 'some'"):
        shown.scores.cover("some")


@pytest.mark.parametrize("stop", [{"type": "run", "on": False}, {"type": "step_iteration", "instance": None}])
def test_the_figures_show_every_step_once_the_session_stops(arm, stop):
    shown = race(arm)
    shown.set_motion("curve")
    shown.running = True
    for _ in range(25):
        shown.tick()
    assert counts(shown) == [0, 0]
    apply(shown, stop)
    assert counts(shown) == [25, 25]


def test_the_figures_show_the_miss_that_the_session_has_paused_on(arm):
    shown = race(arm, ["dls"])
    shown.misses.pause = shown.running = True
    for _ in range(5):
        shown.tick()
    before = shown.steps
    shown.move_ball(0, [9.0, 0.0, 0.0])
    while shown.running:
        shown.tick()
    assert shown.misses.last
    (summary,) = shown.summaries
    assert summary.busy >= shown.steps - before > 0
    assert summary.efficiency < 1.0


def test_steps_that_the_clock_ends_are_counted_apart(arm):
    shown = Session(
        arm, [Own, "ccd"], clock=Clock(each=0.04)
    )  # two turns are longer than what a single step of one robot may take
    shown.set_motion("random")
    ended = [0, 0]
    for _ in range(20):
        shown.step()
        ended = [n + (one.counted and one.status == "TIME_LIMIT") for n, one in zip(ended, shown.seen, strict=True)]
    assert [summary.cut_off for summary in shown.summaries] == ended
    assert sum(ended) > 0
