"""Pasted angles: every form gives the same pose, and what is none of them is refused in words."""

from __future__ import annotations

import json

import pytest

import pinik
from pinik.viewer.protocol.pasting import read_angles
from robots import load_quietly

PANDA = load_quietly("panda")
WANTED = dict(zip(PANDA.joint_names, [0.1, -0.2, 3e-1, -1.5, 0.5, 1.6, -0.7, 0.02], strict=True))
NUMBERS = [str(value) for value in WANTED.values()]
LINES = "\n".join(f"{name}: {value}" for name, value in WANTED.items())


@pytest.mark.parametrize(
    "text",
    [
        " ".join(NUMBERS),
        "[" + ", ".join(NUMBERS) + "]",
        "(" + ";\n".join(NUMBERS) + ")",
        json.dumps(WANTED),
        json.dumps({"schema": 1, "angles": WANTED | {"panda_finger_joint2": 0.02}, "q": [1, 2]}),
        json.dumps({"time": 3, "positions": list(WANTED.values())}),
        LINES,
        "---\n# a pose\nangles:\n  " + LINES.replace("\n", "  # rad\n  ") + "\n...",
        LINES.replace("panda_joint1", "'panda_joint1'").replace("panda_joint2", '"panda_joint2"'),
        "header:\n  stamp:\n    sec: 12\n  frame_id: ''\nname:\n- "
        + "\n- ".join(WANTED)
        + "\nposition:\n- "
        + "\n- ".join(NUMBERS)
        + "\nvelocity: []\n",
        f"name: [{', '.join(WANTED)}]\nposition: [{', '.join(NUMBERS)}]",
    ],
    ids=[
        "words",
        "list",
        "tuple",
        "json",
        "solution",
        "list in json",
        "yaml",
        "nested",
        "quoted",
        "joint state",
        "flow lists",
    ],
)
def test_every_form_gives_the_same_angles(text):
    assert read_angles(PANDA, text) == WANTED


def test_the_json_of_a_solution_can_be_pasted():
    solution = PANDA.solve("panda_hand", position=[0.4, 0.1, 0.5])
    given = read_angles(PANDA, json.dumps(solution.to_dict()))
    assert given == {name: solution.angles[name] for name in PANDA.joint_names}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "nothing was pasted"),
        ("1 2 3", r"panda has 8 joints that can be set \(panda_joint1, .*got 3 numbers"),
        ('{"angles": [0.1, 0.2]}', "panda has 8 joints that can be set .*got 2 numbers"),
        ('{"panda_joint1": 0.1', "begins like JSON, but is not"),
        ('{"angles": {"panda_joint1": 0.1}, "joint_placements": 3}', "joint_placements must be an object"),
        (
            '{"joint_placements": {"root_joint": [1, 2]}}',
            "the placement of joint 'root_joint' must be .*homogeneous matrix",
        ),
        ("panda_joint1 = 0.1", "line 1 of the pasted text must be joint: value; got 'panda_joint1 = 0.1'"),
        ("panda_joint1: 0.1\n\npanda_joint2: fast", "line 3: joint 'panda_joint2' must have a number; got 'fast'"),
        ("panda_joint1: 0.1\npanda_joint1: 0.2", "line 2 .* sets joint 'panda_joint1' a second time"),
        ("hello: world", "has no angles"),
        ("name: [a, b]\nposition: [1]", "has no angles"),
        ("x" * 20_001, "at most 20000 characters"),
    ],
)
def test_what_is_no_pose_is_refused_in_words(text, words):
    with pytest.raises(pinik.InputError, match=words):
        read_angles(PANDA, text)
