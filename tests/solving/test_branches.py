"""`Branches` on findings made by hand: the estimate of what is missing, and whole turns."""

from __future__ import annotations

import dataclasses
import functools
import itertools
import math
import pickle

import numpy as np
import pinocchio
import pytest

import pinik
from every_answer import hinge_arm, puma
from robots import load_quietly
from urdf_texts import joint, link, robot


@functools.cache
def some_branches() -> pinik.Branches:
    return pinik.load("two_link").solve_all("tip", [0.5, 0.3, 0.0])


def made(is_complete: bool = False, **changes: object) -> pinik.Branches:
    own = some_branches()
    return dataclasses.replace(own, is_complete=is_complete, _found=dataclasses.replace(own._found, **changes))


def estimate(hits: np.ndarray, **changes: object) -> float:
    return made(hits=hits, **changes).estimate_missing


@pytest.mark.parametrize(
    ("hits", "wanted"),
    [
        ([], 0.0),
        ([5, 7, 3], 0.0),
        ([1, 5, 7], 0.0),  # 1 · 0 / (2 · 1)
        ([1, 1, 4], 1.0),  # 2 · 1 / (2 · 1)
        ([1, 1, 1, 2, 9], 1.5),  # 3 · 2 / (2 · 2)
        ([1, 1, 1, 1, 2, 2], 2.0),  # 4 · 3 / (2 · 3)
    ],
)
def test_the_estimate_is_the_bound_of_chao(hits, wanted):
    assert estimate(np.array(hits, dtype=np.int64)) == pytest.approx(wanted)


def test_nothing_is_missing_of_what_is_complete_and_infinitely_many_of_a_family():
    once = np.ones(5, dtype=np.int64)
    assert estimate(once, is_complete=True) == 0.0
    assert math.isinf(estimate(once, redundancy=1))


def test_the_estimate_is_right_on_average_where_answers_are_found_at_random():
    rng, gaps = np.random.default_rng(0), []
    for _ in range(300):
        drawn = np.bincount(rng.integers(0, 8, 16), minlength=8)
        gaps.append(estimate(drawn[drawn > 0]) - (drawn == 0).sum())
    assert abs(np.mean(gaps)) < 0.35  # of 0.94 that are missing on average


class TestWholeTurns:
    def test_a_hinge_between_uneven_limits(self):
        robot = pinik.load(hinge_arm("z", [(0, 0, 0), (1, 0, 0)], (-1.0, 14.0)))
        branches = robot.solve_all("tip", [math.cos(0.5), math.sin(0.5), 0.0])
        assert branches[0] == pytest.approx([0.5])
        assert branches.windings.tolist() == [[[0, 2]]]  # 0.5 + 4π = 13.07
        turned = [0.5, 0.5 + 2.0 * math.pi, 0.5 + 4.0 * math.pi]
        assert [float(q[0]) for q in branches.wound(0)] == pytest.approx(turned)

    def test_a_locked_hinge_does_not_turn(self):
        robot = pinik.load(puma((-6.3, 6.3)))
        q = np.array([0.4, -0.5, 1.1, 0.7, 0.8, -1.2])
        branches = robot.solve_all("tip", placement=robot.placement("tip", q), q0=q, locked=["j6"])
        assert branches[0] == pytest.approx(q, abs=1e-6)
        assert branches.windings[0, 5].tolist() == [0, 0]
        assert branches.windings[0, :5].any(axis=1).all()
        assert branches.joint_names == ["j1", "j2", "j3", "j4", "j5"]

    def test_a_leader_whose_follower_does_not_come_back_does_not_turn(self):
        text = hinge_arm("z", [(0, 0, 0), (1, 0, 0)], (-7.0, 7.0))
        half = joint("f", "tip", "finger", '<axis xyz="0 0 1"/>', '<mimic joint="j1" multiplier="0.5"/>')
        free = pinik.load(text).solve_all("tip", [1.0, 0.0, 0.0])
        tied = pinik.load(text.replace("</robot>", f'<link name="finger"/>{half}</robot>'))
        assert free.windings.tolist() == [[[-1, 1]]]
        assert tied.solve_all("tip", [1.0, 0.0, 0.0]).windings.tolist() in ([[[0, 0]]], [[[0, 0]], [[0, 0]]])

    def test_without_limits_there_is_nothing_to_count(self):
        robot = pinik.load(puma((-6.3, 6.3)))
        q = np.array([0.4, -0.5, 1.1, 0.7, 0.8, -1.2])
        branches = robot.solve_all("tip", placement=robot.placement("tip", q), limits=False)
        assert not branches.windings.any()

    def test_those_with_the_fewest_turns_come_first(self):
        robot = pinik.load(hinge_arm("z", [(0, 0, 0), (1, 0, 0)], (-14.0, 14.0)))
        branches = robot.solve_all("tip", [math.cos(0.5), math.sin(0.5), 0.0])
        turns = [round((float(q[0]) - 0.5) / (2.0 * math.pi)) for q in branches.wound(0)]
        assert turns == [0, -1, 1, -2, 2]


