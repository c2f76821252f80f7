"""Flaws put together in lines: one for each sort, and other warnings as they are."""

from __future__ import annotations

import pytest

from pinik.description import reader
from pinik.description.flaw import Flaw, summarised
from urdf_texts import joint, link, robot


def test_flaws_of_one_sort_are_one_line_and_other_warnings_stay_as_they_are():
    first, second = (
        Flaw(f"joint '{name}'", f"{name} is long", code="long", common="is long", line=line)
        for name, line in (("a", 3), ("b", 7))
    )
    lines = summarised(["no SRDF", first, "no home", second, "no SRDF"])
    assert lines == ["no SRDF", "joint 'a' (line 3), joint 'b' (line 7): is long (the first: a is long)", "no home"]


@pytest.mark.parametrize(("word", "holder"), [("effort", "limit"), ("velocity", "limit"), ("friction", "dynamics")])
def test_strengths_that_cannot_be_read_are_one_line(word, holder):
    parts = [f'<{holder} {word}="{value}"/>' for value in ("strong", "weak")]
    joints = [joint(f"j{i}", "a", f"l{i}", part, kind="continuous", limit="") for i, part in enumerate(parts)]
    flaws = reader.read(robot(link("a"), link("l0"), link("l1"), *joints)).warnings
    (line,) = summarised([flaw for flaw in flaws if flaw.code == "bad-strength"])
    assert line.startswith(f"joint 'j0' (line 1), joint 'j1' (line 1): <{holder} {word}> cannot be read; it is ignored")
    assert "'strong'" in line
