from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from by_hand import ZOO, axis, limit, mimic, two_hinges
from pinik.model.limits import Limits
from robots import load_quietly
from urdf_texts import joint, link, robot

TURN = 2 * math.pi


def hinge(low: float, high: float) -> Limits:
    """The limits of one hinge."""
    text = robot(link("a"), link("b"), joint("j", "a", "b", axis(0, 0, 1), limit=limit(low, high)))
    return Limits.of(load_quietly(text))


def outside(angle: float, low: float, high: float) -> float:
    """How far an angle lies outside [low, high]."""
    return max(low - angle, angle - high, 0.0)


HINGES_AND_A_SLIDE = robot(
    *map(link, ("base", "a", "b", "c", "d")),
    joint("hinge", "base", "a", axis(0, 0, 1), limit=limit(-2, 1.5)),
    joint("leader", "a", "b", axis(0, 0, 1), limit=limit(-1, 1)),
    joint("slide", "b", "c", axis(0, 0, 1), kind="prismatic", limit=limit(-0.2, 0.6)),
    joint("z_follower", "c", "d", axis(0, 0, 1), mimic("leader", 0.5), limit=limit(-1, 1)),
)


class TestWrap:
    @given(
        low=st.floats(-8, 8).map(lambda x: round(x, 2)),
        width=st.floats(0, 15).map(lambda x: round(x, 2)),
        angle=st.floats(-30, 30),
        near=st.floats(-30, 30),
    )
    def test_takes_the_angle_nearest_to_another_among_those_inside(self, low, width, angle, near):
        limits = hinge(low, low + width)
        low, high = float(limits.lower[0]), float(limits.upper[0])
        wrapped = limits.wrap(np.array([angle]), np.array([near]))[0]
        assert low <= wrapped <= high
        same = [angle + k * TURN for k in range(-12, 13)]
        nearest = min(same, key=lambda x: abs(x - near))
        inside = [x for x in same if low <= x <= high]
        if not low <= angle <= high and 0.0 < outside(nearest, low, high) <= 0.02:
            assert wrapped == (low if nearest < low else high)
        elif inside:
            assert abs(wrapped - near) == pytest.approx(min(abs(x - near) for x in inside), abs=1e-9)
            assert min(abs(wrapped - x) for x in inside) < 1e-9
        else:
            assert min(abs(wrapped - x) for x in same) == pytest.approx(min(outside(x, low, high) for x in same))

    @pytest.mark.parametrize(
        ("low", "high", "angle", "expected"),
        [
            (-1.0, 1.0, 0.5, 0.5),
            (-1.0, 1.0, 0.5 + TURN, 0.5),
            (-1.0, 1.0, 0.5 - 3 * TURN, 0.5),
            (3.0, 4.0, 3.5 - TURN, 3.5),
            (-1.0, 1.0, 1.2, 1.0),
            (-1.0, 1.0, 1.2 + TURN, 1.0),
            (-1.0, 1.0, TURN - 1.2, -1.0),
            (-0.1, 7.0, -0.11, -0.1),
            (-0.1, 7.0, -0.25, TURN - 0.25),
            (-1.0, 8.0, 3.0 - TURN, 3.0),
            (-3.14159, 3.14159, 3.1420, 3.14159),
            (-3.14159, 3.14159, 3.3, 3.3 - TURN),
            (-TURN, TURN, 20.0, 20.0 - 3 * TURN),
            (-TURN, TURN, 3 * TURN + 0.15, 0.15),
        ],
    )
    def test_of_chosen_angles(self, low, high, angle, expected):
        assert hinge(low, high).wrap(np.array([angle]))[0] == pytest.approx(expected)

    @pytest.mark.parametrize(
        ("angle", "near", "expected"),
        [
            (5.0, 0.0, 5.0 - TURN),
            (5.0, 3.0, 5.0),
            (-6.0, 6.0, TURN - 6.0),
            (6.2, -6.2, 6.2 - TURN),
            (6.4, 0.0, 6.4 - TURN),
            (6.1, 6.2 + TURN, 6.1),
        ],
    )
    def test_near_another_angle(self, angle, near, expected):
        assert hinge(-TURN, TURN).wrap(np.array([angle]), np.array([near]))[0] == pytest.approx(expected)

    def test_of_many_configurations_is_that_of_each(self, panda):
        limits, rng = Limits.of(panda), np.random.default_rng(7)
        q, near = rng.uniform(-9, 9, (2, 40, panda.model.nq))
        wrapped = limits.wrap(q, near)
        for k in range(len(q)):
            assert (wrapped[k] == limits.wrap(q[k], near[k])).all()

    def test_of_a_robot_without_joints_is_empty(self):
        limits = Limits.of(load_quietly(robot(link("a"))))
        assert limits.wrap(np.zeros(0), np.zeros(0)).shape == (0,)
        assert limits.wrap(np.zeros((3, 0))).shape == (3, 0)

    @given(seed=st.integers(0, 2**32 - 1))
    def test_leaves_what_is_inside_to_the_last_bit_and_turns_what_can_turn(self, seed):
        loaded = load_quietly(HINGES_AND_A_SLIDE)
        limits = Limits.of(loaded)
        rng = np.random.default_rng(seed)
        q = loaded.random(rng)
        assert (limits.wrap(q) == q).all()
        hinge_, slide, leader = (loaded.joint(name).idx_q for name in ("hinge", "slide", "leader"))
        q[leader] += TURN  # its follower would turn by half as much: another configuration
        q[hinge_] += rng.choice([-2, -1, 1, 2]) * TURN
        q[slide] += rng.choice([-TURN, TURN])
        kept = q.copy()
        wrapped = limits.wrap(q)
        assert (q == kept).all()
        assert wrapped[leader] == limits.upper[leader]
        assert wrapped[slide] in (limits.lower[slide], limits.upper[slide])
        assert limits.lower[hinge_] <= wrapped[hinge_] <= limits.upper[hinge_]
        assert math.cos(wrapped[hinge_] - q[hinge_]) == pytest.approx(1.0, abs=1e-12)

    def test_switched_off_only_turns_towards_another_configuration(self):
        loaded = load_quietly(two_hinges(1, 1))
        q, near = np.array([1.0, 0.0, 100.0]), np.array([1.0, 0.0, 1.0])
        limits = Limits.of(loaded, False)
        assert (limits.wrap(q) == q).all()
        moved = limits.wrap(q, near)
        assert moved[2] == pytest.approx(100.0 - 16 * TURN)
        assert (moved[:2] == q[:2]).all()

    @pytest.mark.parametrize(("multiplier", "turns"), [(1.0, True), (-2.0, True), (0.5, False), (0.0, True)])
    def test_turns_a_leader_if_its_followers_come_back_with_it(self, multiplier, turns):
        text = robot(
            *map(link, "abc"),
            joint("lead", "a", "b", axis(0, 0, 1), limit=limit(-20, 20)),
            joint("tail", "b", "c", axis(0, 0, 1), mimic("lead", multiplier), limit=limit(-90, 90)),
        )
        loaded = load_quietly(text)
        assert Limits.of(loaded).turning.tolist() == [turns]
        wrapped = Limits.of(loaded).wrap(np.array([7.0]), np.array([0.0]))
        assert loaded.placement("c", wrapped).isApprox(loaded.placement("c", np.array([7.0])), 1e-12)


