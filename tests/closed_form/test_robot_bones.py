"""Two bones of a robot: answers against plain Pinocchio, limits against a grid."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from engines import needs_native
from hinges import two_hinges
from pinik import Status, Target, TwoBone
from robots import load_quietly
from two_bone_cases import configurations, every_case, plain_position

numbers = st.floats(-1.0, 1.0)
vectors = st.tuples(numbers, numbers, numbers)


class TestAnswers:
    @every_case
    def test_both_elbows_hit_by_plain_pinocchio(self, case):
        robot = load_quietly(case.robot)
        bones = TwoBone.of(robot, case.frame, tool=case.tool)
        for q in configurations(robot, 40, seed=4):
            wanted = plain_position(robot, case.frame, q, case.tool)
            found = bones.solve(wanted, limits=case.limits)
            assert found.reachable
            assert sorted(found.elbows) == ["down", "up"]
            for answer, error in zip(found.q, found.errors, strict=True):
                missed = np.linalg.norm(plain_position(robot, case.frame, answer, case.tool) - wanted)
                assert missed <= 1e-12 * (case.l1 + case.l2)
                assert error == pytest.approx(missed, abs=1e-15)

    @given(vectors, vectors, vectors, vectors, vectors, vectors, st.booleans(), vectors)
    def test_however_the_hinges_are_hung(self, at, rpy, second_at, second_rpy, tip_at, axis, against, angles):
        if np.linalg.norm(axis) < 1e-2:
            return
        axis = np.array(axis) / np.linalg.norm(axis)
        own = pinocchio.rpy.rpyToMatrix(np.array(second_rpy)).T @ axis * (-1.0 if against else 1.0)
        text = [" ".join(repr(float(x)) for x in v) for v in (at, rpy, axis, second_at, second_rpy, own, tip_at)]
        robot = pinik.load(f"""<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
          <joint name="first" type="continuous"><parent link="a"/><child link="b"/>
            <origin xyz="{text[0]}" rpy="{text[1]}"/><axis xyz="{text[2]}"/></joint>
          <joint name="second" type="revolute"><parent link="b"/><child link="c"/>
            <origin xyz="{text[3]}" rpy="{text[4]}"/><axis xyz="{text[5]}"/>
            <limit lower="-7" upper="7" effort="1" velocity="1"/></joint>
          <joint name="end" type="fixed"><parent link="c"/><child link="d"/><origin xyz="{text[6]}"/></joint>
        </robot>""")
        l1 = np.linalg.norm(np.cross(axis, second_at))
        l2 = np.linalg.norm(np.cross(own, tip_at))
        if min(l1, l2) < 1e-6 * max(l1, l2, 1e-3):
            return
        bones = TwoBone.of(robot, "d")
        assert (bones.l1, bones.l2) == pytest.approx((l1, l2), rel=1e-9)
        q = robot.configuration({"first": 3.0 * angles[0], "second": 3.0 * angles[1]})
        wanted = plain_position(robot, "d", q)
        found = bones.solve(wanted, q)
        assert found.reachable
        assert abs(found.out_of_plane) < 1e-14
        for answer in found.q:
            assert np.linalg.norm(plain_position(robot, "d", answer) - wanted) <= 1e-12
        normal = pinocchio.rpy.rpyToMatrix(np.array(rpy)) @ axis
        beside = bones.solve(wanted + 0.3 * normal, q)
        assert not beside.reachable
        assert beside.out_of_plane == pytest.approx(0.3, abs=1e-12)
        assert beside.shortfall == pytest.approx(0.3, abs=1e-12)
        assert beside.errors == pytest.approx([0.3, 0.3], abs=1e-12)

    def test_up_and_down_are_as_seen_against_the_first_axis(self, two_link):
        found = TwoBone.of(two_link, "tip").solve([0.7, 0.0, 0.0])
        elbows = {name: plain_position(two_link, "link2", q)[1] for name, q in zip(found.elbows, found.q, strict=True)}
        assert elbows["up"] > 0.1
        assert elbows["down"] == pytest.approx(-elbows["up"])

    def test_the_nearest_to_the_given_q_comes_first(self, two_link):
        bones = TwoBone.of(two_link, "tip")
        for q in configurations(two_link, 20, seed=6):
            found = bones.solve(plain_position(two_link, "tip", q), q)
            assert found.q[0] == pytest.approx(q, abs=1e-7)
            assert np.linalg.norm(found.q[0] - q) <= np.linalg.norm(found.q[1] - q)

    def test_out_of_reach_both_stretch_at_the_target_and_say_how_far_it_is(self, two_link):
        found = TwoBone.of(two_link, "tip").solve([3.0, 4.0, 0.6])
        assert not found.reachable
        assert found.out_of_plane == pytest.approx(0.6)
        assert found.shortfall == pytest.approx(math.hypot(4.1, 0.6))
        assert found.errors == pytest.approx([found.shortfall] * 2)
        assert plain_position(two_link, "tip", found.nearest) == pytest.approx([0.54, 0.72, 0.0])

    def test_with_the_target_on_the_first_axis_the_first_joint_stays(self):
        robot = pinik.load(
            """<robot name="equal"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
            <joint name="one" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
            <joint name="two" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
              <origin xyz="0.4 0 0"/></joint>
            <joint name="end" type="fixed"><parent link="c"/><child link="d"/><origin xyz="0 0.4 0"/></joint></robot>"""
        )
        q = robot.configuration({"one": 1.1, "two": 0.3})
        found = TwoBone.of(robot, "d").solve([0.0, 0.0, 0.0], q)
        assert found.reachable
        assert found.errors.max() < 1e-15
        assert [robot.angles(answer)["one"] for answer in found.q] == pytest.approx([1.1, 1.1])

    @pytest.mark.parametrize("position", [[0.1, 0.2], [0.1, math.nan, 0.0], "here"])
    def test_a_wrong_position_is_refused(self, two_link, position):
        with pytest.raises(pinik.InputError, match="position"):
            TwoBone.of(two_link, "tip").solve(position)


def least_distance_on_a_grid(limits, target, sense: float = 1.0, steps: int = 300) -> float:
    """Of `two_hinges` with these limits, by trying all [m]."""
    first, second = np.meshgrid(*[np.linspace(low, high, steps) for low, high in limits])
    x = 0.5 * np.cos(first) + 0.3 * np.cos(first + sense * second)
    y = 0.5 * np.sin(first) + 0.3 * np.sin(first + sense * second)
    return float(np.sqrt((x - target[0]) ** 2 + (y - target[1]) ** 2 + (target[2] - 0.1) ** 2).min())


ranges = st.tuples(st.floats(-7.0, 7.0), st.floats(0.0, 5.0)).map(lambda r: (r[0], r[0] + r[1]))


class TestLimits:
    @given(ranges, ranges, vectors, vectors, st.sampled_from([1.0, -1.0]))
    def test_nothing_inside_them_is_nearer_than_the_nearest(self, first, second, target, q0, sense):
        robot = two_hinges((first, second), second_axis=f"0 0 {sense}")
        found = TwoBone.of(robot, "hand").solve(target, 3.0 * np.array(q0[:2]))
        assert (found.nearest >= robot.lower).all()
        assert (found.nearest <= robot.upper).all()
        missed = np.linalg.norm(plain_position(robot, "hand", found.nearest) - target)
        assert found.nearest_error == pytest.approx(missed, abs=1e-15)
        least = least_distance_on_a_grid((first, second), target, sense)
        assert missed <= least + 1e-12
        assert missed >= least - 0.8 * 5.0 / 299.0 * 1.5
        for answer, inside in zip(found.q, found.inside, strict=True):
            within = ((answer >= robot.lower) & (answer <= robot.upper)).all()
            assert within == inside
        if found.inside.any():
            assert found.inside[0]
            assert missed == pytest.approx(found.shortfall, abs=1e-12)

    def test_a_hinge_is_turned_by_whole_turns_to_get_inside(self):
        robot = two_hinges(((4.0, 8.0), (-8.0, -4.0)))
        wanted = plain_position(robot, "hand", np.array([0.6, 1.2]))
        found = TwoBone.of(robot, "hand").solve(wanted)
        assert found.inside[0]
        assert found.q[0] == pytest.approx([0.6 + math.tau, 1.2 - math.tau])
        assert plain_position(robot, "hand", found.q[0]) == pytest.approx(wanted, abs=1e-15)

    def test_an_angle_at_the_end_of_its_range_is_inside_whatever_rounding_does_to_it(self):
        robot = two_hinges(((-3.0, 3.0), (0.3, 2.5)))
        bones = TwoBone.of(robot, "hand")
        for first in np.linspace(-2.5, 2.5, 60):
            found = bones.solve(plain_position(robot, "hand", np.array([first, 0.3])))
            assert found.inside[0]
            assert found.q[0, 1] >= 0.3
            assert found.errors[0] < 1e-12

    def test_an_elbow_outside_is_told_as_it_is_and_comes_last(self):
        robot = two_hinges(((-3.0, 3.0), (0.0, 2.5)))
        up = np.array([0.6, -1.2])
        found = TwoBone.of(robot, "hand").solve(plain_position(robot, "hand", up), up)
        assert found.elbows == ("down", "up")
        assert found.inside.tolist() == [True, False]
        assert found.q[1] == pytest.approx(up)
        assert found.errors.max() < 1e-15
        assert (found.nearest == found.q[0]).all()

    def test_with_the_target_on_the_first_axis_the_first_joint_stays_where_the_second_cannot_fold(self):
        robot = two_hinges(((-3.0, 3.0), (0.2, 1.0)))
        found = TwoBone.of(robot, "hand").solve([0.0, 0.0, 0.1], [0.7, 0.5])
        assert found.nearest == pytest.approx([0.7, 1.0])

    def test_switched_off_they_do_not_count(self):
        robot = load_quietly("double_pendulum_simple")
        wanted = plain_position(robot, "link3", np.array([0.4, 1.0]))
        bones = TwoBone.of(robot, "link3")
        assert bones.solve(wanted).inside.tolist() == [False, False]
        assert bones.solve(wanted).nearest.tolist() == [0.0, 0.0]
        assert bones.solve(wanted, limits=False).inside.all()
        assert bones.solve(wanted, limits=False).nearest_error < 1e-15


class TestAsAMethod:
    @every_case
    def test_solve_reaches_what_can_be_reached_in_one_sweep(self, case):
        robot = load_quietly(case.robot)
        rng = np.random.default_rng(8)
        for q in configurations(robot, 15, seed=7):
            wanted = plain_position(robot, case.frame, robot.random(rng) if case.limits else q, case.tool)
            q0 = robot.random(rng)
            target = Target(case.frame, wanted, tool=case.tool)
            s = robot.solve(target, method="two_bone", q0=q0, limits=case.limits, tolerance=(1e-12, 1e-3))
            assert s.status is Status.CONVERGED
            assert s.iterations == 1
            assert np.linalg.norm(plain_position(robot, case.frame, s.q, case.tool) - wanted) <= 1e-12
            if case.limits:
                assert (s.q >= robot.lower_q).all()
                assert (s.q <= robot.upper_q).all()

    @given(ranges, ranges, vectors)
    def test_a_missed_target_is_unreachable_and_answered_with_the_nearest_point(self, first, second, target):
        robot = two_hinges((first, second))
        s = robot.solve("hand", target, method="two_bone")
        missed = np.linalg.norm(plain_position(robot, "hand", s.q) - target)
        assert s.position_error == pytest.approx(missed, abs=1e-12)
        assert missed <= least_distance_on_a_grid((first, second), target) + 1e-9
        if missed <= 1e-4:
            assert s.status is Status.CONVERGED
        elif missed > 2e-4:
            assert s.status is Status.UNREACHABLE
            assert "unreachable" in s.message
        assert s.iterations <= 2

    @pytest.mark.parametrize(
        ("asked", "words"),
        [
            (
                (0.5, 0.3, 0.22),
                "the target of hand lies 12 cm off the plane in which hand moves, whose normal is NORMAL; 12",
            ),
            (
                (0.5, 0.3, 0.05),
                "the target of hand lies 5 cm off the plane in which hand moves, whose normal is NORMAL; 5 ",
            ),
            (
                (3.0, 0.0, 0.2),
                "beyond its chain's reach of 80 cm and 10 cm off the plane in which hand moves, whose normal",
            ),
        ],
    )
    @pytest.mark.parametrize(
        ("rpy", "normal"),
        [
            ((0.0, 0.0, 0.4), "the z axis of the world"),
            ((math.pi, 0.0, 0.0), "the z axis of the world"),
            ((math.pi / 2, 0.0, 0.0), "the y axis of the world"),
            ((0.0, math.pi / 2, 0.0), "the x axis of the world"),
            ((0.0, math.atan2(3.0, 4.0), 0.0), "(0.6, 0, 0.8) in the axes of the world"),
        ],
    )
    def test_the_message_says_how_far_off_the_plane_and_which_plane_that_is(self, asked, words, rpy, normal):
        turned = pinocchio.rpy.rpyToMatrix(np.array(rpy))
        robot = two_hinges(rpy=rpy)
        s = robot.solve("hand", turned @ asked, method="two_bone")
        assert s.status is Status.UNREACHABLE
        assert words.replace("NORMAL", normal) in s.message
        flat = robot.solve("hand", turned @ [*asked[:2], 0.1], method="two_bone")
        assert "plane" not in flat.message

    def test_the_plane_of_a_pair_inside_a_chain_is_told_in_the_axes_of_the_link_before(self, two_link):
        floating = two_link.with_root("free_flyer")
        s = floating.solve("tip", [0.5, 0.3, -0.02], relative_to="base", method="two_bone", q0=floating.random(1))
        assert "lies 2 cm off the plane in which tip moves, whose normal is the z axis of frame 'base'" in s.message

    def test_the_plane_is_named_as_well_where_the_iterations_ran_out_first(self, two_link):
        s = two_link.solve("tip", [0.5, 0.3, 0.1], method="two_bone", max_iterations=1)
        assert s.message == (
            "out of iterations, 10 cm short; the target of tip lies 10 cm off the plane in which tip moves, "
            "whose normal is the z axis of the world"
        )

    def test_what_is_within_the_tolerance_is_off_no_plane(self, two_link):
        s = two_link.solve("tip", [2.0, 0.0, 9e-5], method="two_bone")
        assert "plane" not in s.message
        assert "off the plane" in two_link.solve("tip", [2.0, 0.0, 1.1e-4], method="two_bone").message

    def test_the_message_says_how_far_and_which_limit(self):
        s = two_hinges(((-3.0, 3.0), (0.0, 0.5))).solve("hand", [0.5, 0.0, 0.1], method="two_bone")
        assert s.status is Status.UNREACHABLE
        assert "cm short" in s.message
        assert "elbow at its upper limit" in s.message

    @pytest.mark.parametrize(("elbow", "sign"), [("up", -1.0), ("down", 1.0)])
    def test_the_elbow_asked_for_is_taken(self, two_link, elbow, sign):
        for q in configurations(two_link, 10, seed=9):
            s = two_link.solve("tip", plain_position(two_link, "tip", q), method="two_bone", q0=q, elbow=elbow)
            assert s.success
            assert s.q[1] * sign > 0.0

    def test_the_elbow_asked_for_gives_way_to_limits(self):
        robot = two_hinges(((-3.0, 3.0), (0.0, 2.5)))
        wanted = plain_position(robot, "hand", np.array([0.6, -1.2]))
        assert robot.solve("hand", wanted, method="two_bone", elbow="up").success

    def test_a_locked_joint_stays_and_the_other_does_what_it_can(self, two_link):
        q0 = np.array([0.3, 0.2])
        s = two_link.solve("tip", [0.3, 0.7, 0.0], method="two_bone", q0=q0, locked=["joint1"])
        assert s.q[0] == 0.3
        turns = [plain_position(two_link, "tip", np.array([0.3, x])) for x in np.linspace(-np.pi, np.pi, 2001)]
        least = np.linalg.norm(np.array(turns) - [0.3, 0.7, 0.0], axis=1).min()
        assert s.status is Status.UNREACHABLE
        assert s.position_error == pytest.approx(least, abs=1e-5)
        assert s.position_error <= least

    def test_a_clamp_on_the_step_takes_more_sweeps_to_the_same_place(self, two_link):
        wanted = plain_position(two_link, "tip", np.array([1.0, 1.5]))
        states = list(pinik.iterate(two_link, Target("tip", wanted), "two_bone", [0.0, 0.5], max_step=0.1))
        steps = np.abs(np.diff([state.q for state in states], axis=0)).max(axis=1)
        assert len(states) == 11
        assert steps.max() <= 0.1 + 1e-15
        assert states[-1].status is Status.CONVERGED
        assert states[-1].q == pytest.approx([1.0, 1.5], abs=1e-12)

    @given(ranges, ranges, vectors, vectors, st.sampled_from([{"max_step": 0.05}, {"max_residual": 0.05}]))
    def test_what_can_be_reached_is_not_called_unreachable_however_small_the_steps(self, first, second, at, q0, clamp):
        robot = two_hinges((first, second))
        middle, half = 0.5 * (robot.lower + robot.upper), 0.5 * (robot.upper - robot.lower)
        wanted = plain_position(robot, "hand", middle + half * np.array(at[:2]))
        start = middle + half * np.array(q0[:2])
        s = robot.solve("hand", wanted, method="two_bone", q0=start, **clamp)
        assert s.status is not Status.UNREACHABLE
        if "max_step" in clamp:
            assert robot.solve("hand", wanted, method="two_bone", q0=start, max_iterations=300, **clamp)

    def test_a_long_way_in_small_steps_that_first_leads_away_is_gone_to_its_end(self, two_link):
        for seed in range(60):
            wanted = plain_position(two_link, "tip", two_link.random(1000 + seed))
            s = two_link.solve("tip", wanted, method="two_bone", q0=two_link.random(seed), max_step=0.05)
            assert s.status is (Status.CONVERGED if s.iterations < 100 else Status.MAX_ITERATIONS)

    def test_a_clamp_on_the_step_leaves_the_base_where_it_is_to_the_last_bit(self, two_link):
        floating = two_link.with_root("free_flyer")
        target = Target("tip", [0.2, 0.6, 0.0], relative_to="base")
        for seed in range(10):
            q0 = floating.random(seed)
            states = list(pinik.iterate(floating, target, "two_bone", q0, max_step=0.2))
            assert states[-1].status is Status.CONVERGED
            assert all((state.q[:7] == states[0].q[:7]).all() for state in states)

    def test_a_shortened_residual_moves_the_frame_by_that_much_a_sweep(self, two_link):
        target = Target("tip", [0.2, 0.6, 0.0])
        states = list(pinik.iterate(two_link, target, "two_bone", [0.1, 0.4], max_residual=0.05))
        places = [plain_position(two_link, "tip", state.q) for state in states]
        moves = np.linalg.norm(np.diff(places, axis=0), axis=1)
        assert states[-1].status is Status.CONVERGED
        assert moves[:-1] == pytest.approx(0.05, abs=1e-12)

    def test_a_target_that_moves_is_chased(self, two_link):
        states = pinik.iterate(two_link, Target("tip", [0.5, 0.3, 0.0]), "two_bone", [0.1, 0.4])
        next(states)
        for x in (0.45, 0.4, 0.35):
            assert states.send(Target("tip", [x, 0.3, 0.0])).position_error < 1e-12

    def test_many_questions_are_answered_like_one(self, two_link):
        points = np.column_stack([np.random.default_rng(1).uniform(-0.7, 0.7, (30, 2)), np.zeros(30)])
        together = pinik.solve_many(two_link, "tip", points, "two_bone")
        for k, point in enumerate(points):
            alone = two_link.solve("tip", point, method="two_bone")
            assert together.q[k] == pytest.approx(alone.q, abs=1e-15)
            assert together.status[k] is alone.status

    @pytest.mark.parametrize(
        ("targets", "words"),
        [
            (Target("tip", [0.5, 0.1, 0.0], rpy=[0.0, 0.0, 1.0]), "only a position; target 'tip' has an orient"),
            (Target("tip", axis="x", direction=[1.0, 0.0, 0.0]), "only a position"),
            ([Target("tip", [0.5, 0.1, 0.0]), Target("link2", [0.5, 0.0, 0.0])], "takes only one target; got 2"),
            (Target("link1", [0.5, 0.1, 0.0]), "not moved by two parallel hinges alone: only one joint moves it"),
        ],
    )
    def test_what_it_cannot_do_is_refused_with_the_reason(self, two_link, targets, words):
        for ask in (pinik.solve, pinik.prepare, pinik.iterate):
            with pytest.raises(pinik.InputError, match=words):
                ask(two_link, targets, "two_bone")

    @needs_native
    def test_the_compiled_engine_says_that_it_does_not_know_it(self, two_link):
        with pytest.raises(pinik.EngineError, match="'two_bone' is written in Python"):
            two_link.solve("tip", [0.5, 0.1, 0.0], method="two_bone", engine="native")

    def test_it_is_found_by_name_and_named_where_one_is_not(self, two_link):
        assert pinik.CLOSED_FORMS["two_bone"] is pinik.TwoBoneSolver
        with pytest.raises(pinik.UnknownNameError, match="'two_bone'"):
            two_link.solve("tip", [0.5, 0.1, 0.0], method="two_bones")
        with pytest.raises(pinik.InputError, match="elbow must be one of 'nearest', 'up', 'down'"):
            two_link.solve("tip", [0.5, 0.1, 0.0], method="two_bone", elbow="left")
