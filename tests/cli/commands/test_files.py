"""The options about files that every command with a robot has: --xacro-arg and --allow-outside."""

from __future__ import annotations

import pytest

XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" default="a"/>
<link name="$(arg n)"/></robot>"""


@pytest.mark.parametrize("command", ["solve", "fk", "jacobian", "info", "check", "track", "compare", "live"])
def test_every_command_with_a_robot_has_the_options(run, command):
    text = run(command, "--help").out
    assert "--xacro-arg" in text
    assert "--allow-outside" in text


def test_arguments_of_a_xacro_file_are_given_by_option(run, tmp_path):
    pytest.importorskip("xacrodoc")
    (tmp_path / "r.xacro").write_text(XACRO)
    answer = run("fk", tmp_path / "r.xacro", "--xacro-arg", "n:=b", "--json")
    assert [frame["frame"] for frame in answer.json["frames"] if frame["frame"] != "universe"] == ["b"]
    assert run("check", tmp_path / "r.xacro", "--xacro-arg", "n:=b", "--json").json["second_opinion"]["agrees"]
    wrong = run("fk", tmp_path / "r.xacro", "--xacro-arg", "m:=b")
    assert wrong.status == 3
    assert "no xacro argument 'm'; did you mean" in wrong.err or "available: 'n'" in wrong.err


@pytest.mark.parametrize(
    ("given", "words"),
    [(["n=b"], "must be NAME:=VALUE; got 'n=b'"), ([":=b"], "must be NAME:=VALUE"), (["n:=b", "n:=c"], "given twice")],
)
def test_an_argument_in_another_form_is_wrong_usage(run, given, words):
    for command in ("fk", "check"):
        answer = run(command, "arm", *(word for one in given for word in ("--xacro-arg", one)))
        assert answer.status == 2
        assert words in answer.err


def test_arguments_for_a_urdf_are_wrong_usage(run):
    answer = run("fk", "arm", "--xacro-arg", "n:=b")
    assert answer.status == 2
    assert "are for xacro files" in answer.err


def test_a_mesh_outside_is_named_and_opened_on_request(run, tmp_path):
    (tmp_path / "a.stl").write_text("mesh")
    (tmp_path / "arm").mkdir()
    shape = '<visual><geometry><mesh filename="../a.stl"/></geometry></visual>'
    (tmp_path / "arm" / "r.urdf").write_text(f'<robot name="r"><link name="a">{shape}</link></robot>')
    assert "not opened: it lies outside" in run("info", tmp_path / "arm" / "r.urdf").err
    assert "outside" not in run("info", tmp_path / "arm" / "r.urdf", "--allow-outside").err
