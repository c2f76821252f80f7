"""The search for all answers, and what it starts from: both engines alike, spread out, and within its bounds."""

from __future__ import annotations

import subprocess
import sys
import textwrap
import time

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from every_answer import hinge_arm, puma
from pinik import Target
from pinik.problem.kinematics import Kinematics
from pinik.solving.metric import Metric
from pinik.solving.native.codec import goals_of
from pinik.solving.spread import NEAREST, SIZE, Spread
from robots import load_quietly

Q = np.array([0.4, -0.5, 1.1, 0.7, 0.8, -1.2])


def spread_of(robot: pinik.Robot, target: Target, seed: int = 0, **options) -> tuple[Spread, pinik.Prepared]:
    prepared = pinik.prepare(robot, target, engine="python", seed=seed, **options)
    kinematics = Kinematics.of(prepared.question.problem)
    kinematics.retarget(prepared.targets)
    return Spread(kinematics, prepared.question.limits, seed), prepared


class TestStarts:
    def test_the_first_values_are_the_additive_recurrence(self):
        robot = load_quietly("ur5")
        spread, _ = spread_of(robot, Target("tool0", placement=robot.placement("tool0", Q)))
        spread.begin(robot.neutral())
        shares = np.array([spread.take(k, robot.neutral()) for k in range(6)])
        shares = (shares - robot.lower) / (robot.upper - robot.lower)
        root = max(np.roots([1.0, *[0.0] * 5, -1.0, -1.0]).real)  # φ⁷ = φ + 1
        steps = np.diff(shares, axis=0) % 1.0
        assert np.sort(steps, axis=1) == pytest.approx(np.tile(np.sort(root ** -np.arange(1.0, 7.0)), (5, 1)), abs=1e-9)

    def test_it_covers_the_ranges_of_all_joints_evenly(self):
        robot = load_quietly("ur5")
        spread, _ = spread_of(robot, Target("tool0", placement=robot.placement("tool0", Q)))
        spread.begin(robot.neutral())
        points = np.array([spread.take(k, robot.neutral()) for k in range(SIZE)])
        points = (points - robot.lower) / (robot.upper - robot.lower)
        assert (points >= 0.0).all()
        assert (points < 1.0).all()
        for column in points.T:
            assert np.bincount((8.0 * column).astype(int)) == pytest.approx(np.full(8, SIZE / 8), rel=0.1)

    def test_starts_are_near_the_target_and_far_from_each_other(self):
        robot = load_quietly("ur5")
        wanted = robot.placement("tool0", Q)
        spread, _ = spread_of(robot, Target("tool0", placement=wanted))
        assert spread.begin(robot.neutral()) == NEAREST
        starts = [spread.next() for _ in range(NEAREST)]
        assert len({tuple(q) for q in starts}) == NEAREST
        everywhere = [spread.take(k, robot.neutral()) for k in range(0, SIZE, 8)]
        near, far = (
            np.median([np.linalg.norm(robot.placement("tool0", q).translation - wanted.translation) for q in some])
            for some in (starts, everywhere)
        )
        assert near < 0.7 * far

        def gap(q, others):
            return min(np.linalg.norm((q - other + np.pi) % (2.0 * np.pi) - np.pi) for other in others)

        gaps = [gap(starts[k], starts[:k]) for k in range(1, NEAREST)]
        # The farthest of the rest can only come nearer. Half a turn of the joint that makes none is far, too.
        assert np.mean(gaps[:10]) > 1.5 * np.mean(gaps[-10:])

    def test_an_answer_that_is_marked_is_avoided(self):
        robot = load_quietly("z1")
        wanted = robot.placement("link06", 0.3 * robot.lower + 0.7 * robot.upper)
        spread, _ = spread_of(robot, Target("link06", placement=wanted))
        spread.begin(robot.neutral())
        first = spread.next()
        spread.begin(robot.neutral())
        spread.mark(first)
        assert not np.array_equal(spread.next(), first)

    def test_a_seed_shifts_all(self):
        robot = load_quietly("ur5")
        target = Target("tool0", placement=robot.placement("tool0", Q))
        one, other = (spread_of(robot, target, seed=seed)[0] for seed in (1, 2))
        for spread in (one, other):
            spread.begin(robot.neutral())
        width = robot.upper - robot.lower
        moved, again = ((one.take(k, robot.neutral()) - other.take(k, robot.neutral())) / width for k in (5, 9))
        assert (np.abs(moved) > 1e-3).any()
        assert np.abs((moved - again) - np.round(moved - again)).max() < 1e-9

    def test_locked_joints_stay(self):
        robot = load_quietly("ur5")
        spread, _ = spread_of(robot, Target("tool0", position=[0.4, 0.1, 0.4]), locked=["elbow_joint"])
        start = robot.configuration({"elbow_joint": 0.7})
        spread.begin(start)
        assert {float(spread.next()[2]) for _ in range(20)} == {0.7}

    def test_without_a_joint_of_one_axis_there_is_nothing_to_draw(self):
        robot = load_quietly("two_link", root="free_flyer")
        target = Target("tip", placement=pinocchio.SE3.Identity())
        branches = robot.solve_all(target, locked=["joint1", "joint2"])
        assert branches.starts == 1
        assert len(branches) == 1

    @needs_native
    @pytest.mark.parametrize("name", ["ur5", "z1", "kinova", "so101", "panda"])
    def test_both_engines_go_through_the_same_starts(self, name):
        robot = load_quietly(name)
        frame = {"ur5": "tool0", "z1": "link06", "so101": "gripper_frame_link", "panda": "panda_link8"}
        frame = frame.get(name, "j2s6s200_end_effector")
        rng, same = np.random.default_rng(0), 0
        for _ in range(10):
            words = {"placement": robot.placement(frame, robot.random(rng)), "q0": robot.random(rng), "restarts": 8}
            native, python = (robot.solve_all(frame, engine=engine, **words) for engine in ("native", "python"))
            same += (
                native.found_at.tolist() == python.found_at.tolist() and native.hits.tolist() == python.hits.tolist()
            )
        assert same >= 7  # where rounding decides between two starts or steps, they part


