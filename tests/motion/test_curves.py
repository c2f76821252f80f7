"""The closed curves against their equations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pinik.motion.curves import CURVES, polyline

PHASES = st.floats(0.0, 1.0, exclude_max=True)


@given(st.sampled_from(sorted(CURVES)), PHASES)
def test_every_curve_stays_in_the_unit_ball(name, phase):
    assert math.hypot(*CURVES[name].point(phase)) <= 1.0 + 1e-12


@given(st.sampled_from(sorted(CURVES)), PHASES)
def test_every_curve_is_closed_and_has_no_gap(name, phase):
    here, there = (np.array(CURVES[name].point(p)) for p in (phase, (phase + 1e-4) % 1.0))
    assert np.linalg.norm(here - there) < 1e-4 * 2 * math.pi * 3  # the fastest turns three times as fast as a circle


@pytest.mark.parametrize("name", sorted(CURVES))
def test_every_curve_is_worth_its_size_and_has_a_title(name):
    reach = max(math.hypot(*CURVES[name].point(k / 100)) for k in range(100))
    assert reach > 0.9
    assert CURVES[name].title


@given(PHASES)
def test_the_circle_is_one(phase):
    u, v, w = CURVES["circle"].point(phase)
    assert (math.hypot(u, v), w) == (pytest.approx(1.0), 0.0)
    assert math.atan2(v, u) % (2 * math.pi) == pytest.approx(2 * math.pi * phase, abs=1e-9)


@given(PHASES)
def test_the_eight_is_a_lemniscate_drawn_higher(phase):
    u, v, w = CURVES["eight"].point(phase)
    v /= math.sqrt(2.0)
    assert (u * u + v * v) ** 2 == pytest.approx(u * u - v * v, abs=1e-12)
    assert w == 0.0


@given(PHASES)
def test_the_square_is_a_square_gone_round_at_one_speed(phase):
    u, v, w = CURVES["square"].point(phase)
    half = math.sqrt(0.5)
    assert (max(abs(u), abs(v)), w) == (pytest.approx(half), 0.0)
    corners = {0.0: (half, -half), 0.25: (half, half), 0.5: (-half, half), 0.75: (-half, -half)}
    start = math.floor(4 * phase) / 4
    from_corner = math.dist((u, v), corners[start])
    assert from_corner == pytest.approx(2 * half * 4 * (phase - start), abs=1e-9)


@given(PHASES)
def test_the_knot_lies_on_a_tube_and_winds_about_it_three_times(phase):
    x, y, z = (3.0 * c for c in CURVES["knot"].point(phase))
    across, angle = (5.0 - x * x - y * y) / 4.0, 3 * 2 * math.pi * phase
    assert (across, z) == (pytest.approx(math.cos(angle), abs=1e-9), pytest.approx(-math.sin(angle), abs=1e-9))


@given(PHASES)
def test_the_wave_is_a_circle_from_above_with_four_crests(phase):
    u, v, w = CURVES["wave"].point(phase)
    assert math.hypot(u, w) == pytest.approx(0.9)
    assert v == pytest.approx(0.35 * math.sin(4 * math.atan2(w, u)), abs=1e-9)


def test_a_polyline_is_the_curve_along_the_axes():
    center, axes = np.array([1.0, 2.0, 3.0]), np.array([[0, 2, 0], [0, 0, 0.5], [4, 0, 0]])
    points = polyline(CURVES["circle"], center, axes, count=4)
    expected = [(1, 4, 3), (1, 2, 3.5), (1, 0, 3), (1, 2, 2.5)]
    assert np.allclose(points, expected, atol=1e-12)
    u, v, w = CURVES["wave"].point(1 / 128)
    assert np.allclose(polyline(CURVES["wave"], center, axes)[1], (1 + 4 * w, 2 + 2 * u, 3 + 0.5 * v))
    assert polyline(CURVES["wave"], center, axes).shape == (128, 3)
