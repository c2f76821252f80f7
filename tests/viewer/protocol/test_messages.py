"""What a page may ask: each message does its work, and what is not well formed changes nothing."""

from __future__ import annotations

import json
import math
import re
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pinik
from judge import plain_placement
from pinik.viewer.protocol.messages import FARTHEST, RANGES, apply, parse
from pinik.viewer.protocol.reading import read_json
from pinik.viewer.simulation.session import Session
from stand_ins import GOOD, Clock, snapshot

PROTOCOL = Path(__file__).parents[3] / "docs" / "live-protocol.md"

NO_NUMBER = [None, True, False, "1", "", [], [1], {}, {"a": 1}]
NO_VECTOR = [
    None,
    True,
    1,
    "abc",
    "123",
    {},
    {"0": 1},
    [],
    [1, 2],
    [1, 2, 3, 4],
    [1, 2, None],
    [1, 2, True],
    [1, 2, "3"],
]
NO_VECTOR += [[[1, 2, 3]], [[1], [2], [3]], [1, 2, math.inf], [1, 2, 10**400], [[1, 2], 3, 4], [[]] * 3, [1, 2, {}]]
WRONG = {
    "index or null": [*(wrong for wrong in NO_NUMBER if wrong is not None), 1.0, 0.5, -1, 12, 10**30],
    "index": [*NO_NUMBER, 1.0, 0.5, -1, 12, 10**30, 10**400],
    "count": [*NO_NUMBER, 3.0, 0, -1, 1001, 10**400],
    "number": [*NO_NUMBER, 0, -1, 0.9e-6, 101, 10**400, math.inf, -math.inf],
    "truth": [None, 0, 1, "true", "", [], {}, [True]],
    "name": [None, True, 1, 1.5, [], {}, ["ccd"], "", "nope", "x" * 201, "x" * 60_000, "os:system", "\ud800", "\0"],
    "value": [None, True, "0.3", [], {}, [0.3], {"damping": 0.3}, -1, 10**400, math.inf, "x" * 60_000],
    "point": [*NO_VECTOR, [0, 0, 100.5], [-101, 0, 0], [1e300, 0, 0]],
    "angles": NO_VECTOR,
    "size": [
        *(wrong for wrong in NO_NUMBER if wrong != [1]),
        [0.1, 0.1],
        [0.1] * 4,
        [0.1, 0.1, 0.0],
        [-0.1],
        [11.0],
        [0.1, 0.1, None],
        [math.inf],
        [10**400],
        [[0.1]],
        ["0.1"],
    ],
    "instance": [True, False, "1", "", [], [1], {}, {"a": 1}, 1.0, 0.5, -1, 4, 10**400],
    "joint values": [
        None,
        True,
        1,
        "bone1_x",
        [],
        {},
        ["bone1_x"],
        {"bone1_x": None},
        {"bone1_x": "0.1"},
        {"bone1_x": True},
        {"bone1_x": [0.1]},
        {"bone1_x": 10**400},
        {"bone1_x": math.inf},
        {"bone1_x": 99.0},
        {"nope": 0.1},
        {"bone1_x": 0.1, "nope": 0.1},
        {f"joint{k}": 0.1 for k in range(1001)},
    ],
    "pasted": [
        None,
        True,
        1,
        {},
        [],
        "",
        "  ",
        "nope: 0.1",
        "bone1_x: 99",
        "bone1_x 0.1",
        "1, 2",
        "{",
        "{}",
        '{"bone1_x": NaN}',
        '{"bone1_x": "0.1"}',
        '{"angles": {"nope": 1}}',
        "bone1_x: 0.1\nbone1_x: 0.2",
        "bone1_x: os.system('x')",
        "!!python/object: 1",
        "name: [bone1_x]\nposition: [0.1, 0.2]",
        "x" * 20_001,
        "[" * 3000,
    ],
    "axes": [None, True, 1, [], ["x"], {}, "xyz", "yx", "xx", "w", "x y", "X", "x" * 201],
    "tolerance": [
        *(wrong for wrong in NO_NUMBER if wrong is not None),
        [0.01, 0.1, 0.1],
        [[], 0.1],
        [[0.1, 0.1], 0.1],
        [[0.1] * 4, 0.1],
        [[0.1, 0.1, None], 0.1],
        [[0.1, 0.1, 2.0], 0.1],
        [[[0.1]] * 3, 0.1],
        [0.0, 0.1],
        [1.1, 0.1],
        [0.1, 0.0],
        [0.1, 3.3],
        [0.1, None],
        [None, 0.1],
        ["0.1", 0.1],
        [True, 0.1],
        {"position": 0.1, "orientation": 0.1},
    ],
}


