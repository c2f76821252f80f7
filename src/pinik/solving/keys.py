"""The arguments of a call as a key, by which an equal call finds the compiled problem again."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..problem.tolerance import Tolerance
from ..shapes.avoid import Avoid
from ..solvers.registry import SOLVERS, Method
from .kept import Key
from .options import OPTION_NAMES

__all__ = ["key_of", "settled"]

_PAIRS = (tuple, list, Tolerance)
_LOCKED, _TOLERANCE, _WEIGHTS, _AVOID = map(OPTION_NAMES.index, ("locked", "tolerance", "choose_weights", "avoid"))


def settled(given: tuple[Any, ...]) -> tuple[Any, ...]:
    """The values of the options with a world as it is now, so that no later change of it is seen.

    Args:
        given: The values of the options, in the order of `OPTION_NAMES`.

    Raises:
        InputError: What is to be avoided is not "self", a World, or a list of these.
    """
    avoid = given[_AVOID]
    if avoid is None or type(avoid) is str:
        return given
    return (*given[:_AVOID], Avoid.of(avoid), *given[_AVOID + 1 :])


def key_of(what: object, method: Method, given: tuple[Any, ...], parameters: dict[str, Any]) -> Key | None:
    """The arguments of a call as a key; None for arguments that must be checked in every call.

    The key includes their types, because `True == 1`.

    Args:
        what: The kinds of the targets.
        method: The method.
        given: The values of the options, in the order of `OPTION_NAMES`.
        parameters: The solver's parameters.
    """
    meant: object = SOLVERS.get(method) if type(method) is str else method
    if meant is None:
        return None
    if given[_LOCKED] != () or given[_TOLERANCE] is not None or given[_WEIGHTS] is not None:
        plain = list(given)
        plain[_LOCKED], plain[_TOLERANCE] = _as_names(given[_LOCKED]), _as_pair(given[_TOLERANCE])
        plain[_WEIGHTS] = _as_key(given[_WEIGHTS])
        if plain[_LOCKED] is None or (plain[_TOLERANCE] is None and given[_TOLERANCE] is not None):
            return None
        given = tuple(plain)
    own = tuple([(name, type(value), _as_key(value)) for name, value in parameters.items()]) if parameters else ()
    return what, meant, given, tuple(map(type, given)), own


def _as_names(locked: Any) -> tuple[Any, ...] | None:
    """The locked joints as a tuple; None if they have another type."""
    return tuple(locked) if type(locked) in (tuple, list) else None


def _as_pair(tolerance: Any) -> tuple[Any, ...] | None:
    """The tolerance as a tuple of numbers, or of a box and a number; None if it has another type."""
    tolerance = tolerance.tolist() if type(tolerance) is np.ndarray else tolerance
    if type(tolerance) not in _PAIRS or len(tolerance) != 2:
        return None
    metres, radians = tolerance
    metres = metres.tolist() if type(metres) is np.ndarray else metres
    box = tuple(metres) if type(metres) in (tuple, list) else None
    if any([type(number) not in (float, int) for number in (*(box or (metres,)), radians)]):
        return None
    return metres if box is None else box, radians


def _as_key(value: object) -> object:
    return tuple([(name, type(x), x) for name, x in value.items()]) if type(value) is dict else value
