"""The explanation of a verdict in one sentence."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ..closed_form.robot_bones import OffPlane
from ..problem.reach import Shortfall
from ..problem.targets import Target
from ..problem.tolerance import TargetError, Tolerance, largest_of
from ..shapes.collisions import Collision
from .question import Question
from .state import Status
from .verdict import Verdict

__all__ = ["explain", "how_far", "overlap"]


def explain(
    question: Question,
    targets: Sequence[Target],
    verdict: Verdict,
    active: Mapping[str, str],
    alone: Sequence[str] = (),
    chosen_from: int = 1,
    collisions: Sequence[Collision] = (),
) -> str:
    """Explain why the solve ended, which errors remain, and which joints are at their limits.

    Args:
        question: The problem and the options.
        targets: The targets.
        verdict: The verdict on the answer.
        active: Joint name → "lower", "upper" or "both", for the joints at a limit.
        alone: Which of "position" and "orientation" is found when it is asked for alone.
        chosen_from: The number of distinct answers that this one was chosen from.
        collisions: What touches at the answer, the deepest first.
    """
    status, errors, proof = verdict
    if status is Status.CONVERGED:
        chosen = f"; the nearest of {chosen_from} answers" if chosen_from > 1 else ""
        return f"converged, {how_far(errors)} off{chosen}"
    if status is Status.COLLIDING:
        return _colliding(targets, collisions, chosen_from)
    tolerances = [term.tolerance for term in question.problem.terms]
    missed = _missed(targets, errors, tolerances)
    if not question.problem.free.any():
        return f"no free joint moves {_frames(targets)}; {missed}"
    begin = {
        Status.STALLED: "stalled",
        Status.MAX_ITERATIONS: "out of iterations,",
        Status.TIME_LIMIT: "out of time,",
        Status.UNREACHABLE: "unreachable:",
    }[status]
    off_plane = question.solver.off_plane(question.robot, targets)
    why = _out_of_reach(targets, tolerances, proof, off_plane) or _each_alone(alone)
    first, *others = [*why, missed] if status is Status.UNREACHABLE else [missed, *why]
    return "; ".join([f"{begin} {first}", *others, *_limits(active)])


def how_far(errors: Sequence[TargetError]) -> str:
    """The largest distance and the largest angle of all errors, such as "4.1 cm and 3.2°"."""
    position, orientation = largest_of(errors)
    words = [] if position is None else [_length(position)]
    words += [] if orientation is None else [_angle(orientation)]
    return " and ".join(words)


def _colliding(targets: Sequence[Target], collisions: Sequence[Collision], answers: int) -> str:
    """Which of the links and obstacles overlap, and by how much, and how many answers collide."""
    every = f"; {'both' if answers == 2 else f'all {answers}'} answers found collide"
    return f"reaches the target{'s' * (len(targets) > 1)}, but {overlap(collisions)}{every * (answers > 1)}"


def overlap(collisions: Sequence[Collision]) -> str:
    """Which two overlap the deepest, and by how much, and how many others touch."""
    first, *others = collisions
    link, other = first.pair
    words = f"{link} and {'the object ' * first.with_world}{other} "
    words += f"overlap by {_length(first.depth)}" if first.depth > 0.0 else "touch"
    more = f"; {len(others)} more pair{'s touch' if len(others) > 1 else ' touches'}"
    return words + more * bool(others)


def _out_of_reach(
    targets: Sequence[Target], tolerances: Sequence[Tolerance], proof: Shortfall | None, off_plane: OffPlane | None
) -> list[str]:
    """How the target lies out of reach, as far as that is known."""
    frame, places = targets[0 if proof is None else proof.target].frame, []
    if proof is not None and proof.inner:
        places.append(
            f"{_length(proof.distance)} inside the hole of {_length(proof.bound)} around its chain's first joint"
        )
    elif proof is not None:
        places.append(f"{_length(proof.distance)} beyond its chain's reach of {_length(proof.bound)}")
    if off_plane is not None and abs(off_plane.distance) > tolerances[0].farthest:
        places.append(f"{_length(abs(off_plane.distance))} off the plane in which {frame} moves, {_normal(off_plane)}")
    return [f"the target of {frame} lies {' and '.join(places)}"] if places else []


def _normal(plane: OffPlane) -> str:
    """The plane's normal in words: the name of an axis if it is parallel to one, else its three components."""
    whose = "the world" if plane.relative_to is None else f"frame {plane.relative_to!r}"
    numbers = [round(float(x), 3) + 0.0 for x in plane.normal]  # + 0.0: no −0
    for name, number in zip("xyz", numbers, strict=True):
        if abs(number) == 1.0:
            return f"whose normal is the {name} axis of {whose}"
    return f"whose normal is ({', '.join(f'{x:g}' for x in numbers)}) in the axes of {whose}"


def _each_alone(alone: Sequence[str]) -> list[str]:
    """Which of position and orientation can be reached, if not both."""
    if len(alone) == 2:
        return ["position and orientation can each be reached alone, but both together were not found"]
    return [f"the {alone[0]} alone can be reached"] if alone else []


def _missed(targets: Sequence[Target], errors: Sequence[TargetError], tolerances: Sequence[Tolerance]) -> str:
    parts = []
    for target, error, tolerance in zip(targets, errors, tolerances, strict=True):
        words = []
        if error.position is not None and not error.position_within(tolerance):
            words.append(f"{_length(error.position)} short")
        if error.orientation is not None and not error.orientation_within(tolerance):
            words.append(f"{_angle(error.orientation)} off")
        if words:
            name = f"{target.frame} " if len(targets) > 1 else ""
            parts.append(name + " and ".join(words))
    return ", ".join(parts)


def _limits(active: Mapping[str, str]) -> list[str]:
    sentences = []
    for side, words in (("lower", "lower limit"), ("upper", "upper limit"), ("both", "only value")):
        names = [name for name, at in active.items() if at == side]
        if names:
            sentences.append(
                f"{', '.join(names)} at {'its' if len(names) == 1 else 'their'} {words}{'' if len(names) == 1 else 's'}"
            )
    return sentences


def _frames(targets: Sequence[Target]) -> str:
    names = list(dict.fromkeys(target.frame for target in targets))
    return f"frame {names[0]!r}" if len(names) == 1 else f"frames {', '.join(map(repr, names))}"


def _length(metres: float) -> str:
    if metres >= 100.0:
        return f"{metres:,.0f} m"
    if metres >= 1.0:
        return f"{metres:.3g} m"
    if metres >= 0.01:
        return f"{100.0 * metres:.3g} cm"
    if metres >= 1e-5:
        return f"{1000.0 * metres:.2g} mm"
    if metres >= 1e-8:
        return f"{1e6 * metres:.2g} µm"
    return "less than 0.01 µm"


def _angle(radians: float) -> str:
    degrees = math.degrees(radians)
    if degrees >= 10.0:
        return f"{degrees:.0f}°"
    if degrees >= 0.001:
        return f"{degrees:.2g}°"
    return f"{degrees:.4f}°" if degrees >= 0.00005 else "less than 0.0001°"
