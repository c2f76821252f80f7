"""Cyclic coordinate descent against brute force and Welman's own statements."""

from __future__ import annotations

import copy
import math

import numpy as np
import pinocchio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pinik
from engines import needs_native
from judge import assert_good, is_inside
from pinik import CCD, Kinematics, Target, Tolerance
from pinik.model.limits import Limits
from pinik.solvers.ccd import _best_turn
from robots import load_quietly
from urdf_texts import joint, link
from urdf_texts import robot as robot_text

NEVER = Tolerance(1e-30, 1e-30)


def limited(lower, upper):
    return f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'


def objective(robot, target, q, w_p, w_o=1.0):
    """w_p ‖P_d − P_c‖² + w_o Σ ‖u_jd − u_jc‖², from plain placements."""
    M = robot.placement(target.frame, q, target.relative_to)
    value = 0.0
    if target.position is not None:
        value += w_p * float(np.sum((target.position - M.translation) ** 2))
    if target.rotation is not None:
        value += w_o * float(np.sum((target.rotation - M.rotation) ** 2))
    elif target.direction is not None:
        value += w_o * float(np.sum((target.direction - M.rotation @ target.axis) ** 2))
    return value


def weight_at(robot, solver, kinematics, target, coordinate, q):
    """w_p = α(1 + ρ) with α = k/W², seen from the coordinate's joint; 1 where only a position counts."""
    if target.rotation is None and target.axis is None:
        return 1.0
    pinocchio.forwardKinematics(robot.model, robot.data, q)
    origin = robot.data.oMi[coordinate.movers[0][0].id].translation
    c = np.linalg.norm(robot.placement(target.frame, q).translation - origin)
    d = np.linalg.norm(target.position - origin) if target.position is not None else c
    return solver.position_weight / kinematics.problem.size_of_chain**2 * (1.0 + min(c, d) / max(c, d))


def single_updates(robot, target, solver, q, limits):
    """(coordinate, q before, q after, kinematics) for each joint update of one sweep."""
    kinematics = Kinematics(robot, [target])
    whole = kinematics.problem
    for coordinate in whole.coordinates:
        kinematics.problem = copy.copy(whole)
        kinematics.problem.coordinates = (coordinate,)
        after, count = solver.sweep(q, kinematics, limits, NEVER)
        assert count == 1
        yield coordinate, q, after, kinematics
        q = after


def turned_everywhere(robot, name, q, count=300):
    """`q` with one joint at angles all over its range, written by hand."""
    joint = robot.joint(name)
    if joint.nq == 2:
        angles = np.linspace(-math.pi, math.pi, count)
        entries = np.column_stack([np.cos(angles), np.sin(angles)])
    else:
        low, high = (end[robot.joint_names.index(name)] for end in (robot.lower, robot.upper))
        middle = q[joint.idx_q]
        entries = np.linspace(max(low, middle - 4.0), min(high, middle + 4.0), count)[:, None]
    for entry in entries:
        tried = q.copy()
        tried[joint.idx_q : joint.idx_q + joint.nq] = entry
        yield tried


CASES = [
    ("panda", "panda_hand_tcp"),
    ("kinova", "j2s6s200_end_effector"),
    ("tiago", "hand_grasping_frame"),
    ("arm", "tip"),
]


@pytest.mark.parametrize(("name", "frame"), CASES)
@pytest.mark.parametrize("kind", ["position", "pose", "direction"])
@pytest.mark.parametrize("with_limits", [True, False])
@pytest.mark.parametrize("options", [{}, {"relaxation": 1.95}, {"relaxation": 0.5}, {"max_step": 0.1}], ids=str)
def test_the_objective_never_increases_in_a_joint_update(name, frame, kind, with_limits, options):
    robot = load_quietly(name)
    rng = np.random.default_rng(7)
    limits = Limits.of(robot, with_limits)
    solver = CCD(**options)
    changed = 0
    for _ in range(3):
        wanted = robot.placement(frame, robot.random(rng))
        target = {
            "position": Target(frame, wanted.translation),
            "pose": Target(frame, placement=wanted),
            "direction": Target(frame, axis="z", direction=wanted.rotation[:, 2]),
        }[kind]
        for coordinate, before, after, kinematics in single_updates(robot, target, solver, robot.random(rng), limits):
            w_p = weight_at(robot, solver, kinematics, target, coordinate, before)
            was, is_ = objective(robot, target, before, w_p), objective(robot, target, after, w_p)
            assert is_ <= was + 1e-12 * max(1.0, was)
            changed += is_ < was
            assert not with_limits or is_inside(robot, after)
    assert changed > 5


