"""The answer to one call, by the compiled problem of an earlier call that asked the same of other places."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..model.robot_model import RobotModel
from ..problem.target_values import Position
from ..problem.targets import Target
from ..solvers.registry import Method
from .kept import Kept, Key, kept_of
from .keys import key_of, settled
from .prepared import Prepared
from .solution import Solution
from .words import UNWEIGHTED, Wanted, asked_targets, options_of

__all__ = ["answer", "plainly_asked", "prepared_for"]


def answer(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method,
    wanted: Wanted,
    q0: ArrayLike | Mapping[str, float] | str | None,
    given: tuple[Any, ...],
    parameters: dict[str, Any],
) -> Solution:
    """Solve, and reuse the compiled problem of an earlier call with equal arguments or an equal meaning.

    Args:
        robot: The robot.
        targets: A frame's name or targets.
        method: The method.
        wanted: The values of a target's keywords, in the order of `PLACE_WORDS`.
        q0: The start.
        given: The values of the options, in the order of `OPTION_NAMES`.
        parameters: The solver's parameters.
    """
    plain = plainly_asked(robot, targets, method, wanted, given, parameters)
    if plain.prepared is not None:
        quick = plain.prepared.at(plain.place, q0)
        if quick is not None:
            plain.prepared.recall()
            return quick
    asked = asked_targets(targets, wanted, method, parameters)
    return prepared_for(robot, asked, method, given, parameters, plain.key).answer(asked, q0)


class Plain(NamedTuple):
    """A call that asks for a position or a placement of one frame, and nothing else.

    Attributes:
        key: The key of its arguments; None for other calls, and for arguments that must be checked in every call.
        prepared: The compiled problem of an earlier call with this key, if there was one.
        place: The position or placement as given, unchecked; None for what must be checked first.
    """

    key: Key | None = None
    prepared: Prepared | None = None
    place: object = None


def plainly_asked(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method,
    wanted: Wanted,
    given: tuple[Any, ...],
    parameters: dict[str, Any],
) -> Plain:
    """The call as a plain one, if it is one; the arguments are those of `answer`."""
    if type(targets) is not str or not _is_plain(wanted):
        return Plain()
    position = wanted[0]
    key = key_of((targets, position is None), method, settled(given), parameters)
    return Plain(key, _found(kept_of(robot), key), wanted[5] if position is None else _as_point(position))


def prepared_for(
    robot: RobotModel,
    targets: Sequence[Target],
    method: Method,
    given: tuple[Any, ...],
    parameters: dict[str, Any],
    plain_key: Key | None = None,
) -> Prepared:
    """The compiled problem for targets of these kinds; that of an earlier call with equal arguments, if there was one.

    Args:
        robot: The robot.
        targets: The targets.
        method: The method.
        given: The values of the options, in the order of `OPTION_NAMES`.
        parameters: The solver's parameters.
        plain_key: The key of a plain call, under which `plainly_asked` finds the problem from now on.
    """
    kept, given = kept_of(robot), settled(given)
    key = plain_key
    if key is None or not all(targets[0].along):
        key = key_of(tuple([target.shape for target in targets]), method, given, parameters)
    prepared = _found(kept, key)
    return prepared or kept.prepared(robot, targets, options_of(method, given, parameters), key)


def _is_plain(wanted: Wanted) -> bool:
    """Whether only a position or only a placement is given."""
    (position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight) = wanted
    return (
        (position is None) is not (placement is None)
        and tool is None
        and relative_to is None
        and rotation is None
        and rpy is None
        and quat_xyzw is None
        and quat_wxyz is None
        and axis is None
        and direction is None
        and at is None
        and weight is UNWEIGHTED
    )


def _found(kept: Kept, key: Key | None) -> Prepared | None:
    try:
        return None if key is None else kept.found(key)
    except (TypeError, ValueError):  # an argument is not hashable, or a memoryview that is released
        return None


def _as_point(position: Position) -> object:
    """Three floats as an array, or a vector unchanged; None for anything that must be checked first."""
    if isinstance(position, (list, tuple)) and [type(x) for x in position] == [float, float, float]:
        return np.array(position)
    return position if isinstance(position, np.ndarray) and position.ndim == 1 else None
