"""Tests of the judge: it must accept answers computed by hand and reject answers that are slightly wrong."""

from __future__ import annotations

import copy
import dataclasses
import math

import numpy as np
import pinocchio
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from by_hand import (
    ZOO,
    axis,
    chains,
    homogeneous,
    limit,
    link_placements,
    mimic,
    origin,
    random_placement,
    random_rotation,
    rotation_about,
    rotation_from_rpy,
)
from judge import assert_good, assert_honest, is_good, is_inside, judge, plain_placement
from plain_robot import PlainRobot
from robots import load_quietly
from urdf_texts import joint, link, robot

# two_link: bones of 0.5 m and 0.4 m along x, both hinges about z.
ELBOW = (math.pi / 2, -math.pi / 2)  # up along y, then along x: the tip is at (0.4, 0.5, 0), its axes the world's
CORNER = (0.4, 0.5, 0.0)
HALF = math.sqrt(0.5)


class TestTwoLinkByHand:
    def test_positions_are_measured_in_metres(self, two_link):
        assert judge(two_link, {"frame": "tip", "position": CORNER}, ELBOW).position == pytest.approx(0.0, abs=1e-15)
        off = judge(two_link, {"frame": "tip", "position": (0.4, 0.5 + 3e-4, 4e-4)}, ELBOW)
        assert [miss[:2] for miss in off.each] == [(pytest.approx(5e-4), None)]
        assert off.orientation is None

    @pytest.mark.parametrize(
        "keywords",
        [
            {"rotation": rotation_from_rpy(0, 0, math.pi / 3)},
            {"rpy": (0, 0, math.pi / 3)},
            {"quat_xyzw": (0, 0, math.sin(math.pi / 6), math.cos(math.pi / 6))},
            {"quat_wxyz": (-2 * math.cos(math.pi / 6), 0, 0, -2 * math.sin(math.pi / 6))},
            {"placement": homogeneous(rotation_from_rpy(0, 0, math.pi / 3), CORNER)},
            {"placement": pinocchio.SE3(rotation_from_rpy(0, 0, math.pi / 3), np.array(CORNER))},
        ],
        ids=lambda keywords: next(iter(keywords)),
    )
    def test_every_way_to_ask_for_a_rotation_is_the_same_60_degrees_off(self, keywords, two_link):
        errors = judge(two_link, {"frame": "tip", **keywords}, ELBOW)
        assert errors.orientation == pytest.approx(math.pi / 3)
        assert judge(two_link, pinik.Target("tip", **keywords), ELBOW).orientation == pytest.approx(math.pi / 3)
        turned = (math.pi / 2, -math.pi / 2 + math.pi / 3)
        assert judge(two_link, {"frame": "tip", **keywords}, turned).orientation == pytest.approx(0.0, abs=1e-12)

    @pytest.mark.parametrize(
        ("name", "angle"), [("x", 0.0), ("-x", math.pi), ("y", math.pi / 2), ("-y", math.pi / 2), ("z", math.pi / 2)]
    )
    def test_an_axis_is_held_to_its_direction_and_to_its_point(self, name, angle, two_link):
        along = {"frame": "tip", "axis": name, "direction": (7.0, 0.0, 0.0)}
        assert judge(two_link, along, ELBOW).orientation == pytest.approx(angle)
        at = {"frame": "tip", "axis": name, "at": (1.4, 0.5, 0.0)}
        assert judge(two_link, at, ELBOW).orientation == pytest.approx(angle)

    def test_a_frame_on_the_point_that_it_looks_at_looks_at_it(self, two_link):
        assert judge(two_link, {"frame": "tip", "axis": "z", "at": CORNER}, ELBOW).orientation == 0.0

    def test_a_tool_moves_the_point_and_turns_the_axes(self, two_link):
        assert is_good(two_link, {"frame": "tip", "position": (0.4, 0.7, 0.1), "tool": (0, 0.2, 0.1)}, ELBOW)
        turned = homogeneous(rotation_from_rpy(0, 0, math.pi / 2), (0.1, 0, 0))
        asked = {"frame": "tip", "position": (0.5, 0.5, 0), "axis": "x", "direction": (0, 1, 0), "tool": turned}
        assert is_good(two_link, asked, ELBOW)
        assert not is_good(two_link, asked | {"tool": (0.1, 0, 0)}, ELBOW)

    def test_relative_to_a_link_its_axes_and_origin_count(self, two_link):
        # link2 sits at (0, 0.5, 0); with joint2 at −90° its axes are the world's, link1's x is the world's y
        assert is_good(two_link, {"frame": "tip", "position": (0.4, 0, 0), "relative_to": "link2"}, ELBOW)
        assert is_good(two_link, {"frame": "tip", "position": (0.5, -0.4, 0), "relative_to": "link1"}, ELBOW)
        assert not is_good(two_link, {"frame": "tip", "position": CORNER, "relative_to": "link1"}, ELBOW)
        axis_along = {"frame": "tip", "axis": "x", "direction": (0, -1, 0), "relative_to": "link1"}
        assert is_good(two_link, axis_along, ELBOW)
        assert is_good(two_link, {"frame": "tip", "axis": "x", "at": (0.5, -9, 0), "relative_to": "link1"}, ELBOW)

    def test_every_one_of_several_targets_counts(self, two_link):
        asked = [{"frame": "tip", "position": CORNER}, {"frame": "link2", "position": (0.0, 0.5, 0.02)}]
        errors = judge(two_link, asked, ELBOW)
        assert [miss.position for miss in errors.each] == pytest.approx([0.0, 0.02], abs=1e-15)
        assert errors.position == pytest.approx(0.02)
        assert not errors.are_within()
        assert errors.are_within((0.021, 1e-3))


