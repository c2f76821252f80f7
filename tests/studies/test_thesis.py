"""The thesis's table and parameters, scaled to a robot; what the tuned methods reach."""

from __future__ import annotations

import math

import numpy as np
import pytest

from pinik import native
from pinik.errors import UnknownNameError
from pinik.studies.comparison import COMPARISONS, Row, compare
from pinik.studies.thesis import METHODS, PRESETS, TABLE, contest, counted_iterations, mismatch, published


def row(method, comparison, efficiency, iterations, updates=0.0, engine="python"):
    return Row(comparison, method, engine, 10, 0.001, iterations, updates, efficiency, 0.0, 0.0, 0.0, 0.0)


def as_published():
    for method in METHODS:
        for comparison in COMPARISONS[:4]:
            cell = TABLE[method][comparison.name]
            updates = 2 * cell.iterations if method == "ccd" else 0.0
            yield row(method, comparison, cell.efficiency, cell.iterations, updates)


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


def test_the_ccd_line_fits_a_failed_step_of_six_or_seven_hundred_bones():
    """With the pseudo-code's limit of 100 for each of six or seven bones the solved steps took some sweeps each."""
    for cell in TABLE["ccd"].values():
        for bones in (6, 7):
            solved = cell.iterations_when_solved(100 * bones)
            assert 1 <= solved <= 20 * bones


def test_a_row_as_published_is_off_by_nothing():
    off = mismatch(as_published(), 2.0)
    assert off.efficiency == pytest.approx(0.0, abs=1e-12)
    assert off.iterations == pytest.approx(1.0)


def test_the_mismatch_is_the_mean_of_points_and_of_factors():
    one, two = COMPARISONS[0], COMPARISONS[1]
    rows = [row("jt", one, 0.68, 56.0), row("jt", two, 0.35, 46.0), row("jt", COMPARISONS[4], 0.9, 1.0)]
    off = mismatch(rows, 2.0)
    assert off.efficiency == pytest.approx(15.0)
    assert off.iterations == pytest.approx(2.0)
    assert mismatch(rows, 2.0, box=True).efficiency == pytest.approx((10.0 + 75.0) / 2)
    assert mismatch([], 2.0) is None


def test_two_hinges_count_as_one_bone_and_the_program_counts_bones_already():
    one = COMPARISONS[0]
    assert counted_iterations(row("ccd", one, 1.0, 3.0, 36.0), 2.0) == 18.0
    assert counted_iterations(row("ccd", one, 1.0, 3.0, 18.0, "program"), 2.0) == 18.0
    assert counted_iterations(row("dls", one, 1.0, 7.0), 2.0) == 7.0


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


@pytest.mark.skipif(native.why_not() is not None, reason="the compiled engine is not there")
def test_tuned_every_method_reaches_99_percent_of_the_reachable_places(arm):
    chosen = contest(arm, "tip", "tuned")
    reachable = [comparison for comparison in COMPARISONS if comparison.motion != "box"]
    for r in compare(arm, "tip", METHODS, chosen.begin, chosen.rules, steps=300, comparisons=reachable):
        assert r.engine == "native"
        assert r.efficiency >= 0.99, (r.method, r.comparison)
        assert r.largest_error < 1e-4 or r.efficiency < 1.0
