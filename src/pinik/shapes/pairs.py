"""Which pairs of a robot's links count as collisions, and why the others do not."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..model.limits import Limits
from ..model.robot_model import RobotModel
from . import pair_cache
from .adjacency import adjacent_pairs, rigid_pairs
from .checker import make_checker
from .disabled_pairs import LinkPair, link_pair, read_disabled_pairs
from .solids import Solid
from .touch import Pair

__all__ = ["SAMPLES", "CollisionPairs", "find_pairs", "solid_pairs"]

Reason = Literal["fixed", "srdf", "adjacent", "at rest", "always", "never"]
"""Why a pair does not count: the links are fixed to each other; the SRDF disables it; the links are joined by a joint;
they touch at rest, in all samples, or in none."""

SAMPLES = 10_000
"""How many random configurations decide which pairs always touch, and which never do."""
_BLOCKS = (100, 900, *[3000] * 3)
_SEED = 0


@dataclass(frozen=True)
class CollisionPairs:
    """The pairs of a robot's links that have collision shapes.

    Attributes:
        counting: The pairs that count as collisions.
        left_out: Each pair that does not, with the reason.
        source: "srdf" if the robot's SRDF file says which pairs count, "found" if pinik found out.
        without_shapes: The links that have no collision shape and touch nothing.
    """

    counting: tuple[LinkPair, ...]
    left_out: Mapping[LinkPair, Reason]
    source: Literal["srdf", "found"]
    without_shapes: tuple[str, ...]


def find_pairs(robot: RobotModel, solids: Sequence[Solid]) -> CollisionPairs:
    """Which pairs of links count.

    If the robot's SRDF file disables pairs, all others count. Else pinik finds out: links that are joined by a joint do
    not count (`adjacent_pairs`), nor do those that touch at rest, which is the neutral configuration, put inside the
    limits; nor those that always or never touch in 10,000 random configurations inside the limits. What was found is
    kept in the user's cache folder.

    Raises:
        RobotLoadError: The SRDF file cannot be read.
    """
    links = list(dict.fromkeys(solid.owner for solid in solids))
    left_out: dict[LinkPair, Reason] = dict.fromkeys(sorted(rigid_pairs(robot, links)), "fixed")
    disabled = {} if robot.srdf is None else read_disabled_pairs(robot.srdf, robot.description.links)
    candidates = [pair for a, b in itertools.combinations(links, 2) if (pair := link_pair(a, b)) not in left_out]
    if disabled:
        left_out |= dict.fromkeys([pair for pair in candidates if pair in disabled], "srdf")
    else:
        left_out |= dict.fromkeys(sorted(adjacent_pairs(robot, links)), "adjacent")
        rest = [pair for pair in candidates if pair not in left_out]
        key = pair_cache.key_of(robot, solids)
        found = pair_cache.read(key, rest)
        if found is None:
            found = _find_out(robot, solids, rest)
            pair_cache.write(key, found)
        left_out |= found
    without = tuple(name for name in robot.description.links if name not in links)
    counting = tuple(pair for pair in candidates if pair not in left_out)
    return CollisionPairs(counting, left_out, "srdf" if disabled else "found", without)


def solid_pairs(solids: Sequence[Solid], pairs: Sequence[LinkPair]) -> list[Pair]:
    """The pairs of solids of pairs of links, each of which is one group."""
    by_link: dict[str, list[int]] = {}
    for number, solid in enumerate(solids):
        by_link.setdefault(solid.owner, []).append(number)
    return [
        Pair(first, second, group)
        for group, (a, b) in enumerate(pairs)
        for first, second in itertools.product(by_link[a], by_link[b])
    ]


def _find_out(robot: RobotModel, solids: Sequence[Solid], pairs: Sequence[LinkPair]) -> dict[LinkPair, Reason]:
    """The pairs that touch at rest, always or never."""
    rest = Limits.of(robot).wrap(robot.neutral())
    at_rest = _touching(robot, solids, pairs, rest[None]) > 0
    found: dict[LinkPair, Reason] = {pair: "at rest" for pair, touches in zip(pairs, at_rest, strict=True) if touches}
    open_pairs = np.flatnonzero(~at_rest)
    sums, seen = np.zeros(len(pairs), dtype=np.int64), 0
    rng = np.random.default_rng(_SEED)
    for size in _BLOCKS:
        if not len(open_pairs):
            break
        drawn = np.array([robot.random(rng) for _ in range(size)])
        sums[open_pairs] += _touching(robot, solids, [pairs[k] for k in open_pairs.tolist()], drawn)
        seen += size
        # A pair that was seen both touching and apart counts; only the others need more samples.
        open_pairs = open_pairs[(sums[open_pairs] == 0) | (sums[open_pairs] == seen)]
    for k in open_pairs.tolist():
        found[pairs[k]] = "always" if sums[k] else "never"
    return found


def _touching(
    robot: RobotModel, solids: Sequence[Solid], pairs: Sequence[LinkPair], Q: NDArray[np.float64]
) -> NDArray[np.int64]:
    """In how many configurations (n, nq) each pair of links touches."""
    return make_checker(robot, solids, solid_pairs(solids, pairs)).counts(Q)
