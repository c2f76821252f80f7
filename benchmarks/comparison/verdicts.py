"""How good a peer's answer is, according to the judge in `tests/judge.py`; what the peer claims does not count."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

import pinocchio

from judge import judge_angles

from .arms import Arm

__all__ = ["NEAR", "STRICT", "Verdict", "verdict_on"]

NEAR = (1e-3, 1e-2)  # [m], [rad]: what counts as solved
STRICT = (1e-4, 1e-3)  # [m], [rad]: what the peers are asked for, and pinik's own tolerance
LIMIT_SLACK = 1e-9  # [rad]


class Verdict(IntEnum):
    """How good an answer is."""

    MISSED = 0
    SOLVED = 1
    STRICTLY_SOLVED = 2


def verdict_on(arm: Arm, target: pinocchio.SE3, answer: Sequence[float] | None) -> Verdict:
    """Whether joint values put the tip onto its target with every joint inside its limits."""
    if answer is None:
        return Verdict.MISSED
    angles = dict(zip(arm.joints, answer, strict=True))
    errors = judge_angles(arm.plain, {"frame": arm.tip, "placement": target}, angles)
    if any(not distance <= LIMIT_SLACK for distance in errors.outside.values()) or not errors.are_within(NEAR):
        return Verdict.MISSED
    return Verdict.STRICTLY_SOLVED if errors.are_within(STRICT) else Verdict.SOLVED
