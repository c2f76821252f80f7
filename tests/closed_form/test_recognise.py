"""Two hinges of a robot as two bones: recognised, or refused in words."""

from __future__ import annotations

import math

import numpy as np
import pytest

import pinik
from hinges import two_hinges
from pinik import TwoBone
from robots import load_quietly
from two_bone_cases import configurations, every_case, plain_position


class TestRecognition:
    @every_case
    def test_the_bones_have_the_lengths_of_the_file(self, case):
        bones = TwoBone.of(load_quietly(case.robot), case.frame, tool=case.tool)
        assert (bones.l1, bones.l2) == pytest.approx((case.l1, case.l2), abs=1e-15)

    @every_case
    def test_its_plane_holds_every_position_of_the_frame_at_the_distances_of_two_bones(self, case):
        robot = load_quietly(case.robot)
        bones = TwoBone.of(robot, case.frame, tool=case.tool)
        places = [plain_position(robot, case.frame, q, case.tool) for q in configurations(robot, 20, seed=2)]
        flat, beside = bones.in_plane(places)
        assert np.abs(beside).max() < 1e-15
        for q, point in zip(configurations(robot, 20, seed=2), flat, strict=True):
            found = pinik.two_bone(bones.l1, bones.l2, [point])
            wanted = [joint.angle(q) for joint in bones.joints]
            off = np.abs(np.exp(1j * bones.joint_angles(found.angles[0])) - np.exp(1j * np.array(wanted))).max(axis=1)
            assert off.min() < 1e-6

    def test_a_pair_inside_a_longer_chain_is_found_relative_to_the_link_before(self, ur5):
        point = (0.0, 0.05, 0.39)
        bones = TwoBone.of(ur5, "forearm_link", tool=point, relative_to="shoulder_link")
        assert [joint.name for joint in bones.joints] == ["shoulder_lift_joint", "elbow_joint"]
        for q in configurations(ur5, 10, seed=3):
            wanted = ur5.placement("forearm_link", q, relative_to="shoulder_link").act(np.array(point))
            found = bones.solve(wanted, q)
            assert found.reachable
            for answer in found.q:
                reached = ur5.placement("forearm_link", answer, relative_to="shoulder_link").act(np.array(point))
                assert np.linalg.norm(reached - wanted) < 1e-12
                assert (answer[[0, 3, 4, 5]] == q[[0, 3, 4, 5]]).all()

    def test_a_robot_that_floats_has_them_relative_to_its_base(self, two_link):
        floating = two_link.with_root("free_flyer")
        with pytest.raises(pinik.InputError, match=r"3 joints move it: 'root_joint' \(floating\)"):
            TwoBone.of(floating, "tip")
        q = floating.random(4)
        wanted = floating.placement("tip", q, relative_to="base").translation
        found = TwoBone.of(floating, "tip", relative_to="base").solve(wanted, q)
        assert found.errors.max() < 1e-12
        assert np.abs(found.q[:, :7] - q[:7]).max() < 1e-15
        for engine in ("auto", "python"):
            s = floating.solve("tip", wanted, relative_to="base", method="two_bone", q0=q, engine=engine)
            assert s.position_error < 1e-12

    @pytest.mark.parametrize(
        ("name", "frame", "relative_to", "words"),
        [
            ("panda", "panda_hand_tcp", None, r"7 joints move it: 'panda_joint1' \(revolute\)"),
            ("two_link", "base", None, "no joint moves it"),
            ("two_link", "tip", "link2", "no joint moves it relative to 'link2'"),
            ("two_link", "link1", None, "only one joint moves it: 'joint1'"),
            ("two_link", "link1", "tip", "'tip' is moved by joints that do not move 'link1'"),
            ("two_link", "link2", None, "it lies on the axis of joint 'joint2', which cannot move it; give a tool"),
            ("ur5", "upper_arm_link", None, "'shoulder_pan_joint' and 'shoulder_lift_joint' are 90° from parallel"),
        ],
    )
    def test_others_are_refused_with_the_joint_that_is_in_the_way(self, name, frame, relative_to, words):
        with pytest.raises(pinik.InputError, match=words):
            TwoBone.of(load_quietly(name), frame, relative_to=relative_to)

    def test_a_slide_a_follower_and_skew_axes_are_refused(self):
        with pytest.raises(pinik.InputError, match="joint 'elbow' mimics 'shoulder'"):
            TwoBone.of(two_hinges(extra='<mimic joint="shoulder"/>'), "hand")
        with pytest.raises(pinik.InputError, match="joint 'elbow' is prismatic"):
            TwoBone.of(two_hinges(second="prismatic"), "hand")
        with pytest.raises(pinik.InputError, match=r"'shoulder' and 'elbow' are 0\.573° from parallel"):
            TwoBone.of(two_hinges(second_axis=f"{math.sin(0.01)!r} 0 {math.cos(0.01)!r}"), "hand")
        with pytest.raises(pinik.InputError, match="'shoulder' and 'elbow' turn about the same line"):
            TwoBone.of(two_hinges(axis="1 0 0", second_axis="-1 0 0"), "hand", tool=(0.0, 0.2, 0.0))

    def test_an_unknown_frame_lists_the_near_ones(self, two_link):
        with pytest.raises(pinik.UnknownNameError, match="'tip'"):
            TwoBone.of(two_link, "tipp")
        with pytest.raises(pinik.InputError, match="robot must be a Robot"):
            TwoBone.of("two_link", "tip")
