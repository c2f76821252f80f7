"""urdf/: the committed files are what the generator makes, and the robots are built as promised."""

import itertools
import math
import subprocess
import sys
from pathlib import Path

import coal  # noqa: F401  (pinocchio needs it to hand over shapes)
import numpy as np
import pinocchio
import pytest
import trimesh

from pinik.shapes.meshes import load_shapes
from robots import load_quietly

ROOT = Path(__file__).parents[2]
URDF = ROOT / "urdf"
PAWS = ("left_fore_paw", "right_fore_paw", "left_hind_paw", "right_hind_paw")


def files_in(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def model_of(name):
    model = pinocchio.buildModelFromUrdf(str(URDF / f"{name}.urdf"))
    pinocchio.loadReferenceConfigurations(model, str(URDF / f"{name}.srdf"), False)
    return model


def poses_of(model):
    return {entry.key(): np.array(entry.data()) for entry in model.referenceConfigurations}


def limits_of(model):
    """Joint name → (lower, upper) [rad]."""
    joints = [(name, model.joints[i].idx_q) for i, name in enumerate(model.names) if i > 0]
    return {name: (model.lowerPositionLimit[q], model.upperPositionLimit[q]) for name, q in joints}


def placements(model, q):
    """Link name → SE3."""
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, q)
    return {f.name: data.oMf[i] for i, f in enumerate(model.frames) if f.type == pinocchio.FrameType.BODY}


def turned(model, joint, angle):
    q = pinocchio.neutral(model)
    q[model.joints[model.getJointId(joint)].idx_q] = angle
    return placements(model, q)


def test_the_committed_files_are_what_the_generator_makes(tmp_path):
    subprocess.run([sys.executable, ROOT / "tools" / "make_robots.py", tmp_path], check=True)
    made, committed = files_in(tmp_path), files_in(URDF)
    assert set(made) == set(committed)
    differing = [path for path in made if made[path] != committed[path]]
    assert not differing, "run tools/make_robots.py"
    assert sum(len(content) for path, content in made.items() if path.suffix == ".obj") < 1.5e6


@pytest.mark.parametrize("name", ["arm", "lion", "two_link"])
def test_zero_and_every_pose_lie_inside_the_limits(name):
    model = model_of(name)
    lower, upper = model.lowerPositionLimit, model.upperPositionLimit
    assert (lower < 0).all()
    assert (upper > 0).all()
    poses = poses_of(model)
    assert {"relaxed", "reach"} <= set(poses)
    for q in poses.values():
        assert ((lower <= q) & (q <= upper)).all()


def test_the_arm_has_six_bones_that_swing_45_degrees_about_x_and_z():
    limits = limits_of(model_of("arm"))
    assert list(limits) == [f"bone{i}_{axis}" for i in range(1, 7) for axis in "xz"]
    assert set(limits.values()) == {(-math.pi / 4, math.pi / 4)}


def test_the_arm_stands_upright_with_the_tip_aligned_with_the_world():
    model = model_of("arm")
    links = placements(model, pinocchio.neutral(model))
    base, tip = links["knuckle1"], links["tip"]
    assert tip.rotation == pytest.approx(np.eye(3), abs=1e-9)
    assert tip.translation - base.translation == pytest.approx([0, 0, 1.2], abs=1e-9)


def test_bone_x_bends_the_arm_forward_and_bone_z_sideways():
    model = model_of("arm")
    assert turned(model, "bone1_x", 0.5)["tip"].translation[:2] == pytest.approx([1.2 * math.sin(0.5), 0], abs=1e-9)
    assert turned(model, "bone1_z", 0.5)["tip"].translation[:2] == pytest.approx([0, -1.2 * math.sin(0.5)], abs=1e-9)


def test_two_link_moves_in_the_plane_as_the_textbook_says():
    model = model_of("two_link")
    assert limits_of(model) == {"joint1": (-math.pi, math.pi), "joint2": (-math.pi, math.pi)}
    a, b = 0.7, -1.9
    tip = placements(model, np.array([a, b]))["tip"].translation
    assert tip == pytest.approx(
        [0.5 * math.cos(a) + 0.4 * math.cos(a + b), 0.5 * math.sin(a) + 0.4 * math.sin(a + b), 0], abs=1e-12
    )


def test_the_lion_is_as_large_as_a_lion():
    model = model_of("lion")
    links = placements(model, pinocchio.neutral(model))
    ground = links["left_fore_paw"].translation[2]
    assert 0.7 < links["left_upper_arm"].translation[2] - ground < 0.85  # the joint; the withers are 0.3 m higher
    assert 1.6 < links["nose"].translation[0] - links["tail1"].translation[0] < 1.9
    tail = [links[f"tail{i}"].translation for i in range(1, 7)] + [links["tail_tip"].translation]
    assert sum(np.linalg.norm(np.diff(tail, axis=0), axis=1)) == pytest.approx(0.9)


def test_the_lion_is_symmetric():
    model = model_of("lion")
    links = placements(model, pinocchio.neutral(model))
    limits = limits_of(model)
    mirror = np.array([1, -1, 1])
    sides = [name for name in links if name.startswith("left_")]
    assert len(sides) == 14
    for name in sides:
        other = links[name.replace("left", "right")]
        assert other.translation == pytest.approx(mirror * links[name].translation, abs=1e-12)
    for name, (lower, upper) in limits.items():
        if name.startswith("left_"):
            expected = (-upper, -lower) if name.endswith(("_yaw", "_roll")) else (lower, upper)
            assert limits[name.replace("left", "right")] == expected


