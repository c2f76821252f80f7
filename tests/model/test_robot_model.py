from __future__ import annotations

import io
import math
import pickle
import re
import shutil
import warnings
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pinocchio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pinik
from by_hand import (
    ZOO,
    axis,
    chains,
    homogeneous,
    joint_axes,
    limit,
    link_placements,
    mimic,
    origin,
    random_placement,
    rotation_from_rpy,
    two_hinges,
)
from pinik import InputError, RobotLoadError, UnknownNameError, UrdfWarning
from pinik.description.catalog import find
from robots import load_quietly
from urdf_texts import joint, link, robot

CATALOG = [name for name in pinik.catalog() if name != "ur3_empty"]
ROOTS = ("fixed", "free_flyer", "planar")


def random_angles(robot: pinik.Robot, rng: np.random.Generator) -> dict[str, float]:
    """An angle for each settable joint, drawn without the robot's help; within ±2π, though some allow more."""
    box = 2 * math.pi
    ends = zip(robot.joint_names, robot.lower, robot.upper, strict=True)
    return {name: rng.uniform(max(low, -box), min(high, box)) for name, low, high in ends}


def read_mimics(path: Path) -> dict[str, tuple[str, float, float]]:
    """follower → (leader, multiplier, offset) of the joints that move, straight from the file."""
    found = {}
    for tag in ElementTree.parse(path).getroot().findall("joint"):
        follows = tag.find("mimic")
        if follows is not None and tag.get("type") != "fixed":
            numbers = float(follows.get("multiplier", "1")), float(follows.get("offset", "0"))
            found[tag.get("name", "")] = (follows.get("joint", ""), *numbers)
    return found


def yourdfpy_links(path: Path, free: set[str], angles: Mapping[str, float]) -> dict[str, np.ndarray]:
    """Link → 4×4 by yourdfpy; the mimics of the joints in `free` are taken off first."""
    import yourdfpy

    tree = ElementTree.parse(path)
    for tag in tree.getroot().findall("joint"):
        follows = tag.find("mimic")
        if follows is not None and (tag.get("name") in free or tag.get("type") == "fixed"):
            tag.remove(follows)
    text = io.BytesIO(ElementTree.tostring(tree.getroot()))
    oracle = yourdfpy.URDF.load(text, load_meshes=False, build_scene_graph=True)
    oracle.update_cfg(dict(angles))
    return {name: oracle.get_transform(name) for name in oracle.link_map}


class TestPlacementsOfTheCatalogue:
    @pytest.mark.parametrize("name", CATALOG)
    def test_every_link_is_where_yourdfpy_puts_it(self, name):
        robot = load_quietly(name)
        rng = np.random.default_rng(1)
        angles = random_angles(robot, rng)
        q = robot.configuration(angles)
        said = read_mimics(robot.description.path)
        free = {name for name, (leader, _, _) in said.items() if leader not in robot.model.names}
        expected = yourdfpy_links(robot.description.path, free, angles)
        assert set(expected) <= set(robot.frame_names)
        for frame, placement in expected.items():
            np.testing.assert_allclose(robot.placement(frame, q).homogeneous, placement, atol=1e-9, rtol=0)

    @pytest.mark.parametrize("name", ["baxter", "panda", "pr2", "romeo", "talos_full", "tiago_pro"])
    def test_followers_follow_as_the_file_says(self, name):
        robot = load_quietly(name)
        assert robot.mimics == read_mimics(robot.description.path)
        assert not robot.mimics.keys() & set(robot.joint_names)

    def test_with_mimic_false_every_follower_is_free(self):
        robot = load_quietly("panda", mimic=False)
        assert robot.mimics == {}
        assert {"panda_finger_joint1", "panda_finger_joint2"} <= set(robot.joint_names)
        angles = {"panda_finger_joint1": 0.01, "panda_finger_joint2": 0.03, "panda_joint4": -1.0}
        q = robot.configuration(angles)
        for frame, placement in yourdfpy_links(robot.description.path, {"panda_finger_joint2"}, angles).items():
            np.testing.assert_allclose(robot.placement(frame, q).homogeneous, placement, atol=1e-9)

    @pytest.mark.parametrize("root", ["free_flyer", "planar"])
    @pytest.mark.parametrize("name", ["lion", "panda", "tiago"])
    def test_a_free_root_carries_everything_with_it(self, name, root):
        robot = load_quietly(name, root=root)
        rng = np.random.default_rng(2)
        angles = random_angles(robot, rng)
        where = random_placement(rng, "floating" if root == "free_flyer" else "planar")
        q = robot.configuration(angles, {"root_joint": where})
        for frame, placement in yourdfpy_links(robot.description.path, set(), angles).items():
            np.testing.assert_allclose(robot.placement(frame, q).homogeneous, where @ placement, atol=1e-9, rtol=0)