class TestAnAnswerThatIsALittleOff:
    @pytest.mark.parametrize("entry", [0, 1])
    @pytest.mark.parametrize("sign", [-1, 1])
    def test_is_not_good(self, entry, sign, two_link):
        asked = {"frame": "tip", "placement": homogeneous(np.eye(3), CORNER)}
        assert is_good(two_link, asked, ELBOW)
        off = np.array(ELBOW)
        off[entry] += sign * 1.1e-3
        assert not is_good(two_link, asked, off)

    def test_is_not_good_by_its_position_or_its_orientation_alone(self, two_link):
        assert not is_good(two_link, {"frame": "tip", "position": (0.4 + 1.1e-4, 0.5, 0)}, ELBOW)
        assert is_good(two_link, {"frame": "tip", "position": (0.4 + 0.9e-4, 0.5, 0)}, ELBOW)
        assert not is_good(two_link, {"frame": "tip", "rpy": (1.1e-3, 0, 0)}, ELBOW)
        assert is_good(two_link, {"frame": "tip", "rpy": (0.9e-3, 0, 0)}, ELBOW)

    @pytest.mark.parametrize("swapped", ["y", "z", "-x"])
    def test_with_swapped_axes_is_not_good(self, swapped, two_link):
        assert is_good(two_link, {"frame": "tip", "axis": "x", "direction": (1, 0, 0)}, ELBOW)
        assert not is_good(two_link, {"frame": "tip", "axis": swapped, "direction": (1, 0, 0)}, ELBOW)

    def test_with_rotation_transposed_or_quaternion_in_the_other_order_is_not_good(self, panda):
        q = panda.random(3)
        R = plain_placement(panda, "panda_hand", q).rotation
        x, y, z, w = pinocchio.Quaternion(R).coeffs()
        assert is_good(panda, {"frame": "panda_hand", "rotation": R}, q)
        assert is_good(panda, {"frame": "panda_hand", "quat_xyzw": (x, y, z, w)}, q)
        for wrong in ({"rotation": R.T}, {"quat_wxyz": (x, y, z, w)}, {"quat_xyzw": (-x, -y, -z, w)}):
            assert not is_good(panda, {"frame": "panda_hand", **wrong}, q)

    @pytest.mark.parametrize("bad", [math.nan, math.inf])
    def test_that_is_not_finite_is_neither_good_nor_inside(self, bad, two_link, panda):
        for q in ((bad, 0.1), (0.1, bad)):
            assert not is_good(two_link, {"frame": "tip", "position": CORNER}, q, limits=False)
            assert not is_inside(two_link, q)
        both = [{"frame": "tip", "position": CORNER}, {"frame": "base", "position": (0, 0, 0)}]
        for asked in (both, both[::-1]):
            assert not judge(two_link, asked, (math.nan, 0.1)).position <= 1e9


