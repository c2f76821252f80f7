from __future__ import annotations

import numpy as np
import pinocchio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pinik
from by_hand import ZOO, chains
from robots import load_quietly
from urdf_texts import link, pair, robot

ROBOTS = [name for name in pinik.catalog() if name != "ur3_empty"]
ROOTS = ("fixed", "free_flyer", "planar")
AXES = ("local_world_aligned", "local", "world")
STEP = 1e-5


def moderate_configuration(robot: pinik.Robot, seed: int) -> np.ndarray:
    """A random configuration without the wild angles of rotors whose limits are ±1e16."""
    q = robot.random(seed)
    rng = np.random.default_rng(seed)
    for joint in robot.joints:
        if joint.nq == 1 and abs(q[joint.idx_q]) > 10.0:
            q[joint.idx_q] = rng.uniform(-3, 3)
    return q


def differences(robot: pinik.Robot, frame: str, q: np.ndarray, axes: str, relative_to: str | None = None) -> np.ndarray:
    """The Jacobian (6, nv) by central differences of `placement` on the manifold."""
    at = robot.placement(frame, q, relative_to)
    p, R = at.translation, at.rotation
    columns = []
    for dq in STEP * np.eye(robot.model.nv):
        plus = robot.placement(frame, pinocchio.integrate(robot.model, q, dq), relative_to)
        minus = robot.placement(frame, pinocchio.integrate(robot.model, q, -dq), relative_to)
        velocity = (plus.translation - minus.translation) / (2 * STEP)
        turn = plus.rotation @ minus.rotation.T / (2 * STEP)
        spin = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        if axes == "local":
            velocity, spin = R.T @ velocity, R.T @ spin
        elif axes == "world":
            velocity = velocity - np.cross(spin, p)
        columns.append(np.concatenate((velocity, spin)))
    return np.array(columns).T


def farthest_link(robot: pinik.Robot) -> str:
    """The link with the most joints between it and the world."""
    depth = {name: len(robot.model.supports[robot.model.frames[robot.frame_id(name)].parentJoint])
             for name in robot.description.links}  # fmt: skip
    return max(robot.description.links, key=depth.__getitem__)


@pytest.mark.parametrize("name", [n for n in ROBOTS if load_quietly(n).model.nv])
def test_of_every_catalogue_robot_are_finite_differences(name):
    robot = load_quietly(name)
    frame = farthest_link(robot)
    q = moderate_configuration(robot, 1)
    J = robot.jacobian(frame, q)
    assert J.shape == (6, robot.model.nv)
    np.testing.assert_allclose(J, differences(robot, frame, q, "local_world_aligned"), atol=1e-6, rtol=0)
    assert np.abs(J).max() > 0.1


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("root", ROOTS)
@pytest.mark.parametrize("frame", ["tip", "hand", "d", "l_hinge"])
def test_of_every_kind_of_joint_are_finite_differences(frame, root, axes):
    robot = load_quietly(ZOO, root=root)
    for seed in range(2):
        q = robot.random(seed)
        np.testing.assert_allclose(
            robot.jacobian(frame, q, axes), differences(robot, frame, q, axes), atol=1e-6, rtol=0
        )


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("root", ROOTS)
@pytest.mark.parametrize(
    ("frame", "relative_to"), [("tip", "hand"), ("hand", "tip"), ("tip", "body"), ("a", "tip"), ("tip", "tip")]
)
def test_relative_to_a_frame_are_those_seen_from_it(frame, relative_to, root, axes):
    robot = load_quietly(ZOO, root=root)
    q = robot.random(3)
    np.testing.assert_allclose(
        robot.jacobian(frame, q, axes, relative_to),
        differences(robot, frame, q, axes, relative_to),
        atol=1e-6,
        rtol=0,
    )


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize(
    ("name", "root", "frame", "relative_to"),
    [
        ("lion", "free_flyer", "nose", "left_fore_paw"),
        ("lion", "planar", "tail_tip", None),
        ("panda", "free_flyer", "panda_rightfinger", "panda_link4"),
        ("panda", "fixed", "panda_rightfinger", "panda_leftfinger"),
        ("tiago", "planar", "arm_tool_link", "head_2_link"),
        ("kinova", "fixed", "j2s6s200_end_effector", "base"),
        ("pr2", "free_flyer", "l_gripper_r_finger_tip_link", "r_gripper_l_finger_tip_link"),
        ("tiago_pro", "planar", "gripper_left_inner_finger_left_link", "torso_lift_link"),
    ],
)
def test_of_real_robots_in_all_axes_are_finite_differences(name, root, frame, relative_to, axes):
    robot = load_quietly(name, root=root)
    q = moderate_configuration(robot, 4)
    np.testing.assert_allclose(
        robot.jacobian(frame, q, axes, relative_to),
        differences(robot, frame, q, axes, relative_to),
        atol=1e-6,
        rtol=0,
    )