class TestSequence:
    def test_it_is_a_sequence_of_configurations(self):
        branches = load_quietly("two_link").solve_all("tip", [0.4, 0.3, 0.0])
        assert len(branches) == 2
        assert bool(branches)
        assert all(np.array_equal(a, b) for a, b in zip(branches, branches.q, strict=True))
        assert np.array_equal(branches[1], branches.q[1])
        assert str(branches) == branches.message

    def test_distances_are_the_largest_changes(self):
        robot, start = load_quietly("two_link"), np.array([0.3, -0.4])
        branches = robot.solve_all("tip", [0.4, 0.3, 0.0], q0=start)
        assert branches.distance == pytest.approx([np.abs(q - start).max() for q in branches])
        assert all(a <= b + 1e-9 for a, b in itertools.pairwise(branches.distance))

    def test_errors_are_those_of_plain_pinocchio(self):
        robot = load_quietly("ur5")
        branches = robot.solve_all("tool0", [0.4, 0.1, 0.4])
        for q, errors, position, orientation in zip(
            branches, branches.errors, branches.position_error, branches.orientation_error, strict=True
        ):
            missed = np.linalg.norm(robot.placement("tool0", q).translation - [0.4, 0.1, 0.4])
            assert errors[0].position == pytest.approx(missed, abs=1e-12)
            assert position == pytest.approx(missed, abs=1e-12)
            assert missed <= 1e-9
            assert np.isnan(orientation)


def test_too_few_starts_tell_nothing_of_what_is_missing(ur5):
    angles = {"shoulder_lift_joint": -1.0, "elbow_joint": 1.2, "wrist_2_joint": 0.5}
    place = ur5.placement("tool0", ur5.configuration(angles))
    few = ur5.solve_all("tool0", placement=place, restarts=0)
    assert math.isinf(few.estimate_missing)
    assert "from 1 start, too few to tell" in few.message


def test_the_first_joint_of_two_equal_bones_is_free_where_the_target_is_at_its_base():
    robot = pinik.load(hinge_arm("zz", [(0, 0, 0), (0.5, 0, 0), (0.5, 0, 0)], (-4.0, 4.0)))
    branches = robot.solve_all("tip", [0.0, 0.0, 0.0], method="two_bone")
    assert branches.success
    assert (branches.is_complete, branches.redundancy) == (False, 1)


@pytest.mark.parametrize("engine", ["python", "auto"])
def test_where_no_joint_is_free_there_is_no_answer_and_the_reason_is_told(ur5, engine):
    branches = ur5.solve_all("tool0", [0.4, 0.1, 0.4], locked=list(ur5.joint_names), engine=engine)
    assert not branches
    assert "no free joint" in branches.message


def test_a_pickled_copy_has_the_families_of_the_original_and_not_its_compiled_problem(panda):
    place = panda.placement("panda_hand_tcp", panda.poses["default"])
    branches = panda.solve_all("panda_hand_tcp", placement=place, restarts=8)
    pickled = pickle.dumps(branches)
    assert len(pickle.loads(pickled).families) == len(branches.families) > 0
    assert b"pinik.problem.problem" not in pickled


def test_a_self_motion_of_two_points_has_the_ends_of_its_arc(panda):
    motion = panda.self_motion("panda_hand_tcp", panda.poses["default"], points=2)
    assert len(motion.q) == 2


