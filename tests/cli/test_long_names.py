"""Names of thousands of characters, or with control characters, do not fill or change the terminal."""

from __future__ import annotations

import pytest

from urdf_texts import joint, link, robot

LONG = "n" * 5000
POINT = ("--position", "0", "0", "1")


@pytest.fixture
def long_file(tmp_path):
    mesh = f'<visual><geometry><mesh filename="{LONG}.stl"/></geometry></visual>'
    text = robot(link(LONG, mesh), link("b" + LONG), joint("j" + LONG, LONG, "b" + LONG))
    (tmp_path / "long.urdf").write_text(text.replace('name="r"', f'name="{LONG}"'))
    return tmp_path / "long.urdf"


@pytest.mark.parametrize(
    "arguments",
    [
        ("solve", "arm", "--frame", LONG, *POINT),
        ("solve", LONG, "--frame", "tip", *POINT),
        ("solve", f"/nowhere/{LONG}.urdf", "--frame", "tip", *POINT),
        ("solve", "arm", "--frame", "tip", *POINT, "--lock", LONG),
        ("solve", "arm", "--frame", "tip", *POINT, "--start", f"{LONG}=1"),
        ("solve", "arm", "--frame", "tip", *POINT, "--param", f"{LONG}=1"),
        ("solve", "arm", "--frame", "tip", *POINT, "--targets", LONG),
        ("solve", "arm", "--frame", "tip", "--position", "0", "0", LONG),
        ("solve", "arm", f"--{LONG}"),
        ("track", "arm", LONG, "--frame", "tip"),
        ("check", LONG),
        (LONG,),
    ],
)
def test_no_error_echoes_thousands_of_characters(run, arguments):
    result = run(*arguments)
    assert result.status in (2, 3)
    assert len(result.err) <= 2100
    assert result.err.count("\n") == ("check" not in arguments)  # whose faults are its answer
    assert len(result.out) <= 2100


def test_check_and_the_warnings_of_a_robot_do_not_either(run, long_file):
    checked = run("check", long_file)
    assert checked.status == 0
    assert max(map(len, checked.out.splitlines())) <= 2100
    listed = run("info", long_file)
    assert listed.status == 0
    assert len(listed.out) <= 2100
    shown = run("fk", long_file, "--frame", "missing")
    assert shown.status == 2
    assert max(map(len, shown.err.splitlines())) <= 2100


def test_control_characters_reach_the_terminal_escaped_and_on_one_line(run):
    result = run("fk", "arm", "--frame", "tip", "--set", "\x1b]0;owned\x07\nerror: fake=1")
    assert result.status == 2
    assert result.err.count("\n") == 1
    assert "\x1b" not in result.err
    assert "\x07" not in result.err
