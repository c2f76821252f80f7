"""The statistics of the instances that are compared, all over the same steps and targets."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...errors import UnknownNameError
from ...motion.figures import StepFigures
from .ball import Ball
from .instance import Instance
from .motion import Motion
from .statistics import WINDOWS, Statistics, Summary
from .step_settings import StepSettings

__all__ = ["Scoreboard", "terms"]

Terms = tuple[object, ...]


def terms(instances: Iterable[Instance], settings: StepSettings, motion: Motion, balls: Iterable[Ball]) -> Terms:
    """Everything that figures must have in common to be comparable, except where the targets are."""
    moves = {"hand": (), "curve": (motion.curve, motion.speed), "random": (motion.speed,)}
    asked = tuple((ball.frame, ball.mode, ball.oriented, ball.free, ball.tolerance) for ball in balls)
    return tuple(one.solver for one in instances), settings, motion.kind, moves[motion.kind], asked


class Scoreboard:
    """Counts a step for all instances as soon as it counts for one of them: they share every step and every target.

    An instance that had nothing to do in such a step is counted too, with no time, no iterations and the error that it
    has, because it got there earlier than the others. The figures begin anew whenever the terms change, so they never
    mix two methods, two motions or two sets of targets. A method that refuses the targets has no figures; it can answer
    again only after a change of the terms, so it too shares all its steps with the others.

    Attributes:
        window: What the summaries cover: a name in `WINDOWS`.
    """

    def __init__(self, every: int) -> None:
        """Begin with no instances.

        Args:
            every: After how many steps the summaries are refreshed, so that they can be read.
        """
        self.window = "last"
        self._every = every
        self._terms: Terms | None = None
        self._columns: list[Statistics] = []
        self.begin_anew(0)

    def begin_anew(self, count: int) -> None:
        """Discard all steps; there are `count` instances from now on."""
        self._columns = [Statistics() for _ in range(count)]
        self.refresh()

    def agree(self, terms: Terms, count: int) -> None:
        """Begin anew if these are other terms than before."""
        if terms != self._terms:
            self._terms = terms
            self.begin_anew(count)

    def count(self, instances: Sequence[Instance], at_once: bool) -> None:
        """Count the step that all instances have just taken.

        Args:
            instances: The instances, as many as there are columns.
            at_once: Whether the summaries show this step at once.
        """
        if any(one.counted for one in instances):
            for column, one in zip(self._columns, instances, strict=True):
                if one.last is not None and one.status != "REFUSED":
                    column.add(one.last)
        self._hidden += 1
        if at_once or self._hidden >= self._every:
            self.refresh()

    def refresh(self) -> None:
        """Let the summaries show every step."""
        self._summaries = [column.summary(self.window) for column in self._columns]
        self._hidden = 0

    def cover(self, window: str) -> None:
        """Choose what the summaries cover: "last" or "all".

        Raises:
            UnknownNameError: There is no such window.
        """
        if window not in WINDOWS:
            raise UnknownNameError("window of the statistics", window, WINDOWS)
        self.window = window
        self.refresh()

    @property
    def summaries(self) -> list[Summary]:
        """The summary of every instance, at the moment when all were last refreshed."""
        return self._summaries

    def newest(self, index: int, count: int) -> Sequence[StepFigures]:
        """The newest `count` steps of an instance, the newest one first."""
        return self._columns[index].newest(count)
