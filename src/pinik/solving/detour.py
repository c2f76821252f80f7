"""A tick that would end where something touches: the way out of it, or a part of the tick."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..problem.targets import Target
from .walk import CREEP_HALVINGS, Stride, Walk

__all__ = ["kept_free"]

Array = NDArray[np.float64]


def kept_free(walk: Walk, targets: tuple[Target, ...], stride: Stride, q: Array, most: Array) -> Stride:
    """The stride of a tick, which ends where nothing touches unless something touches at its start.

    If something touches at its end, the way out of it is tried, which leaves the frames where the tick would take them.
    If that does not help, the tick is halved until nothing touches at its end. If nothing helps, it stays at its start.
    Where something touches at the start already, it may go to where that is less deep.

    Args:
        walk: The walk that made the tick.
        targets: The targets of the tick.
        stride: What the tick came to.
        q: The start of the tick (nq,), inside the limits.
        most: As for `Walk.tick`.
    """
    if not walk.question.touches(stride.q):
        return stride
    before = walk.way_out.depth(q)
    for there, is_part, is_on_the_way in _ends(walk, targets, stride.q, q, most):
        depth = walk.way_out.depth(there)
        if depth < max(before, 0.0):
            touching = there if depth >= 0.0 else stride.q if is_part else None
            return stride._replace(q=there, touching=touching, approaches=stride.approaches or is_on_the_way)
    return stride._replace(q=q, touching=stride.q if before < 0.0 else q)


def _ends(
    walk: Walk, targets: tuple[Target, ...], wanted: Array, q: Array, most: Array
) -> Iterator[tuple[Array, bool, bool]]:
    """Where the tick may end instead, the best first.

    Yields:
        The end, whether it is only a part of the tick, and whether it is on the way to an end beyond this tick.
    """
    yield wanted, False, False
    aside = walk.aside(targets, wanted, q)
    yield walk.within(q, aside, most), False, walk.largest_excess(q, aside, most) > 1.0
    for _ in range(CREEP_HALVINGS):
        wanted = walk.shortened(q, wanted, 0.5)
        yield wanted, True, False