@pytest.mark.parametrize(("name", "frame"), CASES)
@pytest.mark.parametrize("kind", ["position", "pose"])
def test_each_joint_update_is_the_best_of_all_angles_in_its_limits(name, frame, kind):
    """Brute force: no angle of a fine grid over the joint's range does better than the closed form."""
    robot = load_quietly(name)
    rng = np.random.default_rng(8)
    limits = Limits.of(robot, True)
    solver = CCD(relaxation=1.0)
    wanted = robot.placement(frame, robot.random(rng))
    target = Target(frame, placement=wanted) if kind == "pose" else Target(frame, wanted.translation)
    for coordinate, before, after, kinematics in single_updates(robot, target, solver, robot.random(rng), limits):
        w_p = weight_at(robot, solver, kinematics, target, coordinate, before)
        found = objective(robot, target, after, w_p)
        for tried in turned_everywhere(robot, coordinate.joint.name, before):
            assert objective(robot, target, tried, w_p) >= found - 1e-12


HINGE = robot_text(
    link("base"),
    link("hand"),
    link("tip"),
    joint("turn", "base", "hand", '<axis xyz="0 0 1"/>', limit=limited(-3.0, 3.0)),
    joint("end", "hand", "tip", '<origin xyz="1 0 0"/>', kind="fixed", limit=""),
)


def one_update(text, start, position, **options):
    robot = load_quietly(text)
    solver = CCD(**options)
    kinematics = Kinematics(robot, [Target("tip", position)])
    q, _ = solver.sweep(robot.configuration(start), kinematics, Limits.of(robot, True), NEVER)
    return robot.angles(q)


@pytest.mark.parametrize("relaxation", [1.0, 1.7])
def test_a_blocked_joint_goes_the_other_way_round_and_does_not_overshoot_there(relaxation):
    wanted = 3.4 - 2.0 * math.pi  # 0.5 ahead of 2.9, but the limit at 3.0 is between
    goal = [math.cos(wanted), math.sin(wanted), 0.0]
    turned = one_update(HINGE, {"turn": 2.9}, goal, relaxation=relaxation)
    assert turned["turn"] == pytest.approx(wanted, abs=1e-12)


def test_where_both_ways_are_blocked_the_better_limit_is_taken():
    turned = one_update(HINGE, {"turn": 0.0}, [math.cos(3.05), math.sin(3.05), 0.0])
    assert turned["turn"] == 3.0
    turned = one_update(HINGE, {"turn": 2.0}, [math.cos(3.2), math.sin(3.2), 0.0])
    assert turned["turn"] == -3.0


def test_stiffness_makes_a_joint_move_its_part_of_the_way():
    target = [math.cos(1.2), math.sin(1.2), 0.0]
    assert one_update(HINGE, {"turn": 0.2}, target)["turn"] == pytest.approx(1.2, abs=1e-12)
    assert one_update(HINGE, {"turn": 0.2}, target, stiffness={"turn": 0.25})["turn"] == pytest.approx(0.45, abs=1e-12)
    assert one_update(HINGE, {"turn": 0.2}, target, stiffness={"turn": 0.0})["turn"] == 0.2


def test_stiffness_counters_the_preference_for_distal_joints(arm):
    """Welman §4.3: CCD moves distal joints more readily; w_i below 1 there spreads the motion."""
    target = Target("tip", [0.35, 0.1, 0.95])

    def share_of_last_joints(**options):
        s = arm.solve(target, method="ccd", restarts=0, **options)
        assert s.success
        return sum(abs(s.q[-4:])) / sum(abs(s.q))

    plain = share_of_last_joints()
    soft = share_of_last_joints(stiffness={f"bone{i}_{a}": 0.05 for i in (4, 5, 6) for a in "xz"})
    assert soft < 0.6 * plain


