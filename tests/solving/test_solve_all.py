"""`solve_all`: all answers and no other, against closed forms and against a search in plain numpy."""

from __future__ import annotations

import concurrent.futures
import json
import math
import pickle

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from every_answer import Arm, hinge_arm, inside, planar_answers, puma, puma_answers, turned_near, unlike, whole_turns
from judge import is_good
from pinik import InputError, Status, Target, UnknownNameError
from robots import load_quietly
from urdf_texts import joint, link

every_engine = pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
EXACT = (1e-8, 1e-8)  # [m], [rad]
PLANAR = (0.5, 0.4, 0.2)  # [m]
ARMS = {"ur5": "tool0", "z1": "link06", "kinova": "j2s6s200_end_effector"}
REGULAR = 0.02  # the smallest singular value at all branches of the poses that are compared


def planar(bounds=(-3.1, 3.1)) -> str:
    return hinge_arm("zzz", [(0.0, 0.0, 0.0), *[(length, 0.0, 0.0) for length in PLANAR]], bounds)


def angles_of(branches: pinik.Branches, names) -> list[np.ndarray]:
    return [np.array([angles[name] for name in names]) for angles in branches.angles]


def unequal(branches: pinik.Branches, wanted, near: float = 1e-6):
    names = branches.robot.joint_names
    return unlike(angles_of(branches, names), wanted, near)


def in_plane(x: float, y: float, heading: float) -> pinocchio.SE3:
    return pinocchio.SE3(pinocchio.utils.rotate("z", heading), np.array([x, y, 0.0]))


class TestAgainstClosedForms:
    @every_engine
    @pytest.mark.parametrize("place", [(0.6, 0.3, 1.0), (-0.2, 0.5, -2.0), (-0.3, -0.4, 2.0)])
    def test_three_parallel_hinges_have_two_answers(self, place, engine):
        robot = pinik.load(planar())
        wanted = inside(planar_answers(PLANAR, *place), robot.lower, robot.upper)
        assert len(wanted) == 2
        branches = robot.solve_all("tip", placement=in_plane(*place), engine=engine)
        assert unequal(branches, wanted) == ([], [])
        assert branches.engine == engine
        assert branches.redundancy == 0

    @every_engine
    def test_a_spherical_wrist_has_eight_answers(self, engine):
        text = puma()
        robot, arm, rng = pinik.load(text), Arm(text, "tip"), np.random.default_rng(3)
        counts = []
        while len(counts) < 8:
            placement = arm.placement(arm.random(rng))
            wanted = inside(puma_answers(placement), robot.lower, robot.upper)
            if min(map(arm.least_singular_value, wanted)) < REGULAR:
                continue
            counts.append(len(wanted))
            assert unequal(robot.solve_all("tip", placement=placement, engine=engine), wanted) == ([], [])
        assert max(counts) == 8

    def test_two_bones_with_their_position_alone(self):
        robot = load_quietly("two_link")
        bones = pinik.TwoBone.of(robot, "tip").solve([0.4, 0.3, 0.0])
        wanted = [q for q, is_inside in zip(bones.q, bones.inside, strict=True) if is_inside]
        branches = robot.solve_all("tip", position=[0.4, 0.3, 0.0])
        assert len(wanted) == 2
        assert unequal(branches, wanted) == ([], [])
        assert not branches.is_complete

    def test_a_closed_form_is_complete(self):
        robot = load_quietly("two_link")
        searched = robot.solve_all("tip", position=[0.4, 0.3, 0.0])
        branches = robot.solve_all("tip", position=[0.4, 0.3, 0.0], method="two_bone")
        assert unequal(branches, searched.q) == ([], [])
        assert branches.is_complete
        assert branches.estimate_missing == 0.0
        assert "all" in branches.message
        assert (np.diff(branches.distance) >= 0.0).all()

    def test_a_closed_form_without_an_answer(self):
        branches = load_quietly("two_link").solve_all("tip", position=[4.0, 0.3, 0.0], method="two_bone")
        assert not branches
        assert branches.status is Status.UNREACHABLE
        assert branches.is_complete

    def test_a_straight_arm_has_one_answer(self):
        robot = load_quietly("two_link")
        branches = robot.solve_all("tip", position=[0.9, 0.0, 0.0], method="two_bone")
        assert len(branches) == 1
        assert branches[0] == pytest.approx([0.0, 0.0], abs=1e-6)


