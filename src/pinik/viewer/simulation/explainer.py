"""Explains the next iterations of instances, and keeps what their questions have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...errors import InputError
from ...problem.targets import Target
from ...solving.options import Options
from ...solving.question import Question
from .explanation import Explanation, explain_iteration
from .instance import Instance

__all__ = ["Explainer"]

_MOST_KEPT = 4  # questions; one for each visible instance


class Explainer:
    """Explains iterations. It keeps the questions of the last instances, because compiling one takes milliseconds."""

    def __init__(self) -> None:
        self._kept: dict[tuple[Any, ...], Question] = {}

    def explain(self, instance: Instance, targets: Sequence[Target]) -> Explanation | str:
        """What an instance's method would do next from where its robot is, or the reason why it does nothing."""
        if not targets:
            return "there are no targets"
        try:
            return explain_iteration(self._question(instance, targets), targets, instance.q)
        except InputError as error:
            return f"waiting: {error}"
        except Exception as error:  # a custom solver may raise any exception
            return f"the solver failed: {type(error).__name__}: {error}"

    def _question(self, instance: Instance, targets: Sequence[Target]) -> Question:
        settings = instance.settings
        key = (id(instance.robot), repr(instance.solver), settings, *(repr(target.shape) for target in targets))
        if key not in self._kept:
            options = Options(
                instance.solver, limits=settings.limits, tolerance=settings.tolerance, polish=settings.polish
            )
            question = Question.of(instance.robot, targets, options)
            while len(self._kept) >= _MOST_KEPT:
                del self._kept[next(iter(self._kept))]
            self._kept[key] = question
        return self._kept[key]
