"""The statistics as CSV, read back by the csv module."""

from __future__ import annotations

import csv
import io
import json

from pinik.problem.tolerance import Tolerance
from pinik.viewer.simulation.session import Session
from pinik.viewer.web.statistics_csv import statistics_csv
from robots import load_quietly
from stand_ins import Clock
from urdf_texts import link, robot


def rows_of(session):
    return list(csv.DictReader(io.StringIO(statistics_csv(session))))


def test_the_table_has_a_row_for_each_instance(two_link):
    session = Session(two_link, ["dls", "ccd"], clock=Clock(each=0.001))
    session.set_motion("random")
    for _ in range(30):
        session.step()
    rows = rows_of(session)
    assert [(row["instance"], row["method"]) for row in rows] == [("0", "dls"), ("1", "ccd")]
    for row, one, summary in zip(rows, session.seen, session.summaries, strict=True):
        assert (row["robot"], row["motion"], row["limits"]) == ("two_link", "random", "on")
        assert int(row["steps"]) == summary.steps > 0
        assert float(row["mean_time_s"]) == summary.mean_time
        assert float(row["mean_iterations"]) == summary.mean_iterations
        assert float(row["mean_joint_updates"]) == summary.mean_joint_updates
        assert float(row["mean_error_m"]) == summary.mean_error
        assert float(row["efficiency"]) == summary.efficiency
        assert float(row["largest_jump_rad_or_m"]) == summary.largest_jump
        assert (int(row["busy_steps"]), int(row["cut_off_steps"])) == (summary.busy, summary.cut_off)
        assert row["engine"] == one.engine


def test_the_table_says_for_which_settings_it_holds(two_link):
    session = Session(two_link, ["dls", "ccd"])
    session.set_parameter(0, "damping", 0.25)
    session.change_settings(tolerance=Tolerance(0.002, 0.1), until_reached=False, at_most=7, polish=True)
    session.balls[0].tolerate(Tolerance((0.01, 0.02, 0.03), 0.5))
    session.move_ball(0, [0.5, 0.2, 0.0])
    session.scores.cover("all")
    first, second = rows_of(session)
    assert set(json.loads(first["parameters"])) == set(session.instances[0].solver.parameters)
    assert json.loads(first["parameters"])["damping"] == 0.25
    assert json.loads(second["parameters"])["max_step"] is None
    for row in (first, second):
        assert (row["tolerance_m"], row["tolerance_rad"]) == ("0.002", "0.1")
        assert (row["iterations_at_most"], row["polish"], row["statistics_over"]) == ("7", "on", "all")
        assert (row["curve"], row["speed"], row["root"]) == ("", "", "fixed")
        assert json.loads(row["balls"]) == [
            ["tip", "on", [0.5, 0.2, 0.0], None, {"tolerance": [[0.01, 0.02, 0.03], 0.5]}]
        ]


def test_a_table_with_nothing_to_tell_and_an_awkward_name_is_still_a_table():
    machine = load_quietly(robot(link("only")).replace('name="r"', 'name="a, &quot;b&quot;; c"'))
    rows = rows_of(Session(machine, ["dls"]))
    assert [(row["robot"], row["steps"], row["mean_error_m"]) for row in rows] == [('a, "b"; c', "0", "")]
