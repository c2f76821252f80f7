"""Wide tolerances, boxes and free axes: an answer inside is looked for, found, and judged by plain Pinocchio."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import axis, limit, origin
from engines import needs_native
from judge import assert_good, assert_honest, judge, plain_placement
from pinik import Target, Tolerance
from pinik.solving import alone as alone_room
from robots import load_quietly
from urdf_texts import joint, link
from urdf_texts import robot as robot_text

ENGINES = ["python", pytest.param("native", marks=needs_native)]
HAND = "gripper_frame_joint"
DEGREES = math.pi / 180.0


def turned_poses(count: int, seed: int = 0) -> list[np.ndarray]:
    """Poses that so101's five joints reach, turned by 15 degrees about random axes."""
    robot, rng, poses = load_quietly("so101"), np.random.default_rng(seed), []
    for _ in range(count):
        M = robot.placement(HAND, robot.random(rng))
        axis = rng.normal(size=3)
        turn = pinocchio.exp3(15.0 * DEGREES * axis / np.linalg.norm(axis))
        poses.append(pinocchio.SE3(M.rotation @ turn, M.translation).homogeneous)
    return poses


@needs_native
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd"])
def test_an_arm_of_five_joints_reaches_turned_poses_within_20_degrees(method, seed):
    robot = load_quietly("so101")
    tolerance = (1e-4, 20.0 * DEGREES)
    poses = turned_poses(100, seed)
    solutions = [robot.solve(HAND, placement=M, method=method, tolerance=tolerance) for M in poses]
    for solution in solutions:
        assert_honest(solution, tolerance=tolerance)
    assert sum(solution.success for solution in solutions) >= 99


@pytest.mark.parametrize("method", ["dls", "pinv", "jt"])
def test_the_python_engine_finds_answers_inside_wide_tolerances_too(method):
    robot = load_quietly("so101")
    own = Tolerance(1e-4, 20.0 * DEGREES)
    for M in turned_poses(5):
        target = Target(HAND, placement=M, tolerance=own)
        assert_good(robot.solve(target, method=method, engine="python"))


def test_solve_many_reads_the_tolerance_of_the_targets():
    robot = load_quietly("so101")
    pattern = Target(HAND, placement=np.eye(4), tolerance=(1e-4, 20.0 * DEGREES))
    many = pinik.solve_many(robot, pattern, np.array(turned_poses(30)))
    assert many.success.all()
    for solution in many:
        assert_good(solution)
        assert solution.targets[0].tolerance == Tolerance(1e-4, 20.0 * DEGREES)


def test_each_target_has_its_own_tolerance():
    robot = load_quietly("ur5")
    q = robot.configuration({"shoulder_lift_joint": -1.0, "elbow_joint": 1.2})
    near = robot.placement("tool0", q)
    beside = near.translation + np.array([0.0, 0.0, 0.02])
    loose, tight = Target("tool0", beside, tolerance=(0.03, 0.1)), Target("tool0", beside)
    assert robot.solve(loose, q0=q, restarts=0, max_iterations=1, polish=False).iterations == 0
    solution = robot.solve([loose, Target("wrist_3_link", rotation=near.rotation)], q0=q)
    assert_good(solution)
    assert robot.solve(tight, q0=q, restarts=0).iterations > 0


@pytest.mark.parametrize("engine", ENGINES)
def test_a_box_bounds_the_error_along_each_axis_of_the_target(engine):
    robot = load_quietly("so101")
    for M in turned_poses(10):
        target = Target(HAND, placement=M, tolerance=Tolerance((0.03, 1e-4, 1e-4), 10.0 * DEGREES))
        solution = robot.solve(target, engine=engine)
        assert_honest(solution, target)
        along = M[:3, :3].T @ (plain_placement(robot, HAND, solution.q).translation - M[:3, 3])
        np.testing.assert_allclose(np.abs(solution.errors[0].offset), np.abs(along), atol=1e-12)
        assert solution.success == (
            (np.abs(along) <= (0.03, 1e-4, 1e-4)).all() and solution.orientation_error <= 10.0 * DEGREES
        )


