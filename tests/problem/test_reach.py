from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pinik
from by_hand import axis, chains, limit, mimic, origin, two_hinges
from pinik import Target
from pinik.model.limits import Limits
from pinik.problem.problem import Problem
from pinik.problem.reach import Shortfall, bounds_of, shortfall
from robots import load_quietly
from urdf_texts import joint, link, robot

L1, L2 = 0.5, 0.4


def proof(robot: pinik.Robot, *targets: Target, limits: bool = True) -> Shortfall | None:
    return shortfall(targets, bounds_of(Problem(robot, targets), Limits.of(robot, limits)))


def attained(robot: pinik.Robot, frame: str, q: np.ndarray, relative_to: str | None = None) -> Target:
    return Target(frame, robot.placement(frame, q, relative_to).translation, relative_to=relative_to)


def corner(robot: pinik.Robot, rng: np.random.Generator) -> np.ndarray:
    """A configuration with every joint at a limit, or in the middle, or at zero."""
    angles = {}
    for name, low, high in zip(robot.joint_names, robot.lower, robot.upper, strict=True):
        low, high = max(low, -math.pi), min(high, math.pi)
        angles[name] = rng.choice([low, high, 0.5 * (low + high), min(max(0.0, low), high)])
    return robot.configuration(angles)


def climbed(robot: pinik.Robot, frame: str, away_from: np.ndarray, sign: float, rng: np.random.Generator) -> np.ndarray:
    """A configuration inside the limits that puts the frame far from a point, or (sign −1) near it."""

    def height(q: np.ndarray) -> float:
        return sign * float(np.linalg.norm(robot.placement(frame, q).translation - away_from))

    box = Limits.of(robot)
    q = max((robot.random(rng) for _ in range(10)), key=height)
    width = 1.0
    for _ in range(150):
        tried = pinocchio.integrate(robot.model, q, width * rng.normal(size=robot.model.nv))
        tried = box.clip(tried)
        if height(tried) > height(q):
            q = tried
        else:
            width = max(0.93 * width, 1e-6)
    return q


class TestNoProof:
    @pytest.mark.parametrize(
        ("name", "frame", "relative_to"),
        [
            ("arm", "tip", None),
            ("arm", "tip", "base"),
            ("arm", "tip", "bone2"),
            ("panda", "panda_hand_tcp", None),
            ("panda", "panda_leftfinger", "panda_link2"),
            ("panda", "panda_rightfinger", "panda_hand"),
            ("ur5", "tool0", None),
            ("z1", "link06", None),
            ("two_link", "tip", None),
            ("tiago", "arm_tool_link", None),
            ("kinova", "j2s6s200_end_effector", None),
            ("pr2", "l_gripper_r_finger_tip_link", None),
            ("lion", "nose", "chest"),
            ("lion", "left_fore_paw", "nose"),
        ],
    )
    @pytest.mark.parametrize("limited", [True, False], ids=["limits", "no limits"])
    def test_of_a_place_that_was_attained(self, name, frame, relative_to, limited):
        robot = load_quietly(name)
        rng = np.random.default_rng(1)
        for i in range(60):
            q = robot.random(rng) if i % 2 else corner(robot, rng)
            assert proof(robot, attained(robot, frame, q, relative_to), limits=limited) is None

    @given(text=chains(), seed=st.integers(0, 9))
    @settings(max_examples=60)
    def test_of_the_farthest_and_nearest_place_of_any_chain(self, text, seed):
        robot = load_quietly(text)
        rng = np.random.default_rng(seed)
        movers = [j for j in robot.joints if j.nq]
        first = robot.model.jointPlacements[1].translation if movers else np.zeros(3)
        for sign in (1.0, -1.0):
            q = climbed(robot, "tip", first, sign, rng)
            assert proof(robot, attained(robot, "tip", q)) is None
        for _ in range(5):
            assert proof(robot, attained(robot, "tip", corner(robot, rng))) is None

    @given(text=chains(), seed=st.integers(0, 9))
    @settings(max_examples=30)
    def test_of_a_tool_s_place_that_was_attained_relative_to_a_link_on_the_way(self, text, seed):
        robot = load_quietly(text)
        rng = np.random.default_rng(seed)
        tool = pinocchio.SE3(np.eye(3), rng.normal(size=3))
        for link_name in robot.description.links:
            q = corner(robot, rng)
            there = robot.placement("tip", q, link_name) * tool
            assert proof(robot, Target("tip", there.translation, tool=tool, relative_to=link_name)) is None

    def test_of_the_very_ends_of_the_reach(self):
        for l1, l2 in ((0.3, 0.3), (0.1, 0.7), (1 / 3, 1 / 7)):
            arm = load_quietly(two_hinges(l1, l2))
            for elbow in (0.0, math.pi, -math.pi):
                for shoulder in np.linspace(-3, 3, 50):
                    q = arm.configuration({"shoulder": shoulder, "elbow": elbow})
                    assert proof(arm, attained(arm, "tip", q)) is None

    @pytest.mark.parametrize("root", ["free_flyer", "planar"])
    def test_under_a_root_that_moves(self, root):
        robot = load_quietly("two_link", root=root)
        assert proof(robot, Target("tip", (1e6, 0, 0))) is None

    def test_through_a_joint_of_several_axes(self):
        text = robot(
            link("a"), link("b"), link("c"),
            joint("drift", "a", "b", kind="floating", limit=""), joint("j", "b", "c", origin((1, 0, 0))),
        )  # fmt: skip
        assert proof(load_quietly(text), Target("c", (1e6, 0, 0))) is None

    def test_of_an_orientation_alone(self, two_link):
        assert proof(two_link, Target("tip", axis="x", at=(1e6, 0, 0))) is None
        assert proof(two_link, Target("tip", rotation=np.diag([1.0, -1, -1]))) is None

    def test_relative_to_a_frame_on_another_branch(self, lion):
        assert proof(lion, Target("nose", (100, 0, 0), relative_to="tail_tip")) is None

    def test_when_no_joint_moves_the_frame(self, two_link):
        assert proof(two_link, Target("base", (100, 0, 0))) is None

    def test_along_a_slide_without_limits(self):
        text = robot(
            link("a"), link("b"), link("c"),
            joint("s", "a", "b", axis(1, 0, 0), kind="prismatic", limit=limit(-0.2, 0.3)),
            joint("j", "b", "c", origin((1, 0, 0)), axis(0, 0, 1)),
        )  # fmt: skip
        loaded = load_quietly(text)
        assert proof(loaded, Target("c", (100, 0, 0)), limits=False) is None
        assert proof(loaded, Target("c", (100, 0, 0)), limits=True) is not None


