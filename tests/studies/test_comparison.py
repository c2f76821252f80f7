"""The four comparisons: their places, and the means of what a method did."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from judge import assert_good, plain_placement
from pinik.model.home import home_configuration
from pinik.motion.figures import StepFigures
from pinik.problem.tolerance import Tolerance
from pinik.studies.comparison import COMPARISONS, Comparison, bones, chain_length, compare, places
from pinik.studies.steps import Rules

RULES = Rules(tolerance=Tolerance())


class Scripted:
    """A chase that answers with given steps and writes down where it was sent."""

    engine = "none"

    def __init__(self, *steps):
        self.steps = list(steps)
        self.places = []

    def step(self, place):
        self.places.append(place.tolist())
        return self.steps[(len(self.places) - 1) % len(self.steps)]


STILL = StepFigures(0.0, 0, 0, True, 0.0, 0.0)


def rows(robot, chase, rules=RULES, **options):
    options = {"steps": 4, "comparisons": COMPARISONS[:1]} | options
    return list(compare(robot, "tip", ["a"], lambda *_: chase, rules, **options))


def test_two_hinges_about_one_point_are_one_bone(arm, two_link):
    assert bones(arm, "tip") == (6, 12)
    assert bones(two_link, "tip") == (2, 2)


def test_the_arm_is_as_long_as_its_bones(arm):
    assert chain_length(arm, "tip") == pytest.approx(0.28 + 0.25 + 0.21 + 0.17 + 0.13 + 0.16)


def test_a_link_that_no_joint_moves_has_a_chain_without_length():
    mast = pinik.load(
        """<robot name="mast"><link name="base"/><link name="top"/>
        <joint name="weld" type="fixed"><parent link="base"/><child link="top"/><origin xyz="0 0 2"/></joint></robot>"""
    )
    assert bones(mast, "top") == (0, 0)
    assert chain_length(mast, "top") == 0.0


def test_every_random_place_can_be_reached_inside_the_limits(arm):
    for place in places(arm, "tip", "random", 20, seed=5):
        solution = arm.solve("tip", position=place, q0=home_configuration(arm))
        assert_good(solution, {"frame": "tip", "position": place})
        assert all(abs(angle) <= np.pi / 4 + 1e-9 for angle in solution.angles.values())


def test_a_part_of_the_box_lies_out_of_reach(arm):
    shoulder = np.array([0.0, 0.0, 0.12])
    for motion, all_inside in (("random", True), ("box", False)):
        far = np.linalg.norm(places(arm, "tip", motion, 200, seed=0) - shoulder, axis=1)
        assert bool((far <= 1.2).all()) is all_inside


@pytest.mark.parametrize("motion", ["curve", "random", "box"])
def test_places_are_repeated_by_the_seed(arm, motion):
    assert (places(arm, "tip", motion, 8, 3) == places(arm, "tip", motion, 8, 3)).all()
    differ = (places(arm, "tip", motion, 8, 3) != places(arm, "tip", motion, 8, 4)).any()
    assert bool(differ) is (motion != "curve")


def test_the_curve_begins_and_ends_at_home(arm):
    home = plain_placement(arm, "tip", home_configuration(arm)).translation
    once_round = places(arm, "tip", "curve", 48, seed=0, lap=48)
    assert np.linalg.norm(once_round[23] - home) < 1e-9  # an eight crosses itself half way
    assert np.linalg.norm(once_round[-1] - home) < 1e-9
    assert np.ptp(once_round, axis=0).max() > 0.1


def test_all_methods_and_both_limits_see_the_same_ball(arm):
    seen = {}

    def begin(method, comparison, start):
        seen[method, comparison.name] = Scripted(STILL)
        return seen[method, comparison.name]

    list(compare(arm, "tip", ["a", "b"], begin, RULES, steps=5))
    assert len(seen) == 2 * len(COMPARISONS)
    for one, other in (("1", "3"), ("2", "4"), ("2b", "4b")):
        assert seen["a", one].places == seen["b", one].places == seen["a", other].places
    assert seen["a", "2"].places != seen["a", "2b"].places


def test_a_row_holds_the_means_and_the_largest(arm):
    fast, slow = StepFigures(0.001, 1, 6, True, 0.01, 0.1), StepFigures(0.003, 4, 12, False, 0.05, 0.5)
    (row,) = rows(arm, Scripted(fast, fast, fast, slow))
    assert row.time == pytest.approx(0.0015)
    assert (row.iterations, row.joint_updates, row.efficiency) == (1.75, 7.5, 0.75)
    assert (row.error, row.largest_error) == (pytest.approx(0.02), 0.05)
    assert (row.jump, row.largest_jump) == (pytest.approx(0.2), 0.5)


def test_a_resting_ball_stays_and_only_at_random(arm):
    resting = Rules(tolerance=Tolerance(), rest=3)
    at_random, on_curve = Scripted(STILL), Scripted(STILL)
    rows(arm, at_random, resting, steps=7, comparisons=[Comparison("2", "random", False)])
    rows(arm, on_curve, resting, steps=7)
    assert [at_random.places.count(place) for place in at_random.places] == [3, 3, 3, 3, 3, 3, 1]
    assert len({tuple(place) for place in on_curve.places}) == 7


def test_progress_is_told_of_every_step(arm):
    ticks = []
    rows(arm, Scripted(STILL), steps=6, progress=lambda: ticks.append(1))
    assert len(ticks) == 6


def test_a_ball_in_pieces_comes_from_where_it_was(arm):
    chase = Scripted(STILL)
    rows(arm, chase, Rules(tolerance=Tolerance(), pieces=2), comparisons=[Comparison("2", "random", False)], steps=2)
    home = home_configuration(arm)
    ways = [plain_placement(arm, "tip", home).translation, *places(arm, "tip", "random", 2, 0)]
    assert np.allclose(chase.places[0], (ways[0] + ways[1]) / 2)
    assert np.allclose(chase.places[2], (ways[1] + ways[2]) / 2)


@pytest.mark.parametrize(
    ("method", "engine", "counted"),
    [("ccd", "python", (1.0 + 1.0 + 3.5) / 3), ("ccd", "program", (1.0 + 2.0 + 7.0) / 3), ("dls", "python", 3.0)],
)
def test_it_counts_bones_of_ccd_and_steps_of_the_others_and_one_at_least(arm, method, engine, counted):
    joint_updates = (0, 2, 7) if method == "ccd" else (0, 0, 0)
    figures = [
        StepFigures(0.0, n, updates, True, 0.0, 0.0) for n, updates in zip((0, 2, 6), joint_updates, strict=True)
    ]
    chase = Scripted(*figures)
    chase.engine = engine
    (row,) = compare(arm, "tip", [method], lambda *_: chase, RULES, steps=3, comparisons=COMPARISONS[:1])
    assert row.counted == pytest.approx(counted)
