"""One target during a sweep, against plain geometry: what counts as reached, what draws, and how it turns."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import axis, limit, mimic, origin, random_rotation, rotation_about
from judge import judge
from pinik import CCD, Kinematics, Target, Tolerance
from pinik.model.limits import Limits
from pinik.problem.slack import SHARE
from pinik.solvers.chaser import Chaser
from robots import load_quietly
from urdf_texts import joint, link
from urdf_texts import robot as robot_text

NEVER = Tolerance(1e-30, 1e-30)
WIDE = 0.2  # [rad]


def chaser(
    robot: pinik.Robot,
    target: Target,
    q: np.ndarray,
    *,
    alpha: float = 1.0,
    max_residual: float = math.inf,
    loose: bool = False,
) -> Chaser:
    kinematics = Kinematics(robot, [target])
    pinocchio.forwardKinematics(kinematics.model, kinematics.data, q)
    return Chaser(kinematics.rows[0], alpha, max_residual, loose)


def unit(rng: np.random.Generator) -> np.ndarray:
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


def turned(R: np.ndarray, rng: np.random.Generator, angle: float) -> np.ndarray:
    """A rotation matrix `angle` away from R."""
    return rotation_about(unit(rng), angle) @ R


@pytest.mark.parametrize("relative_to", [None, "forearm_link"])
@pytest.mark.parametrize("with_rotation", [False, True])
def test_a_position_is_reached_inside_the_box_and_not_beside_it(ur5, relative_to, with_rotation):
    rng = np.random.default_rng(1)
    box, angle = np.array([0.03, 0.002, 0.01]), 0.5
    verdicts = set()
    for _ in range(200):
        q = ur5.random(rng)
        here = ur5.placement("tool0", q, relative_to)
        rotation = turned(here.rotation, rng, rng.uniform(0.0, 1.2 * angle)) if with_rotation else None
        axes = np.eye(3) if rotation is None else rotation
        away = axes @ (box * rng.uniform(-1.3, 1.3, 3))
        target = Target(
            "tool0",
            here.translation + away,
            rotation=rotation,
            relative_to=relative_to,
            tolerance=(box.tolist(), angle),
        )
        reached = chaser(ur5, target, q).within(NEVER)
        assert reached is judge(ur5, target, q).are_within()
        verdicts.add(reached)
    assert verdicts == {True, False}


@pytest.mark.parametrize("kind", ["rotation", "direction", "at"])
def test_loose_axes_are_drawn_to_the_near_edge_of_the_tolerance(ur5, kind):
    rng = np.random.default_rng(2)
    for angle in (0.05, 0.17, 0.19, 0.5, 2.0):
        q = ur5.random(rng)
        here = ur5.placement("tool0", q)
        own = unit(rng)
        across = np.cross(here.rotation @ own, unit(rng))
        across /= np.linalg.norm(across)
        wanted = rotation_about(across, angle) @ here.rotation
        fields = {
            "rotation": {"rotation": wanted},
            "direction": {"axis": own, "direction": wanted @ own},
            "at": {"axis": own, "at": here.translation + 0.7 * wanted @ own},
        }[kind]
        target = Target("tool0", tolerance=(1.0, WIDE), **fields)
        drawn = chaser(ur5, target, q, loose=True)._drawn_axes()
        if angle <= SHARE * WIDE:
            assert drawn is None
            continue
        axes = here.rotation if kind == "rotation" else (here.rotation @ own)[:, None]
        np.testing.assert_allclose(drawn, rotation_about(across, angle - SHARE * WIDE) @ axes, atol=1e-9)


def test_axes_that_are_not_loose_are_drawn_all_the_way(ur5):
    rng = np.random.default_rng(3)
    R = random_rotation(rng)
    target = Target("tool0", rotation=R, tolerance=(1.0, WIDE))
    np.testing.assert_array_equal(chaser(ur5, target, ur5.random(rng))._drawn_axes(), R)


BOX = np.array([0.03, 0.002, 0.01])  # [m]


@pytest.mark.parametrize("max_residual", [math.inf, 0.04])
@pytest.mark.parametrize("kind", ["ball", "box", "box along a rotation", "whole", "free along y"])
def test_a_position_is_drawn_to_the_near_edge_of_what_is_allowed_and_at_most_d_max_far(ur5, kind, max_residual):
    rng = np.random.default_rng(5)
    edge = SHARE * BOX
    drawn_at_all = set()
    for _ in range(100):
        q = ur5.random(rng)
        here = ur5.placement("tool0", q)
        axes = random_rotation(rng) if kind == "box along a rotation" else np.eye(3)
        away = rng.uniform(-2.0, 2.0, 3) * BOX  # from goal to effector, along the axes of the target
        goal = here.translation - axes @ away
        rotation = axes if kind == "box along a rotation" else None
        tolerance = (0.03 if kind == "ball" else BOX.tolist(), 1.0)
        position = [goal[0], None, goal[2]] if kind == "free along y" else goal
        target = Target("tool0", position, rotation=rotation, tolerance=tolerance)
        loose = kind in ("ball", "box", "box along a rotation")
        drawn = chaser(ur5, target, q, max_residual=max_residual, loose=loose)._drawn_goal()
        length = np.linalg.norm(away)
        near = {  # the nearest allowed position, seen from the goal
            "ball": away * min(1.0, SHARE * 0.03 / length),
            "whole": np.zeros(3),
            "free along y": away * [0.0, 1.0, 0.0],
        }.get(kind, np.clip(away, -edge, edge))
        left = axes @ (near - away)
        distance = np.linalg.norm(left)
        drawn_at_all.add(drawn is not None)
        if distance == 0.0:
            assert drawn is None
            continue
        np.testing.assert_allclose(drawn, here.translation + left * min(1.0, max_residual / distance), atol=1e-12)
    assert drawn_at_all == ({True, False} if loose else {True})


@pytest.mark.parametrize("beside", [0.0, 1e-7])
def test_an_axis_at_the_point_that_it_should_point_at_points_there(ur5, beside):
    q = ur5.random(6)
    here = ur5.placement("tool0", q)
    one = chaser(ur5, Target("tool0", axis="x", at=here.translation + beside * here.rotation[:, 1]), q)
    assert one.angle() < 1e-15
    assert one.within(Tolerance(1e-30, 1e-15))


HINGES = robot_text(
    *(link(name) for name in ("base", "arm", "hand", "table")),
    joint("shoulder", "base", "arm", origin((0.1, 0.2, 0.3), (0.4, 0, 0)), axis(0.6, 0, 0.8)),
    joint("wrist", "arm", "hand", origin((0.4, 0.1, 0), (0, 0.5, 0.2)), axis(0, 1, 0)),
    joint("tilt", "base", "table", origin((0.5, 0, 0.1)), axis(0, 0.6, 0.8)),
)
TARGETS = {
    "position": Target("hand", (0.3, 0.2, 0.1), relative_to="table"),
    "pose": Target("hand", (0.3, 0.2, 0.1), rpy=(0.2, -0.4, 1.0), relative_to="table", weight=3.0),
    "direction": Target("hand", axis=(1, 2, 3), direction=(0, 0.6, 0.8), relative_to="table"),
    "point to look at": Target("hand", axis="x", at=(0.9, -0.3, 0.5), relative_to="table"),
}


def scene(target: Target, mover: str) -> tuple[Chaser, np.ndarray, np.ndarray, object]:
    """A chaser at some configuration; a hinge's axis and origin in the world; the hinge."""
    robot = load_quietly(HINGES)
    q = robot.configuration({"shoulder": 0.4, "wrist": -0.7, "tilt": 0.9})
    own = robot.joint(mover)
    pinocchio.forwardKinematics(robot.model, robot.data, q)
    placement = robot.data.oMi[own.id]
    return chaser(robot, target, q, alpha=2.0), placement.rotation @ own.axis, placement.translation.copy(), own


