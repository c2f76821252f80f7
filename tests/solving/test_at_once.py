"""Many questions answered by the closed form at once: as one by one, and by plain Pinocchio."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from hinges import two_hinges
from judge import is_inside, plain_placement
from pinik import Status, Target
from pinik.solving.at_once import lands_at_once
from robots import load_quietly

# Places on a grid as well: on borders, on axes, on top of each other, out of the plane.
numbers = st.one_of(st.floats(-1.0, 1.0), st.sampled_from([0.0, 0.1, 0.2, 0.3, 0.5, 0.8, -0.8]))
vectors = st.tuples(numbers, numbers, st.one_of(st.just(0.1), numbers))
ranges = st.tuples(st.floats(-7.0, 7.0), st.floats(0.0, 9.0)).map(lambda r: (r[0], r[0] + r[1]))


def plain_positions(robot: pinik.Robot, frame: str, q: np.ndarray) -> np.ndarray:
    return np.array([plain_placement(robot, frame, each).translation for each in q])


def are_alike(robot, together, alone):
    """Whether an answer of many is the one of its own; where two are as near, either will do."""
    assert together.status is alone.status
    assert together.position_error == pytest.approx(alone.position_error, abs=1e-9)
    assert together.iterations == alone.iterations
    assert together.joint_updates == alone.joint_updates == 0
    assert together.restarts == 0
    if np.abs(pinocchio.difference(robot.model, together.q, alone.q)).max() < 1e-9:
        assert together.message == alone.message
        assert together.active_limits == alone.active_limits
        return True
    return False


@given(
    ranges,
    ranges,
    st.lists(st.tuples(vectors, vectors), min_size=1, max_size=8),
    st.booleans(),
    st.sampled_from(["nearest", "up", "down"]),
    st.sampled_from([(), ("shoulder",), ("elbow",), ("shoulder", "elbow")]),
    st.sampled_from([(1e-4, 1e-3), (1e-9, 1e-3), (0.05, 1e-3)]),
)
def test_the_answers_are_those_of_single_solves(first, second, asked, limits, elbow, locked, tolerance):
    robot = two_hinges((first, second))
    places = np.array([place for place, _ in asked])
    starts = 3.0 * np.array([start[:2] for _, start in asked])
    options = {"method": "two_bone", "limits": limits, "elbow": elbow, "locked": locked, "tolerance": tolerance}
    many = pinik.solve_many(robot, "hand", places, q0=starts, **options)
    reached = plain_positions(robot, "hand", many.q)
    assert many.position_error == pytest.approx(np.linalg.norm(reached - places, axis=1), abs=1e-14)
    assert (many.success == (many.position_error <= tolerance[0])).all()
    if limits:
        assert all(is_inside(robot, q) for q in many.q)
    for k, (place, start) in enumerate(zip(places, starts, strict=True)):
        are_alike(robot, many[k], robot.solve("hand", place, q0=start, **options))


@pytest.mark.parametrize(
    ("name", "frame", "limits"),
    [("two_link", "tip", True), ("asr_twodof", "Tip", True), ("double_pendulum_continuous", "link2", False)],
)
def test_nearly_all_are_the_same_to_the_joint(name, frame, limits):
    robot, rng = load_quietly(name), np.random.default_rng(5)
    tool = pinocchio.SE3(np.eye(3), np.array([0.0, 0.1, 0.2]))
    placements = [robot.placement(frame, robot.random(rng)) * tool for _ in range(60)]
    places = np.array([placement.translation for placement in placements]) * rng.choice([1.0, 1.3], (60, 1))
    pattern, start = Target(frame, places[0], tool=tool), robot.random(rng)
    many = pinik.solve_many(robot, pattern, places, "two_bone", q0=start, limits=limits)
    alone = [
        robot.solve(Target(frame, place, tool=tool), method="two_bone", q0=start, limits=limits) for place in places
    ]
    assert 10 < many.success.sum() < 60
    assert sum(are_alike(robot, *pair) for pair in zip(many, alone, strict=True)) >= 58


def test_a_pair_inside_a_longer_chain_is_answered_in_its_own_axes(ur5):
    rng, tool = np.random.default_rng(3), pinocchio.SE3(np.eye(3), np.array([0.0, 0.05, 0.39]))
    starts = np.array([ur5.random(rng) for _ in range(20)])
    pattern = Target("forearm_link", [0.0, 0.0, 0.0], tool=tool, relative_to="shoulder_link")
    places = [
        (ur5.placement("forearm_link", ur5.random(rng), relative_to="shoulder_link") * tool).translation
        for _ in range(20)
    ]
    many = pinik.solve_many(ur5, pattern, places, "two_bone", q0=starts)
    assert many.success.all()
    for q, start, place in zip(many.q, starts, places, strict=True):
        reached = (plain_placement(ur5, "forearm_link", q, "shoulder_link") * tool).translation
        assert np.linalg.norm(reached - place) < 1e-12
        assert (q[[0, 3, 4, 5]] == start[[0, 3, 4, 5]]).all()


def test_a_miss_by_a_hair_is_unreachable_only_where_proved(two_link):
    """0.9 m is the reach; 1e-5 of it may be rounding where nothing proves the target out of reach."""
    hair = 1.05e-4
    beyond, beside = [0.9 + hair, 0.0, 0.0], [0.5, 0.0, hair]
    many = pinik.solve_many(two_link, "tip", [beyond, beside], "two_bone")
    assert many.status.tolist() == [Status.UNREACHABLE, Status.STALLED]
    for k, place in enumerate([beyond, beside]):
        assert many[k].message == two_link.solve("tip", place, method="two_bone").message


def test_more_than_a_block_of_them_are_all_answered(two_link):
    rng, count = np.random.default_rng(0), 20_000
    places = np.column_stack([rng.uniform(-0.6, 0.6, (count, 2)), np.zeros(count)])
    starts = np.column_stack([rng.uniform(-2.0, 2.0, (count, 2))])
    many = pinik.solve_many(two_link, "tip", places, "two_bone", q0=starts)
    missed = np.linalg.norm(plain_positions(two_link, "tip", many.q) - places, axis=1)
    assert (many.success == (missed <= 1e-4)).all()
    assert many.success.mean() > 0.5
    assert (many.time > 0.0).all()
    assert many.time.sum() <= many.total_time
    for k in (0, 8191, 8192, count - 1):
        assert are_alike(two_link, many[k], two_link.solve("tip", places[k], method="two_bone", q0=starts[k]))


@pytest.mark.parametrize(
    "options",
    [{"max_step": 0.1}, {"max_residual": 0.05}, {"max_iterations": 1}],
    ids=lambda options: next(iter(options)),
)
def test_pieces_of_the_way_are_still_gone_one_by_one(two_link, options):
    assert lands_at_once(pinik.prepare(two_link, Target("tip", [0.5, 0.1, 0.0]), "two_bone").question)
    assert not lands_at_once(pinik.prepare(two_link, Target("tip", [0.5, 0.1, 0.0]), "two_bone", **options).question)
    places = [[0.2, 0.6, 0.0], [0.5, 0.3, 0.2]]
    many = pinik.solve_many(two_link, "tip", places, "two_bone", **options)
    for k, place in enumerate(places):
        assert are_alike(two_link, many[k], two_link.solve("tip", place, method="two_bone", **options))


def test_starts_near_the_targets_are_taken(two_link):
    places = [[0.5, 0.3, 0.0], [-0.3, 0.5, 0.0]]
    assert pinik.solve_many(two_link, "tip", places, "two_bone", q0="nearest").success.all()


def test_a_place_that_is_none_is_named(two_link):
    with pytest.raises(pinik.InputError, match=r"places\[1\]"):
        pinik.solve_many(two_link, "tip", [[0.5, 0.3, 0.0], [math.nan, 0.0, 0.0]], "two_bone")


def test_a_time_limit_is_each_question_s_own(two_link):
    places = np.array([[0.6, 0.2, 0.0], [0.0, 2.0, 0.0]])
    many = pinik.solve_many(two_link, "tip", places, "two_bone", time_limit=1e-9)
    for k, place in enumerate(places):
        assert many[k].status is two_link.solve("tip", position=place, method="two_bone", time_limit=1e-9).status


def test_a_miss_that_starts_at_its_nearest_point_takes_one_iteration_and_any_other_two():
    robot = two_hinges()
    starts = np.array([[0.0, 0.0], [0.5, 1.0]])
    many = pinik.solve_many(robot, "hand", [(2.0, 0.0, 0.1), (2.0, 0.0, 0.1)], "two_bone", q0=starts)
    assert not many.success.any()
    assert many.iterations.tolist() == [1, 2]


def test_the_solves_take_no_longer_than_the_call():
    robot = two_hinges()
    places = np.tile((0.5, 0.2, 0.1), (50, 1))
    many = pinik.solve_many(robot, "hand", places, "two_bone")
    assert 0.0 < sum(solution.time for solution in many) <= many.total_time
