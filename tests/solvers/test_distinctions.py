"""What tells solvers of one method apart."""

from __future__ import annotations

import pytest

from pinik import CCD, DampedLeastSquares, JacobianTranspose
from pinik.solvers.distinctions import distinctions


def test_methods_that_stand_alone_or_are_alike_need_no_words():
    assert distinctions([]) == []
    assert distinctions([CCD(), DampedLeastSquares(), JacobianTranspose()]) == ["", "", ""]
    assert distinctions([DampedLeastSquares(damping=0.1), DampedLeastSquares(damping=0.1), CCD()]) == ["", "", ""]


def test_the_parameters_that_differ_are_named_with_their_symbols():
    one, other = DampedLeastSquares(damping=0.05), DampedLeastSquares(damping=2.0)
    assert distinctions([one, CCD(), other, one]) == ["λ = 0.05", "", "λ = 2", "λ = 0.05"]


@pytest.mark.parametrize(
    ("name", "values", "words"),
    [
        ("rule", ("constant", "sugihara"), ["rule constant", "rule sugihara"]),
        ("target_jacobian", (False, True), ["target jacobian off", "target jacobian on"]),
        ("stiffness", ({}, {"bone1_x": 0.5}), ["no stiffness", "own stiffness"]),
        ("max_step", (0.25, None), ["max step = 0.25 rad or m", "max step = no limit"]),
    ],
)
def test_every_kind_of_parameter_has_words(name, values, words):
    assert distinctions([DampedLeastSquares(**{name: value}) for value in values]) == words


def test_what_matters_most_comes_first_and_more_than_two_are_not_named():
    one, other = CCD(relaxation=None, position_weight=2.0), CCD(relaxation=1.5)
    assert distinctions([one, other]) == ["ω = automatic, k = 2", "ω = 1.5, k = 15"]
    one = DampedLeastSquares(damping=0.1, max_step=0.2, rule="constant")
    assert distinctions([one, DampedLeastSquares()])[0] == "λ = 0.1, max step = 0.2 rad or m, …"