class TestAgainstSearchInNumpy:
    @every_engine
    @pytest.mark.parametrize("name", ARMS)
    def test_poses_of_an_arm(self, name, engine):
        robot = load_quietly(name)
        arm, rng, done = Arm(robot.urdf, ARMS[name]), np.random.default_rng(11), 0
        while done < 3:
            placement = arm.placement(arm.random(rng))
            everywhere = arm.answers(placement, seed=done)
            wanted = inside(everywhere, arm.lower, arm.upper)
            if min(map(arm.least_singular_value, everywhere)) < REGULAR:
                continue
            done += 1
            branches = robot.solve_all(ARMS[name], placement=placement, engine=engine)
            assert unlike(angles_of(branches, arm.names), wanted) == ([], [])

    def test_a_sliding_joint(self):
        steps = [(0, 0, 0.2), (0, 0, 0.1), (0.3, 0, 0), (0.2, 0, 0), (0.1, 0, 0), (0, 0, 0), (0.1, 0, 0)]
        text = hinge_arm("zzyxyx", steps, (-2.5, 2.5), j2="prismatic")
        robot, arm, rng = pinik.load(text), Arm(text, "tip"), np.random.default_rng(5)
        for seed in range(3):
            placement = arm.placement(arm.random(rng))
            found = arm.answers(placement, seed=seed)
            # The search of the test turns all joints alike: what slides is not brought back by whole turns here.
            wanted = [q for q in found if np.abs(arm.placement(q) - placement).max() < 1e-9 and abs(q[1]) <= 2.5]
            wanted = inside(wanted, arm.lower, arm.upper)
            assert unequal(robot.solve_all("tip", placement=placement), wanted) == ([], [])


class TestLimits:
    def test_answers_outside_are_left_out(self):
        place = (0.6, 0.3, 1.0)
        both = planar_answers(PLANAR, *place)
        low = min(q[1] for q in both)
        robot = pinik.load(planar().replace("-3.1", repr(float(low) + 0.1)))
        wanted = inside(both, robot.lower, robot.upper)
        assert len(wanted) == 1
        assert unequal(robot.solve_all("tip", placement=in_plane(*place)), wanted) == ([], [])
        free = robot.solve_all("tip", placement=in_plane(*place), limits=False)
        assert unequal(free, both) == ([], [])

    def test_an_answer_at_a_limit_belongs_to_them(self):
        place = (0.6, 0.3, 1.0)
        both = planar_answers(PLANAR, *place)
        robot = pinik.load(planar().replace("-3.1", repr(float(min(q[1] for q in both)))))
        wanted = inside(both, robot.lower, robot.upper)
        assert unequal(robot.solve_all("tip", placement=in_plane(*place)), wanted) == ([], [])

    @every_engine
    def test_whole_turns_are_one_branch_and_are_counted_apart(self, engine):
        text = puma((-2.0 * math.pi, 2.0 * math.pi))
        robot, arm = pinik.load(text), Arm(text, "tip")
        placement = arm.placement(np.array([0.4, -0.5, 1.1, 0.7, 0.8, -1.2]))
        branches = robot.solve_all("tip", placement=placement, engine=engine)
        wanted = puma_answers(placement)
        assert len(wanted) == 8
        assert unequal(branches, wanted) == ([], [])
        for index, q in enumerate(branches):
            ways = list(branches.wound(index))
            assert len(ways) == len(whole_turns(turned_near(q), robot.lower, robot.upper)) == 64
            assert len({tuple(np.round(way, 6)) for way in ways}) == 64
            assert np.array_equal(ways[0], q)
            for way in ways:
                assert (robot.lower <= way).all()
                assert (way <= robot.upper).all()
        assert np.abs(arm.placement(ways[-1]) - placement).max() < 1e-8

    def test_branches_are_at_the_turn_nearest_to_the_start(self):
        robot = pinik.load(puma((-2.0 * math.pi, 2.0 * math.pi)))
        start = np.array([5.0, -4.0, 1.1, 0.7, 0.8, -6.0])
        near = robot.solve_all("tip", placement=robot.placement("tip", start), q0=start)
        assert near[0] == pytest.approx(start, abs=1e-7)
        assert near.distance[0] == pytest.approx(0.0, abs=1e-7)
        for q in near:
            others = np.array([q - 2.0 * math.pi, q + 2.0 * math.pi])
            possible = (np.abs(others) <= 2.0 * math.pi) & (np.abs(others - start) < np.abs(q - start) - 1e-9)
            assert not possible.any()


