"""The `robot` message against Pinocchio's placements and matrices written out by hand."""

from __future__ import annotations

import json
import math

import numpy as np
import pinocchio
import pytest

import by_hand
import pinik
from pinik.viewer.protocol.packing import JointPlacements
from pinik.viewer.protocol.robot_message import robot_message
from robots import load_quietly
from urdf_texts import joint, link, robot

ROBOTS = [
    ("panda", "fixed"),  # two fingers, one of which mimics the other
    ("lion", "free_flyer"),
    ("tiago", "planar"),  # continuous joints
    ("hector", "fixed"),  # nothing moves: nq = 0
    (by_hand.ZOO, "fixed"),
]
NO_AXIS = {"axis": None, "follows": None, "multiplier": 1.0}
ABOUT_Z = {"axis": [0, 0, 1], "follows": None, "multiplier": 1.0}


def matrix(seven):
    """4×4 from x, y, z, qx, qy, qz, qw, written out."""
    x, y, z, i, j, k, r = seven
    rotation = [
        [1 - 2 * (j * j + k * k), 2 * (i * j - k * r), 2 * (i * k + j * r)],
        [2 * (i * j + k * r), 1 - 2 * (i * i + k * k), 2 * (j * k - i * r)],
        [2 * (i * k - j * r), 2 * (j * k + i * r), 1 - 2 * (i * i + j * j)],
    ]
    return by_hand.homogeneous(np.array(rotation), (x, y, z))


@pytest.mark.parametrize(("source", "root"), ROBOTS)
def test_each_link_is_at_its_joint_in_the_frame_and_its_place_in_the_message(source, root):
    model = load_quietly(source, root=root)
    message = json.loads(json.dumps(robot_message(model, 3), allow_nan=False))
    placements = JointPlacements(model)
    assert [found["name"] for found in message["links"]] == list(model.description.links)
    for seed in range(5):
        q = model.random(seed)
        joints = placements.at(q)
        assert joints.shape == (len(message["joints"]), 7)
        assert joints[0].tolist() == [0, 0, 0, 0, 0, 0, 1]
        for found in message["links"]:
            placed = matrix(joints[found["joint"]]) @ matrix(found["placement"])
            np.testing.assert_allclose(placed, model.placement(found["name"], q).homogeneous, atol=1e-9)


def test_all_kinds_of_joints_are_where_matrices_by_hand_put_them():
    model = load_quietly(by_hand.ZOO)
    message = robot_message(model, 1)
    angles = {"k_turn": 4.0, "l_hinge": -0.7, "m_slide": 0.3}
    rng = np.random.default_rng(0)
    loose = {"drift": by_hand.random_placement(rng), "s_plane": by_hand.random_placement(rng, "planar")}
    joints = JointPlacements(model).at(model.configuration(angles, loose))
    wanted = by_hand.link_placements(by_hand.ZOO, angles, loose)
    for found in message["links"]:
        placed = matrix(joints[found["joint"]]) @ matrix(found["placement"])
        np.testing.assert_allclose(placed, wanted[found["name"]], atol=1e-9)
    kinds = {found["name"]: found["kind"] for found in message["joints"]}
    assert kinds == {
        "universe": "fixed", "drift": "floating", "k_turn": "continuous", "l_hinge": "revolute",
        "m_slide": "prismatic", "s_plane": "planar", "t_hinge": "revolute", "u_slide": "prismatic",
        "v_turn": "continuous", "w_hinge": "revolute",
    }  # fmt: skip


@pytest.mark.parametrize("name", ["panda", "lion", "hector"])
def test_with_every_angle_zero_joints_hang_together_by_their_placements(name):
    model = load_quietly(name)
    found = robot_message(model, 1)["joints"]
    at_zero = JointPlacements(model).at(model.neutral())
    for index, each in enumerate(found[1:], start=1):
        placed = matrix(at_zero[each["parent"]]) @ matrix(each["placement"])
        np.testing.assert_allclose(placed, matrix(at_zero[index]), atol=1e-9)
        assert each["parent"] < index


@pytest.mark.parametrize(("source", "root"), ROBOTS)
def test_axes_and_leaders_move_the_joints_as_pinocchio_moves_them(source, root):
    model = load_quietly(source, root=root)
    joints = robot_message(model, 1)["joints"]
    placements, step = JointPlacements(model), 1e-6
    q = model.random(7)
    for j, each in enumerate(joints):
        known = next((one for one in model.joints if one.id == j), None)
        if each["axis"] is None:
            assert known is None or known.kind in ("floating", "planar")
            continue
        moves = each["follows"] or j
        (leader,) = (one for one in model.joints if one.id == moves)
        tangent = np.zeros(model.model.nv)
        tangent[leader.idx_v] = step
        before, after = (placements.at(at).copy() for at in (q, pinocchio.integrate(model.model, q, tangent)))
        own = [np.linalg.inv(matrix(at[each["parent"]])) @ matrix(at[j]) for at in (before, after)]
        change = np.linalg.inv(own[0]) @ own[1]
        turned = np.array([change[2, 1], change[0, 2], change[1, 0]])
        moved = change[:3, 3] if each["kind"] == "prismatic" else turned
        np.testing.assert_allclose(moved / step, each["multiplier"] * np.array(each["axis"]), atol=1e-5)


