"""The statistics of the last thousand steps against numpy's."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pinik.motion.figures import StepFigures
from pinik.viewer.simulation.statistics import WINDOW, Statistics

FIGURES = st.builds(
    StepFigures,
    time=st.floats(0, 1),
    iterations=st.integers(0, 1000),
    joint_updates=st.integers(0, 10_000),
    reached=st.booleans(),
    error=st.none() | st.floats(0, 10),
    jump=st.floats(0, 7),
    idle=st.booleans(),
    cut_off=st.booleans(),
)


def filled(steps, window="last"):
    statistics = Statistics()
    for step in steps:
        statistics.add(step)
    return statistics.summary(window)


@given(st.lists(FIGURES, min_size=1, max_size=40), st.sampled_from(["last", "all"]))
def test_a_summary_is_the_means_and_the_largest(steps, window):
    summary = filled(steps, window)
    errors = [s.error for s in steps if s.error is not None]
    assert summary.steps == len(steps)
    assert summary.mean_time == pytest.approx(np.mean([s.time for s in steps]))
    assert summary.mean_iterations == pytest.approx(np.mean([s.iterations for s in steps]))
    assert summary.mean_joint_updates == pytest.approx(np.mean([s.joint_updates for s in steps]))
    assert summary.efficiency == pytest.approx(sum(s.reached for s in steps) / len(steps))
    assert summary.mean_error == (pytest.approx(np.mean(errors)) if errors else None)
    assert summary.largest_jump == max(s.jump for s in steps)
    assert summary.busy == len([s for s in steps if not s.idle])
    assert summary.cut_off == len([s for s in steps if s.cut_off])


def test_nothing_to_tell_is_none():
    assert filled([]) == filled([], "all") == (0, None, None, None, None, None, None, 0, 0)


def test_the_window_is_the_last_thousand_steps_exactly():
    assert WINDOW == 1000
    first = StepFigures(time=5.0, iterations=7, joint_updates=0, reached=False, error=3.0, jump=9.0)
    other = StepFigures(time=1.0, iterations=2, joint_updates=4, reached=True, error=1.0, jump=0.5)
    full = filled([first, *[other] * 999])
    assert (full.steps, full.largest_jump, full.efficiency) == (1000, 9.0, 0.999)
    assert full.mean_time == pytest.approx((5.0 + 999) / 1000)
    moved_on = filled([first, *[other] * 1000])
    assert moved_on == (1000, 1.0, 2.0, 4.0, 1.0, 1.0, 0.5, 1000, 0)
    whole = filled([first, *[other] * 1000], "all")
    assert (whole.steps, whole.largest_jump, whole.efficiency) == (1001, 9.0, pytest.approx(1000 / 1001))


def test_the_newest_steps_come_newest_first():
    statistics = Statistics()
    for jump in range(5):
        statistics.add(StepFigures(0.0, 1, 0, reached=False, error=None, jump=jump))
    assert [step.jump for step in statistics.newest(3)] == [4, 3, 2]
    assert len(statistics.newest(30)) == 5