class TestKindsOfQuestions:
    @every_engine
    def test_positions_alone_have_infinitely_many_answers(self, engine):
        robot = load_quietly("ur5")
        branches = robot.solve_all("tool0", position=[0.4, 0.2, 0.4], engine=engine)
        assert branches.redundancy == 3
        assert math.isinf(branches.estimate_missing)
        assert branches.to_dict()["estimate_missing"] is None
        assert len(branches) >= 8
        assert "infinitely many" in branches.message
        for q in branches:
            assert is_good(robot, {"frame": "tool0", "position": [0.4, 0.2, 0.4]}, q, EXACT)

    def test_seven_joints_have_one_dimension_left(self):
        robot = load_quietly("panda")
        q = robot.random(np.random.default_rng(2))
        branches = robot.solve_all("panda_link8", placement=robot.placement("panda_link8", q))
        assert branches.redundancy == 1
        assert len(branches) >= 8
        for other in branches:
            asked = {"frame": "panda_link8", "placement": robot.placement("panda_link8", q)}
            assert is_good(robot, asked, other, EXACT)

    def test_a_locked_joint_takes_the_dimension_away(self):
        robot = load_quietly("panda")
        q = robot.random(np.random.default_rng(2))
        words = {"placement": robot.placement("panda_link8", q), "locked": ["panda_joint7"]}
        branches = robot.solve_all("panda_link8", q0=q, **words)
        assert branches.redundancy == 0
        assert branches[0] == pytest.approx(q, abs=1e-7)
        arm = Arm(robot.urdf, "panda_link8", held={"panda_joint7": q[6]})
        everywhere = arm.answers(words["placement"].homogeneous)
        wanted = inside(everywhere, arm.lower, arm.upper)
        assert len(wanted) >= 2
        assert unlike(angles_of(branches, arm.names), wanted) == ([], [])

    @every_engine
    def test_several_targets_on_two_arms_multiply(self, engine):
        one, two = (hinge_arm("zz", [(0, side, 0), (0.5, 0, 0), (0.4, 0, 0)], (-3.0, 3.0)) for side in (0.5, -0.5))
        body = one.replace('"l0"', '"base"').removeprefix('<robot name="r">').removesuffix("</robot>")
        other = two.removeprefix('<robot name="r">').removesuffix("</robot>")
        for name in ("l0", "l1", "l2", "j1", "j2", "tip", "end"):
            other = other.replace(f'"{name}"', '"base"' if name == "l0" else f'"other_{name}"')
        robot = pinik.load(f'<robot name="r">{body}{other.replace("""<link name="base"></link>""", "")}</robot>')
        targets = [Target("tip", [0.5, 0.8, 0.0]), Target("other_tip", [0.6, -0.4, 0.0])]
        branches = robot.solve_all(targets, engine=engine)
        sides = []
        for side, target in zip((0.5, -0.5), targets, strict=True):
            x, y = target.position[0], target.position[1] - side
            bend = math.acos((x * x + y * y - 0.25 - 0.16) / 0.4)
            turns = [
                (math.atan2(y, x) - math.atan2(0.4 * math.sin(b), 0.5 + 0.4 * math.cos(b)), b) for b in (bend, -bend)
            ]
            sides.append(turns)
        names = ["j1", "j2", "other_j1", "other_j2"]
        wanted = [np.array([*a, *b]) for a in sides[0] for b in sides[1]]
        assert len(wanted) == 4
        assert unlike(angles_of(branches, names), wanted) == ([], [])

    def test_a_target_relative_to_a_frame_that_moves_and_a_tool(self):
        text = puma()
        robot, tool = pinik.load(text), pinocchio.SE3(pinocchio.utils.rotate("y", 0.4), np.array([0.0, 0.1, 0.05]))
        q = np.array([0.3, -0.4, 1.0, 0.5, 0.9, -0.6])
        wanted = puma_answers(robot.placement("tip", q).homogeneous)
        with_tool = robot.solve_all("tip", placement=robot.placement("tip", q) * tool, tool=tool)
        assert unequal(with_tool, inside(wanted, robot.lower, robot.upper)) == ([], [])
        # Relative to the first link, the first joint does not matter: without it there are four answers.
        relative = robot.placement("tip", q, relative_to="l1")
        branches = robot.solve_all("tip", placement=relative, relative_to="l1", q0=q)
        four = [way for way in wanted if abs(way[0] - q[0]) < 1e-6]
        assert len(four) == 4
        assert unequal(branches, four) == ([], [])

    def test_a_direction_is_less_than_an_orientation(self):
        robot = pinik.load(puma())
        branches = robot.solve_all("tip", position=[0.5, 0.2, 0.5], axis="x", direction=[0, 0, -1])
        assert branches.redundancy == 1
        for q in branches:
            asked = {"frame": "tip", "position": [0.5, 0.2, 0.5], "axis": "x", "direction": [0, 0, -1]}
            assert is_good(robot, asked, q, EXACT)

    @every_engine
    def test_continuous_joints_have_angles_near_their_start(self, engine):
        robot = load_quietly("kinova")
        q = robot.random(np.random.default_rng(4))
        turned = {name: value + 4.0 * math.pi for name, value in robot.angles(q).items() if robot.joint(name).nq == 2}
        words = {"placement": robot.placement(ARMS["kinova"], q), "q0": {**robot.angles(q), **turned}}
        branches = robot.solve_all(ARMS["kinova"], engine=engine, **words)
        for name, value in turned.items():
            assert branches.angles[0][name] == pytest.approx(value, abs=1e-6)
        assert branches.windings.any() == any(
            upper - lower > 2.0 * math.pi for lower, upper in zip(robot.lower, robot.upper, strict=True)
            if math.isfinite(upper - lower)
        )  # fmt: skip

    @every_engine
    def test_a_follower_moves_with_its_leader(self, engine):
        text = hinge_arm("zz", [(0, 0, 0), (0.5, 0, 0), (0.4, 0, 0)], (-3.0, 3.0))
        follower = joint(
            "f", "tip", "finger", '<origin xyz="0.1 0 0"/>', '<axis xyz="0 0 1"/>',
            '<mimic joint="j2" multiplier="-1" offset="0.5"/>',
        )  # fmt: skip
        point = joint("g", "finger", "point", '<origin xyz="0.2 0 0"/>', kind="fixed", limit="")
        robot = pinik.load(text.replace("</robot>", f"{link('finger')}{link('point')}{follower}{point}</robot>"))
        q = robot.configuration({"j1": 0.3, "j2": 1.1})
        at = robot.placement("point", q).translation
        branches = robot.solve_all("point", position=at, engine=engine)
        # A grid of angles: all places of j2 at which the point has the same distance from j1.
        j2 = np.linspace(-3.0, 3.0, 54_321)
        far = np.hypot(*_point_of(j2)) - np.hypot(at[0], at[1])
        crossings = j2[:-1][np.sign(far[:-1]) != np.sign(far[1:])]
        wanted = []
        for second in crossings:
            x, y = _point_of(second)
            first = float(turned_near(np.array(math.atan2(at[1], at[0]) - math.atan2(y, x))))
            wanted += [np.array([first, second])] if abs(first) <= 3.0 else []
        assert len(wanted) >= 2
        assert unlike(angles_of(branches, ["j1", "j2"]), wanted, near=1e-3) == ([], [])

    def test_a_floating_root_is_one_family(self):
        robot = load_quietly("two_link", root="free_flyer")
        branches = robot.solve_all("tip", placement=pinocchio.SE3.Identity())
        assert branches.redundancy == 2
        assert branches.success
        for q in branches:
            assert is_good(robot, {"frame": "tip", "placement": pinocchio.SE3.Identity()}, q, EXACT)