def test_a_box_is_not_its_surrounding_ball():
    robot = load_quietly("ur5")
    q = robot.neutral()
    p = robot.placement("tool0", q).translation
    inside = Target("tool0", p + np.array([0.02, 0.0, 0.0]), tolerance=((0.03, 1e-3, 1e-3), 1e-3))
    outside = Target("tool0", p + np.array([0.0, 0.02, 0.0]), tolerance=((0.03, 1e-3, 1e-3), 1e-3))
    for target, inner in ((inside, True), (outside, False)):
        assert judge(robot, target, q).are_within() is inner
        assert (robot.solve(target, q0=q, restarts=0, polish=False).iterations == 0) is inner


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "pinv", "jt", "ccd"])
@pytest.mark.parametrize("relative_to", [None, "forearm_link"])
def test_axes_of_a_position_can_be_left_free(engine, method, relative_to):
    robot, rng = load_quietly("ur5"), np.random.default_rng(3)
    for _ in range(5):
        p = robot.placement("tool0", robot.random(rng), relative_to).translation
        target = Target("tool0", [None, p[1], None], relative_to=relative_to)
        solution = robot.solve(target, q0=robot.random(rng), method=method, engine=engine)
        assert_good(solution, {"frame": "tool0", "position": [None, p[1], None], "relative_to": relative_to})
        assert np.isnan(solution.targets[0].position).tolist() == [True, False, True]


def test_a_height_is_reached_by_a_shorter_way_than_a_point():
    robot = load_quietly("ur5")
    q = robot.configuration({"shoulder_lift_joint": -1.0, "elbow_joint": 1.2})
    p = robot.placement("tool0", q).translation + np.array([0.2, 0.2, 0.1])
    height, point = robot.solve("tool0", [None, None, p[2]], q0=q), robot.solve("tool0", p, q0=q)
    assert_good(height)
    assert np.linalg.norm(height.q - q) < 0.7 * np.linalg.norm(point.q - q)


def test_a_height_beyond_reach_is_proved_unreachable_and_a_point_in_the_hole_of_free_axes_is_not():
    robot = load_quietly("two_link")
    assert robot.solve("tip", [None, None, 50.0]).status is pinik.Status.UNREACHABLE
    base = robot.placement("tip", robot.neutral(), robot.frame_names[1]).translation
    assert_good(robot.solve("tip", [0.0, None, base[2]], relative_to=robot.frame_names[1]))


@pytest.mark.parametrize("engine", ENGINES)
def test_the_message_says_which_part_can_be_had_alone(engine, monkeypatch):
    if engine == "python":
        monkeypatch.setattr(alone_room, "why_not", lambda _: "it is left out in this test")
    robot = load_quietly("so101")
    M = robot.placement(HAND, robot.configuration({"elbow_flex": 0.4, "wrist_flex": 0.3}))
    sideways = M.rotation @ pinocchio.exp3(np.array([0.0, 0.9, 0.0]))
    both = robot.solve(HAND, position=M.translation, rotation=sideways)
    assert not both.success
    assert "position and orientation can each be reached alone" in both.message
    aloft = robot.solve("gripper_frame_joint", position=[0.0, 0.0, -0.13], rotation=M.rotation)
    alone = robot.solve(HAND, position=[0.0, 0.0, -0.13])
    assert not aloft.success
    assert ("the orientation alone can be reached" in aloft.message) is not alone.success


@pytest.mark.parametrize(
    ("position", "words"),
    [
        ([None, None, None], "must have a coordinate that is not None"),
        ([None, None], "3"),
        ([None, math.nan, 0.3], "finite"),
        ([None, "a", 0.3], "finite"),
        ([math.nan, math.nan, 0.3], "finite"),
    ],
)
def test_a_position_that_says_nothing_is_refused(position, words):
    with pytest.raises(pinik.InputError, match=words):
        Target("tool0", position)


@pytest.mark.parametrize("tolerance", [(0.0, 1.0), ((1e-3, 1e-3), 0.1), ((1e-3, -1e-3, 1e-3), 0.1), 3.0, ("a", 1.0)])
def test_a_tolerance_of_another_form_is_refused(tolerance):
    with pytest.raises(pinik.InputError, match="tolerance"):
        Target("tool0", [0.1, 0.2, 0.3], tolerance=tolerance)
    with pytest.raises(pinik.InputError, match="tolerance"):
        load_quietly("ur5").solve("tool0", [0.1, 0.2, 0.3], tolerance=tolerance)


def test_json_keeps_free_axes_and_tolerances():
    target = Target("tool0", [None, 0.1, 0.3], tolerance=((1e-3, 2e-3, 3e-3), 0.1))
    fields = target.to_dict()
    assert fields == {"frame": "tool0", "position": [None, 0.1, 0.3], "tolerance": [[1e-3, 2e-3, 3e-3], 0.1]}
    assert Target.from_dict(fields) == target
    assert hash(Target.from_dict(fields)) == hash(target)
    assert target != Target("tool0", [None, 0.1, 0.3])


