"""Mimic joints follow whatever the order of names, and the model shows the names of the file."""

from __future__ import annotations

import pickle
from xml.etree import ElementTree

import numpy as np
import pinocchio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pinik
from by_hand import axis, homogeneous, limit, link_placements, mimic, origin, random_placement, rotation_about
from engines import needs_native
from judge import assert_good
from pinik.description.catalog import find
from robots import load_quietly
from urdf_texts import joint, link, robot

ENGINES = ["python", pytest.param("native", marks=needs_native)]

# Two fingers; the left one's leader comes later by name.
TWO_FINGERS = robot(
    *map(link, ("palm", "fl", "fr")),
    joint("left_finger", "palm", "fl", axis(0, 1, 0), mimic("right_finger"), kind="prismatic", limit=limit(0, 0.04)),
    joint("right_finger", "palm", "fr", axis(0, -1, 0), kind="prismatic", limit=limit(0, 0.04)),
)

# An arm with a hand as JVRC's: the thumb leads three fingers, through followers, and its name comes last.
HAND = robot(
    *map(link, ("base", "arm", "hand", "thumb", "thumb_tip", "index", "index_tip", "little", "little_tip")),
    joint("shoulder", "base", "arm", axis(0, 0, 1), limit=limit(-3, 3)),
    joint("wrist", "arm", "hand", origin((0.4, 0, 0)), axis(0, 1, 0), limit=limit(-2, 2)),
    joint("UTHUMB", "hand", "thumb", origin((0.05, 0.03, 0)), axis(0, 0, 1), limit=limit(-0.2, 1.2)),
    joint(
        "LTHUMB", "thumb", "thumb_tip", origin((0.04, 0, 0)), axis(0, 0, 1), mimic("UTHUMB", 0.5), limit=limit(-1, 1)
    ),
    joint("UINDEX", "hand", "index", origin((0.1, 0.02, 0)), axis(0, -1, 0), mimic("UTHUMB", -1.0, 0.1)),
    joint("LINDEX", "index", "index_tip", origin((0.05, 0, 0)), axis(0, -1, 0), mimic("UINDEX", 1.5)),
    joint("ALITTLE", "hand", "little", origin((0.1, -0.02, 0)), axis(0, 1, 0), mimic("LINDEX", -0.8, -0.1)),
    joint("end", "little", "little_tip", origin((0.05, 0, 0)), kind="fixed", limit=""),
)

# The knee's name comes last, and the knee hangs from the hip that follows it.
LEADER_BEYOND = robot(
    *map(link, ("base", "thigh", "shin", "foot", "flag")),
    joint("hip", "base", "thigh", origin((0, 0, 0.1)), axis(0, 1, 0), mimic("knee", -0.5, 0.2), limit=limit(-1, 1)),
    joint("knee", "thigh", "shin", origin((0.3, 0, 0)), axis(0, 1, 0), limit=limit(-1.2, 2)),
    joint("ankle", "shin", "foot", origin((0.3, 0, 0)), axis(0, 1, 0), mimic("hip", 2.0), limit=limit(-3, 3)),
    joint("a_flag", "base", "flag", axis(0, 0, 1), mimic("ankle", 1.0, 0.3), limit=limit(-3, 3)),
)

# Two pairs in two branches; each follower lies before the leader of the other pair.
CROSSED = robot(
    *map(link, ("base", "a1", "a2", "b1", "b2")),
    joint("a_follows", "base", "a1", axis(0, 0, 1), mimic("b_leads", 2.0)),
    joint("a_leads", "a1", "a2", origin((0.2, 0, 0)), axis(0, 1, 0)),
    joint("b_follows", "base", "b1", axis(0, 0, 1), mimic("a_leads", -0.5, 0.1)),
    joint("b_leads", "b1", "b2", origin((0, 0.2, 0)), axis(0, 1, 0)),
)


@st.composite
def trees(draw: st.DrawFn) -> str:
    """URDF texts of trees with random names, in which any joint may follow any other, in chains as well."""
    count = draw(st.integers(2, 8))
    names = draw(st.permutations([f"j{i}" for i in range(count)]))
    rank = draw(st.permutations(range(count)))  # a joint may follow those of lower rank
    number = st.floats(-1.0, 1.0).map(lambda x: round(x, 3))
    parts = [link(f"l{i}") for i in range(count + 1)]
    for i, name in enumerate(names):
        kind = draw(st.sampled_from(("revolute", "continuous", "prismatic")))
        place = origin([draw(number) for _ in range(3)], [draw(number) for _ in range(3)])
        words = [place, axis(*draw(st.tuples(number, number, number).filter(any)))]
        lower = [names[k] for k in range(count) if rank[k] < rank[i]]
        if lower and draw(st.booleans()):
            words.append(
                mimic(draw(st.sampled_from(lower)), draw(st.sampled_from((-2.0, -0.5, 1.0, 3.0))), draw(number))
            )
        bounds = "" if kind == "continuous" else limit(-9, 9)
        parts.append(joint(name, f"l{draw(st.integers(0, i))}", f"l{i + 1}", *words, kind=kind, limit=bounds))
    return robot(*parts)