class TestLimits:
    def test_are_exactly_those_of_the_file(self, panda):
        for k, name in enumerate(panda.joint_names):
            if name == "panda_finger_joint1":
                continue  # its follower's limits, which have a slack for rounding, narrow it
            for end, away in ((panda.lower, -math.inf), (panda.upper, math.inf)):
                q = 0.5 * (panda.lower + panda.upper)
                q[k] = end[k]
                assert is_inside(panda, q)
                q[k] = np.nextafter(q[k], away)
                assert not is_inside(panda, q)
                assert list(judge(panda, [], q).outside) == [name]

    def test_are_read_from_the_file_and_not_from_the_robot(self, two_link):
        """A robot that had lost its limits would be detected."""
        loose = copy.copy(two_link)
        loose.lower_q, loose.upper_q = np.full(2, -np.inf), np.full(2, np.inf)
        assert not is_inside(loose, (0.0, 50.0))

    @pytest.mark.parametrize(
        ("words", "bounds", "inside", "outside"),
        [
            (mimic("lead", 2.0), (-1.0, 1.2), (-0.5, 0.6), (-0.501, 0.601)),
            (mimic("lead", -2.0), (-1.0, 1.2), (-0.6, 0.5), (-0.601, 0.501)),
            (mimic("lead", -1.0, 0.5), (-1.0, 1.2), (-0.7, 1.5), (-0.701, 1.501)),
            (mimic("lead", 0.1), (-3.0, 3.0), (-2.0, 2.0), (-2.001, 2.001)),
            (mimic("lead", -1.0), (0.0, 0.5), (-0.5, 0.0), (-0.501, 0.001)),
        ],
    )
    def test_of_a_leader_are_narrowed_by_its_follower(self, words, bounds, inside, outside):
        loaded = leader_and_follower(words, bounds)
        assert all(is_inside(loaded, [angle]) for angle in inside)
        assert not any(is_inside(loaded, [angle]) for angle in outside)

    def test_of_a_leader_stay_where_its_follower_would_freeze_it(self):
        plain = PlainRobot(text_of_leader_and_follower(mimic("lead", -1.0), (2.0, 3.0)))
        assert plain.limits(["lead"])["lead"] == (-2.0, 2.0)

    def test_of_a_follower_that_is_free_are_its_own(self):
        text = text_of_leader_and_follower(mimic("lead", 2.0), (-1.0, 1.2))
        free = pinik.load(text, mimic=False)
        q = free.configuration({"lead": 2.0, "tail": 1.2})
        assert is_inside(free, q)
        assert judge(free, [], free.configuration({"lead": 2.0, "tail": 1.3})).outside == {"tail": pytest.approx(0.1)}

    def test_a_pair_or_quaternion_off_unit_length_is_outside(self, kinova):
        q = kinova.random(1)
        assert is_inside(kinova, q)
        q[kinova.joint("j2s6s200_joint_1").idx_q :][:2] *= 1.001
        assert judge(kinova, [], q).outside == {"j2s6s200_joint_1": pytest.approx(1e-3)}
        flying = load_quietly("two_link", root="free_flyer")
        q = flying.neutral()
        q[6] = 0.9
        assert judge(flying, [], q).outside == {"root_joint": pytest.approx(-0.1)}


def text_of_leader_and_follower(words: str, bounds: tuple[float, float]) -> str:
    return robot(
        *(link(name) for name in "abc"),
        joint("lead", "a", "b", limit=limit(-2, 2)),
        joint("tail", "b", "c", words, limit=limit(*bounds)),
    )


def leader_and_follower(words: str, bounds: tuple[float, float]) -> pinik.Robot:
    return load_quietly(text_of_leader_and_follower(words, bounds))


class TestPlacements:
    @pytest.mark.parametrize("root", ["fixed", "free_flyer", "planar"])
    def test_of_every_kind_of_joint_are_those_of_matrices_multiplied_by_hand(self, root):
        loaded, rng = load_quietly(ZOO, root=root), np.random.default_rng(3)
        for _ in range(5):
            angles = {"k_turn": rng.uniform(-3, 3), "l_hinge": rng.uniform(-2, 1.5), "m_slide": rng.uniform(-0.2, 0.6)}
            places = {"drift": random_placement(rng), "s_plane": random_placement(rng, "planar")}
            base = np.eye(4)
            if root != "fixed":
                base = random_placement(rng, "floating" if root == "free_flyer" else "planar")
            q = loaded.configuration(angles, places | ({} if root == "fixed" else {"root_joint": base}))
            links = link_placements(ZOO, angles, places, base)
            for frame in ("a", "tip", "hand"):
                assert np.allclose(plain_placement(loaded, frame, q).homogeneous, links[frame], atol=1e-12)
                seen = plain_placement(loaded, frame, q, "body").homogeneous
                assert np.allclose(seen, np.linalg.inv(links["body"]) @ links[frame], atol=1e-12)

    @given(text=chains(), seed=st.integers(0, 9))
    def test_of_any_chain_with_its_followers_too(self, text, seed):
        loaded, rng = load_quietly(text), np.random.default_rng(seed)
        angles = {name: rng.uniform(-3, 3) for name in loaded.joint_names}
        expected = link_placements(text, angles)["tip"]
        found = plain_placement(loaded, "tip", loaded.configuration(angles)).homogeneous
        assert np.allclose(found, expected, atol=1e-9)

    def test_of_a_frame_that_is_not_there_are_refused(self, two_link):
        with pytest.raises(KeyError, match="tipp"):
            plain_placement(two_link, "tipp", ELBOW)

    @given(seed=st.integers(0, 2**32 - 1), angle=st.floats(0.0, math.pi))
    def test_differ_by_the_angle_that_they_were_turned_by(self, seed, angle):
        rng = np.random.default_rng(seed)
        about = rng.normal(size=3)
        R = random_rotation(rng)
        turned = R @ rotation_about(about / np.linalg.norm(about), angle)
        rigid = load_quietly(robot(link("a"), link("b"), joint("j", "a", "b", place(R), kind="fixed", limit="")))
        assert judge(rigid, {"frame": "b", "rotation": turned}, []).orientation == pytest.approx(angle, abs=1e-9)