class TestPlacementsByHand:
    @pytest.mark.parametrize("root", ROOTS)
    def test_of_every_kind_of_joint_under_every_root(self, root):
        robot = load_quietly(ZOO, root=root)
        assert not robot.warnings
        rng = np.random.default_rng(3)
        for _ in range(5):
            angles = random_angles(robot, rng)
            turns = angles["k_turn"]
            angles["k_turn"] = math.atan2(math.sin(turns), math.cos(turns))  # its follower takes a half of it
            places = {"drift": random_placement(rng), "s_plane": random_placement(rng, "planar")}
            base = np.eye(4)
            if root != "fixed":
                base = random_placement(rng, "floating" if root == "free_flyer" else "planar")
            given_places = places | ({} if root == "fixed" else {"root_joint": base})
            q = robot.configuration(angles, given_places)
            for frame, placement in link_placements(ZOO, angles, places, base).items():
                np.testing.assert_allclose(robot.placement(frame, q).homogeneous, placement, atol=1e-12, rtol=0)

    @given(text=chains(("revolute", "continuous", "prismatic", "fixed", "floating", "planar")), seed=st.integers(0, 9))
    @settings(max_examples=60)
    def test_of_any_chain(self, text, seed):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UrdfWarning)
            robot = pinik.load(text)
        rng = np.random.default_rng(seed)
        angles = {name: rng.uniform(-3, 3) for name in robot.joint_names}
        axes = joint_axes(text)
        places = {j.name: random_placement(rng, j.kind, axes[j.name]) for j in robot.joints if not j.has_one_axis}
        q = robot.configuration(angles, places)
        assert not any("free" in words for words in robot.warnings)
        for frame, placement in link_placements(text, angles, places).items():
            np.testing.assert_allclose(robot.placement(frame, q).homogeneous, placement, atol=1e-9, rtol=0)

    def test_a_mimic_of_a_mimic_follows_their_common_leader(self):
        text = robot(
            *(link(name) for name in "abcd"),
            joint("j1", "a", "b", axis(0, 0, 1)),
            joint("j2", "b", "c", origin((1, 0, 0)), axis(0, 1, 0), mimic("j1", -2.0, 0.25)),
            joint("j3", "c", "d", origin((0, 1, 0)), axis(1, 0, 0), mimic("j2", 0.5, -1.0)),
        )
        loaded = load_quietly(text)
        angles = {"j1": 0.6}
        q = loaded.configuration(angles)
        assert loaded.angles(q) == pytest.approx({"j1": 0.6, "j2": -0.95, "j3": -1.475})
        np.testing.assert_allclose(loaded.placement("d", q).homogeneous, link_placements(text, angles)["d"], atol=1e-12)

    @pytest.mark.parametrize("reference", ["tip", "hand", "body", "base"])
    def test_relative_to_another_frame_is_the_one_seen_from_the_other(self, reference):
        robot = load_quietly(ZOO, root="free_flyer")
        rng = np.random.default_rng(4)
        angles = {"k_turn": 1.0, "l_hinge": -0.7, "m_slide": 0.3}
        places = {"drift": random_placement(rng), "s_plane": random_placement(rng, "planar")}
        base = random_placement(rng)
        q = robot.configuration(angles, places | {"root_joint": base})
        links = link_placements(ZOO, angles, places, base)
        for frame in ("tip", "hand", "d"):
            np.testing.assert_allclose(
                robot.placement(frame, q, relative_to=reference).homogeneous,
                np.linalg.inv(links[reference]) @ links[frame],
                atol=1e-12,
            )

    def test_the_answer_is_a_copy_that_the_next_question_leaves_alone(self, arm):
        first = arm.placement("tip", arm.neutral())
        kept = first.copy()
        arm.placement("tip", arm.poses["reach"])
        assert first == kept

    def test_threads_that_share_a_robot_get_their_own_answers(self, lion):
        rng = np.random.default_rng(5)
        configurations = [lion.random(rng) for _ in range(300)]
        alone = [lion.placement("nose", q, "tail_tip").homogeneous for q in configurations]
        columns = [lion.jacobian("nose", q) for q in configurations]
        with ThreadPoolExecutor(8) as pool:
            together = list(pool.map(lambda q: lion.placement("nose", q, "tail_tip").homogeneous, configurations))
            together_columns = list(pool.map(lambda q: lion.jacobian("nose", q), configurations))
        np.testing.assert_array_equal(together, alone)
        np.testing.assert_array_equal(together_columns, columns)

    def test_each_thread_works_on_data_of_its_own(self, arm):
        own = arm.data
        with ThreadPoolExecutor(1) as pool:
            other = pool.submit(lambda: arm.data).result()
        assert other is not own
        assert arm.data is own


