"""Why each flaw matters and how it is mended: for every code, and with a line wherever an element is known."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import pinik
from pinik.description.advice import ADVICE
from pinik.description.flaw import Flaw
from urdf_texts import link, robot

CHECK = Path(__file__).parents[2] / "docs" / "check.md"


def test_every_documented_code_has_a_reason_and_a_mend_in_whole_sentences():
    codes = re.findall(r"^\| `([^`]+)` \|", CHECK.read_text("utf-8").partition("## Codes")[2], re.MULTILINE)
    assert set(codes) == set(ADVICE)
    for code in codes:
        flaw = Flaw("<robot>", "a cause", code=code)
        for sentence in (flaw.why, flaw.mend):
            assert re.fullmatch(r"[A-Zp].*\.", sentence), code


def test_a_flaw_of_its_own_words_keeps_them():
    flaw = Flaw("<robot>", "a cause", code="density", why="Because.", mend="Do it.")
    assert (flaw.why, flaw.mend, flaw.of_expansion().why) == ("Because.", "Do it.", "Because.")


def hinge(name: str, parent: str, child: str, inside: str = "", upper: str = "1") -> str:
    return (
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0 0 1"/><limit lower="-1" upper="{upper}" effort="1" velocity="1"/>{inside}</joint>'
    )


LINKS = [link(name) for name in "abc"]
# Documents whose lines are those of this list, from 2 on; the line → what the message says.
FAULTS = {
    "two roots": ([*LINKS, hinge("j", "a", "b")], 4, "2 root links"),
    "an unknown parent": ([*LINKS, hinge("j", "x", "b")], 5, "'x' is not defined"),
    "two parents": ([*LINKS, hinge("j", "a", "c"), hinge("k", "b", "c")], 6, "two parents"),
    "a circle of links": ([*LINKS, hinge("j", "b", "c"), hinge("k", "c", "b")], (3, 4), "form a cycle"),
    "a circle of mimics": (
        [
            *LINKS,
            hinge("j", "a", "b", '<mimic joint="k"/>'),
            hinge("k", "b", "c", '<mimic joint="j"/>'),
        ],
        (5, 6),
        "in a circle",
    ),
    "a large multiplier": (
        [*LINKS, hinge("j", "a", "b"), hinge("k", "b", "c", '<mimic joint="j" multiplier="1e13"/>')],
        6,
        "must be at most",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_errors_about_the_tree_name_a_line(fault):
    parts, line, words = FAULTS[fault]
    with pytest.raises(pinik.RobotLoadError, match=words) as caught:
        pinik.load(robot("", "\n".join(["", *parts])))
    lines = line if isinstance(line, tuple) else (line,)
    assert any(f"(line {one})" in str(caught.value) for one in lines), str(caught.value)


FLAWS = {
    "mimic-ignored": [*LINKS, hinge("j", "a", "b"), hinge("k", "b", "c", '<mimic joint="x"/>')],
    "mimic-left-free": [
        *LINKS,
        hinge("j", "b", "c"),
        hinge("k", "a", "b", '<mimic joint="j" multiplier="0"/>'),
    ],
    "changed-roles": [*LINKS, hinge("j", "b", "c"), hinge("k", "a", "b", '<mimic joint="j"/>')],
    "follower-limits": [
        *LINKS,
        hinge("j", "a", "b"),
        hinge("k", "b", "c", '<mimic joint="j" offset="5"/>'),
    ],
}


@pytest.mark.filterwarnings("ignore::pinik.UrdfWarning")
@pytest.mark.parametrize("code", FLAWS)
def test_flaws_of_mimics_name_the_line_of_the_follower(code):
    parts = FLAWS[code]
    found = [flaw for flaw in pinik.load(robot("", "\n".join(["", *parts]))).warnings if flaw.code == code]
    at = next(number for number, part in enumerate(parts, start=2) if "<mimic" in part)
    assert [flaw.line for flaw in found] == [at]


def test_a_wrong_encoding_names_the_line_of_the_declaration():
    text = '\n<?xml version="1.0" encoding="utf-16"?><robot name="r"><link name="a"/></robot>'
    with pytest.warns(pinik.UrdfWarning):
        found = pinik.load(text.encode()).warnings
    assert [(flaw.code, flaw.line) for flaw in found] == [("encoding", 2)]
