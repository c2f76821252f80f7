"""A robot that swings in front of a target that it misses is said to do so, and no other is."""

from __future__ import annotations

import re

import numpy as np
import pytest

import pinik
from pinik.motion.figures import StepFigures
from pinik.viewer.protocol.state import session_state
from pinik.viewer.simulation.session import Session
from pinik.viewer.simulation.swinging import LOOKED_AT, swinging

FAR = [0.0, 1.5, 0.2]


def chase(robot, method, count=120, at=FAR, **parameters):
    """The card's message, and the jumps of the last steps in degrees by differences of configurations."""
    shown = Session(robot, [method])
    for name, value in parameters.items():
        shown.set_parameter(0, name, value)
    shown.move_ball(0, at)
    jumps = []
    for _ in range(count):
        before = shown.instances[0].q
        shown.step()
        jumps.append(np.degrees(np.abs(shown.instances[0].q - before).max()))
    return session_state(shown)["instances"][0]["message"], jumps[-LOOKED_AT:]


def test_the_pseudo_inverse_out_of_reach_says_that_it_swings_by_how_much_and_why(arm):
    message, jumps = chase(arm, "pinv", max_residual=0.05)
    swing = re.search(r"it swings by (\d+)°(?: to (\d+)°)? in one step and does not come to rest: .*dls", message)
    assert message.startswith("unreachable")
    assert message.count("come to rest") == 1  # what another method does is not known: dls may swing too, if less
    large = [jump for jump in jumps if jump > 6]
    assert int(swing[1]) == round(min(large))
    assert int(swing[2] or swing[1]) == round(max(large))


@pytest.mark.parametrize("method", ["dls", "jt", "ccd"])
def test_what_comes_to_rest_out_of_reach_says_nothing_of_a_swing(arm, method):
    """Among them the remedy that the sentence names."""
    message, jumps = chase(arm, method)
    assert max(jumps) < 1
    assert "swing" not in message


def test_a_quick_chase_is_no_swing(arm):
    message, _ = chase(arm, "pinv", at=[0.3, 0.1, 0.8])
    assert "swing" not in message


def test_half_a_second_of_misses_is_needed():
    wild, calm = StepFigures(0.0, 1, 0, False, 1.0, 0.5), StepFigures(0.0, 1, 0, True, 0.0, 0.5)
    solver = pinik.DampedLeastSquares()
    assert swinging(solver, [wild] * LOOKED_AT) == "it swings by 29° in one step and does not come to rest"
    assert swinging(solver, [wild] * (LOOKED_AT - 1)) == ""
    assert swinging(solver, [*[wild] * (LOOKED_AT - 1), calm]) == ""
    assert swinging(solver, [*[wild] * LOOKED_AT, calm]) != ""
