from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import ZOO, axis, limit, link_placements, mimic, origin, random_placement, random_rotation
from pinik import InputError, Kinematics, Target, Tolerance, UnknownNameError
from pinik.problem.problem import Problem
from pinik.problem.rows import shortest_rotation
from robots import load_quietly
from urdf_texts import joint, link, pair, robot

STEP = 1e-5
ARM = 1.2  # [m] from the arm's first joint to its tip, stretched out


class Scene(NamedTuple):
    source: str
    root: str
    frame: str
    relative_to: str | None

    @property
    def robot(self) -> pinik.Robot:
        return load_quietly(self.source, root=self.root)


SCENES = {
    "arm": Scene("arm", "fixed", "tip", None),
    "one joint": Scene(pair(origin((1, 0, 0)), axis(0, 0, 1)), "fixed", "b", None),
    "a lion's nose seen from its paw": Scene("lion", "free_flyer", "nose", "left_fore_paw"),
    "a panda's follower seen from its leader": Scene("panda", "fixed", "panda_rightfinger", "panda_leftfinger"),
    "continuous and prismatic": Scene("tiago", "planar", "arm_tool_link", "head_2_link"),
    "every kind of joint": Scene(ZOO, "free_flyer", "tip", None),
    "every kind of joint, seen from the others": Scene(ZOO, "planar", "hand", "tip"),
}

ORIENTATIONS: dict[str, Callable[[np.random.Generator], dict[str, Any]]] = {
    "no orientation": lambda rng: {},
    "rotation": lambda rng: {"rotation": random_rotation(rng)},
    "axis along": lambda rng: {"axis": rng.normal(size=3), "direction": rng.normal(size=3)},
    "axis at": lambda rng: {"axis": rng.normal(size=3), "at": 2 * rng.normal(size=3)},
}


