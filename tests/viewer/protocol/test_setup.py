"""A set-up in one line: read back it is the same again, and what is wrong with it is said in words."""

from __future__ import annotations

import contextlib
import json
import math
import re
import string
from urllib.parse import parse_qs, quote

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import pinik
from pinik.viewer.protocol.messages import apply
from pinik.viewer.protocol.setup import apply_setup, read_setup, write_setup
from pinik.viewer.protocol.state import session_state
from pinik.viewer.simulation.by_hand import set_angles
from pinik.viewer.simulation.looks import LOOKS
from pinik.viewer.simulation.session import Session
from pinik.viewer.web.tab import LARGEST_MESSAGE
from robots import load_quietly
from stand_ins import Clock, snapshot
from urdf_texts import joint, link
from urdf_texts import robot as machine

ARM = load_quietly("two_link")
FRAMES = ["base", "link1", "link2", "tip"]
NUMBER = st.floats(-2, 2)
POINT = st.lists(NUMBER, min_size=3, max_size=3)
LENGTH = st.floats(1e-6, 1.0)
PARAMETERS = [
    ("max_step", st.none() | st.floats(1e-6, 10)),
    ("max_residual", st.none() | st.floats(1e-6, 10)),
    ("step_size", st.floats(1e-6, 2)),
    ("damping", st.floats(1e-6, 1)),
    ("target_jacobian", st.booleans()),
    ("relaxation", st.none() | st.floats(0.01, 1.99)),
    ("stiffness", st.dictionaries(st.sampled_from(ARM.joint_names), st.floats(0, 0.99), max_size=2)),
]
MESSAGES = st.one_of(
    st.builds(lambda count: {"type": "view", "count": count}, st.sampled_from([1, 2, 4])),
    st.builds(
        lambda instance, method: {"type": "method", "instance": instance, "method": method},
        st.integers(0, 3),
        st.sampled_from(["ccd", "jt", "pinv", "dls"]),
    ),
    st.sampled_from(PARAMETERS).flatmap(
        lambda p: st.builds(
            lambda i, value: {"type": "parameter", "instance": i, "name": p[0], "value": value}, st.integers(0, 3), p[1]
        )
    ),
    st.builds(lambda on: {"type": "limits", "on": on}, st.booleans()),
    st.builds(lambda on: {"type": "polish", "on": on}, st.booleans()),
    st.builds(lambda name, on: {"type": "look", "name": name, "on": on}, st.sampled_from(list(LOOKS)), st.booleans()),
    st.builds(lambda m: {"type": "motion", "motion": m}, st.sampled_from(["hand", "curve", "random"])),
    st.builds(lambda c: {"type": "curve", "curve": c}, st.sampled_from(["circle", "square"])),
    st.builds(lambda v: {"type": "speed", "value": v}, st.floats(0.1, 10)),
    st.builds(
        lambda until, n: {"type": "iterations", "until_reached": until, "at_most": n},
        st.booleans(),
        st.integers(1, 1000),
    ),
    st.builds(
        lambda p, o: {"type": "tolerance", "position": p, "orientation": o}, st.floats(1e-6, 1), st.floats(1e-6, 3.2)
    ),
    st.builds(lambda i, p: {"type": "ball", "index": i, "position": p}, st.integers(0, 3), POINT),
    st.builds(lambda on, avoid: {"type": "collisions", "on": on, "avoid": avoid}, st.booleans(), st.booleans()),
    st.builds(
        lambda box, size, p: {
            "type": "add_obstacle",
            "kind": "box" if box else "sphere",
            "size": size if box else size[:1],
            "position": p,
        },
        st.booleans(),
        st.lists(st.floats(0.01, 1.0).map(lambda x: round(x, 4)), min_size=3, max_size=3),
        POINT,
    ),
    st.builds(lambda i, p: {"type": "obstacle", "index": i, "position": p}, st.integers(0, 1), POINT),
    st.builds(lambda i: {"type": "remove_obstacle", "index": i}, st.integers(0, 1)),
    st.builds(
        lambda i, on, rpy: {"type": "orientation", "index": i, "on": on, "rpy": rpy},
        st.integers(0, 3),
        st.booleans(),
        POINT,
    ),
    st.builds(
        lambda i, axes: {"type": "free", "index": i, "axes": axes},
        st.integers(0, 3),
        st.sampled_from(["", "x", "y", "z", "xy", "xz", "yz", "xyz"]),
    ),
    st.builds(
        lambda i, tolerance: {"type": "ball_tolerance", "index": i, "tolerance": tolerance},
        st.integers(0, 3),
        st.none() | st.tuples(LENGTH | st.lists(LENGTH, min_size=3, max_size=3), st.floats(1e-6, 3.2)).map(list),
    ),
    st.builds(
        lambda i, m: {"type": "effector", "index": i, "mode": m},
        st.integers(0, 3),
        st.sampled_from(["on", "pinned", "off"]),
    ),
    st.builds(lambda f: {"type": "add_effector", "frame": f}, st.sampled_from(FRAMES)),
    st.builds(lambda i: {"type": "remove_effector", "index": i}, st.integers(0, 3)),
    st.builds(lambda on: {"type": "pause_on_miss", "on": on}, st.booleans()),
    st.builds(
        lambda i, angles: {"type": "angles", "instance": i, "angles": angles},
        st.none() | st.integers(0, 3),
        st.dictionaries(st.sampled_from(ARM.joint_names), NUMBER, min_size=1),
    ),
    st.just({"type": "balls_lead"}),
    st.just({"type": "step"}),
)


