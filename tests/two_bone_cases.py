"""Frames of the catalogue that two parallel hinges move, for the tests of the closed form."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pinocchio
import pytest

import pinik


class Case(NamedTuple):
    """A robot of the catalogue, and a frame or a point on it that two hinges move."""

    robot: str
    frame: str
    tool: tuple[float, float, float] | None
    l1: float
    l2: float
    limits: bool = True


CASES = [
    Case("two_link", "tip", None, 0.5, 0.4),
    Case("two_link", "link2", (0.1, -0.2, 0.05), 0.5, math.hypot(0.1, 0.2)),
    Case("asr_twodof", "Tip", None, 0.089, 0.122),
    Case("double_pendulum_simple", "link3", None, 0.1, 0.2, limits=False),
    Case("double_pendulum", "link2", (0.03, 0.01, -0.2), 0.1, math.hypot(0.01, 0.2), limits=False),
    Case("double_pendulum_continuous", "link2", (0.0, 0.0, 0.2), 0.1, 0.2),
]
every_case = pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.robot}-{case.frame}")


def plain_position(robot: pinik.Robot, frame: str, q: np.ndarray, tool=None) -> np.ndarray:
    """By plain Pinocchio [m]."""
    data = robot.model.createData()
    pinocchio.framesForwardKinematics(robot.model, data, q)
    placement = data.oMf[robot.model.getFrameId(frame, pinocchio.BODY)]
    return placement.act(np.zeros(3) if tool is None else np.array(tool))


def configurations(robot: pinik.Robot, count: int, seed: int):
    """Anywhere, whatever the limits."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        q = robot.neutral()
        for joint in robot.joints:
            joint.set_angle(q, rng.uniform(-3.1, 3.1))
        yield q
