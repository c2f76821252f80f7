"""The two engines side by side: one step of the Python one, and how far apart two configurations are."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Sequence

import numpy as np
import pinocchio
import pytest
from numpy.typing import NDArray

import pinik
from pinik.solving.native.module import why_not
from pinik.solving.run import Pace, run

Array = NDArray[np.float64]
Step = Callable[..., Array]


SANITIZED = os.environ.get("PINIK_SANITIZED_ENGINE")
"""The path of an engine that was built with sanitizers; `make sanitize` sets it, and `sanitized_engine` loads it."""
WHY_NOT = why_not()
REQUIRED = bool(os.environ.get("PINIK_REQUIRE_NATIVE"))
needs_native = pytest.mark.skipif(WHY_NOT is not None and not REQUIRED, reason=f"no compiled engine: {WHY_NOT}")
"""For tests of the compiled engine. With PINIK_REQUIRE_NATIVE set they run where there is none, and fail."""

DRAWN = 4.0  # how many times the largest of thirty drawn roundings the engines' own may be
SAME = 1e-9  # [rad or m]: two steps from one configuration that agree to this are the same step


def distance(robot: pinik.Robot, a: Array, b: Array) -> float:
    """The largest difference of one coordinate [rad or m], relative where angles or ways are beyond 1."""
    return float(
        np.abs(pinocchio.difference(robot.model, a, b)).max(initial=0.0) / max(1.0, np.abs(a).max(initial=0.0))
    )


def python_step(prepared: pinik.Prepared, *, bold: bool = False) -> Step:
    """One step of the Python engine from any configuration, with the method and targets of a prepared question.

    With `rng` the last bits of Jacobian and residual are other ones, by ten units: rounding in another order does that.
    """
    question, kinematics = prepared.question, prepared.attempts.kinematics
    kinematics.retarget(prepared.targets)
    exact = kinematics.linearize

    def step(q: Array, rng: np.random.Generator | None = None) -> Array:
        def rounded_otherwise(q: Array) -> pinik.Linearization:
            at = exact(q)
            J, e = (a * (1.0 + 2e-15 * rng.uniform(-1.0, 1.0, a.shape)) for a in (at.J, at.e))
            return at._replace(J=J, e=e)

        q = q.copy() if bold else np.array(question.limits.clip(q))
        kinematics.linearize = exact if rng is None else rounded_otherwise
        return [state.q for state in run(question, kinematics, q, Pace(1, bold=bold))][-1]

    return step


def is_a_threshold(robot: pinik.Robot, step: Step, q: Array, gap: float, seed: int = 0) -> bool:
    """Whether the Python step alone changes by as much as `gap` when `q` moves by a billionth, or by rounding.

    So it does where a rule decides between two steps, and where the step's condition blows rounding up to that. Joints
    at a limit stay there: rounding does not move them off it, and all would look like a threshold if they did.
    """
    rng = np.random.default_rng(seed)
    here = step(q)
    movable = np.ones(robot.model.nv)
    for joint in robot.joints:
        if joint.nq == 1 and q[joint.idx_q] in (robot.lower_q[joint.idx_q], robot.upper_q[joint.idx_q]):
            movable[joint.idx_v] = 0.0
    for _ in range(30):
        nearby = pinocchio.integrate(robot.model, q, 1e-9 * movable * rng.uniform(-1.0, 1.0, len(movable)))
        if DRAWN * max(distance(robot, here, step(nearby)), distance(robot, here, step(q, rng))) >= gap:
            return True
    return False


def compare_steps(
    robot: pinik.Robot, step: Step, states: Sequence[pinik.State]
) -> tuple[int, list[tuple[pinik.State, float]], list[tuple[pinik.State, float]]]:
    """(steps compared, those that differ at a threshold, those that differ elsewhere: the state before and the gap).

    `states` are those of one attempt of the compiled engine; each of its steps is taken by the Python engine as well,
    from the same configuration.
    """
    at_thresholds, wrong = [], []
    for before, after in itertools.pairwise(states):
        gap = distance(robot, step(before.q), after.q)
        if not gap <= SAME:
            (at_thresholds if is_a_threshold(robot, step, before.q, gap) else wrong).append((before, gap))
    return len(states) - 1, at_thresholds, wrong