class TestAngles:
    @pytest.mark.parametrize("name", ["arm", "lion", "panda", "kinova", "pr2", "tiago", "talos_full"])
    def test_go_into_a_configuration_and_come_out_again(self, name):
        robot = load_quietly(name)
        angles = random_angles(robot, np.random.default_rng(6))
        read = robot.angles(robot.configuration(angles))
        for joint_ in robot.joints:
            if joint_.leader is not None:
                expected = joint_.multiplier * angles[joint_.leader] + joint_.offset
            elif joint_.kind == "continuous":
                expected = math.remainder(angles[joint_.name], 2 * math.pi)
            else:
                expected = angles[joint_.name]
            assert read.pop(joint_.name) == pytest.approx(expected, abs=1e-12)
        assert not read

    def test_a_configuration_comes_back_from_its_angles_and_joint_placements(self):
        for root in ROOTS:
            robot = load_quietly(ZOO, root=root)
            for seed in range(5):
                q = robot.random(seed)
                settable = {n: a for n, a in robot.angles(q).items() if n in robot.joint_names}
                again = robot.configuration(settable, robot.joint_placements(q))
                for i, joint_ in enumerate(robot.joints):  # a quaternion and its negative are one rotation
                    part = slice(joint_.idx_q, joint_.idx_q + joint_.nq)
                    if joint_.kind == "floating" and q[part][3:] @ again[part][3:] < 0:
                        again[part][3:] *= -1
                    np.testing.assert_allclose(again[part], q[part], atol=1e-12, err_msg=str(i))

    def test_a_continuous_joint_is_a_cosine_and_a_sine_in_q(self, kinova):
        q = kinova.configuration({"j2s6s200_joint_1": 2.0})
        first = kinova.joint("j2s6s200_joint_1")
        assert (first.kind, first.nq, first.nv) == ("continuous", 2, 1)
        assert q[first.idx_q : first.idx_q + 2] == pytest.approx([math.cos(2.0), math.sin(2.0)])
        assert kinova.angles(kinova.configuration({"j2s6s200_joint_1": math.pi}))["j2s6s200_joint_1"] == pytest.approx(
            math.pi
        )

    def test_the_rest_is_neutral(self, panda):
        q = panda.configuration({"panda_joint2": 0.5})
        angles = panda.angles(q)
        assert angles.pop("panda_joint2") == 0.5
        assert set(angles.values()) == {0.0}
        np.testing.assert_array_equal(panda.configuration(), panda.neutral())

    def test_a_follower_is_not_locked_and_the_error_names_its_leader(self, panda):
        with pytest.raises(
            InputError, match=r"'panda_finger_joint2' mimics 'panda_finger_joint1'.*set 'panda_finger_joint1' instead"
        ):
            panda.settable_joint("panda_finger_joint2")

    def test_an_unknown_joint_is_refused_with_near_names(self, panda):
        with pytest.raises(UnknownNameError, match=r"no joint 'panda_jont4'; did you mean .*'panda_joint4'") as caught:
            panda.configuration({"panda_jont4": 0.0})
        assert (caught.value.kind, caught.value.name) == ("joint", "panda_jont4")
        assert "panda_joint4" in caught.value.valid

    def test_a_fixed_joint_is_refused_as_fixed(self, two_link):
        with pytest.raises(UnknownNameError, match="it is a fixed joint"):
            two_link.configuration({"tip_fixed": 0.0})

    @pytest.mark.parametrize("bad", [math.nan, math.inf, "0.3", None, [0.1], True, 10**400])
    def test_an_angle_is_a_finite_number(self, arm, bad):
        with pytest.raises(InputError, match=r"the angle of joint 'bone1_x' .*finite number"):
            arm.configuration({"bone1_x": bad})

    def test_angles_and_placements_are_not_confused(self):
        robot = load_quietly(ZOO, root="planar")
        for name in ("drift", "s_plane", "root_joint"):
            with pytest.raises(InputError, match="give its SE3 in joint_placements"):
                robot.configuration({name: 0.1})
        with pytest.raises(InputError, match="joint 'l_hinge' is revolute; give its angle in angles"):
            robot.configuration(joint_placements={"l_hinge": np.eye(4)})
        with pytest.raises(UnknownNameError, match="no joint 'root'"):
            robot.configuration(joint_placements={"root": np.eye(4)})


