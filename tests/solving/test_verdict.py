"""The verdict on a configuration, where no other test asks for it."""

from __future__ import annotations

import re

import numpy as np
import pytest

import pinik
from engines import needs_native
from pinik import Status, Target

ENGINES = ["python", pytest.param("native", marks=needs_native)]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("behind", "there"), [(1e-7, True), (1e-5, False)])
def test_a_frame_at_the_very_point_that_its_axis_should_point_at_points_at_it(behind, there, engine, two_link):
    """1e-6 m is the documented distance; the axis looks away from the point, so beyond it the error is half a turn."""
    tip = two_link.placement("tip", two_link.neutral())
    target = Target("tip", axis="x", at=tip.translation - behind * tip.rotation[:, 0])
    solution = pinik.solve(two_link, target, locked=two_link.joint_names, engine=engine)
    assert solution.success == there
    assert solution.orientation_error == pytest.approx(0.0 if there else np.pi)


@pytest.mark.parametrize("engine", ENGINES)
def test_where_every_joint_is_locked_a_miss_within_reach_has_stalled_at_the_start(engine, two_link):
    start = np.array([0.3, 0.4])
    wanted = two_link.placement("tip", np.array([0.5, 0.6])).translation
    solution = pinik.solve(two_link, Target("tip", wanted), q0=start, locked=two_link.joint_names, engine=engine)
    assert solution.status is Status.STALLED
    np.testing.assert_array_equal(solution.q, start)


def test_of_a_single_answer_the_message_says_its_errors_and_no_more(two_link):
    solution = pinik.solve(two_link, "tip", position=[0.5, 0.4, 0.0])
    assert re.fullmatch(r"converged, (less than )?[0-9.]+ (µm|mm) off", solution.message)


def test_a_sweep_of_another_shape_is_refused_with_both_shapes(two_link):
    class Longer(pinik.CCD):
        def sweep(self, q, kinematics, limits, tolerance):
            return np.append(q, 0.0), 1

    with pytest.raises(pinik.InputError, match=r"must return q of shape \(2,\); got \(3,\)"):
        pinik.solve(two_link, "tip", position=[0.5, 0.4, 0.0], method=Longer())
