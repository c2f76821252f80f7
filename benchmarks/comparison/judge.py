"""Plain Pinocchio's verdict on an answer, whatever the peer says of it."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

import numpy as np
import pinocchio

from .arms import Arm

__all__ = ["NEAR", "STRICT", "Verdict", "judged"]

NEAR = (1e-3, 1e-2)  # [m], [rad]: what counts as solved
STRICT = (1e-4, 1e-3)  # [m], [rad]: what the peers are asked for, and pinik's own tolerance
LIMIT_SLACK = 1e-9  # [rad]


class Verdict(IntEnum):
    """How good an answer is."""

    MISSED = 0
    SOLVED = 1
    STRICTLY_SOLVED = 2


def judged(arm: Arm, target: pinocchio.SE3, answer: Sequence[float] | None) -> Verdict:
    """Whether joint values put the tip onto its target with every joint inside its limits."""
    if answer is None:
        return Verdict.MISSED
    q = np.array(answer, dtype=np.float64)
    inside = np.isfinite(q).all() and (q >= arm.lower - LIMIT_SLACK).all() and (q <= arm.upper + LIMIT_SLACK).all()
    if not inside:
        return Verdict.MISSED
    found = arm.placement(q)
    away = float(np.linalg.norm(found.translation - target.translation))
    turned = float(np.linalg.norm(pinocchio.log3(target.rotation.T @ found.rotation)))
    if away <= STRICT[0] and turned <= STRICT[1]:
        return Verdict.STRICTLY_SOLVED
    return Verdict.SOLVED if away <= NEAR[0] and turned <= NEAR[1] else Verdict.MISSED