class TestJointPlacements:
    def test_go_into_a_configuration_and_come_out_again(self):
        robot = load_quietly(ZOO, root="free_flyer")
        rng = np.random.default_rng(7)
        places = {
            "root_joint": random_placement(rng),
            "drift": random_placement(rng),
            "s_plane": random_placement(rng, "planar"),
        }
        q = robot.configuration({}, {name: pinocchio.SE3(M) for name, M in places.items()})
        read = robot.joint_placements(q)
        assert set(read) == set(places)
        for name, placement in places.items():
            np.testing.assert_allclose(read[name].homogeneous, placement, atol=1e-12)

    def test_are_xyz_and_quaternion_xyzw_in_q(self):
        robot = load_quietly("arm", root="free_flyer")
        half = math.sqrt(0.5)
        q = robot.configuration({}, {"root_joint": homogeneous(rotation_from_rpy(0, 0, math.pi / 2), (1, 2, 3))})
        assert q[:7] == pytest.approx([1, 2, 3, 0, 0, half, half])

    def test_of_a_fixed_robot_are_none(self, arm):
        assert arm.joint_placements(arm.neutral()) == {}

    @pytest.mark.parametrize(
        "placement",
        [
            homogeneous(np.eye(3), (0, 0, 0.1)),
            homogeneous(rotation_from_rpy(0.1, 0, 0), (0, 0, 0)),
            homogeneous(rotation_from_rpy(math.pi, 0, 0), (0, 0, 0)),
        ],
    )
    def test_of_a_planar_joint_lie_in_its_plane(self, placement):
        robot = load_quietly("arm", root="planar")
        with pytest.raises(InputError, match="planar joint 'root_joint' moves only in its x-y plane"):
            robot.configuration(joint_placements={"root_joint": placement})

    @pytest.mark.parametrize(
        ("bad", "words"),
        [
            (np.eye(3), "4×4 finite numbers"),
            (np.diag([1.0, 1, -1, 1]), "rotation matrix"),
            (np.diag([1.0, 1, 1, 2]), "last row"),
            (np.diag([2.0, 1, 1, 1]), "rotation matrix"),
            (np.full((4, 4), math.nan), "finite"),
            ("here", "finite numbers"),
        ],
    )
    def test_that_are_none_are_refused(self, bad, words):
        robot = load_quietly("arm", root="free_flyer")
        with pytest.raises(InputError, match=words):
            robot.configuration(joint_placements={"root_joint": bad})


class TestConfigurations:
    @pytest.mark.parametrize("shape", [(), (11,), (13,), (12, 1), (1, 12)])
    def test_of_the_wrong_shape_are_refused(self, arm, shape):
        with pytest.raises(InputError, match=r"q .*12 finite numbers \(the configuration of 'arm'\)"):
            arm.placement("tip", np.zeros(shape))

    @pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
    def test_that_are_not_finite_are_refused(self, arm, bad):
        q = arm.neutral()
        q[3] = bad
        for ask in (arm.angles, lambda q: arm.placement("tip", q), lambda q: arm.jacobian("tip", q)):
            with pytest.raises(InputError, match="finite"):
                ask(q)

    @pytest.mark.parametrize("bad", ["straight", None, {"bone1_x": 0.3}, ["0"] * 12])
    def test_that_are_no_numbers_are_refused(self, arm, bad):
        with pytest.raises(InputError, match=r"q .*12 finite numbers"):
            arm.angles(bad)

    @pytest.mark.parametrize(
        ("entry", "joint_name", "words"),
        [(7, "k_turn", "(cos, sin)"), (3, "drift", "the quaternion xyzw"), (13, "s_plane", "(cos, sin)")],
    )
    def test_whose_circles_are_not_of_unit_length_are_refused(self, entry, joint_name, words):
        robot = load_quietly(ZOO)
        q = robot.random(8)
        q[entry] += 3.0
        with pytest.raises(InputError, match=f"{re.escape(words)} of .* joint {joint_name!r} must be of unit length"):
            robot.placement("tip", q)

    def test_that_are_a_little_off_unit_length_are_scaled_in_a_copy(self, kinova):
        q = kinova.random(9)
        off = q.copy()
        first = kinova.joint("j2s6s200_joint_1").idx_q
        off[first : first + 2] *= 1.0001
        before = off.copy()
        assert kinova.placement("j2s6s200_end_effector", off).isApprox(
            kinova.placement("j2s6s200_end_effector", q), 1e-12
        )
        np.testing.assert_array_equal(off, before)

    def test_may_be_lists(self, two_link):
        tip = two_link.placement("tip", [math.pi / 2, 0]).translation
        assert tip == pytest.approx([0.0, 0.9, 0.0], abs=1e-12)