def test_a_wide_tolerance_does_not_change_what_an_exact_answer_is():
    """The exact place is looked for first: a reachable pose ends there."""
    robot, rng = load_quietly("ur5"), np.random.default_rng(5)
    for _ in range(20):
        M = robot.placement("tool0", robot.random(rng))
        solution = robot.solve("tool0", placement=M, tolerance=(1e-3, 0.02), q0=robot.random(rng))
        assert_good(solution, tolerance=(1e-3, 0.02))
        assert solution.position_error < 1e-8


def test_a_whole_position_after_a_partial_one_is_asked_for_as_a_whole():
    robot = load_quietly("ur5")
    p = robot.placement("tool0", robot.random(1)).translation
    for _ in range(2):  # the second time, the calls are recalled
        assert_good(robot.solve("tool0", [None, None, p[2]]), {"frame": "tool0", "position": [None, None, p[2]]})
        assert_good(robot.solve("tool0", p), {"frame": "tool0", "position": p})
    prepared = pinik.prepare(robot, "tool0", position=[None, p[1], None])
    assert_good(prepared(p), {"frame": "tool0", "position": [None, p[1], None]})


def within_20_degrees(robot: pinik.Robot, M: np.ndarray, q: np.ndarray) -> bool:
    at = plain_placement(robot, HAND, q)
    turned = np.linalg.norm(pinocchio.log3(M[:3, :3] @ at.rotation.T))
    return bool(np.linalg.norm(at.translation - M[:3, 3]) <= 1e-4 and turned <= 20.0 * DEGREES)


@pytest.mark.parametrize("method", ["dls", "pinv", "jt", "ccd"])
def test_the_same_target_sent_in_again_does_not_interrupt_the_wait_for_a_stall(method):
    robot = load_quietly("so101")
    target = Target(HAND, placement=turned_near(robot, 0.0))
    states = pinik.iterate(robot, target, method, tolerance=(1e-4, 20.0 * DEGREES), max_iterations=10)
    next(states)
    for _ in range(100):
        state = last_of(states, target)
        if state.status is pinik.Status.CONVERGED:
            break
    assert within_20_degrees(robot, turned_near(robot, 0.0), state.q)


@pytest.mark.parametrize("method", ["dls", "pinv"])
def test_targets_that_move_before_they_are_reached_are_met_inside_their_tolerance(method):
    robot = load_quietly("so101")
    places = [turned_near(robot, 0.004 * step) for step in range(60)]
    states = pinik.iterate(
        robot, Target(HAND, placement=places[0]), method, tolerance=(1e-4, 20.0 * DEGREES), max_iterations=15
    )
    next(states)
    met = []
    for M in places:
        state = last_of(states, Target(HAND, placement=M))
        met.append(within_20_degrees(robot, M, state.q))
    assert sum(met[3:]) >= 50


def turned_near(robot: pinik.Robot, further: float) -> np.ndarray:
    """A pose that so101's five joints reach, turned by 12 degrees; the joints are `further` [rad] along a path."""
    q = np.full(robot.model.nq, 0.2 + further)
    M = robot.placement(HAND, q)
    return pinocchio.SE3(M.rotation @ pinocchio.exp3(np.full(3, 7.0 * DEGREES)), M.translation).homogeneous


def last_of(states, target: Target) -> pinik.State:
    """Send a target in, and run to the last state."""
    state = states.send(target)
    while state.status is None:
        state = next(states)
    return state


@pytest.mark.parametrize("method", ["dls", "pinv", "jt", "ccd"])
def test_a_run_that_rests_where_a_limit_keeps_it_from_a_wide_tolerance_has_stalled(method):
    """A hinge that turns to 0.5 rad, and a target at 1.5 rad."""
    text = robot_text(
        *map(link, ("base", "arm", "tip")),
        joint("turn", "base", "arm", axis(0, 0, 1), limit=limit(-0.5, 0.5)),
        joint("end", "arm", "tip", origin((1, 0, 0)), kind="fixed", limit=""),
    )
    target = Target("tip", [math.cos(1.5), math.sin(1.5), 0.0], tolerance=([0.3, 0.3, 0.3], 0.5))
    *_, last = pinik.iterate(load_quietly(text), target, method, max_iterations=400)
    assert last.status is pinik.Status.STALLED
    assert last.q == pytest.approx([0.5], abs=1e-9)