SLIDE = robot_text(
    link("base"),
    link("hand"),
    link("tip"),
    joint("slide", "base", "hand", '<axis xyz="0 0.6 0.8"/>', kind="prismatic", limit=limited(-0.5, 0.5)),
    joint("end", "hand", "tip", '<origin xyz="1 0 0"/>', kind="fixed", limit=""),
)


def test_a_slide_goes_to_the_point_nearest_the_target():
    moved = one_update(SLIDE, {"slide": 0.1}, [3.0, 0.3, 0.1])
    assert moved["slide"] == pytest.approx(0.6 * 0.3 + 0.8 * 0.1, abs=1e-12)
    assert one_update(SLIDE, {"slide": 0.1}, [3.0, 3.0, 1.0])["slide"] == 0.5


def test_a_moving_reference_is_chased_from_both_sides():
    """The reference hangs on a hinge of its own: turning it the other way brings the goal to the effector."""
    text = robot_text(
        *(link(name) for name in ("base", "left", "right", "tip")),
        joint("a", "base", "left", '<axis xyz="0 0 1"/>', limit=limited(-2.0, 2.0)),
        joint("b", "base", "right", '<axis xyz="0 0 1"/>', limit=limited(-2.0, 2.0)),
        joint("end", "right", "tip", '<origin xyz="1 0 0"/>', kind="fixed", limit=""),
    )
    robot = load_quietly(text)
    angle = 0.7
    target = Target("tip", [math.cos(angle), math.sin(angle), 0.0], relative_to="left")
    for locked in (["a"], ["b"]):
        s = robot.solve(target, method="ccd", locked=locked, restarts=0)
        assert s.success
        assert s.angles["b"] - s.angles["a"] == pytest.approx(angle, abs=1e-3)
        assert s.iterations == 1


def test_a_leader_whose_followers_move_the_target_too_goes_downhill():
    text = robot_text(
        *(link(name) for name in ("base", "upper", "lower", "tip")),
        joint("lead", "base", "upper", '<axis xyz="0 0 1"/>', limit=limited(-1.5, 1.5)),
        joint("z_follow", "upper", "lower", '<origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>',
              '<mimic joint="lead" multiplier="0.5"/>', limit=limited(-1.5, 1.5)),
        joint("z_end", "lower", "tip", '<origin xyz="0.5 0 0"/>', kind="fixed", limit=""),
    )  # fmt: skip
    robot = load_quietly(text)
    assert robot.mimics == {"z_follow": ("lead", 0.5, 0.0)}
    wanted = robot.placement("tip", robot.configuration({"lead": 1.1})).translation
    s = robot.solve("tip", position=wanted, method="ccd", restarts=0, trace=True)
    assert_good(s)
    assert s.angles["lead"] == pytest.approx(1.1, abs=1e-3)
    errors = [state.position_error for state in s.trace]
    assert errors == sorted(errors, reverse=True)


def test_k_over_w_squared_makes_the_steps_independent_of_scale_and_the_printed_form_does_not():
    def angles(scale, scaling):
        text = robot_text(
            *(link(name) for name in ("base", "a", "b", "c")),
            joint("j1", "base", "a", f'<origin xyz="0 0 {0.2 * scale}"/><axis xyz="0 1 0"/>', limit=limited(-3, 3)),
            joint("j2", "a", "b", f'<origin xyz="{0.5 * scale} 0 0"/><axis xyz="0 0 1"/>', limit=limited(-3, 3)),
            joint("j3", "b", "c", f'<origin xyz="{0.4 * scale} 0 0"/><axis xyz="0 1 0"/>', limit=limited(-3, 3)),
        )
        robot = load_quietly(text)
        target = Target("c", np.array([0.3, 0.4, 0.5]) * scale, rpy=[0.3, -0.8, 1.0])
        states = list(pinik.iterate(robot, target, CCD(scaling=scaling), max_iterations=5, tolerance=NEVER))
        return states[5].q

    assert np.allclose(angles(1.0, "area"), angles(30.0, "area"), atol=1e-9)
    assert not np.allclose(angles(1.0, "printed"), angles(30.0, "printed"), atol=1e-3)