def _point_of(j2):
    """Where the point of the arm with a follower is for j1 = 0: the finger is turned by j2 − j2 + 0.5."""
    x = 0.5 + (0.4 + 0.1) * np.cos(j2) + 0.2 * math.cos(0.5)
    return x, (0.4 + 0.1) * np.sin(j2) + 0.2 * math.sin(0.5)


class TestWithoutAnExactAnswer:
    @every_engine
    def test_out_of_reach(self, engine):
        branches = load_quietly("ur5").solve_all("tool0", position=[9.0, 0.0, 0.0], rpy=[0, 0, 0], engine=engine)
        assert len(branches) == 0
        assert not branches.success
        assert branches.status is Status.UNREACHABLE
        assert "unreachable" in branches.message
        assert branches.starts == 0
        assert branches.q.shape == (0, 6)
        assert branches.windings.shape == (0, 6, 2)

    @every_engine
    def test_within_the_bound_and_yet_not_reached(self, engine):
        placement = in_plane(0.6, 0.3, 1.0)
        placement.translation[2] = 0.05
        branches = pinik.load(planar()).solve_all("tip", placement=placement, engine=engine)
        assert len(branches) == 0
        assert branches.status not in (Status.CONVERGED, Status.TIME_LIMIT)
        assert branches.message

    @every_engine
    def test_five_joints_and_a_whole_pose_have_the_answer_inside_the_tolerance(self, engine):
        robot = load_quietly("so101")
        q = 0.3 * robot.random(np.random.default_rng(1))
        wanted = robot.placement("gripper_frame_link", q)
        wanted.translation += [2e-5, 0.0, 1e-5]
        wanted.rotation = wanted.rotation @ pinocchio.utils.rotate("z", 2e-4)
        branches = robot.solve_all("gripper_frame_link", placement=wanted, q0=q, engine=engine)
        assert branches.success
        assert branches.status is Status.CONVERGED
        assert "inside the tolerance" in branches.message
        assert is_good(robot, {"frame": "gripper_frame_link", "placement": wanted}, branches[0], (1e-4, 1e-3))
        assert branches.position_error[0] <= 1e-4

    def test_five_joints_and_a_pose_that_they_reach(self):
        robot = load_quietly("so101")
        q = 0.3 * robot.random(np.random.default_rng(1))
        arm = Arm(robot.urdf, "gripper_frame_link")
        wanted = arm.placement(np.array([robot.angles(q)[name] for name in arm.names]))
        branches = robot.solve_all("gripper_frame_link", placement=wanted)
        assert branches.redundancy == 0
        assert unlike(angles_of(branches, arm.names), inside(arm.answers(wanted), arm.lower, arm.upper)) == ([], [])

    @every_engine
    def test_a_time_limit_keeps_what_was_found(self, engine):
        robot = load_quietly("ur5")
        q = np.array([0.4, -0.5, 1.1, 0.7, 0.8, -1.2])
        words = {"placement": robot.placement("tool0", q), "q0": q, "engine": engine}
        robot.solve_all("tool0", **words)  # the table is made
        branches = robot.solve_all("tool0", time_limit=1e-5, **words)
        assert branches.starts < 56
        assert branches.time < 0.5
        if branches.starts:
            assert "time limit" in branches.message or branches.status is Status.TIME_LIMIT

    @every_engine
    def test_no_restarts(self, engine):
        robot = load_quietly("ur5")
        q = np.array([0.4, -0.5, 1.1, 0.7, 0.8, -1.2])
        words = {"placement": robot.placement("tool0", q), "q0": q, "engine": engine}
        branches = robot.solve_all("tool0", restarts=0, **words)
        assert branches.starts == 1
        assert len(branches) == 1
        assert branches.hits.tolist() == [1]
        assert branches.found_at.tolist() == [0]
        assert robot.solve_all("tool0", restarts=9, **words).starts == 10