def session_after(messages, robot=ARM):
    shown = Session(robot, clock=Clock())
    for message in messages:
        try:
            apply(shown, message)
        except pinik.PinikError:
            continue
    return shown


LEAD = {"type": "angles", "instance": 1, "angles": {"joint1": 0.0}}


@settings(max_examples=120)
@given(st.lists(MESSAGES, max_size=14), st.lists(MESSAGES, max_size=8))
@example([LEAD, {"type": "motion", "motion": "curve"}], [])
@example([LEAD, {"type": "view", "count": 1}], [])
def test_a_set_up_makes_any_session_the_same_again(messages, others):
    text = write_setup(session_after(messages))
    for other in (session_after([]), session_after(others)):
        apply_setup(other, read_setup(text))
        assert write_setup(other) == text


@settings(max_examples=60)
@given(st.lists(MESSAGES, max_size=14))
def test_a_sessions_own_set_up_changes_nothing(messages):
    shown = session_after(messages)
    before, pursuits = snapshot(shown), [one._pursuit for one in shown.instances]
    targets = [ball.target for ball in shown.balls]
    apply_setup(shown, read_setup(write_setup(shown)))
    assert snapshot(shown) == before
    assert [one._pursuit for one in shown.instances] == pursuits  # every run goes on
    assert all(ball.target is target for ball, target in zip(shown.balls, targets, strict=True))


def test_a_set_up_says_what_differs_from_the_beginning_in_plain_words(arm):
    shown = Session(arm, [pinik.CCD(position_weight=7.0), "dls"], clock=Clock())
    assert write_setup(Session(arm, clock=Clock())) == (
        "robot=arm&root=fixed&view=4&methods=ccd,jt,pinv,dls&motion=hand&balls=[[%22tip%22,%22on%22,"
        + json.dumps([round(float(x), 4) for x in shown.balls[0].position], separators=(",", ":"))
        + "]]&run=off"
    )
    shown.set_motion("curve")
    shown.set_curve("knot")
    shown.motion.speed = 2.5
    shown.change_settings(limits=False)
    shown.apply_settings(shown.settings.__class__(limits=False, until_reached=False, at_most=9))
    shown.change_settings(polish=True)
    shown.looks.switch("reach", True)
    shown.looks.switch("axes", True)
    shown.change_settings(tolerance=pinik.Tolerance(0.001, 0.01))
    shown.balls[0].orient(True, [0.1, 0.2, 0.3])
    shown.scores.cover("all")
    shown.running = True
    said = {name: values[0] for name, values in parse_qs(write_setup(shown), strict_parsing=True).items()}
    assert json.loads(said.pop("parameters")) == {"0": {"position_weight": 7.0}}
    assert json.loads(said.pop("balls")) == [["tip", "on", None, [0.1, 0.2, 0.3]]]
    assert said == {
        "robot": "arm",
        "root": "fixed",
        "view": "2",
        "methods": "ccd,dls",
        "motion": "curve",
        "curve": "knot",
        "speed": "2.5",
        "limits": "off",
        "polish": "on",
        "looks": "axes,reach",
        "iterations": "9",
        "tolerance": "0.001,0.01",
        "statistics": "all",
        "run": "on",
    }
    again = Session(arm, clock=Clock())
    apply_setup(again, read_setup(write_setup(shown)))
    assert again.scores.window == "all"


