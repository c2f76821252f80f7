"""The statistics as CSV, read back by the csv module."""

from __future__ import annotations

import csv
import io

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
    for row, one in zip(rows, session.seen, strict=True):
        summary = one.statistics.summary()
        assert (row["robot"], row["motion"], row["limits"]) == ("two_link", "random", "on")
        assert int(row["steps"]) == summary.steps > 0
        assert float(row["mean_time_s"]) == summary.mean_time
        assert float(row["mean_iterations"]) == summary.mean_iterations
        assert float(row["mean_joint_updates"]) == summary.mean_joint_updates
        assert float(row["mean_error_m"]) == summary.mean_error
        assert float(row["efficiency"]) == summary.efficiency
        assert float(row["largest_jump_rad_or_m"]) == summary.largest_jump


def test_a_table_with_nothing_to_tell_and_an_awkward_name_is_still_a_table():
    machine = load_quietly(robot(link("only")).replace('name="r"', 'name="a, &quot;b&quot;; c"'))
    rows = rows_of(Session(machine, ["dls"]))
    assert [(row["robot"], row["steps"], row["mean_error_m"]) for row in rows] == [('a, "b"; c', "0", "")]
