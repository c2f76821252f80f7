"""The answer to one call, by the compiled problem of an earlier call that asked the same of other places."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..model.robot_model import RobotModel
from ..problem.target_values import Position
from ..problem.targets import Target
from ..solvers.registry import Method
from .kept import Kept, Key, kept_of
from .keys import key_of
from .prepared import Prepared
from .solution import Solution
from .words import UNWEIGHTED, Wanted, asked_targets, options_of

__all__ = ["answer"]


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
    kept = kept_of(robot)
    key, prepared = None, None
    if type(targets) is str and _is_plain(wanted):
        position = wanted[0]
        key = key_of((targets, position is None), method, given, parameters)
        prepared = _found(kept, key)
        if prepared is not None:
            quick = prepared.at(wanted[5] if position is None else _as_point(position), q0)
            if quick is not None:
                prepared.recall()
                return quick
    asked = asked_targets(targets, wanted, method, parameters)
    if key is None or not all(asked[0].along):
        key = key_of(tuple([target.shape for target in asked]), method, given, parameters)
        prepared = _found(kept, key)
    if prepared is None:
        prepared = kept.prepared(robot, asked, options_of(method, given, parameters), key)
    return prepared.answer(asked, q0)


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
