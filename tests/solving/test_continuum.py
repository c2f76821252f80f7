"""Answers at singular places: those of a curve or a surface, and those at which two isolated ones meet."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest
from scipy.optimize import least_squares

import pinik
from engines import needs_native
from every_answer import Arm, hinge_arm, inside, puma, puma_answers, turned_near, unlike
from judge import is_good
from pinik import Target
from robots import load_quietly

every_engine = pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])

EXACT = (1e-8, 1e-8)  # [m], [rad]
PLANAR = hinge_arm("zz", [(0, 0, 0), (0.5, 0, 0), (0.4, 0, 0)], (-4.0, 4.0))
TURRET = [(0, 0, 0.3), (0, 0, 0), (0.5, 0, 0), (0.4, 0, 0)]  # the steps of a hinge upwards with two across


def conditioning(robot: pinik.Robot, frame: str, q: np.ndarray) -> float:
    """The smallest singular value of Pinocchio's own Jacobian, relative to the largest."""
    model = robot.model
    data = model.createData()
    J = pinocchio.computeFrameJacobian(model, data, q, model.getFrameId(frame), pinocchio.LOCAL_WORLD_ALIGNED)
    sigma = np.linalg.svd(J, compute_uv=False)
    return float(sigma[-1] / sigma[0])


@every_engine
@pytest.mark.parametrize("seed", [0, 1, 5])
def test_the_ur5_with_parallel_wrist_axes_has_isolated_answers_and_curves(seed, engine):
    robot = load_quietly("ur5")
    q = robot.random(np.random.default_rng(seed))
    q[4] = 0.0
    arm, place = Arm(robot.urdf, "tool0"), robot.placement("tool0", q)
    branches = robot.solve_all("tool0", placement=place, engine=engine)
    for answer, dimension in zip(branches, branches.dimension, strict=True):
        assert dimension == (conditioning(robot, "tool0", answer) < 1e-6)
        assert is_good(robot, {"frame": "tool0", "placement": place}, answer, EXACT)
    # What the search in plain numpy finds where its Jacobian is regular.
    regular = [way for way in arm.answers(place.homogeneous) if arm.least_singular_value(way) > 1e-3]
    isolated = branches.q[branches.dimension == 0]
    assert len(isolated) >= 2
    assert unlike(isolated, inside(regular, arm.lower, arm.upper)) == ([], [])
    assert branches.redundancy == 1
    assert math.isinf(branches.estimate_missing)
    assert 4 <= (branches.dimension == 1).sum() <= 32
    assert branches.starts < 128
    assert f": {len(isolated)} isolated, and {len(branches) - len(isolated)} of infinitely many" in branches.message
    assert [branch["dimension"] for branch in branches.to_dict()["branches"]] == branches.dimension.tolist()


def test_the_curves_of_singular_answers_can_be_followed():
    robot = load_quietly("ur5")
    q = np.array([0.3, -1.0, 1.2, 0.4, 0.0, 0.5])
    branches = robot.solve_all("tool0", placement=robot.placement("tool0", q))
    curved = branches.q[branches.dimension == 1]
    assert branches.families
    for family in branches.families:
        assert family.dimension == 1
        assert family.length > 1.0
        asked = {"frame": "tool0", "placement": robot.placement("tool0", q)}
        assert all(is_good(robot, asked, point, EXACT) for point in family.q[::20])
    assert all(any(family.contains(way) for family in branches.families) for way in curved)


@every_engine
def test_a_spherical_wrist_in_line_has_a_curve_along_which_the_sum_of_its_angles_stays(engine):
    robot, arm = pinik.load(puma()), Arm(puma(), "tip")
    q = np.array([0.4, -0.5, 1.1, 0.7, 0.0, -1.2])
    place = arm.placement(q)
    wanted = puma_answers(place)
    others = [way for way in wanted if abs(way[4]) > 1e-3]
    in_line = [way for way in wanted if abs(way[4]) < 1e-3]
    branches = robot.solve_all("tip", placement=place, engine=engine)
    isolated = branches.q[branches.dimension == 0]
    assert unlike(isolated, inside(others, arm.lower, arm.upper)) == ([], [])
    assert len(others) == 6
    curved = branches.q[branches.dimension == 1]
    assert len(curved) >= 4
    for way in curved:
        assert abs(way[4]) < 1e-6
        assert np.abs(turned_near(way[:3] - in_line[0][:3])).max() < 1e-6
        assert abs(turned_near(way[3] + way[5] - q[3] - q[5])) < 1e-6


@every_engine
def test_a_stretched_arm_has_one_isolated_answer(engine):
    robot = pinik.load(PLANAR)
    for missing in (0.0, 1e-12, 1e-9):
        at = [(0.9 - missing) * math.cos(0.3), (0.9 - missing) * math.sin(0.3), 0.0]
        branches = robot.solve_all("tip", position=at, engine=engine)
        assert len(branches) == 1
        assert branches[0] == pytest.approx([0.3, 0.0], abs=2e-4)
        assert branches.dimension.tolist() == [0]
        assert branches.redundancy == 0