class TestLimits:
    def test_are_those_of_the_file(self, panda):
        file = ElementTree.parse(panda.description.path).getroot()
        for name, low, high in zip(panda.joint_names, panda.lower, panda.upper, strict=True):
            said = file.find(f"joint[@name='{name}']/limit").attrib
            assert (low, high) == (float(said["lower"]), float(said["upper"]))

    def test_of_a_continuous_joint_are_infinite(self, kinova):
        continuous = [kinova.joint_names.index(j.name) for j in kinova.joints if j.kind == "continuous"]
        assert len(continuous) == 3
        assert (kinova.lower[continuous] == -math.inf).all()
        assert (kinova.upper[continuous] == math.inf).all()

    @pytest.mark.parametrize(
        ("words", "bounds", "expected"),
        [
            (mimic("lead", 2.0), (-1.0, 1.2), (-0.5, 0.6)),
            (mimic("lead", -2.0), (-1.0, 1.2), (-0.6, 0.5)),
            (mimic("lead", -1.0, 0.5), (-1.0, 1.2), (-0.7, 1.5)),
            (mimic("lead", 0.1), (-3.0, 3.0), (-2.0, 2.0)),
            (mimic("lead", 0.0, 0.3), (0.2, 0.4), (-2.0, 2.0)),
        ],
    )
    def test_of_a_leader_are_cut_where_its_follower_would_leave_its_own(self, words, bounds, expected):
        text = robot(
            *(link(name) for name in "abc"),
            joint("lead", "a", "b", limit=limit(-2, 2)),
            joint("tail", "b", "c", words, limit=limit(*bounds)),
        )
        loaded = load_quietly(text)
        assert (loaded.lower[0], loaded.upper[0]) == pytest.approx(expected)
        for seed in range(20):
            angle = loaded.angles(loaded.random(seed))["tail"]
            assert bounds[0] - 1e-12 <= angle <= bounds[1] + 1e-12

    def test_that_are_absent_are_zero_with_a_warning(self):
        text = robot(
            *(link(name) for name in "abc"),
            joint("j1", "a", "b", limit='<limit upper="1.5" effort="1" velocity="1"/>'),
            joint("j2", "b", "c", limit='<limit effort="1" velocity="1"/>'),
        )
        with pytest.warns(UrdfWarning) as caught:
            loaded = pinik.load(text)
        assert any("'j1'" in str(w.message) and "no lower" in str(w.message) for w in caught)
        assert any("'j2'" in str(w.message) and "0..0" in str(w.message) for w in caught)
        assert loaded.lower.tolist() == [0.0, 0.0]
        assert loaded.upper.tolist() == [1.5, 0.0]

    def test_of_a_follower_bind_a_continuous_leader_too(self):
        """As (cos, sin) the leader could keep no limits: where others mimic it, q holds its angle."""
        text = robot(
            *map(link, ("base", "wheel", "pointer")),
            joint("turn", "base", "wheel", axis(0, 0, 1), kind="continuous", limit=""),
            joint("z_follow", "base", "pointer", axis(0, 0, 1), mimic("turn", -0.25, 0.1), limit=limit(-0.5, 0.5)),
        )
        loaded = load_quietly(text)
        assert (loaded.lower[0], loaded.upper[0]) == pytest.approx((-1.6, 2.4))
        assert (loaded.lower_q[0], loaded.upper_q[0]) == pytest.approx((-1.6, 2.4))
        solved = loaded.solve("pointer", rpy=[0, 0, 1.5])
        assert not solved.success
        assert solved.angles == pytest.approx({"turn": -1.6, "z_follow": 0.5})
        turned = loaded.configuration({"turn": 2.0 + 2 * math.pi})
        assert loaded.angles(turned)["z_follow"] == pytest.approx(0.1 - 0.25 * (2.0 + 2 * math.pi))
        direction = loaded.placement("pointer", turned).rotation[:, 0]
        follow = loaded.angles(turned)["z_follow"]
        np.testing.assert_allclose(direction, [math.cos(follow), math.sin(follow), 0.0], atol=1e-12)

    def test_stand_in_q_as_well(self):
        loaded = load_quietly(ZOO)
        for q in (loaded.lower_q, loaded.upper_q):
            assert q.shape == (loaded.model.nq,)
        hinge, turn = loaded.joint("l_hinge"), loaded.joint("k_turn")
        assert (loaded.lower_q[hinge.idx_q], loaded.upper_q[hinge.idx_q]) == (-2.0, 1.5)
        assert np.isinf(loaded.lower_q[turn.idx_q : turn.idx_q + 2]).all()
        assert np.isfinite(loaded.lower_q).sum() == 2