class TestRepeatable:
    @needs_native
    def test_both_engines_have_the_same_sets(self):
        rng, compared = np.random.default_rng(7), 0
        for name in (*ARMS, "puma"):
            robot = pinik.load(puma()) if name == "puma" else load_quietly(name)
            frame = ARMS.get(name, "tip")
            arm = Arm(robot.urdf, frame)
            for _ in range(8):
                q = robot.random(rng)
                start = robot.random(rng)
                words = {"placement": robot.placement(frame, q), "q0": start}
                native, python = (robot.solve_all(frame, engine=engine, **words) for engine in ("native", "python"))
                found = [angles_of(branches, arm.names) for branches in (native, python)]
                if min(map(arm.least_singular_value, found[0]), default=1.0) < REGULAR:
                    continue
                compared += 1
                assert unlike(*found) == ([], [])
                assert native.distance == pytest.approx(python.distance, abs=1e-6)
        assert compared >= 20

    def test_the_same_seed_gives_the_same_and_another_seed_the_same_set(self):
        robot = load_quietly("ur5")
        words = {"position": [0.4, 0.1, 0.4], "rpy": [0.3, 0.2, 0.1]}
        first, again, other = (robot.solve_all("tool0", seed=seed, **words) for seed in (1, 1, 2))
        assert np.array_equal(first.q, again.q)
        assert first.found_at.tolist() == again.found_at.tolist()
        assert first.hits.tolist() == again.hits.tolist()
        assert first.hits.tolist() != other.hits.tolist() or first.found_at.tolist() != other.found_at.tolist()
        assert unlike(first.q, other.q) == ([], [])

    def test_threads_agree(self):
        robot = load_quietly("ur5")
        rng = np.random.default_rng(9)
        placements = [robot.placement("tool0", robot.random(rng)) for _ in range(20)]

        def ask() -> list[np.ndarray]:
            return [robot.solve_all("tool0", placement=placement).q for placement in placements]

        alone = ask()
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            for found in [each.result() for each in [pool.submit(ask) for _ in range(4)]]:
                assert all(np.array_equal(a, b) for a, b in zip(alone, found, strict=True))