@pytest.fixture(scope="module")
def begun(arm):
    """A session after a few steps. No test in this module changes it."""
    return fresh(arm)


def fresh(robot):
    shown = Session(robot, clock=Clock())
    shown.add_ball("bone2")
    shown.set_mode(1, "pinned")
    shown.set_motion("random")
    shown.obstacles.add("sphere", [0.1], [2.0, 0.0, 0.0])
    shown.set_obstacles(shown.obstacles)
    for _ in range(3):
        shown.step()
    return shown


def malformed():
    for kind, (fields, kinds) in GOOD.items():
        message = {"type": kind, **fields}
        yield kind, "one too many", {**message, "more": 1}
        for name in fields:
            yield kind, f"no {name}", {key: value for key, value in message.items() if key != name}
            yield (
                kind,
                f"{name} misspelt",
                {**{k: v for k, v in message.items() if k != name}, name.upper(): fields[name]},
            )
            for number, wrong in enumerate(WRONG[kinds[name]]):
                yield kind, f"{name} wrong {number}", {**message, name: wrong}


MALFORMED = list(malformed())


def test_every_type_of_the_documentation_is_tried_here():
    table = PROTOCOL.read_text("utf-8").split("## From the page")[1]
    rows = dict(re.findall(r"^\| `(\w+)` \| (.*?) \|", table, re.MULTILINE))
    answers = {"find_answers", "take_answer", "find_self_motion", "move_along"}
    teaching = {"lesson", "comparison", "explain", "race", "bones"}
    elsewhere = {"type", "robot", "setup", "drawn", *answers, *teaching}  # the table's head, and what the show answers
    assert set(rows) - elsewhere == set(GOOD)
    for kind, (fields, _) in GOOD.items():
        assert set(re.findall(r"`(\w+)`", rows[kind])) == set(fields)


@pytest.mark.parametrize("kind", sorted(GOOD))
def test_what_is_malformed_is_said_in_words_and_changes_nothing(begun, kind):
    before = snapshot(begun)
    for _, _, message in (entry for entry in MALFORMED if entry[0] == kind):
        with pytest.raises(pinik.PinikError) as raised:
            apply(begun, parse(json.dumps(message)))
        assert len(str(raised.value)) > 20
    assert snapshot(begun) == before


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "null",
        "5",
        '"view"',
        "[]",
        '[{"type": "reset"}]',
        "{}",
        '{"type": 5}',
        '{"type": null}',
        '{"type": ["reset"]}',
        '{"Type": "reset"}',
        '{"type": "speed", "value": NaN}',
        '{"type": "speed", "value": Infinity}',
        '{"type": "ball", "index": 0, "position": [0, 0, -Infinity]}',
        '{"type": "speed", "value": ' + "9" * 5000 + "}",
        '{"type": "reset"} {"type": "reset"}',
        "\x00\x01",
    ],
)
def test_what_is_no_message_is_refused(text):
    with pytest.raises(pinik.InputError, match="a message must be a JSON object"):
        parse(text)


@pytest.mark.parametrize("brackets", ["[]", '{"a":}'])
def test_no_nesting_is_too_deep_to_be_refused_in_words(begun, brackets):
    """The parser and the message that quotes the value give up at different depths."""
    opening, closing = brackets[:-1], brackets[-1]
    middle = "" if brackets == "[]" else "1"
    for depth in (9, 100, *range(900, 1100, 7), *range(980, 1000), 5000):
        deep = opening * depth + middle + closing * depth
        for message in (
            '{"type":"ball","index":0,"position":%s}',
            '{"type":"parameter","instance":0,"name":"max_step","value":%s}',
        ):
            with pytest.raises(pinik.InputError, match="a message must be a JSON object"):
                apply(begun, parse(message % deep))


def test_json_that_is_read_is_what_was_written():
    value = {"a": [1, 2.5, {"b": [None, True, "ü"]}]}
    assert read_json(json.dumps(value)) == value
    assert read_json('"NaN"') == "NaN"


@pytest.mark.parametrize(
    "kind", ["exec", "os:system", "__class__", "hello", "state", "drawn", "robot", "setup", "", "x" * 1000]
)
def test_an_unknown_type_is_refused(begun, kind):
    before = snapshot(begun)
    with pytest.raises(pinik.UnknownNameError, match="no message"):
        apply(begun, {"type": kind})
    assert snapshot(begun) == before


