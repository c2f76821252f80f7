"""One parameter of a solver: what is refused is answered with the range, the unit and the other values allowed."""

from __future__ import annotations

import math

import pytest

from pinik.errors import InputError
from pinik.solvers.parameter import JointValues, Parameter, max_step_parameter, parameter

NUMBER = Parameter(0.5, "", low=0.25, high=2.0, name="gain")
TIME = Parameter(1.0, "", unit="s", low=0.5, optional=True, name="pause")
REACH = Parameter(math.inf, "", unit="m", low=0.5, unbounded=True, name="reach")
CHOICE = Parameter("a", "", choices=("a", "b"), name="rule")
JOINTS = Parameter(JointValues(), "", low=0.0, high=1.0, name="stiff")


@pytest.mark.parametrize(
    ("parameter", "value", "words"),
    [
        (NUMBER, 3.0, "m: gain must be a finite number from 0.25 to 2; got 3.0"),
        (TIME, 0.25, "m: pause must be a finite number of at least 0.5 [s] or None; got 0.25"),
        (TIME, math.inf, "m: pause must be a finite number of at least 0.5 [s] or None; got inf"),
        (REACH, 0.25, "m: reach must be a number of at least 0.5 [m]; got 0.25"),
        (REACH, True, "m: reach must be a number of at least 0.5 [m]; got True"),
        (CHOICE, "c", "m: rule must be one of 'a', 'b'; got 'c'"),
        (CHOICE, 1, "m: rule must be one of 'a', 'b'; got 1"),
        (CHOICE, ["a"], "m: rule must be one of 'a', 'b'; got ['a']"),
        (JOINTS, 0.5, "m: stiff must map joint names to numbers; got 0.5"),
        (JOINTS, {"j": 2.0}, "m: stiff['j'] must be a finite number from 0 to 1; got 2.0"),
    ],
)
def test_what_is_refused_is_answered_with_what_it_may_be(parameter, value, words):
    with pytest.raises(InputError) as caught:
        parameter.check(value, "m")
    assert str(caught.value) == words


@pytest.mark.parametrize(
    ("parameter", "given", "taken"),
    [(TIME, None, None), (REACH, None, math.inf), (NUMBER, 2, 2.0), (JOINTS, {"j": 1}, JointValues({"j": 1.0}))],
)
def test_what_is_allowed_is_taken(parameter, given, taken):
    assert parameter.check(given, "m") == taken


def test_the_json_form_has_no_infinity_and_plain_dicts():
    assert REACH.plain(math.inf) is None
    assert REACH.plain(1.5) == 1.5
    assert type(JOINTS.plain(JointValues({"j": 1.0}))) is dict
    assert CHOICE.plain("a") == "a"


def test_a_field_describes_its_parameter_by_all_that_it_was_given():
    given = {"unit": "s", "low": 0.5, "high": 4.0, "slider": (1.0, 2.0), "optional": True, "unbounded": True}
    field = parameter(1.5, "how long", choices=["a", "b"], symbol="t", level=3, **given)
    described = Parameter(1.5, "how long", choices=("a", "b"), symbol="t", level=3, **given)
    assert (field.default, field.metadata["parameter"]) == (1.5, described)


def test_the_largest_step_has_the_default_of_its_method_no_end_and_a_least_value():
    described = max_step_parameter(0.3).metadata["parameter"]
    assert described.default == 0.3
    assert described.check(None, "m") == math.inf
    with pytest.raises(InputError, match=r"at least 1e-06 \[rad or m\]; got 1e-07"):
        described.check(1e-7, "m")