def test_a_sweep_ends_at_the_joint_that_reaches_the_target(arm):
    """Only the last joint has to move: one joint update, and the others are not touched."""
    q0 = arm.neutral()
    goal = arm.configuration({"bone6_z": 0.3})
    s = arm.solve("tip", position=arm.placement("tip", goal).translation, method="ccd", q0=q0)
    assert s.success
    assert (s.iterations, s.joint_updates) == (1, 1)
    assert s.angles["bone6_z"] == pytest.approx(0.3, abs=1e-3)


def test_the_axis_of_a_frame_is_turned_towards_a_point_it_moves_around():
    """L(1 − cos θ) never grows: L the distance to the point, θ the angle between axis and line of sight."""
    robot = load_quietly("panda")
    rng = np.random.default_rng(3)
    limits = Limits.of(robot, True)
    for _ in range(10):
        at = rng.uniform(-1, 1, 3)
        target = Target("panda_hand", axis="z", at=at)

        def badness(q, target=target, at=at):
            M = robot.placement("panda_hand", q)
            line = at - M.translation
            return float(np.linalg.norm(line) - line @ M.rotation @ target.axis)

        for _, before, after, _ in single_updates(robot, target, CCD(relaxation=1.0), robot.random(rng), limits):
            assert badness(after) <= badness(before) + 1e-12


FOLLOWER_BEYOND = {
    "the follower beyond other joints": robot_text(
        *(link(name) for name in ("base", "a", "b", "c", "tip")),
        joint("j1", "base", "a", '<axis xyz="0 0 1"/>', limit=limited(-3, 3)),
        joint("j2", "a", "b", '<origin xyz="1 0 0"/><axis xyz="0 1 0"/>', limit=limited(-3, 3)),
        joint("j3", "b", "c", '<origin xyz="1 0 0"/><axis xyz="0 0 1"/>', '<mimic joint="j1"/>', limit=limited(-3, 3)),
        joint("z_end", "c", "tip", '<origin xyz="1 0 0"/>', kind="fixed", limit=""),
    ),
    "the leader in another branch": robot_text(
        *(link(name) for name in ("base", "side", "a", "b", "c", "tip")),
        joint("a_lead", "base", "side", '<axis xyz="0 0 1"/>', limit=limited(-3, 3)),
        joint("b1", "base", "a", '<axis xyz="0 0 1"/>', limit=limited(-3, 3)),
        joint("b2", "a", "b", '<origin xyz="1 0 0"/><axis xyz="0 1 0"/>', limit=limited(-3, 3)),
        joint("b3", "b", "c", '<origin xyz="1 0 0"/><axis xyz="0 0 1"/>', '<mimic joint="a_lead" multiplier="0.25"/>',
              limit=limited(-3, 3)),
        joint("z_end", "c", "tip", '<origin xyz="1 0 0"/>', kind="fixed", limit=""),
    ),
}  # fmt: skip


@pytest.mark.parametrize("relative_to", [None, "a"])
@pytest.mark.parametrize("text", FOLLOWER_BEYOND.values(), ids=FOLLOWER_BEYOND)
def test_sweeps_never_go_uphill_where_followers_move_what_their_leaders_do_not(text, relative_to):
    robot = load_quietly(text)
    rng = np.random.default_rng(2)
    limits = Limits.of(robot, True)
    for _ in range(40):
        wanted = robot.placement("tip", robot.random(rng), relative_to).translation
        target = Target("tip", wanted, relative_to=relative_to)
        kinematics = Kinematics(robot, [target])
        q = robot.random(rng)
        for _ in range(4):
            after, _ = CCD().sweep(q, kinematics, limits, NEVER)
            assert objective(robot, target, after, 1.0) <= objective(robot, target, q, 1.0) + 1e-12
            q = after


