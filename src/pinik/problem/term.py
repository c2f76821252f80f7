"""One target, compiled: its frame, its constraints and the chain that moves it."""

from __future__ import annotations

from dataclasses import dataclass

from ..model.chains import Chain
from .targets import Target
from .tolerance import Tolerance

__all__ = ["Term"]


@dataclass(frozen=True, eq=False)
class Term:
    """One target without its position and orientation: the same for all targets of one kind.

    Attributes:
        pattern: A target of this kind.
        chain: The joints that move its frame.
        frame, reference: Indices of the frames in the problem's model; a reference of None is the world.
        weight: The factor on its position rows, at most 1.
        turn_weight: The factor on its orientation rows [m]: `weight` times the problem's `size_of_chain`.
        tolerance: The errors that count as reached.
    """

    pattern: Target
    chain: Chain
    frame: int
    reference: int | None
    weight: float
    turn_weight: float
    tolerance: Tolerance

    @property
    def has_free_axes(self) -> bool:
        """Whether the position is constrained along some axes only."""
        return self.pattern.position is not None and not all(self.pattern.along)

    @property
    def size(self) -> int:
        """The number of residual rows: 3 for a position plus 3 for an orientation or an axis."""
        return 3 * ((self.pattern.position is not None) + self.pattern.asks_orientation)