@given(text=chains(("revolute", "continuous", "prismatic", "floating", "planar")), seed=st.integers(0, 9))
@settings(max_examples=40)
def test_of_any_chain_are_finite_differences(text, seed):
    robot = load_quietly(text)
    q = robot.random(seed)
    for axes in AXES:
        np.testing.assert_allclose(
            robot.jacobian("tip", q, axes), differences(robot, "tip", q, axes), atol=1e-6, rtol=0
        )


def test_of_a_mimic_leader_count_what_its_followers_do(panda):
    q = panda.neutral()
    column = panda.joint("panda_finger_joint1").idx_v
    left = panda.jacobian("panda_leftfinger", q, relative_to="panda_hand")[:, column]
    right = panda.jacobian("panda_rightfinger", q, relative_to="panda_hand")[:, column]
    np.testing.assert_allclose(left, [0, 1, 0, 0, 0, 0], atol=1e-12)
    np.testing.assert_allclose(right, [0, -1, 0, 0, 0, 0], atol=1e-12)


def test_relative_to_a_common_ancestor_leave_out_what_moves_both(lion):
    robot = load_quietly("lion", root="free_flyer")
    J = robot.jacobian("nose", robot.random(5), relative_to="chest")
    above = robot.model.supports[robot.model.frames[robot.frame_id("chest")].parentJoint]
    for joint in robot.joints:
        if joint.id in above:
            np.testing.assert_allclose(J[:, joint.idx_v : joint.idx_v + joint.nv], 0.0, atol=1e-12)


def test_take_pinocchios_own_names_of_the_axes(arm):
    q = arm.poses["reach"]
    for name, axes in (
        ("local_world_aligned", pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED),
        ("local", pinocchio.ReferenceFrame.LOCAL),
        ("world", pinocchio.ReferenceFrame.WORLD),
    ):
        for reference in (None, "base"):
            np.testing.assert_array_equal(
                arm.jacobian("tip", q, axes, reference), arm.jacobian("tip", q, name, reference)
            )
    np.testing.assert_array_equal(arm.jacobian("tip", q), arm.jacobian("tip", q, "local_world_aligned"))


@pytest.mark.parametrize("axes", ["LOCAL", "body", "", 1, None])
def test_refuse_unknown_axes_and_name_the_known_ones(arm, axes):
    with pytest.raises(pinik.InputError, match="'local_world_aligned', 'local', 'world'"):
        arm.jacobian("tip", arm.neutral(), axes)


def test_of_a_single_joint_and_of_none_have_their_columns():
    hinge = load_quietly(pair())
    for reference in (None, "a"):
        assert hinge.jacobian("b", [0.3], relative_to=reference).shape == (6, 1)
    np.testing.assert_allclose(hinge.jacobian("b", [0.3])[:, 0], [0, 0, 0, 1, 0, 0], atol=1e-15)
    rigid = load_quietly(robot(link("a")))
    for reference in (None, "a"):
        assert rigid.jacobian("a", rigid.neutral(), relative_to=reference).shape == (6, 0)


def test_predict_where_a_small_step_leads(arm):
    q = arm.poses["reach"]
    step = 1e-5 * np.linspace(-1, 1, arm.model.nv)
    before, after = arm.placement("tip", q), arm.placement("tip", q + step)
    moved = after.translation - before.translation
    assert np.linalg.norm(moved) > 1e-6
    np.testing.assert_allclose(arm.jacobian("tip", q)[:3] @ step, moved, atol=1e-9)