class TestTheJointThatMovesMost:
    """A slide along x carries a hinge about z with a bar of 0.4 m, or the hinge alone follows the slide."""

    X, Z = '<axis xyz="1 0 0"/>', '<axis xyz="0 0 1"/>'
    BAR = joint("end", "bar", "tip", '<origin xyz="0.4 0 0"/>', kind="fixed", limit="")

    @pytest.mark.parametrize("engine", ["python", "auto"])
    def test_its_change_is_in_metres_if_it_slides_and_in_radians_if_it_turns(self, engine):
        slide = joint("slide", "base", "cart", self.X, kind="prismatic")
        links = [link(name) for name in ("base", "cart", "bar", "tip")]
        machine = pinik.load(robot(*links, slide, joint("elbow", "cart", "bar", self.Z), self.BAR))
        branches = machine.solve_all("tip", [1.0, 0.1, 0.0], q0=[0.1, 0.05], engine=engine)
        bend = math.asin(0.1 / 0.4)
        ways = [[1.0 - 0.4 * math.cos(turn) - 0.1, turn - 0.05] for turn in (bend, math.pi - bend)]
        assert ways[0][0] > ways[0][1]
        assert branches.distance == pytest.approx([ways[0][0], ways[1][1]], abs=1e-8)
        assert branches.farthest_joint == ["slide", "elbow"]
        assert branches.distance_unit == ["m", "rad"]
        told = [(row["farthest_joint"], row["distance_unit"]) for row in branches.to_dict()["branches"]]
        assert told == [("slide", "m"), ("elbow", "rad")]
        assert pickle.loads(pickle.dumps(branches)).distance_unit == ["m", "rad"]

    def test_a_slide_that_only_turns_its_follower_is_told_in_metres(self):
        slide = joint("slide", "base", "cart", self.X, kind="prismatic")
        follower = joint("elbow", "base", "bar", self.Z, '<mimic joint="slide" multiplier="2"/>')
        links = [link(name) for name in ("base", "cart", "bar", "tip")]
        machine = pinik.load(robot(*links, slide, follower, self.BAR))
        branches = machine.solve_all("tip", [0.4 * math.cos(0.6), 0.4 * math.sin(0.6), 0.0])
        assert (branches.farthest_joint, branches.distance_unit) == (["slide"], ["m"])
        assert branches.distance == pytest.approx([0.3], abs=1e-8)

    def test_a_free_root_is_told_with_the_unit_of_its_largest_coordinate(self):
        machine = load_quietly("two_link", root="free_flyer")
        branches = machine.solve_all("tip", [3.0, 0.0, 0.0], locked=["joint1", "joint2"], restarts=4)
        step = np.array([pinocchio.difference(machine.model, machine.neutral(), q) for q in branches])
        assert branches.distance == pytest.approx(np.abs(step).max(axis=1))
        wanted = ["m" if k < 3 else "rad" for k in np.abs(step).argmax(axis=1)]
        assert branches.distance_unit == wanted
        assert set(branches.farthest_joint) == {machine.model.names[1]}


class TestMethodsThatMissAnswers:
    def test_what_slow_methods_leave_out_is_not_denied(self, ur5):
        """Of these poses "dls" finds all; "ccd" and "jt" find fewer, and never say that none is missing."""
        rng, fewer = np.random.default_rng(0), 0
        for _ in range(4):
            place = ur5.placement("tool0", ur5.random(rng))
            whole = ur5.solve_all("tool0", placement=place)
            for method in ("ccd", "jt"):
                found = ur5.solve_all("tool0", placement=place, method=method, max_iterations=100)
                fewer += len(found) < len(whole)
                assert math.isinf(found.estimate_missing)
                assert found.to_dict()["estimate_missing"] is None
                assert "none seems" not in found.message
        assert fewer > 0

    @pytest.mark.parametrize(("arrived", "told"), [(56, True), (28, True), (27, False), (1, False)])
    def test_where_few_starts_arrive_nothing_is_told(self, arrived, told):
        some = made(arrived=arrived, starts=56)
        assert math.isfinite(some.estimate_missing) == told
        assert (f"only {arrived} arrived, too few to tell" in some.message) == (not told)

    def test_a_start_that_leads_nowhere_has_not_arrived(self):
        robot = load_quietly("two_link")
        near = robot.solve_all("tip", [0.5, 0.3, 0.0])
        assert near.arrived == near.hits.sum() == near.starts  # two bones always lead to one of both answers
        assert robot.solve_all("tip", [5.0, 0.0, 0.0]).arrived == 0
