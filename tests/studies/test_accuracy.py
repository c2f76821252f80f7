"""Welman's figures, by what he says of them and by counting for oneself."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from pinik.studies.accuracy import CASES, EDGE, NEAR, Problem, accuracy, asked_of, problems
from pinik.studies.chain import TIP, planar_chain

CHAIN = planar_chain()
SOLVERS = {name: solver() for name, solver in pinik.SOLVERS.items()}


def costs(asked, digits=(1, 2, 4), **options):
    answers = accuracy(CHAIN, SOLVERS, asked, digits, repeats=1, **options)
    return {(cost.case, cost.method, cost.digits): cost for cost in answers}


def test_problems_lie_where_their_case_says_and_are_the_same_for_a_seed():
    for case, away in ((NEAR, 0.5), (EDGE, 0.99)):
        own = problems(CHAIN, case, 6, edge=0.99, seed=3)
        again = problems(CHAIN, case, 6, edge=0.99, seed=3)
        other = problems(CHAIN, case, 6, edge=0.99, seed=4)
        assert [np.linalg.norm(problem.place) for problem in own] == pytest.approx([away] * 6)
        assert all((a.place == b.place).all() and (a.start == b.start).all() for a, b in zip(own, again, strict=True))
        assert (own[0].start == other[0].start).all(), "the first is the pictures'"
        assert all((a.start != b.start).all() for a, b in zip(own[1:], other[1:], strict=True))


@pytest.mark.parametrize("edge", [0.0, 1.01, float("nan")])
def test_an_edge_beyond_reach_is_refused(edge):
    with pytest.raises(pinik.InputError, match="a part of the chain's length"):
        problems(CHAIN, EDGE, 1, edge=edge)


@pytest.mark.parametrize("method", list(SOLVERS))
def test_iterations_to_a_digit_are_those_after_which_the_tip_is_that_near(method):
    """Counted along one run to the end, with distances by plain forward kinematics."""
    problem = problems(CHAIN, NEAR, 2)[1]
    target = pinik.Target(TIP, problem.place)
    states = pinik.iterate(
        CHAIN, target, SOLVERS[method], problem.start, limits=False, tolerance=(1e-8, 1.0), max_iterations=10**4
    )
    away = [np.linalg.norm(CHAIN.placement(TIP, state.q).translation - problem.place) for state in states]
    found = costs({NEAR: [problem]}, digits=range(1, 9), engine="python")
    for digits in range(1, 9):
        expected = next(count for count, distance in enumerate(away) if distance <= 10.0**-digits)
        assert found[NEAR, method, digits].iterations == expected


def test_medians_are_over_the_solved_problems_and_the_share_is_told():
    solvable = problems(CHAIN, NEAR, 1)[0]
    beyond = Problem(NEAR, solvable.start, np.array([1.5, 0.0, 0.0]))
    found = costs({NEAR: [solvable, beyond]}, digits=(3,))
    alone = costs({NEAR: [solvable]}, digits=(3,))
    none = costs({NEAR: [beyond]}, digits=(3,))
    for method in SOLVERS:
        both = found[NEAR, method, 3]
        assert (both.solved, both.iterations) == (0.5, alone[NEAR, method, 3].iterations)
        missed = none[NEAR, method, 3]
        assert (missed.solved, missed.iterations, missed.time, missed.most_iterations) == (0.0, None, None, None)


def test_what_welman_says_of_his_figures():
    """Near, each digit costs the transpose more; at the edge CCD is far ahead of it, and both slow down."""
    found = costs({case: problems(CHAIN, case, 5) for case in CASES})
    for case in CASES:
        counts = [found[case, "jt", digits].iterations for digits in (1, 2, 4)]
        assert counts == sorted(counts)
        assert counts[0] < counts[2]
    assert found[NEAR, "ccd", 4].iterations < found[NEAR, "jt", 4].iterations
    assert found[EDGE, "jt", 4].iterations > 3 * found[EDGE, "ccd", 4].iterations
    assert found[EDGE, "ccd", 4].iterations > 100 * found[NEAR, "ccd", 4].iterations
    for method in ("pinv", "dls"):  # whose steps see the singular direction
        assert found[EDGE, method, 4].iterations < 30
    assert all(cost.solved == 1.0 for cost in found.values())


def test_a_bare_method_neither_restarts_nor_knows_limits():
    answer = asked_of(CHAIN, SOLVERS["dls"])(np.array([2.0, 0.0, 0.0]), np.full(7, 4.0))
    assert not answer.success
    assert answer.restarts == 0
    assert answer.active_limits == ()