@every_engine
def test_a_stretched_elbow_of_a_whole_arm_is_isolated(engine):
    robot, arm = pinik.load(puma()), Arm(puma(), "tip")
    q = np.array([0.4, -0.9, 0.0, 0.7, 0.8, -1.2])
    branches = robot.solve_all("tip", placement=arm.placement(q), engine=engine)
    assert conditioning(robot, "tip", q) < 1e-12
    assert branches.redundancy == 0
    assert math.isfinite(branches.estimate_missing)
    assert min(np.abs(turned_near(way - q)).max() for way in branches) < 1e-3


@every_engine
def test_a_point_on_the_first_axis_leaves_the_first_joint_free(engine):
    robot = pinik.load(hinge_arm("zyy", TURRET, (-3.0, 3.0)))
    branches = robot.solve_all("tip", position=[0.0, 0.0, 0.9], engine=engine)
    assert branches.redundancy == 1
    assert (branches.dimension == 1).all()
    assert "isolated" not in branches.message
    # In the plane of the two bones: the law of cosines, with the point 0.6 m above the shoulder.
    bend = math.acos((0.36 - 0.25 - 0.16) / 0.4)
    assert np.abs(np.abs(branches.q[:, 2]) - bend).max() < 1e-6
    assert {bool(way[2] > 0.0) for way in branches} == {True, False}
    assert np.ptp(branches.q[:, 0]) > 3.0


@every_engine
def test_two_curves_at_once_are_a_surface(engine):
    one, two = (hinge_arm("zyy", [(0, side, 0.3), *TURRET[1:]], (-3.0, 3.0)) for side in (0.6, -0.6))
    other = two.removeprefix('<robot name="r">').removesuffix("</robot>").replace('<link name="l0"></link>', "")
    for name in ("l1", "l2", "l3", "j1", "j2", "j3", "tip", "end"):
        other = other.replace(f'"{name}"', f'"other_{name}"')
    robot = pinik.load(one.replace("</robot>", f"{other}</robot>"))
    both = [Target("tip", [0.0, 0.6, 0.9]), Target("other_tip", [0.0, -0.6, 0.9])]
    branches = robot.solve_all(both, engine=engine)
    assert branches.redundancy == 2
    assert (branches.dimension == 2).all()
    assert not branches.families
    mixed = robot.solve_all([both[0], Target("other_tip", [0.3, -0.4, 0.7])], engine=engine)
    assert mixed.redundancy == 1
    assert (mixed.dimension == 1).all()


@every_engine
def test_a_curve_is_found_inside_the_limits_too(engine):
    text = puma((-3.1, 3.1))
    start = text.index('name="j4"')
    narrow = text[:start] + text[start:].replace('lower="-3.1" upper="3.1"', 'lower="0.5" upper="0.7"', 1)
    robot, arm = pinik.load(narrow), Arm(narrow, "tip")
    place = arm.placement(np.array([0.4, -0.5, 1.1, 0.6, 0.0, -1.2]))
    branches = robot.solve_all("tip", placement=place, engine=engine)
    on_curve = branches.q[branches.dimension == 1]
    assert len(on_curve) >= 1
    assert branches.redundancy == 1
    assert ((on_curve[:, 3] >= 0.5) & (on_curve[:, 3] <= 0.7)).all()


@every_engine
@pytest.mark.parametrize("bend", [1e-3, 1e-5])
def test_beside_a_singular_place_the_answers_are_isolated(bend, engine):
    robot, arm = pinik.load(puma()), Arm(puma(), "tip")
    place = arm.placement(np.array([0.4, -0.5, 1.1, 0.7, bend, -1.2]))
    branches = robot.solve_all("tip", placement=place, engine=engine)
    assert branches.redundancy == 0
    wanted = inside(puma_answers(place), arm.lower, arm.upper)
    assert unlike(branches, wanted, near=1e-3)[1] == []


# --- redundant arms ---------------------------------------------------------------------------------------------------

SRS = hinge_arm("zyzyzyz", [(0, 0, h) for h in (0.0, 0.36, 0.0, 0.42, 0.0, 0.4, 0.0, 0.126)], (-3.0, 3.0))


def dimension_by_samples(robot, frame, q):
    """The dimension of the set around q: that of random configurations nearby, which scipy brings onto it."""
    model, data, frame_id = robot.model, robot.model.createData(), robot.model.getFrameId(frame)
    pinocchio.framesForwardKinematics(model, data, q)
    wanted, moving = data.oMf[frame_id].copy(), [joint.idx_v for joint in robot.joints if joint.idx_v < 7]

    def missed(step):
        pinocchio.framesForwardKinematics(model, data, q + embedded(step))
        return pinocchio.log6(wanted.actInv(data.oMf[frame_id])).vector

    def embedded(step):
        dq = np.zeros(model.nv)
        dq[moving] = step
        return dq

    rng, ways = np.random.default_rng(0), []
    for _ in range(40):
        found = least_squares(missed, 0.02 * rng.normal(size=len(moving)), xtol=1e-15, ftol=1e-15, gtol=1e-15)
        if np.abs(found.fun).max() < 1e-7 and np.abs(found.x).max() < 0.1:
            ways.append(found.x)
    sizes = np.linalg.svd(np.array(ways), compute_uv=False)
    return int((sizes > 0.2 * sizes[0]).sum())


