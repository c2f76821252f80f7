from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from by_hand import ZOO
from pinik import Target
from pinik.model.limits import Limits
from pinik.problem.problem import Problem
from pinik.solving import starts
from pinik.solving.starts import random_start, uniform
from robots import load_quietly
from urdf_texts import joint, link, robot

key = st.integers(0, 2**40)
MASK = (1 << 64) - 1
GOLDEN = 0x9E3779B97F4A7C15


def start(robot, targets, q0, *, limits=True, locked=(), seed=0, target=0, attempt=1):
    problem = Problem(robot, targets, locked=locked)
    return random_start(problem, Limits.of(robot, limits), q0, seed=seed, target=target, attempt=attempt)


class TestMixing:
    @pytest.mark.parametrize(
        ("seed", "outputs"),
        [
            (
                1234567,
                (
                    6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431,
                    16408922859458223821,
                ),
            ),
            (0, (0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F)),
        ],
    )  # fmt: skip
    def test_is_that_of_splitmix64_as_published(self, seed, outputs):
        for step, output in enumerate(outputs, start=1):
            assert starts._mix((seed + step * GOLDEN) & MASK) == output

    def test_keys_go_in_one_after_the_other(self):
        """The definition that another engine has to meet, with numpy's wrapping integers."""

        def mix(z):
            z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
            z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
            return z ^ (z >> np.uint64(31))

        keys = np.random.default_rng(1).integers(0, 2**32, size=(4, 100), dtype=np.uint64)
        state = keys[0]
        for key_ in keys[1:]:
            state = mix(state + np.uint64(GOLDEN) * (key_ + np.uint64(1)))
        expected = (state >> np.uint64(11)).astype(np.float64) / 2.0**53
        np.testing.assert_array_equal([uniform(*map(int, column)) for column in keys.T], expected)


class TestUniform:
    @given(key, key, key, key)
    def test_lies_in_the_unit_interval_and_depends_on_its_keys_alone(self, seed, target, attempt, index):
        u = uniform(seed, target, attempt, index)
        assert 0.0 <= u < 1.0
        assert uniform(seed, target, attempt, index) == u

    @given(st.tuples(key, key, key, key), st.integers(0, 3), st.integers(1, 100))
    def test_changes_with_every_key(self, keys, which, change):
        others = list(keys)
        others[which] += change
        assert uniform(*keys) != uniform(*others)

    @pytest.mark.parametrize("which", range(4))
    def test_fills_the_interval_evenly_along_every_key(self, which):
        keys = np.zeros((4, 5000), dtype=int)
        keys[which] = np.arange(5000)
        values = np.array([uniform(*map(int, column)) for column in keys.T])
        counts, _ = np.histogram(values, bins=10, range=(0, 1))
        assert ((counts - 500) ** 2 / 500).sum() < 27.9  # χ² of 9 degrees of freedom, 1 in 1,000
        assert abs(np.corrcoef(values[:-1], values[1:])[0, 1]) < 0.05

    def test_keys_do_not_stand_for_one_another(self):
        rng = np.random.default_rng(2)
        for a, b in rng.integers(0, 1000, size=(100, 2)):
            if a != b:
                assert len({uniform(int(a), int(b), 0, 0), uniform(int(b), int(a), 0, 0), uniform(0, int(a), int(b), 0),
                            uniform(0, int(b), int(a), 0), uniform(0, 0, int(a), int(b))}) == 5  # fmt: skip