def place(R: np.ndarray) -> str:
    """The origin element of a rotation, at (1, 2, 3)."""
    return origin((1, 2, 3), (math.atan2(R[2, 1], R[2, 2]), -math.asin(R[2, 0]), math.atan2(R[1, 0], R[0, 0])))


class TestAssertions:
    """`assert_good` and `assert_honest` must reject solutions whose claims are wrong."""

    @pytest.fixture
    def solution(self, two_link):
        return two_link.solve("tip", position=CORNER)

    def test_a_good_solution_passes(self, solution):
        assert_good(solution)
        assert_good(solution, {"frame": "tip", "position": CORNER})

    def test_a_miss_that_says_so_is_honest_and_not_good(self, two_link):
        missed = two_link.solve("tip", position=(2.0, 0.0, 0.0))
        assert_honest(missed)
        with pytest.raises(AssertionError, match="unreachable"):
            assert_good(missed)

    def test_a_solution_of_another_question_is_detected(self, solution):
        with pytest.raises(AssertionError, match="the judge finds"):
            assert_good(solution, {"frame": "tip", "position": (0.4, 0.5 + 1e-3, 0.0)})

    @pytest.mark.parametrize("change", [1e-3, 1e-7])
    def test_a_q_that_does_not_belong_to_the_errors_is_detected(self, change, solution):
        with pytest.raises(AssertionError, match="the judge finds"):
            assert_honest(forged(solution, q=solution.q + change))

    def test_a_success_outside_the_limits_is_detected(self, two_link):
        hinge = robot(
            *(link(name) for name in "abc"),
            joint("j", "a", "b", axis(0, 0, 1), limit=limit(-1, 1)),
            joint("end", "b", "c", origin((1, 0, 0)), kind="fixed", limit=""),
        )
        free = load_quietly(hinge).solve("c", position=(0.0, 1.0, 0.0), limits=False)
        assert_good(free, limits=False)
        with pytest.raises(AssertionError, match="outside the limits"):
            assert_good(free)

    def test_a_verdict_that_contradicts_the_errors_is_detected(self, solution, two_link):
        with pytest.raises(AssertionError, match="the judge finds"):
            assert_honest(forged(solution, success=False))
        missed = two_link.solve("tip", position=(2.0, 0.0, 0.0))
        with pytest.raises(AssertionError, match="the judge finds"):
            assert_honest(forged(missed, success=True))

    def test_a_tolerance_that_was_not_met_is_detected(self, two_link):
        coarse = two_link.solve("tip", position=CORNER, method="jt", tolerance=(0.05, 0.1), restarts=0)
        assert_good(coarse, tolerance=(0.05, 0.1))
        assert coarse.position_error > 1e-4
        with pytest.raises(AssertionError, match="the judge finds"):
            assert_good(coarse)


@dataclasses.dataclass
class Forged:
    """The fields of a solution that the judge reads, free to be set to anything."""

    robot: pinik.Robot
    targets: tuple[pinik.Target, ...]
    q: np.ndarray
    errors: tuple[pinik.TargetError, ...]
    position_error: float | None
    orientation_error: float | None
    success: bool
    message: str


def forged(solution: pinik.Solution, **changes: object) -> Forged:
    said = {field.name: getattr(solution, field.name) for field in dataclasses.fields(Forged)}
    return Forged(**said | changes)