def test_max_step_is_the_leaders_not_the_followers():
    robot = load_quietly(FOLLOWER_BEYOND["the leader in another branch"])
    target = Target("tip", robot.placement("tip", robot.configuration({"a_lead": 2.0})).translation)
    *_, state = pinik.iterate(robot, target, CCD(max_step=0.1), max_iterations=1)
    assert np.abs(state.q).max() == pytest.approx(0.1)


def test_a_joint_of_stiffness_zero_is_held_through_restarts_as_well(arm):
    wanted = arm.placement("tip", arm.random(10))
    s = arm.solve("tip", placement=wanted, method="ccd", stiffness={"bone1_x": 0.0}, restarts=3, max_iterations=50)
    assert s.angles["bone1_x"] == 0.0
    held = arm.solve("tip", placement=wanted, method="ccd", stiffness=dict.fromkeys(arm.joint_names, 0.0))
    assert (held.iterations, held.joint_updates) == (0, 0)


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
def test_a_leader_whose_followers_cancel_what_it_does_stays(engine):
    """A parallel gripper's finger tip keeps its direction; rounding in its column must not send the finger away."""
    x, y, z = pinocchio.rpy.rpyToMatrix(0.4, 0.7, 0.2).T @ [0.48, 0.6, 0.64]  # the leader's axis, seen from the pad
    text = robot_text(
        *(link(name) for name in ("base", "finger", "pad", "tip")),
        joint("lead", "base", "finger", '<origin xyz="0 0 0" rpy="0.3 0.2 0.1"/><axis xyz="0.48 0.6 0.64"/>'),
        joint("z_follow", "finger", "pad", f'<origin xyz="0.1 0 0" rpy="0.4 0.7 0.2"/><axis xyz="{x} {y} {z}"/>',
              '<mimic joint="lead" multiplier="-1"/>'),
        joint("turn", "pad", "tip", '<origin xyz="0.1 0 0" rpy="0.1 0.2 0.3"/><axis xyz="0 0 1"/>'),
    )  # fmt: skip
    gripper = load_quietly(text)
    wanted = gripper.placement("tip", gripper.configuration({"turn": 1.1})).rotation[:, 0]
    lead = gripper.joint_names.index("lead")

    def rounding(angle):
        return np.abs(gripper.jacobian("tip", gripper.configuration({"lead": angle, "turn": -0.7}))[3:, lead]).max()

    led = next(angle for angle in np.linspace(0.1, 0.9, 50).tolist() if 0.0 < rounding(angle) < 1e-15)
    start = gripper.configuration({"lead": led, "turn": -0.7})
    options = {"method": "ccd", "limits": False, "restarts": 0, "engine": engine}
    s = gripper.solve("tip", axis="x", direction=wanted, q0=start, **options)
    assert s.success
    assert s.angles["lead"] == led


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
@pytest.mark.parametrize(("arm", "height"), [(1e-5, 1.0), (1e-6, 1.0), (1e-4, 1000.0), (1e-9, 0.1)])
def test_a_hinge_turns_a_point_that_is_much_farther_along_its_axis_than_beside_it(engine, arm, height):
    text = robot_text(
        *(link(name) for name in ("base", "part", "tip")),
        joint("turn", "base", "part", '<axis xyz="0 0 1"/>'),
        joint("z_end", "part", "tip", f'<origin xyz="{arm!r} 0 {height!r}"/>', kind="fixed", limit=""),
    )
    options = {"method": "ccd", "restarts": 0, "tolerance": (arm / 1000.0, 1.0), "engine": engine}
    s = load_quietly(text).solve("tip", position=[0.0, arm, height], **options)
    assert s.success
    assert s.angles["turn"] == pytest.approx(math.pi / 2, abs=1e-3)


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
def test_a_hinge_whose_axis_runs_through_the_effector_stays(engine):
    """Far from the world's origin rounding puts the effector beside the axis, and would turn it anywhere."""
    text = robot_text(
        *(link(name) for name in ("base", "arm", "part", "tip")),
        joint("lift", "base", "arm", '<origin xyz="3 -7 5" rpy="0.3 0.5 0.7"/><axis xyz="0 1 0"/>'),
        joint("spin", "arm", "part", '<origin xyz="0.3 0.1 0.2" rpy="0.2 0.9 0.4"/><axis xyz="0 0 1"/>'),
        joint("z_end", "part", "tip", '<origin xyz="0 0 0.08"/>', kind="fixed", limit=""),
    )
    robot = load_quietly(text)
    rng = np.random.default_rng(0)
    for _ in range(50):
        start = robot.random(rng)
        wanted = robot.placement("tip", robot.random(rng)).translation
        s = robot.solve("tip", position=wanted, method="ccd", q0=start, restarts=0, max_iterations=3, engine=engine)
        assert s.angles["spin"] == start[robot.joint_names.index("spin")]