def test_no_message_imports_a_module(begun, tmp_path, monkeypatch):
    (tmp_path / "evil_module.py").write_text("import pinik\nclass Solver(pinik.CCD):\n    pass\n")
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("evil_module:Solver", "evil_module", "evil_module.Solver", "os:system"):
        for fields in ({"method": name, "instance": 0}, {"method": name, "instance": 1}):
            with pytest.raises(pinik.UnknownNameError):
                apply(begun, {"type": "method", **fields})
        for parameter in ("scaling", "stiffness", "max_step"):
            with pytest.raises(pinik.PinikError):
                apply(begun, {"type": "parameter", "instance": 0, "name": parameter, "value": name})
    assert "evil_module" not in sys.modules


# What each does


def after(robot, kind, **fields):
    shown = fresh(robot)
    apply(shown, parse(json.dumps({"type": kind, **fields})))
    return shown


def test_view_method_and_parameters(arm):
    assert after(arm, "view", count=1).view == 1
    assert after(arm, "method", instance=1, method="dls").instances[1].solver == pinik.DampedLeastSquares()
    for value in (0.3, 1):
        assert after(arm, "parameter", instance=3, name="damping", value=value).instances[3].solver.damping == value
    assert after(arm, "parameter", instance=0, name="max_step", value=None).instances[0].solver.max_step == math.inf
    assert after(arm, "parameter", instance=0, name="relaxation", value=None).instances[0].solver.relaxation is None
    assert after(arm, "parameter", instance=0, name="scaling", value="area").instances[0].solver.scaling == "area"
    stiffness = {arm.joint_names[2]: 0.25}
    shown = after(arm, "parameter", instance=0, name="stiffness", value=stiffness)
    assert shown.instances[0].solver.stiffness == stiffness
    assert [one.solver.name for one in shown.instances] == ["ccd", "jt", "pinv", "dls"]


def test_the_closed_form_where_it_can_be_and_nowhere_else(arm, two_link):
    shown = Session(two_link, clock=Clock())
    apply(shown, {"type": "method", "instance": 2, "method": "two_bone"})
    apply(shown, {"type": "parameter", "instance": 2, "name": "elbow", "value": "down"})
    assert shown.instances[2].solver == pinik.TwoBoneSolver(elbow="down")
    other = fresh(arm)
    before = snapshot(other)
    with pytest.raises(pinik.InputError, match="two_bone cannot chase a ball here: frame 'tip' is not moved by two"):
        apply(other, {"type": "method", "instance": 2, "method": "two_bone"})
    assert snapshot(other) == before


def test_what_all_instances_share(arm):
    assert not after(arm, "limits", on=False).settings.limits
    assert not after(arm, "polish", on=False).settings.polish
    assert after(arm, "polish", on=True).settings.polish
    assert list(after(arm, "look", name="reach", on=True).looks) == ["reach"]
    assert list(after(arm, "look", name="reach", on=False).looks) == []
    settings = after(arm, "iterations", until_reached=False, at_most=7).settings
    assert (settings.until_reached, settings.at_most) == (False, 7)
    shown = after(arm, "tolerance", position=0.25, orientation=1)
    assert shown.settings.tolerance == (0.25, 1.0)
    assert all(one.settings == shown.settings for one in shown.instances)


def test_motion_and_time(arm):
    assert after(arm, "motion", motion="hand").motion.kind == "hand"
    assert after(arm, "curve", curve="square").motion.curve == "square"
    assert after(arm, "speed", value=0.1).motion.speed == 0.1
    assert after(arm, "run", on=True).running
    assert after(arm, "step").steps == 4
    shown = after(arm, "reset")
    assert shown.steps == 0
    assert [summary.steps for summary in shown.summaries] == [0] * 4


def test_balls(arm):
    shown = after(arm, "ball", index=1, position=[0.1, -100, 100])
    assert shown.balls[1].position.tolist() == [0.1, -100.0, 100.0]
    assert shown.motion.kind == "hand"
    assert after(arm, "free", index=0, axes="xz").balls[0].target.along == (False, True, False)
    for tolerance in ([0.01, 0.2], [[0.01, 0.02, 0.03], 0.2]):
        own = after(arm, "ball_tolerance", index=0, tolerance=tolerance).balls[0].target.tolerance
        assert own == pinik.Tolerance.of(tolerance)
    assert after(arm, "ball_tolerance", index=0, tolerance=None).balls[0].target.tolerance is None
    shown = after(arm, "orientation", index=0, on=True, rpy=[0.1, 0.2, 0.3])
    assert (shown.balls[0].oriented, shown.balls[0].rpy.tolist()) == (True, [0.1, 0.2, 0.3])
    assert [ball.mode for ball in after(arm, "effector", index=1, mode="off").balls] == ["on", "off"]
    assert [ball.mode for ball in after(arm, "effector", index=0, mode="pinned").balls] == ["pinned", "pinned"]
    shown = after(arm, "add_effector", frame="bone3")
    assert [ball.frame for ball in shown.balls] == ["tip", "bone2", "bone3"]
    there = plain_placement(arm, "bone3", shown.instances[0].q).translation
    assert shown.balls[2].position == pytest.approx(there)
    assert [ball.frame for ball in after(arm, "remove_effector", index=0).balls] == ["bone2"]


