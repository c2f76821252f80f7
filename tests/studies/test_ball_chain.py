"""The thesis's own program: its chain against the robot's forward kinematics, its methods against closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from judge import plain_placement
from pinik.errors import InputError
from pinik.studies.ball_chain import BallChain, ProgramChase

AT = {"unit": 1.0, "tolerance": 1e-6, "damping": 1.1, "max_angle": math.pi / 16, "max_iterations": 1, "alpha": 0.01}


def test_the_chain_stands_where_the_robot_does(arm):
    rng = np.random.default_rng(2)
    for _ in range(10):
        q = arm.random(rng)
        chain = BallChain.of(arm, "tip", q, unit=0.2)
        assert np.allclose(0.2 * chain.points()[0][-1], plain_placement(arm, "tip", q).translation, atol=1e-12)
        hinges = [[arm.angles(q)[f"bone{k}_{axis}"] for axis in "xz"] for k in range(1, 7)]
        assert np.allclose(chain.leaning(), hinges)


def test_other_chains_are_refused(panda, two_link):
    for robot, frame in ((panda, "panda_hand_tcp"), (two_link, "tip")):
        with pytest.raises(InputError, match="two hinges about one point"):
            BallChain.of(robot, frame, robot.neutral())


def test_one_bone_of_ccd_points_at_the_ball():
    chain = BallChain(np.zeros(3), np.array([2.0]))
    ball = np.array([3.0, -4.0, 12.0])
    step = ProgramChase("ccd", chain, **AT).step(ball)
    assert np.allclose(chain.points()[0][-1], 2.0 * ball / 13.0)
    assert step.error == pytest.approx(11.0)
    assert step.jump == pytest.approx(math.acos(12.0 / 13.0))
    assert (step.iterations, step.joint_updates) == (1, 1)


@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
def test_no_bone_leans_further_than_its_swing(arm, method):
    chain = BallChain.of(arm, "tip", arm.poses["relaxed"], swing=0.6)
    chase = ProgramChase(method, chain, **AT | {"max_iterations": 50, "alpha": 0.5})
    rng = np.random.default_rng(0)
    for _ in range(5):
        chase.step(rng.uniform(-1.0, 1.0, 3))
    assert np.abs(chain.leaning()).max() <= 0.6 + 1e-9
    assert np.abs(chain.leaning()).max() > 0.5


def turned(lengths, goal, rotations):
    """Where the last bone ends when each bone of a straight chain is turned in the world by a rotation vector."""
    chain = BallChain(np.zeros(3), lengths)
    for bone in range(len(lengths)):
        chain.turn(bone, np.eye(3), rotations[bone])
    return chain.points()[0][-1]


def test_a_transpose_step_is_alpha_times_the_gradient_by_finite_differences():
    lengths, goal = np.array([1.0, 0.7, 0.4]), np.array([0.9, 0.2, 1.2])
    end = np.array([0.0, 0.0, lengths.sum()])
    starts = np.array([[0.0, 0.0, z] for z in (0.0, 1.0, 1.7)])
    axes = np.cross(end - starts, goal - starts)
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    h = 1e-6
    rotations = []
    for bone in range(3):
        nudge = np.zeros((3, 3))
        nudge[bone] = h * axes[bone]
        column = (turned(lengths, goal, nudge) - turned(lengths, goal, -nudge)) / (2 * h)
        rotations.append(0.01 * (column @ (goal - end)) * axes[bone])
    chain = BallChain(np.zeros(3), lengths)
    ProgramChase("jt", chain, **AT).step(goal)
    # The angles about the axes are the gradient's; each is taken about its world axis, the parents' turns first.
    by_hand = BallChain(np.zeros(3), lengths)
    for bone, rotation in enumerate(rotations):
        by_hand.turn(bone, np.eye(3), rotation)
    assert np.allclose(chain.R, by_hand.R, atol=1e-8)


def test_a_step_of_dls_turns_no_bone_further_than_alpha_times_the_clamp():
    chain = BallChain(np.zeros(3), np.ones(6))
    step = ProgramChase("dls", chain, **AT | {"damping": 1e-3}).step(np.array([3.0, 0.0, 1.0]))
    assert step.jump == pytest.approx(0.01 * math.pi / 16)


@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
def test_a_ball_within_the_tolerance_is_left_alone(method):
    chain = BallChain(np.zeros(3), np.ones(3))
    step = ProgramChase(method, chain, **AT | {"tolerance": 0.5}).step(np.array([0.1, 0.1, 3.0]))
    assert (step.iterations, step.joint_updates, step.reached, step.jump) == (0, 0, True, 0.0)


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="this system does not tell a process's size so")
def test_turning_a_bone_leaves_no_memory_behind():
    chain = BallChain(np.zeros(3), np.ones(1))

    def pages():
        """The resident size, in pages."""
        for _ in range(20_000):
            chain.turn(0, np.eye(3), np.array([0.01, 0.02, 0.0]))
        return int(Path("/proc/self/statm").read_text().split()[1])

    before = pages()
    assert pages() - before < 100  # a leak of 80 bytes each would take 390