def test_a_set_up_fits_into_an_address():
    """For any names of a robot and its frames."""
    turn = joint("j", "a=b", "c&amp;d")
    robot = load_quietly(machine(link("a=b"), link("c&amp;d"), turn).replace('name="r"', 'name="&amp; ü #?%"'))
    setup = write_setup(Session(robot, clock=Clock()))
    assert set(setup) <= set(string.ascii_letters + string.digits + "-._~!$&'()*+,;=:@/?%[]{}")
    assert read_setup(setup)["robot"] == "& ü #?%"
    assert json.loads(read_setup("#" + setup)["balls"])[0][0] == "c&d"
    other = Session(robot, clock=Clock())
    apply_setup(other, read_setup("#" + setup))
    assert write_setup(other) == setup


def test_an_undo_of_four_robots_with_many_joints_can_be_read():
    """The page adds the poses of all robots to a set-up, in full digits, and escapes them as browsers do."""
    shown = Session(load_quietly("tiago_dual"), ["ccd", "jt", "pinv", "dls"], clock=Clock())
    state = session_state(shown)["instances"]
    poses = {
        str(k): {name: angle + 0.1234567890123 for name, angle in one["angles"].items()} for k, one in enumerate(state)
    }
    text = f"{write_setup(shown)}&angles={quote(json.dumps(poses, separators=(',', ':')), safe='')}&lead=balls"
    assert len(text) > 20_000
    assert json.loads(read_setup(text)["angles"]) == poses
    assert len(json.dumps({"type": "setup", "setup": "x" * 65_000})) <= LARGEST_MESSAGE


def test_a_link_can_be_read_when_a_pose_took_the_balls_farther_than_one_may_be_put():
    lion = load_quietly("lion", root="free_flyer")
    shown, again = (Session(lion, ["dls"], clock=Clock()) for _ in range(2))
    set_angles(shown, None, {"root_joint": [500.0, 0.0, -500.0, 0.0, 0.0, 0.0, 1.0]})
    apply(shown, {"type": "balls_lead"})
    setup, before = read_setup(write_setup(shown)), snapshot(shown)
    apply_setup(again, setup)
    assert again.balls[0].position[[0, 2]].tolist() == [100.0, -100.0]
    apply_setup(shown, setup)
    assert snapshot(shown) == before


def test_numbers_are_kept_to_the_last_digit(arm):
    shown, other = (Session(arm, clock=Clock()) for _ in range(2))
    shown.motion.speed = math.pi
    shown.change_settings(tolerance=pinik.Tolerance(1.23456789e-5, math.e / 3))
    shown.set_parameter(3, "damping", 1 / 3)
    apply_setup(other, read_setup(write_setup(shown)))
    assert other.motion.speed == math.pi
    assert other.settings == shown.settings
    assert other.instances[3].solver == shown.instances[3].solver


def test_the_order_of_balls_is_kept():
    lion = load_quietly("lion")
    shown, other = (Session(lion, clock=Clock()) for _ in range(2))
    shown.balls.remove(0)
    shown.add_ball("left_fore_paw")
    apply_setup(other, read_setup(write_setup(shown)))
    assert [ball.frame for ball in other.balls] == [ball.frame for ball in shown.balls]
    assert write_setup(other) == write_setup(shown)


def test_twelve_other_balls_fit_where_there_were_six():
    lion = load_quietly("lion")
    shown, other = (Session(lion, clock=Clock()) for _ in range(2))
    ends = [ball.frame for ball in shown.balls]
    others = [name for name in lion.description.links if name not in ends][:12]
    for frame in others:
        shown.add_ball(frame)
        if shown.balls[0].frame in ends:
            shown.balls.remove(0)
    apply_setup(other, read_setup(write_setup(shown)))
    assert [ball.frame for ball in other.balls] == others
    assert write_setup(other) == write_setup(shown)