@pytest.mark.parametrize("mover", ["shoulder", "wrist", "tilt"])
@pytest.mark.parametrize("kind", TARGETS)
def test_the_sums_across_an_axis_tell_how_well_each_turn_about_it_aims(kind, mover):
    """Σ w (turned c)·d changes by cosine (cos φ − 1) + sine sin φ; what carries the goal turns it the other way."""
    target = TARGETS[kind]
    one, direction, point, own = scene(target, mover)
    cosine, sine, _ = one.across(direction, point, own)
    pairs = [(c - point, d - point, w) for c, d, w in one.point_pairs(point)]
    if one.U is not None and one.V is not None:
        pairs += [(u, v, 1.0) for u, v in zip(one.U.T, one.V.T, strict=True)]

    def aim(angle: float) -> float:
        R = rotation_about(direction, -angle if mover == "tilt" else angle)
        return sum(w * float((R @ c) @ d) for c, d, w in pairs)  # alone, a target weighs 1

    for angle in (-2.0, -0.3, 0.1, 1.0, 3.0):
        expected = cosine * (math.cos(angle) - 1.0) + sine * math.sin(angle)
        assert aim(angle) - aim(0.0) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("kind", ["position", "pose"])
def test_the_error_scale_of_the_sums_bounds_what_rounding_does_to_them_and_not_far_from_above(kind):
    rng = np.random.default_rng(4)
    rounding = 1e-7
    one, direction, point, own = scene(TARGETS[kind], "wrist")
    cosine, sine, blur = one.across(direction, point, own)
    p, goal, largest = one.p, one.goal, 0.0
    for _ in range(300):
        one.p = p + rounding * np.linalg.norm(p) * unit(rng)
        one.goal = goal + rounding * np.linalg.norm(goal) * unit(rng)
        moved = one.across(direction, point + rounding * np.linalg.norm(point) * unit(rng), own)
        largest = max(largest, abs(moved[0] - cosine), abs(moved[1] - sine))
    assert largest <= rounding * blur <= 10.0 * largest


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("ballast", [None, 1000.0], ids=["alone", "beside a target a million times as heavy"])
@pytest.mark.parametrize(("left_over", "moves"), [(1e-9, True), (1e-14, False)])
def test_a_leader_moves_for_what_its_follower_leaves_over_unless_that_is_rounding(size, ballast, left_over, moves):
    text = robot_text(
        *(link(name) for name in ("base", "finger", "pad", "tip", "other", "end")),
        joint("lead", "base", "finger", axis(0, 0, 1), limit=limit(-3, 3)),
        joint("z_follow", "finger", "pad", origin((size, 0, 0)), axis(0, 0, 1), mimic("lead", left_over - 1.0)),
        joint("z_tip", "pad", "tip", origin((size, 0, 0)), kind="fixed", limit=""),
        joint("other", "base", "other", axis(0, 0, 1)),
        joint("z_end", "other", "end", origin((size, 0, 0)), kind="fixed", limit=""),
    )
    robot = load_quietly(text)
    targets = [Target("tip", axis="x", direction=(0, 1, 0), weight=1.0 if ballast is None else 1.0 / ballast)]
    if ballast is not None:
        targets.append(Target("end", (size, 0, 0), weight=ballast))
    q, _ = CCD().sweep(robot.neutral(), Kinematics(robot, targets), Limits.of(robot), NEVER)
    assert robot.angles(q)["lead"] == (3.0 if moves else 0.0)
    assert robot.angles(q)["other"] == 0.0