@pytest.mark.parametrize("name", sorted(RANGES))
def test_the_ends_of_a_range_belong_to_it(arm, name):
    kind, field, others = {
        "speed": ("speed", "value", {}),
        "iterations": ("iterations", "at_most", {"until_reached": True}),
        "position_tolerance": ("tolerance", "position", {"orientation": 0.1}),
        "orientation_tolerance": ("tolerance", "orientation", {"position": 0.1}),
    }[name]
    for end, beyond in zip(RANGES[name], (-1, 1), strict=True):
        after(arm, kind, **{field: end}, **others)
        further = end + beyond if name == "iterations" else math.nextafter(end, beyond * math.inf)
        words = f"{kind}: {field} must be a number from"
        if name == "iterations":
            words = "max. iterations must be a whole number from 1 to 1000; got"
        with pytest.raises(pinik.InputError, match=re.escape(words)):
            after(arm, kind, **{field: further}, **others)
    assert FARTHEST == 100.0
    words = "ball: position must be from -100 to 100 m along each axis; got 99, 1000, -0.08571"
    with pytest.raises(pinik.InputError, match=re.escape(words) + "$"):
        after(arm, "ball", index=0, position=[99.0, 1000.0, -0.08571428571427833])
    after(arm, "ball", index=0, position=[-100.0, 100.0, 100.0])


def test_angles_of_many_turns_stay_numbers_and_huge_ones_are_refused(arm):
    shown = after(arm, "orientation", index=0, on=True, rpy=[100.0, -99.9, 5e-324])
    shown.step()
    json.dumps(json.loads(snapshot(shown)), allow_nan=False)
    with pytest.raises(pinik.InputError, match="at most 100 rad"):
        after(arm, "orientation", index=0, on=True, rpy=[1e300, 0.0, 0.0])


# And everything else

VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=8)
    | st.sampled_from([10**400, "x" * 300]),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=6,
)
NAMES = sorted({name for fields, _ in GOOD.values() for name in fields})
WORDS = [
    "ccd",
    "dls",
    "hand",
    "curve",
    "random",
    "eight",
    "on",
    "off",
    "pinned",
    "tip",
    "joint1",
    "damping",
    "max_step",
]
NUMBERS = [0, 1, 2, 0.5, 1000, 1e-6, True, False, None]
PLAUSIBLE = st.sampled_from([*WORDS, *NUMBERS, [0.1, 0.2, 0.3], [100, 100, 100], {"joint1": 0.5}, {}])


@st.composite
def near_messages(draw):
    """A message with an existing type, some of whose fields are missing, added or replaced."""
    kind = draw(st.sampled_from(sorted(GOOD)))
    message = {"type": kind, **GOOD[kind][0]}
    for _ in range(draw(st.integers(0, 3))):
        name = draw(
            st.sampled_from([*GOOD[kind][0], *NAMES, "type"] if draw(st.booleans()) else [*GOOD[kind][0], "type"])
        )
        if name != "type" and draw(st.integers(0, 5)) == 0:
            message.pop(name, None)
        elif name != "type" or draw(st.integers(0, 9)) == 0:
            message[name] = draw(PLAUSIBLE | VALUES)
    return message


@settings(max_examples=150)
@given(st.lists(near_messages() | VALUES, min_size=1, max_size=5))
def test_no_json_does_more_than_raise_in_words(two_link, messages):
    shown = Session(two_link, ["dls", "ccd"], clock=Clock())
    for message in messages:
        before = snapshot(shown)
        try:
            apply(shown, parse(json.dumps(message)))
        except pinik.PinikError:
            assert snapshot(shown) == before
    json.dumps(json.loads(snapshot(shown)), allow_nan=False)


@given(st.text() | st.binary().map(lambda b: b.decode("latin-1")))
def test_no_text_does_more_than_raise_in_words(text):
    with pytest.raises(pinik.InputError):
        parse(text)
