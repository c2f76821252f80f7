"""Explains the next iterations of instances, and keeps what their questions have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

from ...errors import InputError
from ...problem.reach import Bounds
from ...problem.targets import Target
from ...solving.options import Options
from ...solving.question import Question
from .explanation import Explanation, explain_iteration
from .instance import Instance

__all__ = ["Explainer"]

Kept = TypeVar("Kept")

_MOST_KEPT = 4  # questions; one for each visible instance


class Explainer:
    """Explains iterations. It keeps the questions of the last instances, because compiling one takes milliseconds."""

    def __init__(self) -> None:
        self._kept: dict[tuple[Any, ...], Question] = {}
        self._bounds: dict[tuple[Any, ...], list[Bounds | None]] = {}

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
        shapes = tuple(repr(target.shape) for target in targets)
        key = (instance.robot, repr(instance.solver), settings, shapes)
        if key not in self._kept:
            options = Options(
                instance.solver, limits=settings.limits, tolerance=settings.tolerance, polish=settings.polish
            )
            question = Question.of(instance.robot, targets, options)
            # The bounds take a tenth of a second on a lion, and do not depend on parameters such as λ.
            alike = (instance.robot, settings.limits, instance.solver.held, shapes)
            vars(question)["bounds"] = _keep(self._bounds, alike, self._bounds.get(alike) or question.bounds)
            _keep(self._kept, key, question)
        return self._kept[key]


def _keep(kept: dict[tuple[Any, ...], Kept], key: tuple[Any, ...], value: Kept) -> Kept:
    """Keep a value, instead of the oldest one if there are too many."""
    while key not in kept and len(kept) >= _MOST_KEPT:
        del kept[next(iter(kept))]
    kept[key] = value
    return value