class TestProof:
    def test_says_how_far_outside_the_reach_a_target_lies(self, two_link):
        for turn in np.linspace(-3, 3, 7):
            direction = np.array([math.cos(turn), math.sin(turn), 0.0])
            found = proof(two_link, Target("tip", (L1 + L2 + 1e-3) * direction))
            assert found == pytest.approx((0, 1e-3, L1 + L2, False), abs=1e-12)
            assert proof(two_link, Target("tip", (L1 + L2 - 1e-9) * direction)) is None

    def test_says_how_far_inside_the_hole_a_target_lies(self, two_link):
        for turn in np.linspace(-3, 3, 7):
            direction = np.array([math.cos(turn), math.sin(turn), 0.0])
            found = proof(two_link, Target("tip", (L1 - L2 - 1e-3) * direction))
            assert found == pytest.approx((0, 1e-3, L1 - L2, True), abs=1e-12)
            assert proof(two_link, Target("tip", (L1 - L2 + 1e-9) * direction)) is None

    @pytest.mark.parametrize("low_high", [(0.5, 2.0), (-2.0, -0.5), (-0.5, 2.0), (2.5, 3.5), (-7.0, -5.0)])
    def test_counts_the_limits_of_the_elbow(self, low_high):
        # the law of cosines over a grid of the elbow's angles, its ends among them
        arm = load_quietly(two_hinges(L1, L2, *low_high))
        low, high = low_high
        lines = [angle for angle in (0.0, math.pi, -2 * math.pi) if low <= angle <= high]
        angles = np.append(np.linspace(low, high, 200_001), lines)
        distances = np.sqrt(L1**2 + L2**2 + 2 * L1 * L2 * np.cos(angles))
        far = proof(arm, Target("tip", (0, distances.max() + 1e-3, 0)))
        near = proof(arm, Target("tip", (0, distances.min() - 1e-3, 0)))
        assert far == pytest.approx((0, 1e-3, distances.max(), False), abs=1e-9)
        assert near == pytest.approx((0, 1e-3, distances.min(), True), abs=1e-9)
        assert proof(arm, Target("tip", (0, distances.max() - 1e-9, 0))) is None
        assert proof(arm, Target("tip", (0, distances.min() + 1e-9, 0))) is None
        # without limits the elbow stretches and folds
        assert proof(arm, Target("tip", (0, L1 + L2 - 1e-9, 0)), limits=False) is None
        assert proof(arm, Target("tip", (0, L1 - L2 + 1e-9, 0)), limits=False) is None
        assert proof(arm, Target("tip", (0, L1 + L2 + 1e-3, 0)), limits=False).bound == pytest.approx(L1 + L2)

    @pytest.mark.parametrize("stiff", [1, 2, 3])
    def test_cuts_the_chain_where_that_proves_most(self, stiff):
        lengths = (0.5, 0.4, 0.3, 0.2)
        bounds = [(-0.1, 3.1)] * 3
        bounds[stiff - 1] = (1.5, 1.6)  # this one cannot stretch
        text = robot(
            *(link(f"l{i}") for i in range(6)),
            joint("j0", "l0", "l1", axis(0, 0, 1), kind="continuous", limit=""),
            *(
                joint(f"j{i}", f"l{i}", f"l{i + 1}", origin((lengths[i - 1], 0, 0)), axis(0, 0, 1), limit=limit(*b))
                for i, b in enumerate(bounds, start=1)
            ),
            joint("end", "l4", "l5", origin((lengths[3], 0, 0)), kind="fixed", limit=""),
        )
        before, after = lengths[stiff - 1], lengths[stiff]
        bent = math.sqrt(before**2 + after**2 + 2 * before * after * math.cos(1.5))
        found = proof(load_quietly(text), Target("l5", (3, 0, 0)))
        assert found.bound == pytest.approx(bent + sum(lengths) - before - after)

    def test_counts_what_lies_along_the_hinge(self):
        text = robot(
            *(link(name) for name in "abcd"),
            joint("j1", "a", "b", axis(0, 0, 1)),
            joint("j2", "b", "c", origin((0.3, 0, 0.4)), axis(0, 0, 1), limit=limit(-4, 4)),
            joint("end", "c", "d", origin((0, 0.2, 0.5)), kind="fixed", limit=""),
        )
        # both parts rise along the hinge: sqrt(0.9² + (0.3 ± 0.2)²) and nothing nearer or farther
        far = proof(load_quietly(text), Target("d", (0, 0, 2)))
        near = proof(load_quietly(text), Target("d", (0, 0, 0.9)))
        assert far.bound == pytest.approx(math.hypot(0.9, 0.5))
        assert near.bound == pytest.approx(math.hypot(0.9, 0.1))
        assert near.inner

    def test_counts_the_limits_of_a_slide(self):
        text = robot(
            *(link(name) for name in "abc"),
            joint("turn", "a", "b", origin((1, 2, 3), (0.3, 0, 0)), axis(0, 0, 1), kind="continuous", limit=""),
            # a quarter turn about z: the slide's own −y is its parent's x
            joint(
                "slide",
                "b",
                "c",
                origin((0.3, 0, 0), (0, 0, math.pi / 2)),
                axis(0, -1, 0),
                kind="prismatic",
                limit=limit(-0.1, 0.5),
            ),
        )
        loaded = load_quietly(text)
        direction = np.array([0.6, 0, 0.8])
        assert proof(loaded, Target("c", np.array([1, 2, 3]) + 0.9 * direction)) == pytest.approx(
            (0, 0.1, 0.8, False), abs=1e-12
        )
        assert proof(loaded, Target("c", np.array([1, 2, 3]) + 0.15 * direction)) == pytest.approx(
            (0, 0.05, 0.2, True), abs=1e-12
        )

    def test_counts_how_far_a_slide_runs_beside_the_joint_before_it(self):
        text = robot(
            *(link(name) for name in "abc"),
            joint("turn", "a", "b", axis(0, 0, 1), kind="continuous", limit=""),
            joint("slide", "b", "c", origin((0.3, 0, 0)), axis(0, 1, 0), kind="prismatic", limit=limit(-0.1, 0.4)),
        )
        loaded = load_quietly(text)
        assert proof(loaded, Target("c", (0, 0.1, 0))) == pytest.approx((0, 0.2, 0.3, True), abs=1e-12)
        assert proof(loaded, Target("c", (0, 0.7, 0))) == pytest.approx((0, 0.2, 0.5, False), abs=1e-12)

    def test_counts_a_slide_under_the_first_hinge(self):
        text = robot(
            *(link(name) for name in "abc"),
            joint("slide", "a", "b", axis(0, 1, 0), kind="prismatic", limit=limit(0, 0.5)),
            joint("turn", "b", "c", axis(0, 0, 1), kind="continuous", limit=""),
            link("d"), joint("end", "c", "d", origin((0.3, 0, 0)), kind="fixed", limit=""),
        )  # fmt: skip
        found = proof(load_quietly(text), Target("d", (0, 1.0, 0)))
        assert found == pytest.approx((0, 0.2, 0.8, False), abs=1e-12)

    def test_counts_a_followers_own_range(self):
        text = robot(
            *(link(name) for name in "abcd"),
            joint("lead", "a", "b", axis(0, 0, 1), limit=limit(-0.3, 0.2)),
            joint("tail", "b", "c", origin((L1, 0, 0)), axis(0, 0, 1), mimic("lead", -2.0, 1.5), limit=limit(-3, 3)),
            joint("end", "c", "d", origin((L2, 0, 0)), kind="fixed", limit=""),
        )
        # the follower turns through 1.1..2.1
        reach = math.sqrt(L1**2 + L2**2 + 2 * L1 * L2 * math.cos(1.1))
        hole = math.sqrt(L1**2 + L2**2 + 2 * L1 * L2 * math.cos(2.1))
        assert proof(load_quietly(text), Target("d", (0, reach + 0.1, 0))) == pytest.approx((0, 0.1, reach, False))
        assert proof(load_quietly(text), Target("d", (0, hole - 0.1, 0))) == pytest.approx((0, 0.1, hole, True))

    def test_counts_a_follower_that_stays_at_its_offset_under_a_leader_without_limits(self):
        text = robot(
            *(link(name) for name in "abcd"),
            joint("lead", "a", "b", axis(0, 0, 1), kind="continuous", limit=""),
            joint("tail", "b", "c", origin((L1, 0, 0)), axis(1, 0, 0), mimic("lead", 0.0, 0.2), kind="prismatic"),
            joint("end", "c", "d", origin((L2, 0, 0)), kind="fixed", limit=""),
        )
        reach = L1 + 0.2 + L2
        assert proof(load_quietly(text), Target("d", (0, reach + 0.1, 0))) == pytest.approx((0, 0.1, reach, False))

    def test_counts_the_tool(self, two_link):
        for length in (0.1, 0.3):
            tool = (length, 0, 0)
            found = proof(two_link, Target("tip", (2, 0, 0), tool=tool))
            assert found == pytest.approx((0, 1.1 - length, 0.9 + length, False))

    def test_holds_relative_to_a_frame_below_the_chain_even_when_that_moves(self):
        robot = load_quietly("two_link", root="free_flyer")
        target = Target("tip", (0, 0, L1 + L2 + 0.01), relative_to="base")
        assert proof(robot, target) == pytest.approx((0, 0.01, L1 + L2, False), abs=1e-12)
        assert proof(robot, Target("tip", (0, 0, L1 + L2 - 0.01), relative_to="base")) is None

    def test_is_measured_from_the_first_joint_wherever_that_sits(self):
        text = two_hinges(L1, L2).replace('<joint name="shoulder"', '<joint name="lift"').replace("shoulder", "lift")
        text = text.replace(axis(0, 0, 1), origin((1, 2, 3), (0.5, 0.6, 0.7)) + axis(0, 0, 1), 1)
        arm = load_quietly(text)
        found = proof(arm, Target("tip", (1, 2, 3 + L1 + L2 + 0.01)))
        assert found == pytest.approx((0, 0.01, L1 + L2, False), abs=1e-12)
        # and so it is as seen from a link that is turned and moved itself
        seen = proof(arm, Target("tip", (-10, 0, 0), relative_to="upper"))
        assert seen == pytest.approx((0, 10 + L1 - L2, L2, False), abs=1e-12)

    def test_names_the_target_that_lies_farthest_outside(self, lion):
        targets = [
            Target("nose", (0.3, 0, 0.5)),
            Target("left_fore_paw", (50, 0, 0)),
            Target("tail_tip", (-90, 0, 0)),
            Target("right_hind_paw", (0, 0, 20)),
        ]
        found = proof(lion, *targets)
        assert found.target == 2
        assert found.distance == pytest.approx(np.linalg.norm([-90, 0, 0]), abs=3)

    def test_is_not_changed_by_weights(self, two_link):
        found = proof(two_link, Target("tip", (1, 0, 0), weight=5.0))
        assert found.distance == pytest.approx(0.1)

    @pytest.mark.parametrize(
        ("name", "frame", "most"),
        [("arm", "tip", 1.3), ("panda", "panda_hand_tcp", 1.5), ("ur5", "tool0", 1.25), ("z1", "link06", 1.1)],
    )
    def test_is_near_enough_to_the_true_reach_to_be_of_use(self, name, frame, most):
        robot = load_quietly(name)
        found = proof(robot, Target(frame, (100, 0, 0)))
        first = robot.model.jointPlacements[1].translation
        rng = np.random.default_rng(2)
        q = climbed(robot, frame, first, 1.0, rng)
        true = np.linalg.norm(robot.placement(frame, q).translation - first)
        assert true <= found.bound <= most
        assert found.bound <= 1.25 * true