class TestBox:
    def test_holds_one_axis_joints_and_no_circles(self):
        loaded = load_quietly(ZOO, root="free_flyer")
        limits = Limits.of(loaded)
        bounded = {joint_.name for joint_ in loaded.joints if joint_.nq and limits.entry[joint_.idx_v] >= 0}
        assert bounded == {"l_hinge", "m_slide"}
        for name in bounded:
            assert limits.entry[loaded.joint(name).idx_v] == loaded.joint(name).idx_q
        assert np.isfinite(limits.lower).sum() == np.isfinite(limits.upper).sum() == 2
        plain = load_quietly(HINGES_AND_A_SLIDE)
        assert np.flatnonzero(Limits.of(plain).turning).tolist() == [plain.joint("hinge").idx_q]

    def test_loosened_holds_only_joints_of_a_single_value(self):
        loaded = load_quietly(
            robot(
                *map(link, ("base", "a", "b")),
                joint("dead", "base", "a", axis(0, 0, 1), limit=limit(0.0, 0.0)),
                joint("live", "a", "b", axis(0, 0, 1), limit=limit(-1.0, 1.0)),
            )
        )
        loose = Limits.of(loaded).loosened()
        assert loose.lower.tolist() == [0.0, -np.inf]
        assert loose.upper.tolist() == [0.0, np.inf]
        assert not Limits.of(load_quietly(HINGES_AND_A_SLIDE)).loosened().enabled

    def test_clips_entry_by_entry_into_itself(self, panda):
        limits = Limits.of(panda)
        q = np.linspace(-9, 9, panda.model.nq)
        inside = limits.clip(q)
        assert (inside >= panda.lower).all()
        assert (inside <= panda.upper).all()
        within = (q >= panda.lower) & (q <= panda.upper)
        assert (inside[within] == q[within]).all()
        assert ((inside == panda.lower) | (inside == panda.upper))[~within].all()

    def test_contains_what_lies_inside_with_the_ends(self, panda):
        limits = Limits.of(panda)
        for q in (panda.lower, panda.upper, 0.5 * (panda.lower + panda.upper)):
            assert limits.contains(q)
        for i in range(panda.model.nq):
            q = panda.upper.copy()
            q[i] = np.nextafter(q[i], math.inf)
            assert not limits.contains(q)

    def test_switched_off_holds_nothing(self, panda):
        limits = Limits.of(panda, False)
        q = np.full(panda.model.nq, 1e6)
        assert limits.contains(q)
        assert (limits.clip(q) == q).all()
        assert limits.active(q) == {}
        assert not limits.blocked(q, q + 1, limits.clip(q + 1)).any()

    def test_of_a_leader_is_cut_by_its_follower(self):
        text = robot(
            *(link(name) for name in "abc"),
            joint("lead", "a", "b", limit=limit(-2, 2)),
            joint("tail", "b", "c", mimic("lead", -2.0), limit=limit(-1, 3)),
        )
        limits = Limits.of(load_quietly(text))
        assert (limits.lower[0], limits.upper[0]) == (-1.5, 0.5)


