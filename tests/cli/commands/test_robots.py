from __future__ import annotations

from pathlib import Path

import pinik


def test_one_name_a_line_as_the_catalogue_has_them(run):
    assert run("robots").out.splitlines() == pinik.catalog()


def test_the_files_are_there(run):
    robots = run("robots", "--json").json["robots"]
    assert [robot["name"] for robot in robots] == pinik.catalog()
    assert all(Path(robot["urdf"]).is_file() for robot in robots)
    assert all(robot["srdf"] is None or Path(robot["srdf"]).is_file() for robot in robots)
    assert next(robot for robot in robots if robot["name"] == "arm")["srdf"].endswith("arm.srdf")