def test_a_part_of_a_set_up_changes_that_part():
    shown = session_after([{"type": "motion", "motion": "random"}, {"type": "step"}])
    apply_setup(shown, read_setup("view=2"))
    assert (shown.view, shown.motion.kind, [ball.frame for ball in shown.balls]) == (2, "random", ["tip"])
    apply_setup(shown, read_setup("methods=dls,dls"))
    assert [one.solver.name for one in shown.instances] == ["dls", "dls", "pinv", "dls"]
    apply_setup(shown, read_setup("run=on"))
    assert shown.running
    apply_setup(shown, read_setup("motion=curve&curve=square"))
    assert (shown.running, shown.motion.kind, shown.motion.curve) == (True, "curve", "square")
    apply_setup(shown, read_setup("run=off"))
    assert not shown.running
    apply_setup(shown, read_setup(""))
    assert (shown.view, shown.motion.kind) == (2, "curve")


def test_parameters_that_are_not_said_are_the_defaults():
    shown = session_after([{"type": "parameter", "instance": 3, "name": "damping", "value": 0.5}])
    apply_setup(shown, read_setup("methods=ccd,jt,pinv,dls"))
    assert shown.instances[3].solver == pinik.DampedLeastSquares()


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("x" * 65_001, "at most 65000 characters"),
        ("view=1&view=2", "contains 'view' twice"),
        ("colour=red", "no part of a set-up 'colour'"),
        ("path=/etc/passwd", "no part of a set-up 'path'"),
        ("view=3", "1, 2 or 4"),
        ("view=", "view must be a whole number"),
        ("view=1.0", "view must be a whole number"),
        ("view=-1", "view must be a whole number"),
        ("view=" + "9" * 100, "view must be a whole number"),
        ("view=²", "view must be a whole number"),
        ("methods=", "no method ''"),
        ("methods=os:system", "no method 'os:system'"),
        ("methods=ccd,ccd,ccd,ccd,ccd", "methods must be at most 4; got 5"),
        ("methods=" + "ccd," * 1000, "methods must be at most 4"),
        ("methods=ccd&parameters=5", "parameters must be a JSON object"),
        ("methods=ccd&parameters={", "parameters must be a JSON object"),
        ("methods=ccd&parameters=[]", "parameters must be a JSON object"),
        ('methods=ccd&parameters={"0":5}', "parameters of instance 0 must be an object"),
        ('methods=ccd&parameters={"0":{"nope":5}}', "no parameter 'nope'"),
        ('methods=ccd&parameters={"0":{"max_step":-5}}', "max_step"),
        ('methods=ccd&parameters={"0":{"max_step":NaN}}', "parameters must be a JSON object"),
        ('methods=ccd&parameters={"0":{"stiffness":{"nope":0.5}}}', "no joint 'nope'"),
        ("methods=ccd&parameters=" + "[" * 2000, "parameters must be a JSON object"),
        ("methods=ccd&parameters=" + '{"0":' * 985 + "1" + "}" * 985, "parameters must be a JSON object"),
        ("motion=dance", "no motion 'dance'"),
        ("curve=line", "no curve 'line'"),
        ("speed=fast", "speed must be 1 number"),
        ("speed=1,2", "speed must be 1 number"),
        ("speed=nan", "finite number"),
        ("speed=inf", "finite number"),
        ("speed=1e9", "number from 0.1"),
        ("limits=banana", "limits must be on or off; got 'banana'"),
        ("limits=", "limits must be on or off"),
        ("polish=1", "polish must be on or off; got '1'"),
        ("looks=axes,x-ray", "no look 'x-ray'"),
        ("run=yes", "run must be on or off"),
        ("iterations=0", "number from 1 to 1000"),
        ("iterations=many", "iterations must be a whole number"),
        ("tolerance=1", "tolerance must be 2 numbers"),
        ("tolerance=0,0", "number from 1e-06"),
        ("tolerance=a,b", "tolerance must be 2 numbers"),
        ("balls=tip", "balls must be a JSON array"),
        ("balls={}", "balls must be a JSON array"),
        ("balls=[]", "balls must contain at least one ball"),
        ("balls=[5]", "a ball must be"),
        ("balls=[[]]", "a ball must be"),
        ('balls=[["tip"]]', "a ball must be"),
        ('balls=[["tip","on",null,null,null]]', "a ball must be"),
        ('balls=[["tip","on",null,null,{},0]]', "a ball must be"),
        ('balls=[["tip","on",null,null,{"fre":"x"}]]', "a ball must be"),
        ('balls=[["tip","on",null,null,{"free":5}]]', "axes must be a text"),
        ('balls=[["tip","on",null,null,{"free":"yx"}]]', 'letters of "xyz" in order'),
        ('balls=[["tip","on",null,null,{"free":"xyz"}]]', "at least one axis, or for an orientation"),
        ('balls=[["tip","on",null,null,{"tolerance":0.1}]]', "null or [metres, radians]"),
        ('balls=[["tip","on",null,null,{"tolerance":[[1,2],0.1]}]]', "one length, or three for a box"),
        ('balls=[["nope","on"]]', "no frame 'nope'"),
        ('balls=[[5,"on"]]', "frame must be a text"),
        ('balls=[[{},"on"]]', "frame must be a text"),
        ('balls=[["tip","in"]]', "no mode 'in'"),
        ('balls=[["tip",[]]]', "mode must be a text"),
        ('balls=[["tip","on",[1,2]]]', "3 finite numbers"),
        ('balls=[["tip","on","here"]]', "3 finite numbers"),
        ('balls=[["tip","on",[1,2,1e5]]]', "from -100 to 100 m"),
        ('balls=[["tip","on",[1,2,1e999]]]', "3 finite numbers"),
        ('balls=[["tip","on",null,[1]]]', "3 finite numbers"),
        ('balls=[["tip","on",null,{"a":1}]]', "3 finite numbers"),
    ],
)
def test_what_is_wrong_with_a_set_up_is_said_in_words(text, fault):
    shown = Session(ARM, clock=Clock())
    with pytest.raises(pinik.PinikError, match=re.escape(fault)):
        apply_setup(shown, read_setup(quote(text, safe="=&,")))
    shown.step()
    assert write_setup(shown)