class TestWords:
    def test_the_front_and_the_method_are_one(self):
        robot = load_quietly("ur5")
        target = Target("tool0", [0.4, 0.1, 0.4], rpy=[0.3, 0.2, 0.1])
        a, b = pinik.solve_all(robot, target), robot.solve_all("tool0", [0.4, 0.1, 0.4], rpy=[0.3, 0.2, 0.1])
        assert np.array_equal(a.q, b.q)

    def test_slips_are_named(self):
        robot = load_quietly("ur5")
        with pytest.raises(UnknownNameError, match="position"):
            robot.solve_all("tool0", positon=[0.4, 0.1, 0.4])
        with pytest.raises(UnknownNameError, match="choose"):
            robot.solve_all("tool0", [0.4, 0.1, 0.4], choose="nearest")
        with pytest.raises(InputError, match="nearest"):
            robot.solve_all("tool0", [0.4, 0.1, 0.4], q0="nearest")
        with pytest.raises(InputError, match=r"pinik\.load"):
            pinik.solve_all("ur5", "tool0")

    def test_json(self):
        branches = load_quietly("ur5").solve_all("tool0", [0.4, 0.1, 0.4], rpy=[0.3, 0.2, 0.1])
        told = json.loads(json.dumps(branches.to_dict(), allow_nan=False))
        assert [row["q"] for row in told["branches"]] == branches.q.tolist()
        assert told["starts"] == branches.starts

    def test_pickled_results_are_equal(self):
        branches = load_quietly("ur5").solve_all("tool0", [0.4, 0.1, 0.4], rpy=[0.3, 0.2, 0.1])
        copy = pickle.loads(pickle.dumps(branches))
        assert np.array_equal(copy.q, branches.q)
        assert copy.to_dict() == branches.to_dict()
        assert copy.targets == branches.targets
        assert np.array_equal(copy.windings, branches.windings)
        assert [len(list(copy.wound(i))) for i in range(len(copy))] == [
            len(list(branches.wound(i))) for i in range(len(branches))
        ]
        assert copy.errors == branches.errors
        assert len(pickle.dumps(branches)) < len(pickle.dumps(branches.robot)) + 50_000


@every_engine
@pytest.mark.parametrize("method", ["ccd", "pinv", "dls"])
def test_each_method_finds_the_eight_answers_of_a_ur5(engine, method):
    """A solve stops inside the tolerance; a search goes on until an answer is exact, with any method."""
    robot = load_quietly("ur5")
    place = robot.placement("tool0", [0.3, -1.0, 1.2, 0.4, 0.7, 0.5])
    found = robot.solve_all("tool0", placement=place, method=method, engine=engine)
    assert len(found) == 8
    for q in found:
        assert is_good(robot, [Target("tool0", placement=place)], q, (1e-7, 1e-7))
