"""The order in which Pinocchio adds joints, chosen so that every joint that others mimic comes before them.

Pinocchio's parser walks through the tree depth first, and visits the joints that hang from one link in the order of
their names. In its model a mimic joint must come after the joint that it follows. Where the names give another order,
the joints of a link are visited in one that suits the mimics; elsewhere they stay in the order of their names.
"""

from __future__ import annotations

import heapq
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import replace

from ..description.flaw import Flaw
from ..description.reader import Description, JointTag, Mimic

__all__ = ["leaders_first"]

_SLOWEST = 1e-6  # a follower that moves less than this for each rad or m of its leader cannot lead it

_Path = tuple[str, ...]  # the joints from the root to a joint, itself included
_Later = Mapping[str, frozenset[str]]  # joint → joints of the same parent link that come after it


def leaders_first(description: Description) -> tuple[tuple[JointTag, ...], tuple[Flaw, ...]]:
    """The joints in the order in which Pinocchio's parser shall add them, with the mimics that it can then follow.

    A leader cannot come first if it hangs from its follower, or if other mimics need the opposite order. It then
    changes roles with a follower: follower = m · leader + o means leader = follower / m − o / m, so that all angles
    stay as they are. A follower that its leader hardly moves cannot lead; where it cannot follow either, it is left
    free.

    Args:
        description: The checked URDF, in which each follower names the leader at the end of its chain.

    Returns:
        The joints, and a warning for each change of roles and each follower that is left free.
    """
    groups: dict[str, dict[str, Mimic]] = defaultdict(dict)  # leader → its followers
    for tag in description.joints:
        if tag.mimic is not None:
            groups[tag.mimic.leader][tag.name] = tag.mimic
    paths = _paths(description, {name for leader, followers in groups.items() for name in (leader, *followers)})
    lines = {tag.name: tag.line for tag in description.joints}
    later: _Later = {}
    mimics: dict[str, Mimic] = {}
    roles: dict[str, Mimic] = {}  # leader → how it follows the joint that comes first in its stead; usually itself
    warnings = []
    for leader, followers in groups.items():
        group = {leader: Mimic(leader, 1.0, 0.0)}
        group |= {name: mimic for name, mimic in followers.items() if abs(mimic.multiplier) >= _SLOWEST}
        first, later = _first_of(group, paths, later)
        own = group[first]
        roles[leader] = Mimic(first, 1.0 / own.multiplier, -own.offset / own.multiplier)
        mimics |= {name: mimic.after(roles[leader]) for name, mimic in group.items() if name != first}
        if first != leader:
            warnings.append(_changed_roles(first, leader, lines[first]))
    for leader, followers in groups.items():
        first = roles[leader].leader
        for name in (name for name in followers if name != first and name not in mimics):
            order = _with_first(first, [name], paths, later)
            if order is None:
                warnings.append(_left_free(name, followers[name], lines[name]))
            else:
                later, mimics[name] = order, followers[name].after(roles[leader])
    tags = (replace(tag, mimic=mimics.get(tag.name)) for tag in _depth_first(description, later))
    return tuple(tags), tuple(warnings)


def _changed_roles(first: str, leader: str, line: int | None) -> Flaw:
    why = "Pinocchio's model needs a leader before its followers, and cannot have"
    cause = f"{why} {leader!r} before {first!r}; {leader!r} follows {first!r} instead, with the same angles"
    common = f"{why} their leader before them; the leader follows one of them instead, with the same angles"
    return Flaw(f"joint {first!r}", cause, code="changed-roles", line=line, common=common)


def _left_free(follower: str, mimic: Mimic, line: int | None) -> Flaw:
    why = "which Pinocchio's model cannot have before it"
    end = f"and with multiplier {mimic.multiplier:g} it cannot lead; it is left free"
    cause, common = f"it mimics {mimic.leader!r}, {why}, {end}", f"it mimics a joint, {why}, {end}"
    return Flaw(f"joint {follower!r}", cause, code="mimic-left-free", line=line, common=common)


def _paths(description: Description, names: Iterable[str]) -> dict[str, _Path]:
    """The path to each of these joints."""
    above = {tag.child: tag for tag in description.joints}
    by_name = {tag.name: tag for tag in description.joints}
    paths = {}
    for name in names:
        tag: JointTag | None = by_name[name]
        path = []
        while tag is not None:
            path.append(tag.name)
            tag = above.get(tag.parent)
        paths[name] = tuple(reversed(path))
    return paths


def _first_of(names: Iterable[str], paths: Mapping[str, _Path], later: _Later) -> tuple[str, _Later]:
    """The first of these joints that can come before all the others, and `later` with what that asks for.

    There is always one: the earliest of them in any order that `later` allows.
    """
    names = tuple(names)
    orders = ((name, _with_first(name, names, paths, later)) for name in names)
    return next((name, order) for name, order in orders if order is not None)


def _with_first(first: str, names: Iterable[str], paths: Mapping[str, _Path], later: _Later) -> _Later | None:
    """`later`, extended so that one joint comes before all others of `names`; None if that cannot be."""
    extended = dict(later)
    for name in names:
        if first in paths[name]:  # also where it is the joint itself
            continue
        if name in paths[first]:
            return None
        one, other = next(pair for pair in zip(paths[first], paths[name], strict=False) if pair[0] != pair[1])
        if one in _all_later(extended, other):
            return None
        extended[one] = extended.get(one, frozenset()) | {other}
    return extended


def _all_later(later: _Later, start: str) -> set[str]:
    """The joints that come after a joint, directly or through others."""
    found: set[str] = set()
    pending = [start]
    while pending:
        for name in later.get(pending.pop(), frozenset()) - found:
            found.add(name)
            pending.append(name)
    return found


def _depth_first(description: Description, later: _Later) -> list[JointTag]:
    """All joints, depth first; those that hang from one link by their names, as far as `later` allows."""
    tags = {tag.name: tag for tag in description.joints}
    hanging: dict[str, list[str]] = defaultdict(list)  # link → the joints that hang from it
    for tag in description.joints:
        hanging[tag.parent].append(tag.name)
    ordered = []
    pending = _siblings(hanging[description.root], later)[::-1]
    while pending:
        tag = tags[pending.pop()]
        ordered.append(tag)
        pending.extend(_siblings(hanging[tag.child], later)[::-1])
    return ordered


def _siblings(names: Iterable[str], later: _Later) -> list[str]:
    """The joints of one link in their order: always the first name whose turn may come."""
    waiting = dict.fromkeys(names, 0)  # how many joints must still come before each
    for name in waiting:
        for after in later.get(name, ()):
            waiting[after] += 1
    ready = sorted(name for name, count in waiting.items() if count == 0)
    ordered = []
    while ready:
        name = heapq.heappop(ready)
        ordered.append(name)
        for after in later.get(name, ()):
            waiting[after] -= 1
            if waiting[after] == 0:
                heapq.heappush(ready, after)
    return ordered