def swept(text, targets, start, **parameters):
    """The angles after one sweep from `start`, inside the limits."""
    robot = load_quietly(text)
    q, _ = CCD(**parameters).sweep(robot.configuration(start), Kinematics(robot, targets), Limits.of(robot), NEVER)
    return robot.angles(q)


def test_a_slide_that_two_targets_pull_goes_where_the_squares_of_their_weighted_distances_are_least():
    ends = [("left", -1.0), ("right", 1.0)]
    text = robot_text(
        *(link(name) for name in ("base", "hand", "left", "right")),
        joint("slide", "base", "hand", '<axis xyz="1 0 0"/>', kind="prismatic", limit=limited(-5, 5)),
        *(joint(f"to_{n}", "hand", n, f'<origin xyz="{x} 0 0"/>', kind="fixed", limit="") for n, x in ends),
    )
    wanted = [Target("left", [-0.9, 0.0, 0.0], weight=1.0), Target("right", [1.7, 0.0, 0.0], weight=3.0)]
    places = np.linspace(-5.0, 5.0, 100_001)
    squares = (1.0 * (places - 1.0 + 0.9)) ** 2 + (3.0 * (places + 1.0 - 1.7)) ** 2
    assert swept(text, wanted, {})["slide"] == pytest.approx(places[squares.argmin()], abs=1e-4)


def test_a_slide_that_carries_the_reference_brings_the_goal_to_the_effector():
    text = robot_text(
        *(link(name) for name in ("base", "table", "tip")),
        joint("slide", "base", "table", '<axis xyz="1 0 0"/>', kind="prismatic", limit=limited(-5, 5)),
        joint("end", "base", "tip", '<origin xyz="0.5 0 0"/>', kind="fixed", limit=""),
    )
    target = Target("tip", [0.2, 0.0, 0.0], relative_to="table")
    assert swept(text, [target], {})["slide"] == pytest.approx(0.3, abs=1e-12)


LED = (
    *(link(name) for name in ("base", "upper", "lower", "tip")),
    joint("z_follow", "upper", "lower", '<origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>',
          '<mimic joint="lead" multiplier="0.5"/>', limit=limited(-3, 3)),
    joint("z_end", "lower", "tip", '<origin xyz="0.5 0 0"/>', kind="fixed", limit=""),
)  # fmt: skip


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_leader_turns_to_the_side_of_its_target_and_stops_at_its_limit_and_at_max_step(side):
    text = robot_text(*LED, joint("lead", "base", "upper", '<axis xyz="0 0 1"/>', limit=limited(-0.2, 0.2)))
    robot = load_quietly(text.replace("0.2", "1.5"))
    target = Target("tip", robot.placement("tip", robot.configuration({"lead": 1.1 * side})).translation)
    assert swept(text, [target], {})["lead"] == pytest.approx(0.2 * side, abs=1e-12)
    assert swept(text, [target], {}, max_step=0.15)["lead"] == pytest.approx(0.15 * side, abs=1e-12)


@pytest.mark.parametrize("part", [1.0, 0.5])
def test_a_leader_of_a_follower_that_slides_as_well_goes_its_part_of_the_way_in_one_step(part):
    """Leader and follower move the tip by 1.5 times the leader's slide, so that 0.4 m of it reach 0.6 m."""
    slide = {"kind": "prismatic", "limit": limited(-3, 3)}
    follow = '<mimic joint="lead" multiplier="0.5"/>'
    text = robot_text(
        *(link(name) for name in ("base", "upper", "tip")),
        joint("lead", "base", "upper", '<axis xyz="1 0 0"/>', **slide),
        joint("z_follow", "upper", "tip", '<axis xyz="1 0 0"/>', follow, **slide),
    )
    lead = swept(text, [Target("tip", [0.6, 0.0, 0.0])], {}, stiffness={"lead": part})["lead"]
    assert lead == pytest.approx(0.4 * part, abs=1e-12)


