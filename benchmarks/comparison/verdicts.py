"""How good a peer's answer is, according to the judge in `tests/judge.py`; what the peer claims does not count."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

import numpy as np
import pinocchio
from numpy.typing import NDArray

from judge import judge_angles

from .arms import Arm

__all__ = ["NEAR", "STRICT", "Verdict", "verdict_on", "verdict_on_placement"]

NEAR = (1e-3, 1e-2)  # [m], [rad]: what counts as solved
STRICT = (1e-4, 1e-3)  # [m], [rad]: what the peers are asked for, and pinik's own tolerance
LIMIT_SLACK = 1e-9  # [rad]
SAME = 1e-9  # what two entries of a placement may differ by when both compute it from the same joint values


class Verdict(IntEnum):
    """How good an answer is."""

    MISSED = 0
    OUTSIDE_LIMITS = 1
    SOLVED = 2
    STRICTLY_SOLVED = 3


def verdict_on(
    arm: Arm, target: pinocchio.SE3, answer: Sequence[float], strict: tuple[float, float] = STRICT
) -> Verdict:
    """Whether joint values put the tip onto its target, and whether every joint is inside its limits.

    Args:
        arm: The arm.
        target: Where the tip should be.
        answer: Joint values (n,); NaN for no answer.
        strict: The tolerance that the peer was given [m], [rad].
    """
    angles = dict(zip(arm.joints, answer, strict=True))
    errors = judge_angles(arm.plain, {"frame": arm.tip, "placement": target}, angles)
    if not errors.are_within(NEAR):
        return Verdict.MISSED
    if any(not distance <= LIMIT_SLACK for distance in errors.outside.values()):
        return Verdict.OUTSIDE_LIMITS
    return Verdict.STRICTLY_SOLVED if errors.are_within(strict) else Verdict.SOLVED


def verdict_on_placement(target: pinocchio.SE3, answer: NDArray[np.float64]) -> Verdict:
    """Whether a placement (4, 4) is the one that Pinocchio computes from the same joint values."""
    same = answer.shape == (4, 4) and np.allclose(answer, target.homogeneous, rtol=0.0, atol=SAME)
    return Verdict.STRICTLY_SOLVED if same else Verdict.MISSED