@pytest.mark.parametrize("pose", ["neutral", "relaxed", "roar", "sit"])
def test_the_lion_stands_on_level_paws(pose):
    model = model_of("lion")
    q = pinocchio.neutral(model) if pose == "neutral" else poses_of(model)[pose]
    links = placements(model, q)
    heights = [links[paw].translation[2] for paw in PAWS]
    assert max(heights) - min(heights) < 0.003
    for paw in PAWS:
        assert links[paw].rotation[2, 2] > math.cos(math.radians(4))


def test_reaching_lifts_the_left_fore_paw_before_the_lions_eyes():
    model = model_of("lion")
    links = placements(model, poses_of(model)["reach"])
    paw = links["left_fore_paw"].translation
    standing = [links[name].translation[2] for name in PAWS[1:]]
    assert max(standing) - min(standing) < 0.003
    assert paw[2] > max(standing) + 0.4
    ball = paw + np.array([0.085, 0.01, 0.0])
    towards = (ball - links["head"].translation) / np.linalg.norm(ball - links["head"].translation)
    assert links["head"].rotation[:, 0] @ towards > math.cos(math.radians(8))


def test_elbows_and_knees_bend_only_the_right_way():
    model = model_of("lion")
    limits = limits_of(model)

    def interior(joint, above, at, below, angle):
        links = turned(model, joint, angle)
        one = links[above].translation - links[at].translation
        two = links[below].translation - links[at].translation
        return math.degrees(math.atan2(np.cross(one, two)[1], one @ two))

    for side in ("left", "right"):
        elbow = (f"{side}_elbow", f"{side}_upper_arm", f"{side}_forearm", f"{side}_metacarpus")
        knee = (f"{side}_knee", f"{side}_thigh", f"{side}_shank", f"{side}_metatarsus")
        for joint, straight in ((elbow, 20), (knee, -50)):
            signs = {np.sign(interior(*joint, angle)) for angle in limits[joint[0]]}
            assert len(signs) == 1, joint
            assert abs(interior(*joint, math.radians(straight))) > 155


def ends_across(path):
    """The heights y [mm] of the faces of a mesh that lie across its own y axis, as a segment's ends do."""
    lines = [line.split() for line in path.read_text().splitlines()]
    corners = np.array([[float(number) for number in parts[1:]] for parts in lines if parts[0] == "v"])
    faces = np.array([[int(index) - 1 for index in parts[1:]] for parts in lines if parts[0] == "f"])
    heights = corners[faces][:, :, 1]
    return set(heights[np.ptp(heights, axis=1) == 0][:, 0].tolist())


@pytest.mark.parametrize("number", range(1, 6))
def test_the_arms_collars_have_no_two_colours_in_one_plane(number):
    """Two surfaces in one place flicker."""
    blue, silver = (ends_across(URDF / "meshes" / "arm" / f"bone{number}_{color}.obj") for color in ("blue", "silver"))
    assert len(blue) >= 2
    assert not blue & silver


def boxes(points_of):
    """Link → the corners (2, 3) of the box around its points [m]."""
    return {link: np.array([np.min(found, axis=0), np.max(found, axis=0)]) for link, found in points_of.items()}


def boxes_of_skin(name):
    points = {}
    for shape in load_shapes(load_quietly(name))[0]:
        here = trimesh.transform_points(shape.mesh.vertices, shape.placement)
        points.setdefault(shape.link, []).extend(here)
    return boxes(points)


def boxes_of_solids(name):
    robot = model_of(name)
    model = pinocchio.buildGeomFromUrdf(robot, str(URDF / f"{name}.urdf"), pinocchio.GeometryType.COLLISION)
    points = {}
    for part in model.geometryObjects:
        part.geometry.computeLocalAABB()
        frame, local = robot.frames[part.parentFrame], part.geometry.aabb_local
        here = frame.placement.inverse() * part.placement
        corners = itertools.product(*zip(local.min_, local.max_, strict=True))
        points.setdefault(frame.name, []).extend(here.act(np.array(corner)) for corner in corners)
    return boxes(points)


@pytest.mark.parametrize(("name", "most"), [("arm", 0.042), ("lion", 0.020), ("two_link", 0.002)])
def test_what_can_touch_lies_where_the_robot_is_seen(name, most):
    """But for the balls in the arm's joints, which cover the forks of their neighbours too."""
    seen, solid = boxes_of_skin(name), boxes_of_solids(name)
    assert set(solid) == set(seen)
    for link, (low, high) in solid.items():
        assert (low >= seen[link][0] - most).all(), link
        assert (high <= seen[link][1] + most).all(), link
        assert np.prod(high - low) > 0.07 * np.prod(seen[link][1] - seen[link][0]), link


@pytest.mark.parametrize("name", ["arm", "lion", "two_link"])
def test_nothing_touches_in_the_poses_and_links_can_touch(name):
    robot = load_quietly(name)
    for q in (robot.neutral(), *robot.poses.values()):
        assert robot.collisions(q) == []
    if name != "arm":  # whose twelve hinges, 45 degrees to each side, cannot bend it back to itself
        assert robot.collision_pairs.counting