@settings(max_examples=300)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["view", "methods", "parameters", "motion", "curve", "speed", "limits", "iterations"])
            | st.sampled_from(["tolerance", "balls", "run", "robot", "root"]),
            st.text(max_size=12)
            | st.sampled_from(
                ["1", "2", "ccd,dls", "on", "off", "0.5,0.5", "hand", '{"0":{}}', '[["tip","on"]]', "7", "curve"]
            )
            | st.recursive(
                st.none() | st.integers() | st.floats() | st.sampled_from(["tip", "base", "on", "off", "0"]),
                lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from("01ab"), inner, max_size=2),
                max_leaves=8,
            ).map(json.dumps),
        ),
        max_size=5,
    )
)
def test_no_set_up_does_more_than_raise_in_words(parts):
    shown = Session(ARM, clock=Clock())
    with contextlib.suppress(pinik.PinikError):
        apply_setup(shown, read_setup("&".join(f"{name}={quote(value)}" for name, value in parts)))
    json.dumps(json.loads(snapshot(shown)), allow_nan=False)
    shown.step()


def test_a_link_keeps_free_axes_and_a_balls_own_tolerance(arm):
    shown, other = (Session(arm, clock=Clock()) for _ in range(2))
    ball = shown.balls[0]
    ball.orient(True, [0.1, 0.2, 0.3])
    ball.release("xyz")
    ball.tolerate(pinik.Tolerance((0.01, 0.02, 1 / 3), 0.5))
    apply_setup(other, read_setup(write_setup(shown)))
    assert other.balls[0].target.position is None
    assert other.balls[0].target.tolerance == pinik.Tolerance((0.01, 0.02, 1 / 3), 0.5)
    apply_setup(other, read_setup(write_setup(Session(arm, clock=Clock()))))
    back = other.balls[0]
    assert (back.oriented, back.free, back.tolerance, back.target.along) == (False, "", None, (True, True, True))