class TestRandom:
    @pytest.mark.parametrize("name", ["arm", "lion", "panda", "tiago", "quadruped", "iris"])
    def test_keeps_inside_the_limits(self, name):
        robot = load_quietly(name)
        rng = np.random.default_rng(10)
        for _ in range(50):
            angles = robot.angles(robot.random(rng))
            values = np.array([angles[joint_name] for joint_name in robot.joint_names])
            bounded = np.isfinite(robot.lower)
            assert (values[bounded] >= robot.lower[bounded]).all()
            assert (values[bounded] <= robot.upper[bounded]).all()

    @pytest.mark.parametrize(
        ("kind", "limits", "drawn_from"),
        [
            ("revolute", (-3.0, 9.0), (-3.0, 9.0)),
            ("revolute", (-1e16, 1e16), (-math.pi, math.pi)),
            ("revolute", (1.0, 1e16), (1.0, 1.0 + 2 * math.pi)),
            ("revolute", (-1e16, 1.0), (1.0 - 2 * math.pi, 1.0)),
            ("prismatic", (-1e16, 1e16), (-1.0, 1.0)),
            ("prismatic", (0.0, 1e16), (0.0, 2.0)),
            ("continuous", (-math.inf, math.inf), (-math.pi, math.pi)),
        ],
    )
    def test_takes_limits_that_no_one_reaches_for_none(self, kind, limits, drawn_from):
        bounds = "" if kind == "continuous" else limit(*limits)
        loaded = load_quietly(robot(link("a"), link("b"), joint("j", "a", "b", kind=kind, limit=bounds)))
        rng = np.random.default_rng(14)
        values = np.array([loaded.angles(loaded.random(rng))["j"] for _ in range(500)])
        low, high = drawn_from
        assert ((values >= low) & (values <= high)).all()
        assert values.min() < low + 0.1 * (high - low)
        assert values.max() > high - 0.1 * (high - low)

    def test_fills_the_limits(self, panda):
        rng = np.random.default_rng(11)
        fractions = []
        for _ in range(2000):
            angles = panda.angles(panda.random(rng))
            values = np.array([angles[name] for name in panda.joint_names])
            fractions.append((values - panda.lower) / (panda.upper - panda.lower))
        np.testing.assert_allclose(np.quantile(fractions, [0.1, 0.5, 0.9], axis=0).T, [[0.1, 0.5, 0.9]] * 8, atol=0.05)

    def test_is_the_same_for_the_same_seed_and_another_for_another(self):
        robot = load_quietly(ZOO, root="free_flyer")
        np.testing.assert_array_equal(robot.random(3), robot.random(np.random.default_rng(3)))
        assert not np.allclose(robot.random(3), robot.random(4))

    @pytest.mark.parametrize("root", ROOTS)
    def test_is_a_configuration_with_every_part_drawn(self, root):
        robot = load_quietly(ZOO, root=root)
        first, second = robot.random(1), robot.random(2)
        assert (np.abs(first - second) > 1e-6).all()
        for q in (first, second):
            np.testing.assert_allclose(pinocchio.normalize(robot.model, q), q, atol=1e-12)
            np.testing.assert_allclose(robot.check_configuration(q), q, atol=1e-12)

    def test_orientations_are_uniform(self):
        robot = load_quietly("two_link", root="free_flyer")
        rng = np.random.default_rng(12)
        rotations = np.array([robot.joint_placements(robot.random(rng))["root_joint"].rotation for _ in range(2000)])
        np.testing.assert_allclose(rotations.mean(axis=0), 0.0, atol=0.05)
        # of a uniform rotation by θ: the mean of cos θ is −1/2
        assert ((np.trace(rotations, axis1=1, axis2=2) - 1) / 2).mean() == pytest.approx(-0.5, abs=0.05)


class TestNames:
    def test_of_an_unknown_frame_brings_near_ones(self, lion):
        with pytest.raises(UnknownNameError, match=r"no frame 'left_paw'; did you mean .*'left_fore_paw'") as caught:
            lion.placement("left_paw", lion.neutral())
        assert caught.value.kind == "frame"
        assert isinstance(caught.value, KeyError)
        with pytest.raises(UnknownNameError, match="no frame 'nos'; did you mean 'nose'"):
            lion.placement("tail_tip", lion.neutral(), relative_to="nos")
        with pytest.raises(UnknownNameError, match="no frame 'noose'; did you mean 'nose'"):
            lion.jacobian("noose", lion.neutral())

    @pytest.mark.parametrize("strange", ["", "\n", "tip ", "TIP", 3, None, ("tip",), ["tip"], {}])
    def test_that_are_none_are_unknown_in_words(self, arm, strange):
        with pytest.raises(UnknownNameError, match="no frame"):
            arm.placement(strange, arm.neutral())
        with pytest.raises(UnknownNameError, match="no joint"):
            arm.joint(strange)

    @pytest.mark.parametrize("name", ["anymal_c", "b1_z1", "so100", "z1"])
    def test_that_a_joint_and_a_link_share_mean_the_link(self, name):
        robot = load_quietly(name)
        shared = set(robot.description.links) & {tag.name for tag in robot.description.joints}
        assert shared
        angles = random_angles(robot, np.random.default_rng(13))
        q = robot.configuration(angles)
        links = yourdfpy_links(robot.description.path, set(), angles)
        for frame in shared:
            assert robot.model.frames[robot.frame_id(frame)].type == pinocchio.BODY
            np.testing.assert_allclose(robot.placement(frame, q).homogeneous, links[frame], atol=1e-9)
            assert np.isfinite(robot.jacobian(frame, q)).all()

    def test_a_link_wins_over_a_joint_elsewhere_of_the_same_name(self):
        text = robot(
            link("a"), link("b"), link("c"),
            joint("c", "a", "b", origin((1, 0, 0))),
            joint("j", "b", "c", origin((1, 0, 0))),
        )  # fmt: skip
        loaded = load_quietly(text)
        assert loaded.placement("c", loaded.neutral()).translation == pytest.approx([2, 0, 0])
        assert loaded.joint("c").name == "c"
        assert loaded.frame_names.count("c") == 1

    def test_every_frame_has_a_placement(self):
        for name in ("lion", "tiago_pro"):
            robot = load_quietly(name, root="free_flyer")
            assert len(set(robot.frame_names)) == len(robot.frame_names)
            for frame in robot.frame_names:
                assert np.isfinite(robot.placement(frame, robot.neutral()).homogeneous).all()

    def test_joint_names_are_those_that_can_be_set_in_the_models_order(self, panda):
        assert panda.joint_names == (*(f"panda_joint{i}" for i in range(1, 8)), "panda_finger_joint1")
        assert len(panda.lower) == len(panda.upper) == len(panda.joint_names)


