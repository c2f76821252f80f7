"""The thesis's table and parameters, scaled to a robot; what the tuned methods reach."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engines import needs_native
from pinik.errors import InputError, UnknownNameError
from pinik.studies.comparison import COMPARISONS, Row, compare
from pinik.studies.thesis import METHODS, PRESETS, TABLE, contest, mismatch, published


def row(method, comparison, efficiency, counted):
    return Row(comparison, method, "python", 10, 0.001, 0.0, 0.0, counted, efficiency, 0.0, 0.0, 0.0, 0.0)


def as_published():
    for method in METHODS:
        for comparison in COMPARISONS[:4]:
            cell = TABLE[method][comparison.name]
            yield row(method, comparison, cell.efficiency, cell.iterations)


def test_the_table_is_the_printed_one():
    printed = """
        CCD 1.1 20 99 5.0 210 75 5.0 83 92 16.7 232 74
        Transponirani 5.0 28 78 15.4 92 15 45.6 93 8 47.8 99 3
        Pseudoinverzni 7.0 25 96 21.8 79 47 23.8 40 81 51.9 88 29
        DLS 3.5 18 100 19 100 0 27.8 55 69 50 99 2
    """
    lines = [[float(word) for word in line.split()[1:]] for line in printed.strip().splitlines()]
    for method, figures in zip(METHODS, lines, strict=True):
        for number in range(4):
            cell = TABLE[method][str(number + 1)]
            assert [1000 * cell.time, cell.iterations, 100 * cell.efficiency] == pytest.approx(
                figures[3 * number : 3 * number + 3]
            )


def test_a_row_as_published_is_off_by_nothing():
    off = mismatch(as_published())
    assert off.efficiency == pytest.approx(0.0, abs=1e-12)
    assert off.iterations == pytest.approx(1.0)


def test_the_mismatch_is_the_mean_of_points_and_of_factors():
    one, two = COMPARISONS[0], COMPARISONS[1]
    rows = [row("jt", one, 0.68, 56.0), row("jt", two, 0.35, 46.0), row("jt", COMPARISONS[4], 0.9, 1.0)]
    off = mismatch(rows)
    assert off.efficiency == pytest.approx(15.0)
    assert off.iterations == pytest.approx(2.0)
    assert mismatch(rows, box=True).efficiency == pytest.approx((10.0 + 75.0) / 2)
    assert mismatch([]) is None


@pytest.mark.parametrize(("frame", "why"), [("base", "no length"), ("bone1_x", "no length")])
def test_a_frame_that_no_chain_moves_is_refused(arm, frame, why):
    with pytest.raises(InputError, match=why):
        contest(arm, frame)


def test_a_row_in_a_box_stands_beside_the_random_one():
    assert published(row("ccd", COMPARISONS[4], 0.5, 1.0)) == TABLE["ccd"]["2"]
    assert published(row("mine", COMPARISONS[0], 0.5, 1.0)) is None


@pytest.mark.parametrize("method", ["jt", "pinv", "dls"])
def test_the_scaled_step_is_the_one_in_the_thesis_s_units(arm, method):
    """In metres the solvers take the step that the formulas give in units of a seventh of the arm."""
    chosen = contest(arm, "tip")
    unit = 1.2 / 7
    assert chosen.unit == pytest.approx(unit)
    rng = np.random.default_rng(1)
    J, e = rng.normal(size=(3, 12)), 0.1 * rng.normal(size=3)
    in_units, off = J / unit, e / unit
    expected = {
        "jt": 0.01 * in_units.T @ off,
        "pinv": 0.01 * np.linalg.pinv(in_units) @ off,
        "dls": 0.01 * in_units.T @ np.linalg.inv(in_units @ in_units.T + 1.1**2 * np.eye(3)) @ off,
    }
    solver = chosen.solvers[method]
    assert np.allclose(solver.direction(J, e) * solver.step_size, expected[method])
    assert chosen.rules.tolerance.position == pytest.approx(0.05 * unit)
    assert chosen.rules.max_iterations == 100
    assert chosen.solvers["dls"].max_step == pytest.approx(math.pi / 16)


@pytest.mark.parametrize("reading", PRESETS["thesis"])
def test_every_reading_runs(arm, reading):
    chosen = contest(arm, "tip", "thesis", reading)
    rows = list(compare(arm, "tip", METHODS, chosen.begin, chosen.rules, steps=2, comparisons=COMPARISONS[:2]))
    assert [r.method for r in rows] == [*METHODS, *METHODS]
    assert all(math.isfinite(r.error) for r in rows)


def test_degrees_read_as_radians_are_57_times_alpha(arm):
    assert contest(arm, "tip", "thesis", "degrees").solvers["pinv"].step_size == pytest.approx(0.572958, abs=1e-6)


def test_unknown_names_are_refused_with_the_known_ones(arm):
    with pytest.raises(UnknownNameError, match="thesis"):
        contest(arm, "tip", "thesi")
    with pytest.raises(UnknownNameError, match="literal"):
        contest(arm, "tip", "thesis", "litteral")


@needs_native
def test_tuned_every_method_reaches_99_percent_of_the_reachable_places(arm):
    chosen = contest(arm, "tip", "tuned")
    reachable = [comparison for comparison in COMPARISONS if comparison.motion != "box"]
    for r in compare(arm, "tip", METHODS, chosen.begin, chosen.rules, steps=300, comparisons=reachable):
        assert r.engine == "native"
        assert r.efficiency >= 0.99, (r.method, r.comparison)
        assert r.efficiency < 1.0 or r.largest_error < 1e-4


def test_ccd_turns_its_joints_furthest_when_the_ball_jumps(arm):
    """The thesis: "CCD jumps". From place to place, by the methods alone: restarts jump as well.

    Whole turns are no part of a jump: every answer is at the turn nearest to its start.
    """
    chosen = contest(arm, "tip", "tuned", "no-restarts")
    random = [comparison for comparison in COMPARISONS if comparison.name == "2"]
    jumps = {
        r.method: r.jump for r in compare(arm, "tip", METHODS, chosen.begin, chosen.rules, steps=60, comparisons=random)
    }
    assert jumps["ccd"] > 1.5 * max(jumps[method] for method in ("pinv", "dls"))
