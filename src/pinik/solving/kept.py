"""A cache of compiled problems per robot, so that repeated solves take only microseconds to set up."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field

from ..model.robot_model import RobotModel
from ..problem.targets import Target
from .options import Options
from .prepared import Prepared

__all__ = ["Kept", "Key", "kept_of"]

# A compiled problem holds one or two `pinocchio.Data`, each of about 50 kB plus 50 bytes times nv³ (measured).
_BYTES_AT_MOST = 200_000_000
_BYTES_OF_ONE = 100_000
_BYTES_PER_CUBE = 100
_MOST = 256

_MOST_KEYS = 16  # keys of arguments kept per problem, oldest dropped first

Key = tuple[object, ...]
"""The arguments of a call, or their meaning, as a key."""


@dataclass(eq=False)
class _Entry:
    """A cached problem: its meaning, the arguments that led to it, and the time of its last use."""

    meaning: Key
    prepared: Prepared
    used: int = 0
    keys: list[Key] = field(default_factory=list)


class Kept:
    """The problems that one thread solved last for one robot; the least recently used one is dropped first.

    Problems are stored by their meaning, and found faster by the arguments of earlier calls.
    """

    def __init__(self, robot: RobotModel) -> None:
        of_one = _BYTES_OF_ONE + _BYTES_PER_CUBE * int(robot.model.nv) ** 3
        self._most = max(1, min(_MOST, _BYTES_AT_MOST // of_one))
        self._clock = itertools.count(1)
        self._by_key: dict[Key, _Entry] = {}
        self._by_meaning: dict[Key, _Entry] = {}

    def __len__(self) -> int:
        return len(self._by_meaning)

    @property
    def most(self) -> int:
        """The maximum number of cached problems, by the memory that they take."""
        return self._most

    def found(self, key: Key) -> Prepared | None:
        """The problem of an earlier call with these arguments; None if there is none.

        Raises:
            TypeError: An argument is not hashable.
            ValueError: An argument is a memoryview that is released.
        """
        entry = self._by_key.get(key)
        if entry is None:
            return None
        entry.used = next(self._clock)
        return entry.prepared

    def prepared(
        self, robot: RobotModel, targets: Sequence[Target], options: Options, key: Key | None = None
    ) -> Prepared:
        """The problem with these targets and options, compiled unless it is cached.

        Args:
            robot: The robot.
            targets: The targets.
            options: The options.
            key: The arguments of the call, under which the problem can be found from now on.
        """
        meaning = (*[target.shape for target in targets], options)
        try:
            entry = self._by_meaning.get(meaning)
        except TypeError:  # a custom solver has a field that is not hashable
            return Prepared(robot, targets, options)
        if entry is None:
            entry = _Entry(meaning, Prepared(robot, targets, options))
            self._by_meaning[meaning] = entry
        entry.used = next(self._clock)
        if key is not None:
            self._remember(key, entry)
        while len(self._by_meaning) > self._most:
            self._drop(min(self._by_meaning.values(), key=lambda entry: entry.used))
        return entry.prepared

    def _remember(self, key: Key, entry: _Entry) -> None:
        try:
            self._by_key[key] = entry
        except TypeError:  # an argument is not hashable
            return
        entry.keys.append(key)
        if len(entry.keys) > _MOST_KEYS:
            self._by_key.pop(entry.keys.pop(0), None)

    def _drop(self, entry: _Entry) -> None:
        del self._by_meaning[entry.meaning]
        for key in entry.keys:
            self._by_key.pop(key, None)

    def clear(self) -> None:
        """Forget everything."""
        self._by_key.clear()
        self._by_meaning.clear()


def kept_of(robot: RobotModel) -> Kept:
    """This thread's cache for a robot."""
    local = robot.local
    try:
        kept: Kept = local.kept
    except AttributeError:
        kept = local.kept = Kept(robot)
    return kept
