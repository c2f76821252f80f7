"""The walk through the thesis's comparisons: their parameters, and figures that fit those of `pinik compare`."""

from __future__ import annotations

import math

import pytest

import pinik
from pinik.studies.comparison import bones
from pinik.studies.thesis import TABLE
from pinik.viewer.protocol.setup import apply_setup, write_setup
from pinik.viewer.protocol.thesis_walk import published_table, walk_to
from pinik.viewer.simulation.session import Session
from stand_ins import Clock

UNIT = 1.2 / 7  # a seventh of the arm's length [m]


def walked(robot, number, preset):
    session = Session(robot, clock=Clock())
    walk = walk_to(session, number, preset)
    apply_setup(session, walk.setup)
    session.motion.start_at(walk.phase)
    return session


@pytest.mark.parametrize(
    ("number", "motion", "limits"),
    [("1", "curve", False), ("2", "random", False), ("3", "curve", True), ("4", "random", True)],
)
@pytest.mark.parametrize("preset", ["thesis", "tuned"])
def test_comparisons_have_the_thesiss_motion_limits_and_tolerance(arm, number, motion, limits, preset):
    session = walked(arm, number, preset)
    assert (session.motion.kind, session.settings.limits, session.running) == (motion, limits, True)
    assert [instance.solver.name for instance in session.seen] == list(TABLE)
    assert session.settings.tolerance.farthest == pytest.approx(0.05 * UNIT)
    assert (session.settings.until_reached, session.settings.at_most) == (False, 100)
    assert "REFUSED" not in [instance.status for instance in session.seen]
    assert write_setup(session)


def test_the_thesiss_parameters_are_those_it_states(arm):
    _, jt, pinv, dls = (instance.solver for instance in walked(arm, "1", "thesis").seen)
    assert jt.max_step == pinv.max_step == math.inf
    assert pinv.step_size == dls.step_size == 0.01
    assert dls.damping == pytest.approx(1.1 * UNIT)
    assert (dls.rule, dls.max_step) == ("constant", pytest.approx(math.pi / 16))
    assert [i.solver.parameters for i in walked(arm, "1", "tuned").seen] == [
        pinik.SOLVERS[name]().parameters for name in TABLE
    ]


def test_a_random_ball_jumps_in_every_step(arm):
    session = walked(arm, "2", "tuned")
    places = set()
    for _ in range(10):
        session.step()
        places.add(tuple(session.balls[0].position))
    assert len(places) == 10


def test_the_walk_fills_the_figures_of_the_study(arm):
    """The first comparison with the thesis's parameters: N / η of `docs/thesis.md`, reading "literal"."""
    session = walked(arm, "1", "thesis")
    session.running = False  # else the figures follow once a second
    for _ in range(480):
        session.step()
    methods = [instance.solver.name for instance in session.seen]
    figures = dict(zip(methods, session.summaries, strict=True))
    assert all(one.efficiency == 1.0 for one in figures.values())
    assert figures["pinv"].mean_iterations == pytest.approx(39, rel=0.1)
    assert figures["dls"].mean_iterations == pytest.approx(41, rel=0.1)
    assert figures["jt"].mean_iterations == pytest.approx(3, abs=1)


def test_a_bone_of_the_arm_has_two_joints(arm, panda):
    assert walk_to(Session(arm), "1", "thesis").joints_per_bone == 2.0
    count, joints = bones(panda, "panda_hand_tcp")
    assert walk_to(Session(panda), "1", "thesis").joints_per_bone == joints / count


@pytest.mark.parametrize(("number", "preset"), [("5", "thesis"), ("2b", "thesis"), ("1", "best")])
def test_other_comparisons_are_refused(arm, number, preset):
    with pytest.raises(pinik.UnknownNameError):
        walk_to(Session(arm), number, preset)


def test_the_published_table_is_the_thesiss(arm):
    table = published_table()
    assert [each["name"] for each in table["methods"]] == ["ccd", "jt", "pinv", "dls"]
    assert table["methods"][0]["published"][1] == {"time": 0.005, "iterations": 210, "efficiency": 0.75}
    assert [each["number"] for each in table["comparisons"]] == ["1", "2", "3", "4"]
