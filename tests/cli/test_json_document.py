"""docs/json.md and what the commands print: neither has a field that the other has not."""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import pinik

ROOT = Path(__file__).parents[2]
DOCUMENT = ROOT / "docs" / "json.md"
JUMP = ROOT / "examples" / "jump.csv"
CIRCLE = ROOT / "examples" / "circle.csv"
POSES = ROOT / "examples" / "poses.csv"
SLIP = """<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent link="a"/>
<child link="b"/><origin xzy="1 2 3"/><limit lower="-90" upper="90" effort="1" velocity="1"/></joint></robot>"""
PLACEHOLDERS = {
    "angles": "JOINT",
    "joint_placements": "JOINT",
    "mimics": "JOINT",
    "by_status": "STATUS",
    "changes": "JOINT",
    "counts": "CODE",
    "limits": "JOINT",
    "answers": "NAME",
    "parameters": "NAME",
    "poses": "POSE",
    "stiffness": "JOINT",
    "turns": "JOINT",
    "windings": "JOINT",
    "workspaces": "WORKSPACE",
}
TARGETS = [
    {"frame": "tip", "position": [0.2, 0.1, 0.8], "rpy": [0, 0.3, 0], "tool": [0, 0, 0.1], "weight": 2},
    {"frame": "tip", "axis": "z", "direction": [1, 0, 0], "relative_to": "bone2_x"},
    {"frame": "tip", "axis": "x", "at": [1, 0, 0], "tolerance": [1e-4, 0.1]},
]
# The place of tool0 at elbow_joint=2.9, where links of the ur5 touch.
TOUCH = ("--position", "0.02149671", "0.19145", "0.08721464", "--start", "elbow_joint=2.9")
BOX = ("--cell", "0.2", "--box", "0.3", "0", "0.3", "0.7", "0.2", "0.5")
DOWN = ("--axis", "z", "--direction", "0", "0", "-1")
RUNS = {
    "solve": [
        ("solve", "arm", "--targets", "-", "--root", "planar", "--json"),
        ("solve", "arm", "--frame", "tip", "--position", "0", "0", "9", "--method", "ccd", "--json"),
        ("solve", "ur5", "--frame", "tool0", *TOUCH, "--avoid-self", "--restarts", "0", "--json"),
    ],
    "solve-all": [
        ("solve-all", "ur5", "--frame", "tool0", "--position", "0.4", "0.1", "0.4", "--rpy", "0", "0", "0", "--json"),
        ("solve-all", "ur5", "--frame", "tool0", "--position", "0.4", "0.1", "0.4", *DOWN, "--families", "--json"),
    ],
    "track": [
        ("track", "two_link", JUMP, "--frame", "tip", "--start", "joint1=-2.64", "--start", "joint2=1.5", "--json"),
    ],
    "reach": [
        ("reach", "ur5", "--frame", "tool0", "--by", "both", "--branches", "--samples", "1000", *BOX, "--json"),
        ("reach", "panda", CIRCLE, "--frame", "panda_hand_tcp", "--json"),
        ("reach", "two_link", JUMP, "--frame", "tip", "--bases", "2", "--samples", "1000", "--json"),
    ],
    "batch": [("batch", "arm", POSES, "--frame", "tip", "--output", "{tmp}/answers.csv", "--json")],
    "fk": [("fk", "panda", "--root", "free_flyer", "--json")],
    "jacobian": [("jacobian", "panda", "--frame", "panda_hand", "--root", "free_flyer", "--json")],
    "info": [("info", "panda", "--root", "free_flyer", "--json")],
    "check": [
        ("check", "ur3_empty", "--json"),
        ("check", "two_link", "--json"),
        ("check", "{tmp}/slip.urdf", "--fix", "{tmp}/mended.urdf", "--json"),
    ],
    "collisions": [
        ("collisions", "ur5", "--set", "elbow_joint=2.9", "--root", "free_flyer", "--json"),
    ],
    "robots": [("robots", "--json")],
    "compare": [("compare", "--steps", "1", "--json")],
    "accuracy": [("accuracy", "--problems", "1", "--digits", "1", "--json")],
}


def documented(command: str) -> set[str]:
    """The fields that the document lists under a heading."""
    section = re.search(rf"^## {command}$(.*?)(?=^## |\Z)", DOCUMENT.read_text(), re.MULTILINE | re.DOTALL)
    assert section
    return set(re.findall(r"^\| `([^`]+)` \|", section[1], re.MULTILINE))


def fields(value: dict[str, Any], prefix: str = "", names: str = "") -> Iterator[str]:
    """Every field of an object, names of joints and the like replaced by what stands for them."""
    for key, item in value.items():
        path = f"{prefix}{names or key}"
        yield path
        if isinstance(item, dict) and names != "NAME":
            yield from fields(item, f"{path}.", "" if names else PLACEHOLDERS.get(key, ""))
        elif isinstance(item, list):
            for element in item:
                if isinstance(element, dict):
                    yield from fields(element, f"{path}[].")


@pytest.mark.parametrize("command", RUNS)
def test_every_field_is_documented_and_every_documented_field_exists(run, command, tmp_path):
    (tmp_path / "slip.urdf").write_text(SLIP)
    found = set()
    for arguments in RUNS[command]:
        words = [str(argument).replace("{tmp}", str(tmp_path)) for argument in arguments]
        answer = run(*words, stdin=json.dumps(TARGETS)).json
        assert answer["schema"] == 1
        found |= set(fields(answer))
    assert found == documented(f"`pinik {command}`")


def test_every_keyword_of_a_target_is_documented():
    keywords = set(inspect.signature(pinik.Target).parameters)
    assert documented("Input: `pinik solve --targets`") == keywords
