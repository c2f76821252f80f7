"""The `race` message: who arrived where, after which iterations and time."""

from __future__ import annotations

from typing import Any

from ..simulation.race import Race
from ..simulation.race_card import card

__all__ = ["race_message"]


def race_message(race: Race, seed: int) -> dict[str, Any]:
    """Return the message; docs/live-protocol.md describes its fields."""
    entry = race.entry
    return {
        "type": "race",
        "frame": entry.frame,
        "random": entry.random,
        "seed": seed,
        "most": race.most,
        "places": [[round(float(x), 4) for x in place] for place in entry.places],
        "runners": [
            {
                "method": runner.method,
                "distinction": runner.distinction,
                "engine": runner.engine,
                "wins": runner.wins,
                "shortest": runner.shortest,
                "refusal": runner.refusal,
                "finishes": [finish._asdict() for finish in runner.finishes],
            }
            for runner in race.runners
        ],
        "card": card(race),
    }
