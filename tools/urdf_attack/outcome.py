"""What can become of an input."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["FAULTS", "GOOD", "Outcome"]

# Outcomes that are as they must be, and those that are faults of pinik.
GOOD = ("refused", "agreed", "assumed", "unread", "renamed")
FAULTS = ("raised", "disagreed", "infinite", "warned", "opened", "wordless", "stopped", "crashed", "hung")


@dataclass(frozen=True)
class Outcome:
    """What became of an input.

    Attributes:
        kind: One of `GOOD` or `FAULTS`: "agreed" if yourdfpy places all links of the plain form as pinik does; "unread"
            if yourdfpy cannot read that form; "assumed" if it differs from it where pinik's warnings say what was
            assumed; "renamed" if the mutation changed the bytes of a joint's name. In these cases yourdfpy agrees on
            the text that pinik gave to Pinocchio. "stopped" is a refusal for parts that say nothing about kinematics.
        words: The error, or what is wrong.
        signature: Equal for outcomes with the same cause.
    """

    kind: str
    words: str = ""
    signature: str = ""

    @property
    def is_fault(self) -> bool:
        """Whether pinik is at fault."""
        return self.kind in FAULTS
