"""The poses in a picture: configurations, and how each looks, whatever answer they come from."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias, TypeGuard

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError
from ..robot import Robot
from ..shapes.collisions import Collision
from ..solving.branches import Branches
from ..solving.self_motion import SelfMotion
from ..solving.solution import Solution
from ..solving.track import Track
from .arguments import as_color, as_configurations

__all__ = ["GHOSTS", "TINTS", "Answer", "Drawable", "Pose", "links_of", "poses_of", "whose"]

Array = NDArray[np.float64]

Answer: TypeAlias = Solution | Branches | SelfMotion | Sequence[SelfMotion] | Track
Drawable: TypeAlias = ArrayLike | Answer

TINTS = (
    "#1f6fc4", "#d97a00", "#0c9a72", "#b9559a", "#7a5fd0", "#94a81e", "#2a9db0",
    "#6e3f18", "#ecd800", "#cc22dd", "#86f2c8", "#3322dd", "#e8bfae", "#3cc81e", "#6a1080",
)  # fmt: skip
"""The colours of ghosts, one after the other, from the first again after the last; none is red, as balls are.

On a grey arm, any two ghosts differ by more than 5 in CIELAB (ΔE of 1976), on white and on nearly black.
"""

GHOSTS = 12
"""How many ghosts stand for infinitely many answers."""

_BRANCH = 0.42  # the opacity of another branch
_NEAR, _FAR = 0.46, 0.16  # the opacities of a fan near its start and at its far end


@dataclass(frozen=True, eq=False)
class Pose:
    """A configuration, and how it looks.

    Attributes:
        q: The configuration (nq,).
        opacity: In 0..1.
        tint: The colour (3,) that the robot is tinted with, each in 0..1; None for none.
        ghost: Whether solid robots cover it, even from behind.
        touching: The names of the links that touch something.
    """

    q: Array
    opacity: float = 1.0
    tint: Array | None = None
    ghost: bool = False
    touching: frozenset[str] = frozenset()


def links_of(collisions: Iterable[Collision]) -> frozenset[str]:
    """The names of the links that touch something."""
    return frozenset(name for collision in collisions for name in collision.links)


def whose(robot: Robot | Answer, shown: Drawable | None) -> tuple[Robot, Drawable | None]:
    """The robot, and what is to be shown; an answer in the robot's place is shown with its own robot.

    Raises:
        InputError: There is no robot; or there are an answer in its place and something else to show.
    """
    if isinstance(robot, Robot):
        return robot, shown
    one = robot[0] if _are_motions(robot) else robot
    if not isinstance(one, (Solution, Branches, SelfMotion, Track)) or not isinstance(one.robot, Robot):
        raise InputError(
            f"must be one that pinik.load returned, or an answer with its own; got an object of type "
            f"{type(robot).__name__!r}",
            argument="robot",
        )
    if shown is not None:
        raise InputError("must be left out, because the answer before it is what is drawn", argument="q")
    return one.robot, robot


def poses_of(robot: Robot, shown: Drawable | None) -> list[Pose]:
    """Configurations as they are; of several answers, the first as it is and the others as ghosts; of a path, the end.

    Raises:
        InputError: `shown` holds no configuration of this robot.
    """
    if isinstance(shown, Branches):
        if not shown:
            raise InputError(f"has no configuration to draw: {shown.message}", argument="q")
        curved = shown.redundancy == 1 and shown.families
        return _of(robot, _fans(curved) if curved else _branches(shown))
    if isinstance(shown, SelfMotion):
        return _of(robot, _fans([shown]))
    if isinstance(shown, Solution):
        return _of(robot, iter([Pose(shown.q, touching=links_of(shown.collisions))]))
    if _are_motions(shown):
        return _of(robot, _fans(shown))
    if isinstance(shown, Track):
        return _of(robot, _path(robot, shown.q))
    return [Pose(q) for q in as_configurations(robot, shown)]  # type: ignore[arg-type]


def _of(robot: Robot, poses: Iterator[Pose]) -> list[Pose]:
    return [replace(pose, q=robot.check_configuration(pose.q)) for pose in poses]


def _are_motions(shown: object) -> TypeGuard[Sequence[SelfMotion]]:
    return isinstance(shown, (list, tuple)) and len(shown) > 0 and all(isinstance(one, SelfMotion) for one in shown)


def _branches(branches: Branches) -> Iterator[Pose]:
    """The first branch as it is, and the others as ghosts, each in its own tint; of infinitely many only some."""
    yield Pose(branches.q[0])
    for k, q in enumerate(branches.q[1 : GHOSTS + 1 if branches.redundancy else None]):
        yield Pose(q, _BRANCH, _tint(k), ghost=True)


def _fans(motions: Sequence[SelfMotion]) -> Iterator[Pose]:
    """The start of the first motion as it is, and ghosts along each, in its own tint.

    All of them share the ghosts by their lengths.
    """
    yield Pose(motions[0].start)
    whole = sum(motion.length for motion in motions)
    for k, motion in enumerate(motions):
        if motion.length:
            others = _fan(motion, max(round(GHOSTS * motion.length / whole), 2))
        else:
            others = [(q, 0.5) for q in motion.q[1 : GHOSTS + 1]]  # of a surface: first those farthest from each other
        for q, away in others:
            yield Pose(q, _NEAR + (_FAR - _NEAR) * away, _tint(k), ghost=True)


def _fan(motion: SelfMotion, count: int) -> list[tuple[Array, float]]:
    """Configurations at equal distances along a curve, and how far each is from the start, from 0 to 1 at the farthest.

    An arc's ends are among them; on a closed one, the start is.
    """
    n = len(motion)
    model = motion.robot.model
    begin = np.argmin([np.linalg.norm(pinocchio.difference(model, motion.start, q)) for q in motion.q])
    if motion.closed:
        places = (begin + np.arange(count) * n // count) % n
        away = (places - begin) % n
        away = np.minimum(away, n - away)
    else:
        places = np.linspace(0, n - 1, count).round().astype(np.int64)
        away = np.abs(places - begin)
    return list(zip(motion.q[places], away / max(away.max(), 1), strict=True))


def _path(robot: Robot, q: Array) -> Iterator[Pose]:
    """The end of a path as it is, and ghosts on the way there, from its beginning on, evenly in the joints."""
    yield Pose(q[-1])
    steps = [np.linalg.norm(pinocchio.difference(robot.model, *pair)) for pair in itertools.pairwise(q)]
    left = np.append(np.cumsum(steps[::-1])[::-1], 0.0)  # [rad or m] from each configuration to the end
    if left[0] > 0.0:
        places = {int(np.abs(left - share * left[0]).argmin()) for share in np.linspace(1.0, 0.0, GHOSTS + 1)[:-1]}
        for k in sorted(places - {len(q) - 1}):
            yield Pose(q[k], _NEAR + (_FAR - _NEAR) * left[k] / left[0], _tint(0), ghost=True)


def _tint(k: int) -> Array:
    return as_color(TINTS[k % len(TINTS)], "tint")
