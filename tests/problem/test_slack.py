"""Residuals that stop pulling inside a tolerance, held against the losses that they come from."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from by_hand import random_rotation, rotation_about
from pinik import Kinematics, Target, Tolerance
from pinik.problem.problem import Problem
from pinik.problem.slack import SHARE, outside_ball, outside_box
from robots import load_quietly

STEP = 1e-5
BOX = (0.03, 0.1, 0.002)


def gradient(loss: Callable[[np.ndarray], float], e: np.ndarray) -> np.ndarray:
    return np.array([(loss(e + d) - loss(e - d)) / (2 * STEP) for d in STEP * np.eye(3)])


def curvature(loss: Callable[[np.ndarray], float], e: np.ndarray) -> np.ndarray:
    return np.array([(gradient(loss, e + d) - gradient(loss, e - d)) / (2 * STEP) for d in STEP * np.eye(3)])


def of_ball(tolerance: float) -> Callable[[np.ndarray], float]:
    return lambda e: 0.5 * max(0.0, float(np.linalg.norm(e)) - SHARE * tolerance) ** 2


def of_box(tolerance: tuple[float, float, float], axes: np.ndarray) -> Callable[[np.ndarray], float]:
    return lambda e: (
        0.5
        * sum(max(0.0, abs(float(axis @ e)) - SHARE * most) ** 2 for axis, most in zip(axes.T, tolerance, strict=True))
    )


@pytest.mark.parametrize("length", [0.031, 0.05, 0.7, 2.0])
def test_outside_a_ball_the_residual_is_the_gradient_of_the_loss_and_the_factor_its_curvature(length):
    rng = np.random.default_rng(1)
    e = rng.normal(size=3)
    e *= length / np.linalg.norm(e)
    left, factor = outside_ball(e, 0.03)
    np.testing.assert_allclose(left, gradient(of_ball(0.03), e), atol=1e-7)
    np.testing.assert_allclose(factor.T @ factor, curvature(of_ball(0.03), e), atol=1e-4)


@pytest.mark.parametrize("e", [(0.2, 0.01, 0.0), (-0.2, 0.3, -0.1), (0.0, -0.11, 0.001), (0.01, 0.01, -0.01)])
def test_outside_a_box_each_of_its_axes_pulls_by_itself(e):
    axes = random_rotation(np.random.default_rng(2))
    error = axes @ e
    left, factor = outside_box(error, BOX, axes)
    np.testing.assert_allclose(left, gradient(of_box(BOX, axes), error), atol=1e-7)
    np.testing.assert_allclose(factor.T @ factor, curvature(of_box(BOX, axes), error), atol=1e-4)


def test_inside_a_tolerance_nothing_pulls():
    e = np.array([0.02, -0.01, 0.001])
    for left, factor in (outside_ball(e, 0.03), outside_box(e, BOX, np.eye(3))):
        assert not left.any()
        assert not factor.any()


def test_what_is_outside_the_tolerances_is_measured_with_weights_and_three_tenths_of_the_length_for_a_radian():
    robot, rng = load_quietly("lion"), np.random.default_rng(3)
    q = robot.neutral()
    here = {frame: robot.placement(frame, q) for frame in ("nose", "left_fore_paw", "tail_tip")}
    shift, about = np.array([0.1, -0.2, 0.05]), rng.normal(size=3)
    turn = rotation_about(about / np.linalg.norm(about), 0.4)
    tilted = here["left_fore_paw"].rotation @ turn
    targets = [
        Target("nose", here["nose"].translation + shift, weight=0.5, tolerance=(0.05, 0.1)),
        Target("left_fore_paw", here["left_fore_paw"].translation - shift, rotation=tilted, tolerance=(0.02, 0.1)),
        Target("tail_tip", rotation=here["tail_tip"].rotation @ turn, weight=0.2, tolerance=(1, 0.3)),
    ]
    kinematics = Kinematics(robot, targets)
    kinematics.loose = True
    radian = 0.3 * Problem(robot, targets).size_of_chain
    away = float(np.linalg.norm(shift))
    parts = [
        0.5 * (away - SHARE * 0.05), away - SHARE * 0.02,
        radian * (0.4 - SHARE * 0.1), 0.2 * radian * (0.4 - SHARE * 0.3),
    ]  # fmt: skip
    assert kinematics.linearize(q).distance == pytest.approx(math.hypot(*parts), rel=1e-9)


@pytest.mark.parametrize("turned", [False, True], ids=["in the axes of the reference", "in its own axes"])
def test_an_error_in_a_box_is_told_along_the_axes_of_the_box(turned):
    robot, rng = load_quietly("ur5"), np.random.default_rng(4)
    q = robot.random(rng)
    frame, reference = robot.placement("tool0", q), robot.placement("forearm_link", q)
    wanted, rotation = rng.normal(size=3), random_rotation(rng) if turned else None
    target = Target(
        "tool0", wanted, rotation=rotation, relative_to="forearm_link", tolerance=Tolerance((0.1, 0.2, 0.3), 1.0)
    )
    axes = reference.rotation @ (np.eye(3) if rotation is None else rotation)
    missing = reference.rotation @ wanted + reference.translation - frame.translation
    kinematics = Kinematics(robot, target)
    assert kinematics.linearize(q).errors[0].offset == pytest.approx(axes.T @ missing)
    kinematics.loose = True
    own = axes.T @ missing
    left = np.sign(own) * np.maximum(np.abs(own) - SHARE * np.array([0.1, 0.2, 0.3]), 0.0)
    np.testing.assert_allclose(kinematics.linearize(q).e[:3], axes @ left, atol=1e-12)