class TestDistances:
    def test_whole_turns_are_no_change_and_lengths_count_as_lengths_of_the_chain(self):
        text = hinge_arm("zzx", [(0, 0, 0), (0.6, 0, 0), (0.4, 0, 0), (0.5, 0, 0)], (-7.0, 7.0), j3="prismatic")
        robot = pinik.load(text)
        prepared = pinik.prepare(robot, Target("tip", [0.5, 0.2, 0.0]))
        problem = prepared.question.problem
        metric = Metric(problem, prepared.question.limits)
        a, b = np.array([0.1, 0.2, 0.0]), np.array([0.1 + 2.0 * np.pi, 0.5, 0.2])
        size = problem.size_of_chain
        assert metric.largest(a, b) == pytest.approx(max(0.3, 0.2 / size))
        assert metric.length(a, b) == pytest.approx(np.hypot(0.3, 0.2 / size))

    def test_a_joint_that_cannot_turn_is_far_away_after_a_turn(self):
        robot = load_quietly("kinova")
        prepared = pinik.prepare(robot, Target("j2s6s200_end_effector", [0.3, 0.2, 0.4]))
        metric = Metric(prepared.question.problem, prepared.question.limits)
        a = robot.neutral()
        b = robot.configuration({"j2s6s200_joint_1": 2.0 * np.pi - 0.1})
        assert metric.largest(a, b) == pytest.approx(0.1)


class TestEnds:
    def test_isolated_answers_take_56_to_129_starts_and_families_32(self):
        robot = pinik.load(puma())
        assert 56 <= robot.solve_all("tip", placement=robot.placement("tip", Q)).starts <= 129
        assert robot.solve_all("tip", [0.4, 0.2, 0.5]).starts == 32

    @pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
    def test_hits_are_starts_that_led_to_an_answer(self, engine):
        robot = pinik.load(puma())
        branches = robot.solve_all("tip", placement=robot.placement("tip", Q), engine=engine)
        assert branches.hits.sum() <= branches.starts
        assert (branches.hits >= 2).all()
        assert (branches.found_at < branches.starts).all()
        assert len(set(branches.found_at.tolist())) == len(branches)

    @pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
    def test_ctrl_c_ends_it(self, engine):
        program = textwrap.dedent(f"""
            import signal, threading, time, pinik
            signal.signal(signal.SIGINT, signal.default_int_handler)
            arm = pinik.load("arm")
            threading.Timer(0.3, signal.raise_signal, [signal.SIGINT]).start()
            began = time.perf_counter()
            try:
                while time.perf_counter() - began < 20.0:
                    arm.solve_all("tip", [0.3, 0.2, 0.5], rpy=[0.1, 0.2, 0.3], method="jt", engine={engine!r})
                print("never")
            except KeyboardInterrupt:
                print("ended")
        """)
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
        assert done.stdout == "ended\n", done.stderr


class TestOrder:
    @needs_native
    def test_answers_at_equal_distances_come_in_the_order_of_their_angles_in_both_engines(self):
        robot = pinik.load(hinge_arm("zz", [(0, 0, 0), (0.5, 0, 0), (0.5, 0, 0)], (-3.1, 3.1)))
        rng, ties = np.random.default_rng(2), 0
        for _ in range(60):
            radius, angle = rng.uniform(0.2, 0.6), rng.uniform(-0.5, 0.5)
            at = [radius * np.cos(angle), radius * np.sin(angle), 0.0]
            bend = 2.0 * np.arccos(radius)  # of two bones of 0.5 m, one way or the other
            wanted = [[angle - bend / 2.0, bend], [angle + bend / 2.0, -bend]]
            if abs(angle) + bend / 2.0 > bend:
                continue
            ties += 1  # the elbow, which turns the farthest, turns as far in both
            for engine in ("native", "python"):
                assert robot.solve_all("tip", position=at, engine=engine).q == pytest.approx(np.array(wanted), abs=1e-6)
        assert ties > 40


