"""Whether an instance has arrived at its balls, as a self-motion needs, and what to do if it has not."""

from __future__ import annotations

from collections.abc import Sequence

from ...model.limits import Limits
from ...problem.targets import Target
from ...problem.tolerance import TargetError
from ...solving.message import how_far
from ...solving.verdict import measure_errors
from .instance import Array
from .session import Session

__all__ = ["why_away", "why_near_only"]

_MOVED = 1e-9  # [rad or m] that a joint must move before it counts as beyond a limit


def why_away(session: Session, index: int) -> str:
    """Why a visible instance is not at what the balls ask for, inside its limits, in words; "" if it is.

    Raises:
        InputError: There is no such visible instance.
    """
    instance, targets = session.instances.visible(index), session.balls.targets
    missed = _missed(session, targets, instance.q)
    if missed:
        balls = [f"the ball of {target.frame} by {how_far([error])}" for target, error in missed]
        return (
            f"{_name(session, index)} misses {_listed(balls)}, and a self-motion begins where every ball is reached: "
            f"let the robot arrive first (Start), or move the ball{'s' * (len(balls) > 1)} to where it can"
        )
    inside = Limits.of(session.robot).wrap(instance.q) if session.settings.limits else instance.q
    if not _missed(session, targets, inside):
        return ""
    before, after = session.robot.angles(instance.q), session.robot.angles(inside)
    beyond = [joint for joint in session.robot.joint_names if abs(before[joint] - after[joint]) > _MOVED]
    return (
        f"{_name(session, index)} reaches every ball only with {_listed(beyond)} beyond the joint limits: let it come "
        "back inside them (Start), or switch Joint limits off"
    )


def why_near_only(session: Session, index: int) -> str:
    """The words for an instance that is within the tolerance of balls that cannot be reached exactly."""
    return (
        f"{_name(session, index)} is within the tolerance of every ball, but a self-motion begins where they are "
        "reached exactly, and no pose nearby does that: move a ball a little nearer"
    )


def _name(session: Session, index: int) -> str:
    return f"robot {index + 1} ({session.instances[index].solver.name})"


def _missed(session: Session, targets: Sequence[Target], q: Array) -> list[tuple[Target, TargetError]]:
    """The targets that are missed at a configuration (nq,), each with its error."""
    tolerance = session.settings.tolerance
    errors = measure_errors(session.robot, targets, q, tolerance)
    return [
        (target, error)
        for target, error in zip(targets, errors, strict=True)
        if not error.within(target.tolerance or tolerance)
    ]


def _listed(words: Sequence[str]) -> str:
    """Words as a list in a sentence: "a", "a and b", "a, b and c"."""
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last