def placements(scene: Scene, target: Target, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """4×4 of the point meant and of the reference, in the world."""
    frame = scene.robot.placement(target.frame, q).homogeneous
    if target.tool is not None:
        frame = frame @ target.tool.homogeneous
    if target.relative_to is None:
        return frame, np.eye(4)
    return frame, scene.robot.placement(target.relative_to, q).homogeneous


def length(scene: Scene, target: Target) -> float:
    """What a radian counts [m]; tests/model/test_chains.py measures it."""
    return Problem(scene.robot, [target]).size_of_chain


def residual(scene: Scene, target: Target, q: np.ndarray) -> np.ndarray:
    """The residual by hand, from `Robot.placement` and the chain's length."""
    from scipy.spatial.transform import Rotation

    frame, reference = placements(scene, target, q)
    p, R = frame[:3, 3], frame[:3, :3]
    rows = []
    if target.position is not None:
        rows.append((reference @ [*target.position, 1])[:3] - p)
    if target.rotation is not None:
        turn = Rotation.from_matrix(reference[:3, :3] @ target.rotation @ R.T).as_rotvec()
        rows.append(length(scene, target) * turn)
    elif target.axis is not None:
        pointing = R @ target.axis
        if target.direction is not None:
            wanted = reference[:3, :3] @ target.direction
        else:
            wanted = (reference @ [*target.at, 1])[:3] - p
            wanted /= np.linalg.norm(wanted)
        normal = np.cross(pointing, wanted)
        angle = math.atan2(np.linalg.norm(normal), pointing @ wanted)
        turn = normal if angle < 1e-6 else angle * normal / np.linalg.norm(normal)
        rows.append(length(scene, target) * turn)
    return np.concatenate(rows)  # a weight means something only beside another


def differences(scene: Scene, target: Target, q: np.ndarray) -> np.ndarray:
    """−∂e/∂q on the manifold, central."""
    model = scene.robot.model
    columns = []
    for dq in STEP * np.eye(model.nv):
        plus = residual(scene, target, pinocchio.integrate(model, q, dq))
        minus = residual(scene, target, pinocchio.integrate(model, q, -dq))
        columns.append((minus - plus) / (2 * STEP))
    return np.array(columns).T


def reached_target(scene: Scene, q: np.ndarray, orientation: str, rng: np.random.Generator, **options: Any) -> Target:
    """A target with this kind of orientation, and a position, that `q` reaches."""
    probe = Target(scene.frame, (0, 0, 0), relative_to=scene.relative_to, **options)
    frame, reference = placements(scene, probe, q)
    there = np.linalg.inv(reference) @ frame
    p, R = there[:3, 3], there[:3, :3]
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    fields: dict[str, Any] = {
        "no orientation": {},
        "rotation": {"rotation": R},
        "axis along": {"axis": direction, "direction": R @ direction},
        "axis at": {"axis": direction, "at": p + 0.7 * R @ direction},
    }[orientation]
    return Target(scene.frame, p, relative_to=scene.relative_to, **fields, **options)


@pytest.mark.parametrize("orientation", ORIENTATIONS)
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_the_residual_is_target_minus_frame_position_first(scene, orientation):
    rng = np.random.default_rng(1)
    for tool in (None, random_placement(rng)):
        for positioned in (True, False):
            fields = ORIENTATIONS[orientation](rng)
            if positioned:
                fields["position"] = rng.normal(size=3)
            if not fields:
                continue
            target = Target(scene.frame, relative_to=scene.relative_to, tool=tool, weight=0.7, **fields)
            q = scene.robot.random(rng)
            at = Kinematics(scene.robot, [target]).linearize(q)
            expected = residual(scene, target, q)
            assert at.e.shape == expected.shape
            assert at.J.shape == (len(expected), scene.robot.model.nv)
            np.testing.assert_allclose(at.e, expected, atol=1e-9, rtol=0)
            parts = iter(np.split(expected, len(expected) // 3))
            position = np.linalg.norm(next(parts)) if positioned else None
            angle = None
            if orientation != "no orientation":
                angle = np.linalg.norm(next(parts)) / length(scene, target)
            assert at.errors[0] == pytest.approx((position, angle), abs=1e-9)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("tooled", [False, True], ids=["frame", "tool"])
def test_position_rows_of_the_jacobian_are_exact_everywhere(scene, tooled):
    rng = np.random.default_rng(2)
    tool = random_placement(rng) if tooled else None
    for fields in ORIENTATIONS.values():
        target = Target(scene.frame, rng.normal(size=3), relative_to=scene.relative_to, tool=tool, **fields(rng))
        q = scene.robot.random(rng)
        at = Kinematics(scene.robot, [target]).linearize(q)
        alone = Target(scene.frame, target.position, relative_to=scene.relative_to, tool=tool)
        expected = differences(scene, alone, q)
        np.testing.assert_allclose(at.J[:3, at.free], expected[:, at.free], atol=1e-6, rtol=0)
        # the others turn the residual with everything else, at most, and none makes it shorter
        np.testing.assert_allclose(at.e[:3] @ expected[:, ~at.free], 0.0, atol=1e-6)


@pytest.mark.parametrize("orientation", ORIENTATIONS)
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("tooled", [False, True], ids=["frame", "tool"])
def test_all_rows_of_the_jacobian_are_exact_where_the_target_is_reached(scene, orientation, tooled):
    rng = np.random.default_rng(3)
    q = scene.robot.random(rng)
    tool = {"tool": random_placement(rng)} if tooled else {}
    target = reached_target(scene, q, orientation, rng, weight=2.0, **tool)
    at = Kinematics(scene.robot, [target]).linearize(q)
    np.testing.assert_allclose(at.e, 0.0, atol=1e-9)
    np.testing.assert_allclose(at.J, differences(scene, target, q), atol=1e-5, rtol=0)
    # and near it, J dq ≈ e for the step dq that leads there
    dq = 1e-6 * rng.normal(size=scene.robot.model.nv)
    before = pinocchio.integrate(scene.robot.model, q, -dq)
    near = Kinematics(scene.robot, [target]).linearize(before)
    np.testing.assert_allclose(near.J @ dq, near.e, atol=1e-9)


@pytest.mark.parametrize("orientation", [name for name in ORIENTATIONS if name != "no orientation"])
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_orientation_rows_alone_are_those_beside_a_position(scene, orientation):
    rng = np.random.default_rng(4)
    fields = ORIENTATIONS[orientation](rng)
    q = scene.robot.random(rng)
    for target_jacobian in (False, True):
        both, alone = (
            Kinematics(
                scene.robot,
                [Target(scene.frame, position, relative_to=scene.relative_to, **fields)],
                target_jacobian=target_jacobian,
            ).linearize(q)
            for position in ((0.1, 0.2, 0.3), None)
        )
        np.testing.assert_allclose(alone.e, both.e[3:], atol=1e-12)
        np.testing.assert_allclose(alone.J, both.J[3:], atol=1e-12)


@pytest.mark.parametrize(
    ("name", "frame"), [("arm", "tip"), ("two_link", "tip"), ("ur5", "tool0"), ("tiago", "arm_tool_link")]
)
@pytest.mark.parametrize("rotation", [None, np.eye(3)], ids=["position", "pose"])
def test_the_target_jacobian_is_taken_at_the_target(name, frame, rotation):
    robot = load_quietly(name)
    rng = np.random.default_rng(5)
    q = robot.random(rng)
    wanted = rng.normal(size=3)
    links = link_placements(robot.description.path.read_text(), robot.angles(q))
    support = robot.model.supports[robot.model.frames[robot.frame_id(frame)].parentJoint]
    expected = np.zeros((3, robot.model.nv))
    for tag in robot.description.joints:
        if tag.kind == "fixed" or robot.joint(tag.name).id not in support:
            continue
        child = links[tag.child]  # its origin is the joint's, and the joint's turn leaves the axis in place
        v, p = child[:3, :3] @ tag.axis, child[:3, 3]
        column = v if tag.kind == "prismatic" else np.cross(v, wanted - p)
        expected[:, robot.joint(tag.name).idx_v] = column
    target = Target(frame, wanted, rotation=rotation)
    at = Kinematics(robot, [target], target_jacobian=True).linearize(q)
    usual = Kinematics(robot, [target]).linearize(q)
    np.testing.assert_allclose(at.J[:3], expected, atol=1e-9)
    assert np.abs(at.J[:3] - usual.J[:3]).max() > 0.1
    np.testing.assert_allclose(at.J[3:], usual.J[3:], atol=1e-12)
    np.testing.assert_array_equal(at.e, usual.e)


def test_the_target_jacobian_at_a_reached_target_is_the_usual_one():
    rng = np.random.default_rng(6)
    for scene in SCENES.values():
        q = scene.robot.random(rng)
        target = reached_target(scene, q, "rotation", rng)
        J = [Kinematics(scene.robot, [target], target_jacobian=where).linearize(q).J for where in (False, True)]
        np.testing.assert_allclose(J[0], J[1], atol=1e-9)


def test_free_axes_of_a_pose_have_rows_of_zeros_and_the_others_keep_theirs(ur5):
    rng = np.random.default_rng(15)
    q, R = ur5.random(rng), random_rotation(rng)
    at, whole = (Kinematics(ur5, Target("tool0", p, rotation=R)).linearize(q) for p in ((None, 1, None), (3, 1, 2)))
    kept = [1, 3, 4, 5]
    np.testing.assert_allclose(at.J[kept], whole.J[kept], atol=1e-12)
    np.testing.assert_allclose(at.e[kept], whole.e[kept], atol=1e-12)
    assert not at.J[[0, 2]].any()
    assert not at.e[[0, 2]].any()


def test_several_targets_are_stacked_in_order_and_weights_scale_their_rows(lion):
    rng = np.random.default_rng(7)
    fields = [
        {"frame": "nose", "position": rng.normal(size=3)},
        {"frame": "left_fore_paw", "position": rng.normal(size=3), "rotation": random_rotation(rng)},
        {"frame": "head", "axis": "x", "at": rng.normal(size=3), "relative_to": "chest"},
    ]
    q = lion.random(rng)
    weights = [2.0, 0.5, 0.1]  # only their ratios count: the heaviest becomes 1
    together = Kinematics(lion, [Target(**f, weight=w) for f, w in zip(fields, weights, strict=True)])
    at = together.linearize(q)
    assert together.problem.size == 12
    rows = np.split(np.arange(12), [3, 9])
    turns = [[False] * 3, [False] * 3 + [True] * 3, [True] * 3]
    lengths = [Problem(lion, [Target(**field)]).size_of_chain for field in fields]
    for i, (field, weight) in enumerate(zip(fields, weights, strict=True)):
        alone = Kinematics(lion, [Target(**field)]).linearize(q)
        # a radian counts the length of the longest chain; alone, that of its own
        factors = 0.5 * weight * np.where(turns[i], max(lengths) / lengths[i], 1.0)
        np.testing.assert_allclose(at.e[rows[i]], factors * alone.e, atol=1e-12)
        np.testing.assert_allclose(
            at.J[rows[i]][:, alone.free], factors[:, np.newaxis] * alone.J[:, alone.free], atol=1e-12
        )
        assert at.errors[i] == pytest.approx(alone.errors[0])  # a weight changes the step, never the verdict


class TestFree:
    def test_are_the_coordinates_that_move_a_target(self, lion):
        kinematics = Kinematics(lion, [Target("nose", (1, 0, 0))])
        moving = {j.name for j in lion.joints if kinematics.problem.free[j.idx_v]}
        assert moving == {
            "spine_yaw", "spine_pitch", "spine_roll", "chest_yaw", "chest_pitch", "neck_yaw", "neck_pitch",
            "head_yaw", "head_pitch", "head_roll",
        }  # fmt: skip
        at = kinematics.linearize(lion.random(8))
        assert at.free is kinematics.problem.free
        assert (np.abs(at.J).max(axis=0) > 0)[kinematics.problem.free].all()

    @pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
    def test_others_have_columns_of_exact_zeros(self, scene):
        rng = np.random.default_rng(9)
        target = Target(
            scene.frame, (1, 2, 3), axis="z", at=(3, 2, 1), relative_to=scene.relative_to, tool=(0.1, 0.2, 0.3)
        )
        kinematics = Kinematics(scene.robot, [target])
        for _ in range(3):
            J = kinematics.linearize(scene.robot.random(rng)).J
            assert (J[:, ~kinematics.problem.free] == 0.0).all()

    def test_leave_out_what_moves_frame_and_reference_alike(self):
        robot = load_quietly("lion", root="free_flyer")
        kinematics = Kinematics(robot, [Target("nose", (1, 0, 0), relative_to="chest")])
        moving = {j.name for j in robot.joints if kinematics.problem.free[j.idx_v]}
        assert moving == {"neck_yaw", "neck_pitch", "head_yaw", "head_pitch", "head_roll"}

    def test_include_a_leader_for_its_followers_sake(self, panda):
        kinematics = Kinematics(panda, [Target("panda_rightfinger", (1, 0, 0), relative_to="panda_hand")])
        assert np.flatnonzero(kinematics.problem.free).tolist() == [panda.joint("panda_finger_joint1").idx_v]

    def test_leave_out_the_leader_of_a_follower_that_does_not_move(self):
        text = robot(
            *(link(name) for name in "abc"),
            joint("lead", "a", "b", limit=limit(-1, 1)),
            joint("tail", "a", "c", origin((1, 0, 0)), mimic("lead", 0.0, 0.2), limit=limit(-1, 1)),
        )
        assert not Kinematics(load_quietly(text), [Target("c", (1, 0, 0))]).problem.free.any()

    def test_are_visited_from_the_tip_to_the_base(self, arm):
        coordinates = Kinematics(arm, [Target("tip", (1, 0, 0))]).problem.coordinates
        assert tuple(c.joint.name for c in coordinates) == arm.joint_names[::-1]


class TestLocked:
    def test_joints_have_columns_of_zeros_and_the_others_keep_theirs(self, arm):
        rng = np.random.default_rng(10)
        target = Target("tip", (0.1, 0.2, 0.3), rotation=random_rotation(rng))
        q = arm.random(rng)
        at = Kinematics(arm, [target], locked=["bone1_x", "bone4_z"]).linearize(q)
        usual = Kinematics(arm, [target]).linearize(q)
        columns = [arm.joint("bone1_x").idx_v, arm.joint("bone4_z").idx_v]
        assert (at.J[:, columns] == 0.0).all()
        assert not at.free[columns].any()
        others = np.delete(np.arange(arm.model.nv), columns)
        np.testing.assert_array_equal(at.J[:, others], usual.J[:, others])
        np.testing.assert_array_equal(at.e, usual.e)

    def test_roots_lose_all_their_columns(self):
        robot = load_quietly("arm", root="free_flyer")
        kinematics = Kinematics(robot, [Target("tip", (1, 0, 0))], locked=["root_joint"])
        assert not kinematics.problem.free[:6].any()
        assert kinematics.problem.free[6:].all()
        assert (kinematics.linearize(robot.random(11)).J[:, :6] == 0.0).all()
        assert all(c.joint.name != "root_joint" for c in kinematics.problem.coordinates)

    def test_leaders_hold_their_followers(self, panda):
        target = Target("panda_rightfinger", (1, 0, 0), relative_to="panda_hand")
        assert not Kinematics(panda, [target], locked=["panda_finger_joint1"]).problem.free.any()

    def test_names_are_checked(self, panda):
        target = Target("panda_hand", (1, 0, 0))
        with pytest.raises(InputError, match="'panda_finger_joint2' mimics 'panda_finger_joint1'"):
            Kinematics(panda, [target], locked=["panda_finger_joint2"])
        with pytest.raises(UnknownNameError, match="did you mean 'panda_joint1'"):
            Kinematics(panda, [target], locked=["panda_jont1"])
        with pytest.raises(InputError, match="list of joint names; got 'panda_joint1'"):
            Kinematics(panda, [target], locked="panda_joint1")


class TestTools:
    def test_leave_the_robots_model_alone(self, arm):
        frames = arm.model.nframes
        before = pinocchio.Model(arm.model)
        targets = [Target("tip", (1, 0, 0), tool=(0, 0, 0.1 * i)) for i in range(3)]
        kinematics = Kinematics(arm, targets)
        assert kinematics.model.nframes == frames + 3
        kinematics.retarget(targets)
        assert kinematics.model.nframes == frames + 3
        assert arm.model.nframes == frames
        assert arm.model == before

    def test_without_one_the_robots_model_is_used(self, arm):
        assert Kinematics(arm, [Target("tip", (1, 0, 0))]).model is arm.model

    def test_move_the_point_meant_and_turn_its_axes(self, two_link):
        turned = pinocchio.SE3(pinocchio.rpy.rpyToMatrix(0, 0, math.pi / 2), np.array([0.1, 0, 0]))
        target = Target("tip", (1, 0, 0), axis="x", direction=(0, 1, 0), tool=turned)
        at = Kinematics(two_link, [target]).linearize(two_link.neutral())
        np.testing.assert_allclose(at.e, 0.0, atol=1e-12)


class TestExtremes:
    @pytest.mark.parametrize("axis_name", ["x", "y", "z", "-x", "-y", "-z"])
    def test_an_axis_opposite_to_its_direction_is_half_a_turn_off(self, arm, axis_name):
        q = arm.poses["reach"]
        R = arm.placement("tip", q).rotation
        direction = -R @ Target("tip", axis=axis_name, direction=(1, 0, 0)).axis
        at = Kinematics(arm, [Target("tip", axis=axis_name, direction=direction)]).linearize(q)
        assert np.linalg.norm(at.e) == pytest.approx(math.pi * ARM)
        assert at.errors[0].orientation == pytest.approx(math.pi)
        assert abs(at.e @ direction) < 1e-6  # about an axis across
        assert np.isfinite(at.J).all()

    @pytest.mark.parametrize("a", np.vstack([np.eye(3), -np.eye(3)]).tolist(), ids=str)
    def test_the_shortest_rotation_to_the_opposite_is_half_a_turn_that_leads_there(self, a):
        turn, angle = shortest_rotation(np.array(a), -np.array(a))
        assert angle == math.pi
        np.testing.assert_allclose(pinocchio.exp3(turn) @ a, -np.array(a), atol=1e-12)

    def test_an_axis_along_its_direction_is_no_way_off(self, arm):
        q = arm.poses["reach"]
        direction = arm.placement("tip", q).rotation[:, 2]
        at = Kinematics(arm, [Target("tip", axis="z", direction=direction)]).linearize(q)
        np.testing.assert_allclose(at.e, 0.0, atol=1e-12)
        assert np.isfinite(at.J).all()

    def test_a_rotation_half_a_turn_off_has_finite_rows(self, arm):
        q = arm.poses["reach"]
        R = arm.placement("tip", q).rotation
        for half_turn in (np.diag([1.0, -1, -1]), np.diag([-1.0, 1, -1]), np.diag([-1.0, -1, 1])):
            at = Kinematics(arm, [Target("tip", rotation=half_turn @ R)]).linearize(q)
            assert np.linalg.norm(at.e) == pytest.approx(math.pi * ARM)
            assert np.isfinite(at.J).all()

    def test_a_frame_on_the_point_that_it_should_look_at_looks_at_it(self, arm):
        q = arm.poses["reach"]
        here = arm.placement("tip", q).translation
        at = Kinematics(arm, [Target("tip", here, axis="z", at=here)]).linearize(q)
        np.testing.assert_array_equal(at.e, 0.0)
        assert np.isfinite(at.J).all()
        assert at.errors[0] == (0.0, 0.0)

    def test_a_frame_near_the_point_that_it_should_look_at_has_finite_rows(self, arm):
        q = arm.poses["reach"]
        here = arm.placement("tip", q).translation
        for distance in (1e-12, 1e-8, 1e-4):
            for side in np.eye(3):
                at = Kinematics(arm, [Target("tip", axis="z", at=here + distance * side)]).linearize(q)
                assert np.isfinite(at.e).all()
                assert np.isfinite(at.J).all()

    def test_a_robot_without_joints_has_residuals_and_no_columns(self):
        rigid = load_quietly(robot(link("a")))
        at = Kinematics(rigid, [Target("a", (1, 2, 3), rotation=np.eye(3))]).linearize(rigid.neutral())
        assert at.e == pytest.approx([1, 2, 3, 0, 0, 0])
        assert at.J.shape == (6, 0)


class TestShortened:
    def test_cuts_each_position_and_keeps_its_direction(self, lion):
        targets = [
            Target("nose", (9, 0, 0), rotation=np.eye(3), weight=0.5),
            Target("head", axis="x", direction=(0, 0, 1)),
            Target("tail_tip", (-9, 1, 0), weight=3.0),
            Target("left_fore_paw", lion.placement("left_fore_paw", lion.neutral()).translation + 0.01),
        ]
        kinematics = Kinematics(lion, targets)
        e = kinematics.linearize(lion.neutral()).e
        kept = e.copy()
        short = kinematics.shortened(e, 0.1)
        np.testing.assert_array_equal(e, kept)
        np.testing.assert_allclose(short[:3], 0.5 / 3.0 * 0.1 * e[:3] / np.linalg.norm(e[:3]))
        np.testing.assert_array_equal(short[3:9], e[3:9])
        np.testing.assert_allclose(short[9:12], 0.1 * e[9:12] / np.linalg.norm(e[9:12]))
        np.testing.assert_array_equal(short[12:], e[12:])


def test_evaluations_are_counted(arm):
    kinematics = Kinematics(arm, [Target("tip", (1, 0, 0)), Target("gripper", (1, 0, 0))])
    assert kinematics.evaluations == 0
    for count in (1, 2, 3):
        kinematics.linearize(arm.neutral())
        assert kinematics.evaluations == count
    kinematics.retarget([Target("tip", (0, 1, 0))])
    assert kinematics.evaluations == 3


def test_retargeting_is_the_same_as_starting_anew(arm):
    rng = np.random.default_rng(12)
    kinematics = Kinematics(arm, [Target("tip", (1, 0, 0))], locked=["bone1_x"])
    other = [Target("bone3", axis="z", at=(1, 1, 1), tool=(0, 0, 0.1)), Target("tip", (0, 1, 0))]
    kinematics.retarget(other)
    q = arm.random(rng)
    at, anew = kinematics.linearize(q), Kinematics(arm, other, locked=["bone1_x"]).linearize(q)
    np.testing.assert_array_equal(at.e, anew.e)
    np.testing.assert_array_equal(at.J, anew.J)
    np.testing.assert_array_equal(at.free, anew.free)


def test_retargeting_keeps_the_options_of_the_problem(arm):
    other = [Target("bone3", (1, 1, 1))]
    options = {"locked": ["bone1_x"], "target_jacobian": True, "tolerance": Tolerance(0.5, 0.25)}
    kinematics = Kinematics.of(Problem(arm, [Target("tip", (1, 0, 0))], **options))
    kinematics.retarget(other)
    anew = Kinematics.of(Problem(arm, other, **options))
    q = arm.random(14)
    assert kinematics.problem.tolerance == Tolerance(0.5, 0.25)
    np.testing.assert_array_equal(kinematics.linearize(q).J, anew.linearize(q).J)
    usual = Kinematics(arm, other, locked=["bone1_x"]).linearize(q)
    assert np.abs(kinematics.linearize(q).J - usual.J).max() > 0.1


def test_linearizing_leaves_the_configuration_alone(arm):
    q = arm.random(13)
    kept = q.copy()
    Kinematics(arm, [Target("tip", (1, 0, 0))]).linearize(q)
    np.testing.assert_array_equal(q, kept)


def test_nothing_to_solve_and_unknown_frames_are_refused(arm):
    with pytest.raises(InputError, match="at least one target"):
        Kinematics(arm, [])
    with pytest.raises(UnknownNameError, match="no frame 'tipp'; did you mean 'tip'"):
        Kinematics(arm, [Target("tipp", (1, 0, 0))])
    with pytest.raises(UnknownNameError, match="no frame 'bones3'; did you mean 'bone3'"):
        Kinematics(arm, [Target("tip", (1, 0, 0), relative_to="bones3")])


@pytest.mark.parametrize(
    ("error", "verdict"),
    [
        ((None, None), True), ((1e-4, 1e-3), True), ((2e-4, None), False), ((None, 2e-3), False),
        ((2e-4, 1e-4), False), ((0.0, 2e-3), False), ((math.nan, None), False),
    ],
)  # fmt: skip
def test_an_error_is_within_tolerance_when_both_its_parts_are(error, verdict):
    assert pinik.TargetError(*error).within(Tolerance()) is verdict