class TestTime:
    def test_the_solve_after_a_search_without_an_answer_has_what_is_left_of_the_time(self, monkeypatch):
        robot = load_quietly("so101")
        wanted = robot.placement("gripper_frame_link", 0.3 * robot.random(np.random.default_rng(1)))
        wanted.rotation = wanted.rotation @ pinocchio.utils.rotate("z", 0.3)
        words = {"placement": wanted, "engine": "python", "restarts": 20}
        ticks = iter(range(10**9))
        monkeypatch.setattr(time, "perf_counter", lambda: 0.1 * next(ticks))
        unlimited = robot.solve_all("gripper_frame_link", time_limit=1e6, **words)
        assert unlimited.status is pinik.Status.STALLED
        enough = 0.95 * unlimited.time
        branches = robot.solve_all("gripper_frame_link", time_limit=enough, **words)
        assert not branches
        assert branches.status is pinik.Status.TIME_LIMIT
        assert enough < branches.time < enough + 1.0

    @needs_native
    def test_time_that_is_spent_counts_in_the_compiled_engine(self):
        robot = load_quietly("so101")
        wanted = robot.placement("gripper_frame_link", 0.3 * robot.random(np.random.default_rng(1)))
        prepared = pinik.prepare(robot, Target("gripper_frame_link", placement=wanted), time_limit=50.0)
        goals = goals_of(prepared.targets)
        ended = pinik.Solution(prepared.native.solve(robot.neutral(), goals, False, 60.0), prepared.question, {})
        assert ended.status is pinik.Status.TIME_LIMIT
        assert ended.time > 60.0
        assert prepared.native.solve(robot.neutral(), goals, False, 10.0).iterations > ended.iterations


class TestWideSlides:
    BONES = (0.5, 0.3)

    @pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
    @pytest.mark.parametrize("limits", [True, False])
    def test_a_rail_without_end_is_searched_around_the_start(self, engine, limits):
        a, b = self.BONES
        steps = [(0, 0, 0), (0, 0, 0), (a, 0, 0), (b, 0, 0)]
        robot = pinik.load(hinge_arm("xzz", steps, (-1e6, 1e6), j1="prismatic"))
        for place in (5000.0, -123456.7):
            x, y, heading = place + 0.4, 0.35, 0.8
            wanted = []
            for first in (np.arcsin((y - b * np.sin(heading)) / a), np.pi - np.arcsin((y - b * np.sin(heading)) / a)):
                wanted.append([x - a * np.cos(first) - b * np.cos(heading), first, heading - first])
            target = pinocchio.SE3(pinocchio.utils.rotate("z", heading), np.array([x, y, 0.0]))
            q0 = np.array([place, 0.1, 0.1])
            branches = robot.solve_all("tip", placement=target, q0=q0, limits=limits, engine=engine)
            found = branches.q[np.argsort(branches.q[:, 1])]
            assert found == pytest.approx(np.array(wanted), abs=1e-6)
            assert branches.estimate_missing == 0.0
            assert branches.hits.sum() > 40

    def test_starts_slide_by_the_length_of_the_chain_around_the_given_one(self):
        steps = [(0, 0, 0), (0, 0, 0), (self.BONES[0], 0, 0), (self.BONES[1], 0, 0)]
        robot = pinik.load(hinge_arm("xzz", steps, (-1e6, 1e6), j1="prismatic"))
        spread, _ = spread_of(robot, Target("tip", position=[700.0, 0.1, 0.0]))
        for start in (700.0, 700.1, -3.0, 700.0):
            spread.begin(np.array([start, 0.0, 0.0]))
            slides = np.array([spread.next()[0] for _ in range(NEAREST)])
            assert np.abs(slides - start).max() <= 1.5 * sum(self.BONES)
            assert np.ptp(slides) > 0.3


class TestSamples:
    @pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
    def test_starts_that_lead_to_colliding_answers_do_not_count_where_there_are_infinitely_many(self, panda, engine):
        place = panda.placement("panda_hand_tcp", panda.poses["default"])
        world = pinik.World()
        world.add_box("wall", (0.05, 0.4, 0.6), (0.1, -0.45, 0.5))
        words = {"placement": place, "engine": engine}
        branches = panda.solve_all("panda_hand_tcp", avoid=["self", world], **words)
        open_ = panda.solve_all("panda_hand_tcp", **words)
        assert open_.starts == 32
        assert branches.colliding > 0
        assert branches.starts >= 32 + branches.colliding
        assert all(not panda.collisions(q, world=world) for q in branches)
        few = panda.solve_all("panda_hand_tcp", avoid=["self", world], restarts=31, **words)
        assert len(few) < len(branches)


@needs_native
def test_a_placement_of_a_question_that_is_known_goes_straight_to_the_compiled_engine(ur5, monkeypatch):
    place = ur5.placement("tool0", Q)
    before = ur5.solve_all("tool0", placement=place)
    monkeypatch.setattr(sys.modules["pinik.solving.solve_all"], "asked_targets", None)  # reads targets anew
    for same in (place, place.homogeneous):
        again = ur5.solve_all("tool0", placement=same)
        assert np.array_equal(again.q, before.q)
        assert again.targets[0].rotation == pytest.approx(place.rotation, abs=1e-15)
