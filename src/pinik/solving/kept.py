"""The questions that a robot keeps compiled, so that asking one again costs microseconds."""

from __future__ import annotations

import contextlib
from collections import OrderedDict
from collections.abc import Hashable, Sequence
from typing import Generic, TypeVar

from ..model.robot_model import RobotModel
from ..problem.targets import Target
from .options import Options
from .prepared import Prepared

__all__ = ["Kept", "kept_of"]

# `pinocchio.Data`, of which a question keeps one or two, takes some 50 bytes times nv³ and 50 kB besides (measured).
_BYTES_AT_MOST = 200_000_000
_BYTES_OF_ONE = 100_000
_BYTES_PER_CUBE = 100
_MOST = 256

Key = TypeVar("Key", bound=Hashable)


class _Last(Generic[Key]):
    """The questions asked last, by key; the one unused for longest is dropped first."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._questions: OrderedDict[Key, Prepared] = OrderedDict()

    def __len__(self) -> int:
        return len(self._questions)

    def get(self, key: Key) -> Prepared | None:
        found = self._questions.get(key)
        if found is not None:
            self._questions.move_to_end(key)
        return found

    def put(self, key: Key, prepared: Prepared) -> None:
        self._questions[key] = prepared
        while len(self._questions) > self._most:
            self._questions.popitem(last=False)

    def clear(self) -> None:
        self._questions.clear()


class Kept:
    """What one thread asked of one robot last.

    Questions are kept by what they ask, and found faster by the words in which they were asked.
    """

    def __init__(self, robot: RobotModel) -> None:
        most = min(_MOST, _BYTES_AT_MOST // (_BYTES_OF_ONE + _BYTES_PER_CUBE * robot.model.nv**3))
        self._by_words: _Last[tuple[object, ...]] = _Last(2 * most)
        self._by_meaning: _Last[tuple[object, ...]] = _Last(most)

    def __len__(self) -> int:
        return len(self._by_meaning)

    def said(self, words: tuple[object, ...]) -> Prepared | None:
        """The question that was asked in these words; TypeError where something in them cannot be hashed."""
        return self._by_words.get(words)

    def remember(self, words: tuple[object, ...], prepared: Prepared) -> None:
        """From now on these words mean this question; words that cannot be hashed are not remembered."""
        with contextlib.suppress(TypeError):
            self._by_words.put(words, prepared)

    def prepared(self, robot: RobotModel, targets: Sequence[Target], options: Options) -> Prepared:
        """The question with these targets and options, compiled now unless it was kept."""
        try:
            key = (*[target.shape for target in targets], options)
            found = self._by_meaning.get(key)
        except TypeError:  # a solver of the user's with a field that cannot be hashed
            return Prepared(robot, targets, options)
        if found is None:
            found = Prepared(robot, targets, options)
            self._by_meaning.put(key, found)
        return found

    def clear(self) -> None:
        """Forget everything."""
        self._by_words.clear()
        self._by_meaning.clear()


def kept_of(robot: RobotModel) -> Kept:
    """What this thread asked of a robot last."""
    local = robot.local
    try:
        kept: Kept = local.kept
    except AttributeError:
        kept = local.kept = Kept(robot)
    return kept