class TestRandomStart:
    @pytest.mark.parametrize(
        ("name", "frame"), [("arm", "tip"), ("panda", "panda_leftfinger"), ("tiago", "arm_tool_link")]
    )
    def test_lies_inside_the_limits(self, name, frame):
        robot = load_quietly(name)
        limits = Limits.of(robot)
        q0 = limits.clip(robot.neutral())
        for attempt in range(50):
            q = start(robot, [Target(frame, (1, 0, 0))], q0, attempt=attempt)
            assert limits.contains(q)
            np.testing.assert_allclose(robot.check_configuration(q), q, atol=1e-12)

    def test_fills_the_limits(self, panda):
        q0 = panda.poses["default"]
        targets = [Target("panda_leftfinger", (1, 0, 0))]
        drawn = np.array([start(panda, targets, q0, attempt=attempt) for attempt in range(2000)])
        fractions = (drawn - panda.lower) / (panda.upper - panda.lower)
        np.testing.assert_allclose(
            np.quantile(fractions, [0.1, 0.5, 0.9], axis=0).T, [[0.1, 0.5, 0.9]] * panda.model.nq, atol=0.05
        )
        correlations = np.corrcoef(fractions.T) - np.eye(panda.model.nq)
        assert np.abs(correlations).max() < 0.1

    @pytest.mark.parametrize("u", [0.0, 1.0 - 2.0**-53])
    def test_lies_inside_the_limits_at_both_ends_of_the_interval(self, monkeypatch, u):
        monkeypatch.setattr(starts, "uniform", lambda *keys: u)
        fingertip = "l_gripper_l_finger_tip_link"
        for name, frame in (("panda", "panda_leftfinger"), ("lion", "nose"), ("ur5", "tool0"), ("pr2", fingertip)):
            robot = load_quietly(name)
            q0 = Limits.of(robot).clip(robot.neutral())
            assert Limits.of(robot).contains(start(robot, [Target(frame, (1, 0, 0))], q0))

    def test_leaves_joints_that_move_no_target_as_they_were(self, lion):
        q0 = lion.poses["relaxed"]
        q = start(lion, [Target("nose", (1, 0, 0))], q0)
        free = Problem(lion, [Target("nose", (1, 0, 0))]).free
        assert (q[~free] == q0[~free]).all()
        assert (q[free] != q0[free]).all()

    def test_leaves_locked_joints_as_they_were(self, arm):
        q0 = arm.poses["reach"]
        q = start(arm, [Target("tip", (1, 0, 0))], q0, locked=["bone2_x", "bone6_z"])
        held = [arm.joint(name).idx_q for name in ("bone2_x", "bone6_z")]
        assert (q[held] == q0[held]).all()
        assert (np.delete(q, held) != np.delete(q0, held)).all()

    def test_leaves_floating_and_planar_joints_as_they_were(self):
        robot = load_quietly(ZOO, root="free_flyer")
        q0 = robot.random(3)
        q = start(robot, [Target("tip", (1, 0, 0)), Target("hand", (0, 1, 0))], q0)
        for moved in robot.joints:
            if moved.nq:
                part = slice(moved.idx_q, moved.idx_q + moved.nq)
                assert (q[part] == q0[part]).all() == (not moved.has_one_axis)

    def test_leaves_the_start_itself_alone(self, arm):
        q0 = arm.poses["reach"]
        kept = q0.copy()
        start(arm, [Target("tip", (1, 0, 0))], q0)
        np.testing.assert_array_equal(q0, kept)

    def test_without_limits_turns_within_half_a_turn_and_slides_within_the_length_of_the_chain_of_the_start(self):
        robot = load_quietly(ZOO)
        q0 = robot.configuration({"m_slide": 7.0, "l_hinge": 9.0})
        drawn = [
            robot.angles(start(robot, [Target("tip", (1, 0, 0))], q0, limits=False, attempt=attempt))
            for attempt in range(300)
        ]
        length = Problem(robot, [Target("tip", (1, 0, 0))]).size_of_chain
        for name, middle, half in (("k_turn", 0, math.pi), ("l_hinge", 0, math.pi), ("m_slide", 7.0, length)):
            values = np.array([angles[name] for angles in drawn])
            assert (np.abs(values - middle) <= half).all()
            assert values.min() < middle - 0.9 * half
            assert values.max() > middle + 0.9 * half

    def test_is_told_apart_by_seed_target_and_attempt(self, arm):
        q0 = arm.neutral()
        targets = [Target("tip", (1, 0, 0))]
        variants = [{}, {"seed": 1}, {"target": 1}, {"attempt": 2}]
        drawn = [start(arm, targets, q0, **keys) for keys in variants]
        again = [start(arm, targets, q0, **keys) for keys in variants]
        np.testing.assert_array_equal(drawn, again)
        for i in range(4):
            for j in range(i):
                assert not np.isclose(drawn[i], drawn[j]).any()

    def test_draws_a_joint_the_same_whatever_else_is_drawn(self, arm):
        q0 = arm.neutral()
        targets = [Target("tip", (1, 0, 0))]
        alone = start(arm, targets, q0, locked=[name for name in arm.joint_names if name != "bone3_x"])
        column = arm.joint("bone3_x").idx_q
        assert alone[column] == start(arm, targets, q0)[column]


@pytest.mark.parametrize(
    ("kind", "limits", "expected"),
    [
        ("revolute", (-60, 60), (-math.pi, math.pi)),
        ("revolute", (150, 1000), (150, 150 + 2 * math.pi)),
        ("revolute", (-math.inf, -2), (-2 - 2 * math.pi, -2)),
        ("revolute", (-1, 2), (-1, 2)),
        ("prismatic", (-1e16, 1e16), (4, 6)),
        ("prismatic", (5.5, math.inf), (5.5, 7.5)),
        ("prismatic", (0, 3), (0, 3)),
    ],
)
def test_a_range_to_draw_from_is_finite_and_inside_the_limits(kind, limits, expected):
    text = robot(link("a"), link("b"), joint("j", "a", "b", kind=kind))
    assert load_quietly(text).joint("j").range_to_draw_from(*limits, slide_about=5.0) == pytest.approx(expected)