def test_the_message_of_a_small_robot():
    message = robot_message(pinik.load("two_link"), 4)
    reach = pytest.approx([-math.pi, math.pi])
    fixed, hinge = {"leader": None, "range": None}, {"leader": None, "range": reach}
    assert message == {
        "type": "robot",
        "generation": 4,
        "name": "two_link",
        "root": "fixed",
        "joints": [
            {"name": "universe", "parent": 0, "kind": "fixed", "placement": [0, 0, 0, 0, 0, 0, 1]} | NO_AXIS | fixed,
            {"name": "joint1", "parent": 0, "kind": "revolute", "placement": [0, 0, 0, 0, 0, 0, 1]} | ABOUT_Z | hinge,
            {"name": "joint2", "parent": 1, "kind": "revolute", "placement": [0.5, 0, 0, 0, 0, 0, 1]} | ABOUT_Z | hinge,
        ],
        "links": [
            {"name": "base", "joint": 0, "placement": [0, 0, 0, 0, 0, 0, 1]},
            {"name": "link1", "joint": 1, "placement": [0, 0, 0, 0, 0, 0, 1]},
            {"name": "link2", "joint": 2, "placement": [0, 0, 0, 0, 0, 0, 1]},
            {"name": "tip", "joint": 2, "placement": [0.4, 0, 0, 0, 0, 0, 1]},
        ],
        "frames": ["tip", "link1", "link2"],
        "size": 0.9,
        "warnings": [],
    }


def test_size_is_the_longest_way_from_a_first_joint_along_the_others():
    crane = robot(
        *(link(name) for name in ("base", "mast", "trolley", "hook", "stub")),
        joint("turn", "base", "mast", by_hand.origin((0, 3, 4))),
        joint("ride", "mast", "trolley", by_hand.origin((1, 0, 0)), kind="prismatic", limit=by_hand.limit(-0.5, 2)),
        joint("rope", "trolley", "hook", by_hand.origin((0, 0, -6)), kind="fixed", limit=""),
        joint("side", "base", "stub", by_hand.origin((0, 0, 1))),
    )
    assert robot_message(pinik.load(crane), 1)["size"] == pytest.approx(1 + 2 + 6)
    assert robot_message(load_quietly("arm"), 1)["size"] == pytest.approx(1.2)
    assert robot_message(pinik.load(robot(link("alone"))), 1)["size"] == 1
    rigid = robot(link("a"), link("b"), joint("j", "a", "b", by_hand.origin((0, 3, 0)), kind="fixed", limit=""))
    assert robot_message(pinik.load(rigid), 1)["size"] == 3


def test_frames_are_what_moves_with_the_ends_first(panda):
    frames = robot_message(panda, 1)["frames"]
    assert frames[:3] == ["panda_hand_tcp", "panda_leftfinger", "panda_rightfinger"]
    assert set(frames) == {link for link in panda.description.links if link != "panda_link0"}
    assert len(frames) == len(set(frames))
    assert set(frames) <= set(panda.frame_names)
    assert "panda_link0" in robot_message(load_quietly("panda", root="free_flyer"), 1)["frames"]
    assert robot_message(pinik.load(robot(link("alone"))), 1)["frames"] == ["alone"]


def test_warnings_of_loading_are_passed_on():
    urdf = robot(link("a"), link("b"), joint("j", "a", "b", by_hand.mimic("nobody")))
    with pytest.warns(pinik.UrdfWarning):
        model = pinik.load(urdf)
    assert robot_message(model, 1)["warnings"] == list(model.warnings) != []


def test_a_joint_tells_its_leader_and_its_range_which_keeps_its_followers_inside_theirs():
    found = {each["name"]: each for each in robot_message(load_quietly("panda", root="free_flyer"), 1)["joints"]}
    assert found["panda_finger_joint2"]["leader"] == "panda_finger_joint1"
    assert found["panda_finger_joint2"]["range"] == [0.0, 0.04]
    assert (found["panda_joint4"]["leader"], found["panda_joint4"]["range"]) == (None, [-3.0718, -0.0698])
    assert found["root_joint"]["range"] is None
    turning = {each["name"]: each for each in robot_message(load_quietly(by_hand.ZOO), 1)["joints"]}
    assert turning["k_turn"]["range"] is None
    assert {follower: turning[follower]["leader"] for follower in load_quietly(by_hand.ZOO).mimics} == {
        follower: leader for follower, (leader, _, _) in load_quietly(by_hand.ZOO).mimics.items()
    }
