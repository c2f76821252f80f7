"""Races: the same start, targets and rules for all, and finishes that plain kinematics and single solves confirm."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from judge import is_inside, plain_placement
from pinik.model.home import home_configuration
from pinik.solvers.registry import make_solver
from pinik.viewer.simulation.balls import Balls
from pinik.viewer.simulation.race import enter, run_race
from pinik.viewer.simulation.race_card import card
from pinik.viewer.simulation.step_settings import StepSettings

ALL = ("ccd", "jt", "pinv", "dls")


def entered(robot, methods=ALL, count=10, seed=3, balls=None, **settings):
    solvers = [make_solver(method) for method in methods]
    balls = Balls(robot) if balls is None else balls
    return enter(robot, solvers, StepSettings(**settings), home_configuration(robot), balls, count, seed)


def test_places_are_repeatable_within_reach_and_the_same_for_all(arm):
    entry = entered(arm)
    assert entry.places.shape == (10, 3)
    np.testing.assert_array_equal(entry.places, entered(arm).places)
    assert (entry.places != entered(arm, seed=4).places).any()
    for place, (target,) in zip(entry.places, entry.targets, strict=True):
        np.testing.assert_allclose(target.position, place)
        assert arm.solve("tip", position=place).success


def test_finishes_are_those_of_single_solves_without_restarts(panda):
    entry = entered(panda, count=3, tolerance=pinik.Tolerance(1e-3, 1e-2))
    race = run_race(entry, rounds=2)
    assert [runner.method for runner in race.runners] == list(ALL)
    home = home_configuration(panda)
    for runner in race.runners:
        for finish, place in zip(runner.finishes, entry.places, strict=True):
            alone = panda.solve(
                entry.frame, position=place, method=runner.method, q0=home, restarts=0, max_iterations=1000,
                tolerance=(1e-3, 1e-2), polish=False,
            )  # fmt: skip
            assert (finish.reached, finish.iterations) == (alone.success, alone.iterations)
            assert finish.time > 0
            off = np.linalg.norm(plain_placement(panda, entry.frame, alone.q).translation - place)
            assert finish.error == pytest.approx(off, abs=1e-9)
            assert finish.reached == (off <= 1e-3)
            assert is_inside(panda, alone.q)


def test_the_first_is_the_quickest_of_those_that_arrived(arm):
    race = run_race(entered(arm, count=6))
    wins, shortest = dict.fromkeys(ALL, 0), dict.fromkeys(ALL, 0)
    for k in range(6):
        there = {r.method: r.finishes[k] for r in race.runners if r.finishes[k].reached}
        assert there
        wins[min(there, key=lambda method: there[method].time)] += 1
        least = min(finish.iterations for finish in there.values())
        for method, finish in there.items():
            shortest[method] += finish.iterations == least
    assert {r.method: r.wins for r in race.runners} == wins
    assert {r.method: r.shortest for r in race.runners} == shortest
    assert sum(wins.values()) == 6


def test_balls_as_they_are_and_a_place_out_of_reach(arm):
    balls = Balls(arm)
    balls[0].put([3.0, 0.0, 0.0])
    race = run_race(entered(arm, count=0, balls=balls), rounds=1)
    for runner in race.runners:
        (finish,) = runner.finishes
        assert not finish.reached
        assert finish.error > 1.5
        assert (runner.wins, runner.arrived) == (0, ())
    assert "the balls as they are" in card(race)
    assert "0/1" in card(race)


def test_the_sessions_limit_of_iterations_holds_for_all(arm):
    race = run_race(entered(arm, count=4, until_reached=False, at_most=2), rounds=1)
    assert race.most == 2
    assert max(finish.iterations for runner in race.runners for finish in runner.finishes) == 2
    assert "at most 2 iterations" in " ".join(card(race).split())


def test_pinned_paws_are_asked_for_at_every_place(lion):
    balls = Balls(lion)
    balls[1].mode = "pinned"
    entry = entered(lion, count=2, balls=balls)
    held = plain_placement(lion, balls[1].frame, home_configuration(lion)).translation
    for targets in entry.targets:
        np.testing.assert_allclose(targets[1].position, held, atol=1e-9)


def test_free_axes_stay_free(arm):
    balls = Balls(arm)
    balls[0].release("xy")
    entry = entered(arm, count=2, balls=balls)
    assert all(target.along == (False, False, True) for (target,) in entry.targets)


def test_methods_that_cannot_are_named_with_the_reason(two_link):
    balls = Balls(two_link)
    balls[0].orient(True, [0.0, 0.0, 0.0])
    race = run_race(entered(two_link, ("two_bone", "dls"), count=2, balls=balls), rounds=1)
    bones, other = race.runners
    assert bones.refusal
    assert (bones.finishes, bones.wins) == ((), 0)
    assert len(other.finishes) == 2
    assert f"two_bone: {bones.refusal}" in " ".join(card(race).split())


def test_a_race_needs_a_ball_that_is_on(arm):
    balls = Balls(arm)
    balls[0].mode = "pinned"
    with pytest.raises(pinik.InputError, match="a ball that is on"):
        entered(arm, balls=balls)


def test_equal_methods_run_once(arm):
    assert len(entered(arm, ("dls", "dls", "ccd")).solvers) == 2


def test_the_card_has_a_line_for_each_method_in_columns(arm):
    race = run_race(entered(arm, count=5))
    title, *rules, head, ccd, jt, pinv, dls, _, _ = card(race).splitlines()
    rows = [ccd, jt, pinv, dls]
    assert title == "pinik race: arm, tip, 5 random places within reach"
    assert " ".join(rules) == "tolerance 0.1 mm, limits on, at most 1000 iterations, no restarts"
    assert head.split() == ["method", "first", "reached", "iterations", "time", "error"]
    found = {row.split()[0]: row.split() for row in rows}
    for runner in race.runners:
        assert found[runner.method][1:3] == [str(runner.wins), f"{len(runner.arrived)}/5"]
    assert len({len(row) for row in rows}) == 1
    assert max(map(len, card(race).splitlines())) <= 54


def test_runners_with_one_method_are_told_apart(arm):
    solvers = [pinik.DampedLeastSquares(damping=0.1), pinik.CCD(), pinik.DampedLeastSquares(damping=2.0)]
    race = run_race(entered(arm, solvers, count=1, until_reached=False, at_most=1), rounds=1)
    assert [runner.called for runner in race.runners] == ["dls, λ = 0.1", "ccd", "dls, λ = 2"]
    assert {"dls, λ = 0.1", "ccd", "dls, λ = 2"} == {row.split("  ")[0] for row in card(race).splitlines()[4:7]}
    assert "at most 1 iteration," in card(race)
