"""The examples run, and what they print is true."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio
import pytest

import pinik
from judge import assert_honest
from pinik.description.catalog import find

ROOT = Path(__file__).parents[1]


def test_every_answer_of_the_tour_is_what_it_says(monkeypatch):
    spec = importlib.util.spec_from_file_location("tour", ROOT / "examples" / "tour.py")
    tour = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "tour", tour)  # its dataclass looks itself up
    spec.loader.exec_module(tour)
    for question in tour.questions():
        for solution in tour.answers(question):
            assert_honest(solution, question.targets)


def test_the_tour_shows_every_robot_by_every_method_plainly_when_piped():
    done = subprocess.run(
        [sys.executable, ROOT / "examples" / "tour.py"],
        capture_output=True,
        check=False,
        encoding="utf-8",
        env={"PATH": "", "PYTHONPATH": str(ROOT / "src"), "PYTHONIOENCODING": "utf-8"},
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert "\x1b" not in done.stdout
    sections = done.stdout.split("\n\n")[1:-1]
    assert [section.split(":")[0] for section in sections] == ["arm", "lion", "panda", "arm"]
    for section in sections:
        rows = [line.split()[:2] for line in section.splitlines()[2:]]
        assert [name for name, _ in rows if name in pinik.SOLVERS] == list(pinik.SOLVERS)
    for section in sections[:3]:
        for method in ("ccd", "pinv", "dls"):
            assert re.search(rf"^  {method} +converged ", section, re.MULTILINE), section
    unreachable = sections[3]
    assert len(re.findall(r"^  \w+ +unreachable ", unreachable, re.MULTILINE)) == len(pinik.SOLVERS)
    assert "beyond its chain's reach" in unreachable


ARM = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll"]


def lerobot_kinematics(**options):
    spec = importlib.util.spec_from_file_location("lerobot_kinematics", ROOT / "examples" / "lerobot_kinematics.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.RobotKinematics("so101", "gripper_frame_link", **options)


def pose_by_pinocchio(degrees):
    """The pose (4, 4) of the gripper's frame at the values of ARM, by Pinocchio alone."""
    model = pinocchio.buildModelFromUrdf(str(find("so101").urdf))
    q = pinocchio.neutral(model)
    for name, value in zip(ARM, degrees[: len(ARM)], strict=True):
        q[model.joints[model.getJointId(name)].idx_q] = np.radians(value)
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, q)
    return data.oMf[model.getFrameId("gripper_frame_link", pinocchio.BODY)].homogeneous


def test_lerobots_kinematics_takes_and_gives_degrees_and_keeps_the_gripper():
    kinematics = lerobot_kinematics(joint_names=ARM)
    rng = np.random.default_rng(5)
    for _ in range(20):
        there = np.append(rng.uniform(-60.0, 60.0, 5), 33.0)
        pose = pose_by_pinocchio(there)
        np.testing.assert_allclose(kinematics.forward_kinematics(there), pose, atol=1e-9)
        start = there + np.append(rng.uniform(-5.0, 5.0, 5), 9.0)
        values = kinematics.inverse_kinematics(start, pose)
        assert values.shape == (6,)
        assert values[5] == start[5]
        reached = pose_by_pinocchio(values)
        assert np.linalg.norm(reached[:3, 3] - pose[:3, 3]) < 1e-3
        assert np.linalg.norm(pinocchio.log3(pose[:3, :3] @ reached[:3, :3].T)) < 0.02
        assert np.abs(values[:5] - start[:5]).max() < 20.0


def test_lerobots_kinematics_prefers_the_position_of_a_pose_that_five_joints_cannot_reach():
    kinematics = lerobot_kinematics()
    there = np.array([10.0, -20.0, 40.0, 30.0, 0.0, 25.0])
    pose = pose_by_pinocchio(there)
    pose[:3, :3] = pinocchio.exp3(np.array([0.0, 0.0, 0.25])) @ pose[:3, :3]
    reached = pose_by_pinocchio(kinematics.inverse_kinematics(there, pose))
    assert np.linalg.norm(reached[:3, 3] - pose[:3, 3]) < 1e-3
    free = pose_by_pinocchio(kinematics.inverse_kinematics(there, pose, orientation_weight=0.0))
    assert np.linalg.norm(free[:3, 3] - pose[:3, 3]) < 1e-3


def test_lerobots_kinematics_leaves_a_part_of_the_pose_free_where_its_weight_is_0():
    kinematics = lerobot_kinematics(joint_names=ARM)
    there = np.array([10.0, -20.0, 40.0, 30.0, 0.0])
    pose = pose_by_pinocchio(there)
    far = pose.copy()
    far[:3, 3] += 5.0
    turned = pose_by_pinocchio(kinematics.inverse_kinematics(there + 4.0, far, 0.0, 1.0))
    assert np.linalg.norm(pinocchio.log3(pose[:3, :3] @ turned[:3, :3].T)) < 0.01


def test_lerobots_kinematics_says_which_weights_and_how_many_values_it_takes():
    kinematics = lerobot_kinematics(joint_names=ARM)
    pose = pose_by_pinocchio(np.zeros(5))
    with pytest.raises(ValueError, match=r"weight must be a number from 0\.001 to 1000; got 1e-05"):
        kinematics.inverse_kinematics(np.zeros(5), pose, orientation_weight=1e-5)
    with pytest.raises(ValueError, match="there must be a value for each of shoulder_pan"):
        kinematics.forward_kinematics(np.zeros(3))
