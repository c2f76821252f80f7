"""Tolerances, and the errors that are compared with them, at the edge and beyond."""

from __future__ import annotations

import math

import pytest

from pinik import InputError, TargetError, Tolerance
from pinik.problem.tolerance import largest_of

BOX = Tolerance((0.1, 0.2, 0.3), 0.5)
BALL = Tolerance(0.1, 0.5)


class TestBoxes:
    @pytest.mark.parametrize(
        ("value", "words"),
        [
            (((1, 2), 1), r"box position must be 3 finite numbers \(a box, in metres\); got an array of shape \(2,\)"),
            (((1, 2, math.nan), 1), r"box position must be 3 finite numbers \(a box, in metres\)"),
            (((1, 2, 3), "wide"), "box orientation must be a finite number; got 'wide'"),
            (((1, 2, 3), math.inf), "box orientation must be a finite number; got inf"),
            (((0, 2, 3), 1), "box must be three positive lengths and a positive angle; got"),
            (((1, -2, 3), 1), "box must be three positive lengths and a positive angle; got"),
            (((1, 2, 0), 1), "box must be three positive lengths and a positive angle; got"),
            (((1, 2, 3), 0), "box must be three positive lengths and a positive angle; got"),
        ],
    )
    def test_are_refused_in_words_where_they_are_none(self, value, words):
        with pytest.raises(InputError, match=words):
            Tolerance.of(value, "box")

    def test_reach_as_far_as_their_corners(self):
        assert BOX.box == (0.1, 0.2, 0.3)
        assert BOX.farthest == pytest.approx(math.sqrt(0.01 + 0.04 + 0.09))
        assert (BALL.box, BALL.farthest) == (None, 0.1)


class TestWithin:
    @pytest.mark.parametrize(
        ("error", "tolerance", "verdict"),
        [
            (TargetError(0.1, 0.5), BALL, True),
            (TargetError(0.1, None), BALL, True),
            (TargetError(None, 0.5), BALL, True),
            (TargetError(math.nextafter(0.1, 1), 0.5), BALL, False),
            (TargetError(0.1, math.nextafter(0.5, 1)), BALL, False),
            (TargetError(0.37, 0.5, (0.1, -0.2, 0.3)), BOX, True),
            (TargetError(0.2, 0.5, (math.nextafter(0.1, 1), 0.0, 0.0)), BOX, False),
            (TargetError(0.3, 0.5, (0.0, -math.nextafter(0.2, 1), 0.0)), BOX, False),
            (TargetError(0.4, 0.5, (0.0, 0.0, -0.4)), BOX, False),
            (TargetError(None, 0.5), BOX, True),
        ],
    )
    def test_counts_the_edge_as_inside(self, error, tolerance, verdict):
        assert error.within(tolerance) is verdict


class TestExcess:
    @pytest.mark.parametrize(
        ("error", "tolerance", "excess"),
        [
            (TargetError(0.1, 0.5), BALL, 0.0),
            (TargetError(0.4, 0.5), BALL, 0.3),
            (TargetError(0.4, None), BALL, 0.3),
            (TargetError(None, 2.5), BALL, 4.0),
            (TargetError(None, 0.1), BALL, 0.0),
            (TargetError(3.1, 2.5), BALL, 5.0),
            (TargetError(0.37, 0.5, (0.1, -0.2, 0.3)), BOX, 0.0),
            (TargetError(9.0, 0.5, (3.1, -4.2, 0.1)), BOX, 5.0),
            (TargetError(9.0, 6.5, (0.0, 5.2, 0.0)), BOX, 13.0),
            (TargetError(None, 2.5), BOX, 4.0),
        ],
    )
    def test_is_the_norm_of_what_lies_beyond_with_two_metres_for_a_radian(self, error, tolerance, excess):
        assert error.excess(tolerance, 2.0) == pytest.approx(excess)


def test_the_largest_errors_are_those_that_were_asked_for():
    assert largest_of([TargetError(None, 0.5), TargetError(None, 0.2)]) == TargetError(None, 0.5)
    assert largest_of([TargetError(0.1, None), TargetError(0.3, None)]) == TargetError(0.3, None)
    assert largest_of([TargetError(0.1, None), TargetError(None, 0.2)]) == TargetError(0.1, 0.2)