class TestPoses:
    @pytest.mark.parametrize(
        ("name", "srdf"),
        [
            ("arm", "arm.srdf"), ("lion", "lion.srdf"), ("two_link", "two_link.srdf"), ("panda", "panda.srdf"),
            ("kinova", "kinova.srdf"), ("pr2", "pr2.srdf"),
        ],
    )  # fmt: skip
    @pytest.mark.parametrize("root", ["fixed", "planar"])
    def test_are_the_angles_of_the_srdf(self, name, srdf, root):
        robot = load_quietly(name, root=root)
        path = next(robot.description.path.parents[1].rglob(srdf))
        states = ElementTree.parse(path).getroot().findall("group_state")
        assert set(robot.poses) == {state.get("name") for state in states}
        for state in states:
            angles = robot.angles(robot.poses[state.get("name")])
            said = {tag.get("name"): float(tag.get("value")) for tag in state.findall("joint")}
            for joint_name, angle in said.items():
                if joint_name in robot.joint_names:
                    difference = math.remainder(angles[joint_name] - angle, 2 * math.pi)
                    assert difference == pytest.approx(0.0, abs=1e-9)
            assert all(angles[n] == 0.0 for n in robot.joint_names if n not in said)

    def test_put_a_free_root_where_the_srdf_says(self):
        robot = load_quietly("talos", root="free_flyer")
        root = robot.joint_placements(robot.poses["half_sitting"])["root_joint"]
        assert root.translation == pytest.approx([0, 0, 1.01927])

    def test_of_pinik_s_own_robots_are_relaxed_and_reach_inside_the_limits(self):
        for name in ("arm", "lion", "two_link"):
            robot = load_quietly(name)
            assert {"relaxed", "reach"} <= set(robot.poses)
            for q in robot.poses.values():
                assert (q >= robot.lower_q).all()
                assert (q <= robot.upper_q).all()

    def test_cannot_be_spoiled(self, arm):
        poses = arm.poses
        with pytest.raises(ValueError, match="read-only"):
            poses["reach"][0] = 1.0
        with pytest.raises(TypeError):
            poses["reach"] = arm.neutral()
        with pytest.raises(UnknownNameError, match="no pose 'reech'; did you mean 'reach'"):
            poses["reech"]

    @pytest.mark.parametrize(("name", "root"), [("romeo", "fixed"), ("romeo", "free_flyer"), ("panda", "planar")])
    def test_are_those_that_pinocchio_reads_without_its_words(self, name, root, capfd):
        robot = pickle.loads(pickle.dumps(load_quietly(name, root=root)))
        capfd.readouterr()
        poses = robot.poses
        assert capfd.readouterr() == ("", "")
        model = pinocchio.Model(robot.model)
        pinocchio.loadReferenceConfigurations(model, str(find(name).srdf), False)
        expected = {entry.key(): pinocchio.normalize(model, entry.data()) for entry in model.referenceConfigurations}
        assert set(poses) == set(expected)
        assert all(np.array_equal(poses[pose], expected[pose]) for pose in expected)

    def test_without_an_srdf_are_none(self):
        assert load_quietly(ZOO).poses == {}

    def test_come_from_the_srdf_beside_a_file(self, tmp_path, arm):
        for suffix in (".urdf", ".srdf"):
            shutil.copy(arm.description.path.with_suffix(suffix), tmp_path / f"mine{suffix}")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UrdfWarning)
            mine = pinik.load(tmp_path / "mine.urdf")
        np.testing.assert_array_equal(mine.poses["reach"], arm.poses["reach"])

    def test_of_a_faulty_srdf_are_an_error_that_names_the_file(self, tmp_path):
        (tmp_path / "mine.urdf").write_text(two_hinges(0.5, 0.4))
        (tmp_path / "mine.srdf").write_text("<robot><group_state name='x'>")
        mine = pinik.load(tmp_path / "mine.urdf")
        with pytest.raises(RobotLoadError, match=r"mine\.srdf"):
            mine.poses  # noqa: B018