class TestBlocked:
    def test_are_joints_at_a_limit_that_would_leave_it(self):
        loaded = load_quietly(ZOO, root="planar")
        limits = Limits.of(loaded)
        slide = loaded.joint("m_slide")
        for value, change, expected in (
            (0.6, 0.1, True), (0.6, -0.1, False), (0.5, 0.3, False), (-0.2, -0.1, True), (-0.2, 0.1, False),
            (0.6, 0.0, False),
        ):  # fmt: skip
            q = loaded.random(1)
            q[slide.idx_q] = value
            wanted = q.copy()
            wanted[slide.idx_q] += change
            blocked = limits.blocked(q, wanted, limits.clip(wanted))
            assert blocked[slide.idx_v] == expected
            assert blocked.sum() == expected

    def test_are_never_coordinates_without_limits(self):
        loaded = load_quietly("lion", root="free_flyer")  # whose last entry of q is a bounded one
        limits = Limits.of(loaded)
        q = loaded.neutral()
        q[7:] = loaded.upper
        wanted = q.copy()
        wanted[7:] += 1.0
        blocked = limits.blocked(q, wanted, limits.clip(wanted))
        assert not blocked[:6].any()
        assert blocked[6:].all()

    def test_are_one_each_for_the_tangent_coordinates(self, lion):
        limits = Limits.of(lion)
        wanted = lion.upper_q + 1
        assert limits.blocked(lion.upper_q, wanted, limits.clip(wanted)).tolist() == [True] * lion.model.nv


class TestActive:
    def test_names_the_joints_at_a_limit_and_the_side(self, panda):
        limits = Limits.of(panda)
        q = 0.5 * (panda.lower + panda.upper)
        assert limits.active(q) == {}
        q[0], q[3], q[7] = panda.lower[0], panda.upper[3], panda.upper[7] - 1e-7
        q[5] = panda.lower[5] + 1e-5
        assert limits.active(q) == {"panda_joint1": "lower", "panda_joint4": "upper", "panda_finger_joint1": "upper"}

    def test_calls_a_joint_without_room_at_both(self):
        assert hinge(0.3, 0.3).active(np.array([0.3])) == {"j": "both"}

    def test_never_names_continuous_and_free_joints(self):
        loaded = load_quietly(ZOO, root="free_flyer")
        q = loaded.configuration({"l_hinge": 1.5, "m_slide": -0.2})
        assert Limits.of(loaded).active(q) == {"l_hinge": "upper", "m_slide": "lower"}
