"""The questions that a robot keeps compiled, so that asking one again costs microseconds."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field

from ..model.robot_model import RobotModel
from ..problem.targets import Target
from .options import Options
from .prepared import Prepared

__all__ = ["Kept", "Key", "kept_of"]

# `pinocchio.Data`, of which a question keeps one or two, takes some 50 bytes times nv³ and 50 kB besides (measured).
_BYTES_AT_MOST = 200_000_000
_BYTES_OF_ONE = 100_000
_BYTES_PER_CUBE = 100
_MOST = 256

_MOST_WAYS = 16  # in which one question may be asked before its oldest words are forgotten

Key = tuple[object, ...]
"""Words or a meaning, as a key."""


@dataclass(eq=False)
class _Entry:
    """A question that is kept: what it means, the words it was asked in, and when it was used last."""

    meaning: Key
    prepared: Prepared
    used: int = 0
    words: list[Key] = field(default_factory=list)


class Kept:
    """What one thread asked of one robot last; the question that was not used for longest is dropped first.

    Questions are kept by what they ask, and found faster by the words in which they were asked.
    """

    def __init__(self, robot: RobotModel) -> None:
        of_one = _BYTES_OF_ONE + _BYTES_PER_CUBE * int(robot.model.nv) ** 3
        self._most = max(1, min(_MOST, _BYTES_AT_MOST // of_one))
        self._clock = itertools.count(1)
        self._by_words: dict[Key, _Entry] = {}
        self._by_meaning: dict[Key, _Entry] = {}

    def __len__(self) -> int:
        return len(self._by_meaning)

    @property
    def most(self) -> int:
        """How many questions are kept at most, by the memory that they take."""
        return self._most

    def said(self, words: Key) -> Prepared | None:
        """The question that was asked in these words; TypeError where something in them cannot be hashed."""
        entry = self._by_words.get(words)
        if entry is None:
            return None
        entry.used = next(self._clock)
        return entry.prepared

    def prepared(
        self, robot: RobotModel, targets: Sequence[Target], options: Options, words: Key | None = None
    ) -> Prepared:
        """The question with these targets and options, compiled now unless it was kept.

        Args:
            robot: The robot.
            targets: The targets.
            options: The options.
            words: From now on these words mean this question.
        """
        meaning = (*[target.shape for target in targets], options)
        try:
            entry = self._by_meaning.get(meaning)
        except TypeError:  # a user's solver has a field that cannot be hashed
            return Prepared(robot, targets, options)
        if entry is None:
            entry = _Entry(meaning, Prepared(robot, targets, options))
            self._by_meaning[meaning] = entry
        entry.used = next(self._clock)
        if words is not None:
            self._remember(words, entry)
        while len(self._by_meaning) > self._most:
            self._drop(min(self._by_meaning.values(), key=lambda entry: entry.used))
        return entry.prepared

    def _remember(self, words: Key, entry: _Entry) -> None:
        try:
            self._by_words[words] = entry
        except TypeError:  # something in them cannot be hashed
            return
        entry.words.append(words)
        if len(entry.words) > _MOST_WAYS:
            self._by_words.pop(entry.words.pop(0), None)

    def _drop(self, entry: _Entry) -> None:
        del self._by_meaning[entry.meaning]
        for words in entry.words:
            self._by_words.pop(words, None)

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