class TestLoad:
    def test_by_path_and_text_gives_the_same_robot(self, tmp_path):
        text = two_hinges(0.5, 0.4)
        path = tmp_path / "mine.urdf"
        path.write_text(text)
        for source in (path, str(path), text, "\n  " + text, "\ufeff" + text):
            loaded = pinik.load(source)
            assert loaded.name == "r"
            assert loaded.joint_names == ("shoulder", "elbow")
            assert loaded.placement("tip", loaded.neutral()).translation == pytest.approx([0.9, 0, 0])

    def test_by_name_gives_the_file_of_the_catalogue(self, panda):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UrdfWarning)
            by_path = pinik.load(panda.description.path)
        assert by_path.model == panda.model
        assert by_path.name == panda.name == "panda"

    def test_finds_a_file_in_the_working_directory(self, tmp_path, monkeypatch):
        for name in ("mine.urdf", "no_suffix"):
            (tmp_path / name).write_text(two_hinges(0.5, 0.4))
        monkeypatch.chdir(tmp_path)
        assert pinik.load("mine.urdf").joint_names == pinik.load("no_suffix").joint_names

    def test_a_catalogue_name_means_the_robot_whatever_lies_in_the_working_directory(self, tmp_path, monkeypatch):
        (tmp_path / "two_link").mkdir()
        (tmp_path / "arm").write_text("not a robot")
        monkeypatch.chdir(tmp_path)
        assert pinik.load("two_link").name == "two_link"
        assert pinik.load("arm").name == "arm"

    def test_an_unknown_name_brings_near_ones(self):
        with pytest.raises(UnknownNameError, match="no robot 'pandas'; did you mean 'panda'"):
            pinik.load("pandas")
        with pytest.raises(UnknownNameError):
            pinik.load("")

    @pytest.mark.parametrize("bad", [None, 5, ["arm"]])
    def test_what_is_neither_name_nor_path_nor_text_is_refused(self, bad):
        with pytest.raises(InputError, match="a catalogue name, a path or URDF text"):
            pinik.load(bad)

    def test_an_unknown_root_is_refused_with_the_known_ones(self):
        with pytest.raises(InputError, match="root must be one of 'fixed', 'free_flyer', 'planar'; got 'floating'"):
            pinik.load("two_link", root="floating")

    def test_one_folder_is_no_list_of_package_dirs(self):
        with pytest.raises(InputError, match=r"package_dirs .*a list of folders"):
            pinik.load("two_link", package_dirs="/tmp")

    def test_without_its_meshes_warns_and_works(self):
        mesh = '<visual><geometry><mesh filename="package://nowhere/{}.stl"/></geometry></visual>'
        parts = [joint("j", "a", "b", origin((1, 0, 0)), axis(0, 0, 1))]
        with pytest.warns(UrdfWarning, match="r: mesh 'package://nowhere/a.stl': not found: no package 'nowhere'"):
            loaded = pinik.load(robot(link("a", mesh.format("a")), link("b"), *parts))
        assert loaded.placement("b", [0.0]).translation == pytest.approx([1, 0, 0])
        with pytest.warns(
            UrdfWarning,
            match=r"mesh 'package://nowhere/a.stl' \(line 1\), mesh 'package://nowhere/b.stl' \(line 1\): not found",
        ):
            pinik.load(robot(link("a", mesh.format("a")), link("b", mesh.format("b")), *parts))

    def test_finds_meshes_in_package_dirs(self, tmp_path):
        (tmp_path / "somewhere").mkdir()
        (tmp_path / "somewhere" / "a.stl").write_bytes(b"")
        mesh = '<visual><geometry><mesh filename="package://somewhere/a.stl"/></geometry></visual>'
        text = robot(link("a", mesh), link("b"), joint("j", "a", "b"))
        assert not pinik.load(text, package_dirs=[tmp_path]).warnings

    def test_every_warning_is_kept_on_the_robot(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            loaded = pinik.load("quadruped")
        (words,) = [str(w.message) for w in caught if issubclass(w.category, UrdfWarning)]
        assert words.startswith("quadruped: joint 'FL_KFE' (line 65), joint 'FR_KFE' (line ")
        assert words.endswith(": <limit> has no lower and no upper, which is read as 0: its range is 0..0")
        assert [flaw.element for flaw in loaded.warnings] == [f"joint '{leg}_KFE'" for leg in ("FL", "FR", "BL", "BR")]

    def test_needs_neither_yourdfpy_nor_trimesh(self):
        import subprocess
        import sys

        code = (
            "import sys, pinik; pinik.load('panda').placement('panda_hand', pinik.load('panda').neutral());"
            "sys.exit(any(name in sys.modules for name in ('yourdfpy', 'trimesh', 'meshcat', 'scipy')))"
        )
        assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

    @pytest.mark.parametrize(
        ("name", "options"), [("lion", {"root": "free_flyer"}), ("panda", {}), ("panda", {"mimic": False})]
    )
    def test_makes_a_robot_that_another_process_can_have(self, name, options):
        loaded = load_quietly(name, **options)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            copy = pickle.loads(pickle.dumps(loaded))
        assert copy.model == loaded.model
        assert (copy.name, copy.root, copy.mimics) == (loaded.name, loaded.root, loaded.mimics)
        assert copy.warnings == loaded.warnings
        assert set(copy.poses) == set(loaded.poses)
        q = loaded.random(15)
        for frame in loaded.frame_names[-3:]:
            assert copy.placement(frame, q) == loaded.placement(frame, q)

    def test_shows_itself_in_a_line(self, arm: Any):
        assert repr(arm) == f"<Robot 'arm': 12 joints, {len(arm.frame_names)} frames, fixed root>"