@every_engine
def test_of_an_arm_with_all_hinges_in_line_all_but_one_are_free(engine):
    robot = pinik.load(SRS)
    branches = robot.solve_all("tip", placement=robot.placement("tip", np.zeros(7)), engine=engine)
    assert branches.redundancy == 3
    assert (branches.dimension == 3).all()
    assert np.abs(branches.q[:, [1, 3, 5]]).max() < 1e-3
    assert np.abs(turned_near(branches.q[:, ::2].sum(axis=1))).max() < 1e-6
    assert branches.message.endswith("of infinitely many in 3 dimensions")
    assert not branches.families
    # Not more than three: plain Pinocchio's kernel at one of these answers.
    q, data = np.array([0.3, 0.0, -0.5, 0.0, 0.8, 0.0, -0.6]), robot.model.createData()
    assert np.allclose(robot.placement("tip", q), robot.placement("tip", np.zeros(7)))
    J = pinocchio.computeFrameJacobian(robot.model, data, q, robot.model.getFrameId("tip"), pinocchio.LOCAL)
    assert 7 - np.linalg.matrix_rank(J, 1e-9) == 3


@every_engine
def test_the_answers_of_an_arm_that_stays_stretched_have_one_dimension(engine):
    robot, q = pinik.load(SRS), np.array([0.3, 0.5, 0.2, 0.0, 0.4, 0.6, 0.1])
    branches = robot.solve_all("tip", placement=robot.placement("tip", q), engine=engine)
    assert (branches.dimension == 1).all()
    assert np.abs(branches.q[:, 3]).max() < 1e-3
    assert branches.redundancy == 1


@every_engine
def test_answers_of_different_dimensions_are_told_apart(engine):
    robot = load_quietly("panda")
    start = robot.placement("panda_hand_tcp", robot.neutral())
    branches = robot.solve_all("panda_hand_tcp", placement=start, engine=engine, limits=False)
    assert set(branches.dimension.tolist()) == {1, 2}
    assert branches.redundancy == 2
    assert "in 1 or 2 dimensions" in branches.message
    # Joints 1, 3 and 5 are in line where joints 2, 4 and 6 are at 0.
    in_line = np.abs(turned_near(branches.q[:, [1, 3, 5]])).max(axis=1) < 1e-3
    assert branches.dimension.tolist() == [2 if one else 1 for one in in_line]
    for dimension in (1, 2):
        assert (
            dimension_by_samples(robot, "panda_hand_tcp", branches.q[branches.dimension == dimension][0]) == dimension
        )
    assert all(family.dimension == 1 for family in branches.families)


@every_engine
def test_three_bones_at_full_length_have_one_answer(engine):
    robot = pinik.load(hinge_arm("zzz", [(0, 0, 0), (0.5, 0, 0), (0.4, 0, 0), (0.3, 0, 0)], (-4.0, 4.0)))
    branches = robot.solve_all("tip", position=[1.2 * math.cos(0.3), 1.2 * math.sin(0.3), 0.0], engine=engine)
    assert branches.dimension.tolist() == [0]
    assert branches.redundancy == 0
    assert branches[0] == pytest.approx([0.3, 0.0, 0.0], abs=2e-4)
    inside = robot.solve_all("tip", position=[0.9, 0.3, 0.0], engine=engine)
    assert (inside.dimension == 1).all()


@every_engine
def test_a_joint_with_a_single_value_is_no_freedom(engine):
    text = SRS.replace('lower="-3.0" upper="3.0"', 'lower="0.5" upper="0.5"', 1)
    robot = pinik.load(text)
    q = np.array([0.5, 0.6, -0.4, 1.1, 0.3, -0.7, 0.2])
    branches = robot.solve_all("tip", placement=robot.placement("tip", q), engine=engine)
    assert branches.redundancy == 0
    assert min(np.abs(turned_near(way - q)).max() for way in branches) < 1e-6


@every_engine
def test_what_the_time_limit_left_unknown_is_said(engine):
    robot = load_quietly("panda")
    target = robot.placement("panda_hand_tcp", robot.poses["default"])
    branches = robot.solve_all("panda_hand_tcp", placement=target, time_limit=1e-9, engine=engine)
    assert branches.ended_early
    assert branches.redundancy is None
    told = branches.to_dict()
    assert told["redundancy"] is None
    assert all(branch["dimension"] is None for branch in told["branches"])


@every_engine
def test_a_robot_whose_limits_leave_no_joint_free_has_one_answer(engine):
    """Its arm hangs straight, so that its Jacobian is singular."""
    robot = load_quietly("double_pendulum_simple")
    assert all(joint.lower == joint.upper for joint in robot.joints)
    q = robot.neutral()
    branches = robot.solve_all("link3", position=robot.placement("link3", q).translation, q0=q, engine=engine)
    np.testing.assert_array_equal(branches.q, [q])
    assert (branches.dimension.tolist(), branches.redundancy) == ([0], 0)