def test_the_joints_that_are_held_are_those_of_stiffness_zero():
    assert CCD(stiffness={"a": 0.0, "b": 1.0, "c": 0.5, "d": 0.0}).held == ("a", "d")


HANDS = robot_text(
    *(link(name) for name in ("base", "arm", "hand", "rail", "table")),
    joint("swing", "base", "arm", '<origin xyz="0.1 0 0.3"/><axis xyz="0.6 0 0.8"/>', limit=limited(-3, 3)),
    joint("reach", "arm", "hand", '<origin xyz="0.4 0.1 0" rpy="0.3 0 0.2"/><axis xyz="1 0 0"/>',
          kind="prismatic", limit=limited(-2, 2)),
    joint("run", "base", "rail", '<axis xyz="0 1 0"/>', kind="prismatic", limit=limited(-2, 2)),
    joint("tilt", "rail", "table", '<origin xyz="0.5 0 0"/><axis xyz="0 0.6 0.8"/>', limit=limited(-3, 3)),
)  # fmt: skip


@pytest.mark.parametrize(
    "target",
    [
        Target("hand", [0.3, 0.2, 0.1], relative_to="table"),
        Target("hand", [0.3, 0.2, 0.1], rpy=[0.2, -0.4, 1.0], relative_to="table"),
        Target("hand", [0.3, 0.2, 0.1], axis="x", direction=[0.0, 0.6, 0.8], relative_to="table"),
        Target("hand", axis="x", at=[0.9, -0.3, 0.5], relative_to="table"),
        Target("hand", [0.3, 0.2, 0.1], axis="z", at=[0.9, -0.3, 0.5]),
    ],
    ids=["position", "pose", "axis along a direction", "axis towards a point", "position and axis"],
)
def test_a_sweep_is_its_joint_updates_one_after_the_other(target):
    """Within a sweep, points and axes are carried along; each single update takes them from Pinocchio instead."""
    robot = load_quietly(HANDS)
    start = robot.configuration({"swing": 0.4, "reach": -0.3, "run": 0.2, "tilt": 0.7})
    limits = Limits.of(robot)
    whole, count = CCD(relaxation=1.0).sweep(start, Kinematics(robot, [target]), limits, NEVER)
    updates = list(single_updates(robot, target, CCD(relaxation=1.0), start, limits))
    assert count == len(updates)
    np.testing.assert_allclose(whole, updates[-1][2], rtol=0.0, atol=1e-12)
    assert np.abs(whole - start).min() > 1e-3 or target.relative_to is None, "every joint moves"


@settings(deadline=None)
@given(*(st.floats(-1.0, 1.0) for _ in range(2)), *(st.floats(0.0, 7.0) for _ in range(2)))
def test_no_angle_in_the_range_is_better_than_the_turn(cosine, sine, below, above):
    turn = _best_turn(cosine, sine, -below, above, shortest=False)
    assert -below <= turn <= above
    angles = np.linspace(-below, above, 2_001)
    best = (cosine * np.cos(angles) + sine * np.sin(angles)).max()
    assert cosine * math.cos(turn) + sine * math.sin(turn) >= best - 1e-12


def test_the_relaxation_is_the_given_one_else_that_of_poses_and_none_inside_tolerances(arm):
    pose = Kinematics(arm, Target("tip", (0.3, 0.1, 0.4), rpy=(0.0, 0.1, 0.2))).problem
    position = Kinematics(arm, Target("tip", (0.3, 0.1, 0.4))).problem
    assert CCD(relaxation=1.3).relaxation_for(pose) == CCD(relaxation=1.3).relaxation_for(pose, loose=True) == 1.3
    assert CCD().relaxation_for(pose) > 1.0
    assert CCD().relaxation_for(pose, loose=True) == CCD().relaxation_for(position) == 1.0