def with_random_angles(loaded: pinik.Robot, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """(q with angles in ±1, the 4×4 of a free or planar root)."""
    angles = dict(zip(loaded.joint_names, rng.uniform(-1, 1, len(loaded.joint_names)), strict=True))
    if loaded.root == "fixed":
        return loaded.configuration(angles), np.eye(4)
    base = random_placement(rng, "floating" if loaded.root == "free_flyer" else "planar")
    return loaded.configuration(angles, {"root_joint": base}), base


def check_follows(text: str, root: str = "fixed") -> pinik.Robot:
    """Every follower of the file follows, in angles, placements and `mimics`, and the names are the file's."""
    loaded = load_quietly(text, root=root)
    tags = {tag.attrib["name"]: tag for tag in ElementTree.fromstring(text).findall("joint")}
    moving = {name for name, tag in tags.items() if tag.attrib["type"] != "fixed"}
    assert set(loaded.model.names) - {"universe", "root_joint"} == moving
    assert len(loaded.joint_names) + len(loaded.mimics) == len(moving)
    assert set(tags) < set(loaded.frame_names)
    for seed in range(3):
        q, base = with_random_angles(loaded, np.random.default_rng(seed))
        angles = loaded.angles(q)
        for name in moving:
            follows = tags[name].find("mimic")
            if follows is not None:
                said = float(follows.attrib["multiplier"]) * angles[follows.attrib["joint"]]
                assert angles[name] == pytest.approx(said + float(follows.attrib["offset"]), abs=1e-12)
        for follower, (leader, multiplier, offset) in loaded.mimics.items():
            assert leader in loaded.joint_names
            assert angles[follower] == pytest.approx(multiplier * angles[leader] + offset, abs=1e-12)
        for frame, placement in link_placements(text, angles, base=base).items():
            np.testing.assert_allclose(loaded.placement(frame, q).homogeneous, placement, atol=1e-11, rtol=0)
        again = loaded.configuration(angles, loaded.joint_placements(q))
        np.testing.assert_allclose(again, q, atol=1e-12)
    return loaded


@pytest.mark.parametrize("root", ["fixed", "free_flyer", "planar"])
@pytest.mark.parametrize("text", [TWO_FINGERS, HAND, LEADER_BEYOND, CROSSED], ids=["two", "hand", "beyond", "crossed"])
def test_followers_follow_under_any_root(text: str, root: str) -> None:
    check_follows(text, root)


@settings(max_examples=60)
@given(text=trees(), root=st.sampled_from(["fixed", "free_flyer", "planar"]))
def test_followers_follow_in_any_tree_with_any_names(text: str, root: str) -> None:
    check_follows(text, root)


def test_the_left_finger_is_at_0_03_when_the_right_one_is() -> None:
    loaded = load_quietly(TWO_FINGERS)
    q = loaded.configuration({"right_finger": 0.03})
    assert loaded.placement("fl", q).translation == pytest.approx([0, 0.03, 0], abs=1e-15)
    assert (loaded.joint_names, loaded.warnings) == (("right_finger",), ())
    assert loaded.mimics == {"left_finger": ("right_finger", 1.0, 0.0)}


def test_a_chain_is_reported_by_the_leader_at_its_end() -> None:
    loaded = load_quietly(HAND)
    assert loaded.joint_names == ("shoulder", "wrist", "UTHUMB")
    expected = {"LTHUMB": (0.5, 0.0), "UINDEX": (-1.0, 0.1), "LINDEX": (-1.5, 0.15), "ALITTLE": (1.2, -0.22)}
    assert loaded.mimics.keys() == expected.keys()
    for follower, (multiplier, offset) in expected.items():
        assert loaded.mimics[follower] == ("UTHUMB", pytest.approx(multiplier), pytest.approx(offset))


def test_joints_stay_in_the_order_of_their_names_where_the_mimics_allow_it() -> None:
    """The hand's children come as UTHUMB, and then by name; the others do not move."""
    names = list(load_quietly(HAND).model.names)
    assert names == ["universe", "shoulder", "wrist", "UTHUMB", "LTHUMB", "ALITTLE", "UINDEX", "LINDEX"]


@pytest.mark.parametrize("name", ["panda", "baxter", "pr2", "tiago_pro"])
def test_a_robot_whose_leaders_come_first_keeps_pinocchios_order(name: str) -> None:
    model, expected = load_quietly(name).model, pinocchio.buildModelFromUrdf(str(find(name).urdf))
    assert list(model.names) == list(expected.names)
    assert [(f.name, f.type, f.parentJoint, f.parentFrame) for f in model.frames] == [
        (f.name, f.type, f.parentJoint, f.parentFrame) for f in expected.frames
    ]


@pytest.mark.parametrize("name", ["romeo", "talos_full", "talos_full_box"])
def test_a_robot_in_another_order_has_the_same_names_links_and_inertias(name: str) -> None:
    model, expected = load_quietly(name).model, pinocchio.buildModelFromUrdf(str(find(name).urdf))
    assert sorted(model.names) == sorted(expected.names)
    assert sorted((f.name, str(f.type)) for f in model.frames) == sorted((f.name, str(f.type)) for f in expected.frames)
    for frame in model.frames:
        theirs = expected.frames[expected.getFrameId(frame.name, frame.type)]
        assert frame.placement.isApprox(theirs.placement, 1e-12)
        assert model.names[frame.parentJoint] == expected.names[theirs.parentJoint]
        assert model.frames[frame.parentFrame].name == expected.frames[theirs.parentFrame].name
    for joint_name, inertia in zip(model.names, model.inertias, strict=True):
        assert inertia.isApprox(expected.inertias[expected.getJointId(joint_name)], 1e-12)


def test_links_and_joints_may_share_their_names() -> None:
    text = TWO_FINGERS.replace('"fl"', '"left_finger"').replace('"fr"', '"0 left_finger"')
    loaded = check_follows(text)
    model = loaded.model
    for kind in (pinocchio.BODY, pinocchio.JOINT):
        assert model.existFrame("left_finger", kind)
    assert model.existFrame("0 left_finger", pinocchio.BODY)


def test_a_fixed_joint_called_root_joint_keeps_its_name_beside_pinocchios() -> None:
    text = HAND.replace('"end"', '"root_joint"')
    model = load_quietly(text, root="free_flyer").model
    assert model.existFrame("root_joint", pinocchio.JOINT)
    assert model.existFrame("root_joint", pinocchio.FIXED_JOINT)


def test_a_leader_that_hangs_from_its_follower_changes_roles_with_it_and_a_warning_says_so() -> None:
    loaded = load_quietly(LEADER_BEYOND)
    assert loaded.joint_names == ("hip",)
    assert {name: leader for name, (leader, _, _) in loaded.mimics.items()} == dict.fromkeys(
        ("knee", "ankle", "a_flag"), "hip"
    )
    assert loaded.warnings == (
        "joint 'hip': Pinocchio's model needs a leader before its followers, and cannot have 'knee' before 'hip'; "
        "'knee' follows 'hip' instead, with the same angles (line 1)",
    )
    # The hip's range −1…1, cut by the knee's −1.2…2: hip = −0.5 · knee + 0.2.
    assert (loaded.lower[0], loaded.upper[0]) == pytest.approx((-0.8, 0.8))


def test_a_leader_that_lies_across_other_mimics_changes_roles() -> None:
    loaded = load_quietly(CROSSED)
    assert len(loaded.mimics) == 2
    assert len(loaded.warnings) == 1
    assert "with the same angles" in loaded.warnings[0]


def test_a_follower_at_rest_is_left_free_only_where_its_leader_cannot_come_first() -> None:
    beside = robot(*map(link, "bcd"), joint("a", "b", "c", mimic("z", 0.0, 0.4)), joint("z", "b", "d"))
    assert check_follows(beside).mimics == {"a": ("z", 0.0, 0.4)}
    beyond = robot(*map(link, "bcd"), joint("rest", "b", "c", mimic("lead", 0.0, 0.4)), joint("lead", "c", "d"))
    loaded = load_quietly(beyond)
    assert loaded.mimics == {}
    assert loaded.warnings == (
        "joint 'rest': it mimics 'lead', which Pinocchio's model cannot have before it, and with multiplier 0 it "
        "cannot lead; it is left free (line 1)",
    )


def test_names_with_any_characters_come_back_as_they_were() -> None:
    strange = {"left_finger": "0 &lt;left&gt; &amp; &#39;ünder&#39;", "right_finger": " 1 right "}
    text = TWO_FINGERS
    for name, other in strange.items():
        text = text.replace(f'"{name}"', f'"{other}"')
    assert check_follows(text).mimics == {"0 <left> & 'ünder'": (" 1 right ", 1.0, 0.0)}


def test_followers_far_down_a_deep_tree_follow() -> None:
    count = 200
    text = robot(
        *(link(f"l{i}") for i in range(count + 1)),
        *(joint(f"f{i:03}", f"l{i}", f"l{i + 1}", origin((0.01, 0, 0)), kind="fixed", limit="") for i in range(count)),
        *map(link, ("one", "two")),
        joint("one", f"l{count}", "one", origin((0.1, 0, 0)), axis(0, 1, 0), mimic("two", -2.0, 0.1)),
        joint("two", f"l{count}", "two", axis(0, 0, 1)),
    )
    assert check_follows(text).joint_names == ("two",)


@pytest.mark.parametrize("root", ["fixed", "free_flyer", "planar"])
@pytest.mark.parametrize(
    ("text", "frame"),
    [(HAND, "little_tip"), (LEADER_BEYOND, "foot"), (CROSSED, "a2")],
    ids=["hand", "beyond", "crossed"],
)
def test_the_jacobian_is_the_derivative_of_the_placement(text: str, frame: str, root: str) -> None:
    loaded, step = load_quietly(text, root=root), 1e-6
    q, _ = with_random_angles(loaded, np.random.default_rng(8))
    J = loaded.jacobian(frame, q)
    for k, along in enumerate(step * np.eye(loaded.model.nv)):
        ahead, behind = (loaded.placement(frame, pinocchio.integrate(loaded.model, q, way)) for way in (along, -along))
        linear = (ahead.translation - behind.translation) / (2 * step)
        angular = pinocchio.log3(ahead.rotation @ behind.rotation.T) / (2 * step)
        np.testing.assert_allclose(J[:, k], [*linear, *angular], atol=1e-8)


def test_a_pickled_robot_is_the_same() -> None:
    loaded = load_quietly(HAND, root="planar")
    copy = pickle.loads(pickle.dumps(loaded))
    assert (copy.model, copy.mimics, copy.joint_names) == (loaded.model, loaded.mimics, loaded.joint_names)


def test_setting_a_follower_sets_its_leader() -> None:
    loaded = load_quietly(HAND)
    q = loaded.neutral()
    loaded.joint("ALITTLE").set_angle(q, 0.5)
    assert loaded.angles(q)["UTHUMB"] == pytest.approx(0.6)
    np.testing.assert_allclose(loaded.configuration({"ALITTLE": 0.5}), q, atol=1e-12)


def test_a_pose_of_an_srdf_sets_the_joints_that_it_names(tmp_path) -> None:
    (tmp_path / "hand.urdf").write_text(HAND)
    state = '<joint name="UTHUMB" value="0.4"/><joint name="ALITTLE" value="9"/><joint name="wrist" value="0.7"/>'
    (tmp_path / "hand.srdf").write_text(
        f'<robot name="r"><group_state name="grip" group="g">{state}</group_state></robot>'
    )
    loaded = pinik.load(tmp_path / "hand.urdf")
    angles = loaded.angles(loaded.poses["grip"])
    assert (angles["UTHUMB"], angles["wrist"], angles["shoulder"]) == pytest.approx((0.4, 0.7, 0.0))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd"])
@pytest.mark.parametrize(
    ("source", "frame"),
    [
        (TWO_FINGERS, "fl"),
        (HAND, "little_tip"),
        (HAND, "index_tip"),
        ("romeo", "LFinger23Link"),
        ("talos_full", "gripper_left_fingertip_1_link"),
    ],
    ids=["two fingers", "little finger", "index finger", "romeo", "talos_full"],
)
def test_both_engines_reach_what_followers_carry(source: str, frame: str, method: str, engine: str) -> None:
    loaded = load_quietly(source)
    inside = loaded.random(np.random.default_rng(5))
    target = pinik.Target(frame, position=loaded.placement(frame, inside).translation)
    solution = loaded.solve(target, method=method, engine=engine, seed=1)
    assert_good(solution, target)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("text", [LEADER_BEYOND, CROSSED], ids=["beyond", "crossed"])
def test_both_engines_solve_where_roles_were_changed(text: str, engine: str) -> None:
    loaded = load_quietly(text)
    frame = "foot" if text is LEADER_BEYOND else "a2"
    asked = loaded.placement(frame, loaded.random(np.random.default_rng(3)))
    solution = loaded.solve(frame, placement=asked, engine=engine)
    assert solution.success, solution.message
    found = link_placements(text, loaded.angles(solution.q))[frame]
    np.testing.assert_allclose(found, asked.homogeneous, atol=1e-3)


def test_a_turn_of_the_leader_turns_the_follower_of_a_continuous_joint_by_its_multiple() -> None:
    text = robot(
        *map(link, ("base", "slow", "fast")),
        joint("a_slow", "base", "slow", axis(0, 0, 1), mimic("fast", 0.25), kind="continuous", limit=""),
        joint("fast", "base", "fast", axis(0, 0, 1), kind="continuous", limit=""),
    )
    loaded = load_quietly(text)
    q = loaded.configuration({"fast": 2 * np.pi})
    expected = homogeneous(rotation_about(np.array([0.0, 0, 1]), np.pi / 2), (0, 0, 0))
    np.testing.assert_allclose(loaded.placement("slow", q).homogeneous, expected, atol=1e-12)
