"""Check how links and joints are connected: in one tree, with every mimic chain ending at a leader."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import replace

from .flaw import Flaw
from .joints import ONE_AXIS_KINDS, JointTag, Mimic
from .numbers import FARTHEST
from .part import required_name
from .xml import DocumentError, Element

__all__ = ["check_links", "check_unique", "resolved_mimics", "root_link"]


def check_unique(robot: Element) -> None:
    """Check that every link and joint of `<robot>` has a name of its own.

    Raises:
        DocumentError: A name is missing, or two links or two joints share one.
    """
    for tag in ("link", "joint"):
        first: dict[str, int] = {}
        for element in robot.named(tag):
            name = required_name(element)
            if name in first:
                cause = f"defined twice, first on line {first[name]}"
                raise DocumentError(cause, owner=f"{tag} {name!r}", line=element.line)
            first[name] = element.line


def check_links(joint: JointTag, links: Container[str]) -> None:
    """Check that the two links of a joint are defined.

    Raises:
        DocumentError: One of them is not.
    """
    for role, link in (("parent", joint.parent), ("child", joint.child)):
        if link not in links:
            raise DocumentError(
                f"its {role} link {link!r} is not defined", owner=f"joint {joint.name!r}", line=joint.line
            )


def root_link(links: Mapping[str, int], joints: Iterable[JointTag]) -> str:
    """The root: the only link without a parent.

    Args:
        links: The line of each link.
        joints: The joints, whose links are defined.

    Raises:
        DocumentError: A link has two parents, links form a cycle, or there are several roots.
    """
    joint_above: dict[str, JointTag] = {}
    for joint in joints:
        other = joint_above.setdefault(joint.child, joint)
        if other is not joint:
            raise DocumentError(
                f"it has two parents: joint {other.name!r} from link {other.parent!r} and "
                f"joint {joint.name!r} from link {joint.parent!r}",
                owner=f"link {joint.child!r}",
                line=joint.line,
            )
    cycle = _cycle({link: joint.parent for link, joint in joint_above.items()})
    if cycle:
        raise DocumentError(
            f"links form a cycle: {_listed(cycle[::-1])}", owner=f"link {cycle[0]!r}", line=links[cycle[0]]
        )
    roots = [link for link in links if link not in joint_above]
    if len(roots) > 1:
        cause = f"{len(roots)} root links, but a robot has one: {_listed(roots)}; connect them by fixed joints"
        raise DocumentError(cause, owner="<robot>", line=links[roots[1]])
    return roots[0]


def resolved_mimics(joints: Sequence[JointTag], flaws: list[Flaw]) -> list[JointTag]:
    """The joints, with each mimic naming the leader at the end of its chain, and the chain's multiplier and offset.

    Mimics that have nothing to follow are removed and added to `flaws`.

    Raises:
        DocumentError: A joint mimics itself, joints mimic each other in a circle, or a multiplier or offset is so large
            that placements would not be finite.
    """
    by_name = {joint.name: joint for joint in joints}
    followers: dict[str, Mimic] = {}
    for joint in joints:
        if joint.mimic is None:
            continue
        leader = by_name.get(joint.mimic.leader)
        common = None
        if joint.kind not in ONE_AXIS_KINDS:
            cause = f"a {joint.kind} joint cannot mimic another joint; its <mimic> is ignored"
        elif leader is None:
            cause = f"it mimics {joint.mimic.leader!r}, which does not exist; it is left free"
            common = "it mimics a joint that does not exist; it is left free"
        elif leader.kind not in ONE_AXIS_KINDS:
            cause = f"it mimics {leader.name!r}, which is a {leader.kind} joint; it is left free"
            common = f"it mimics a {leader.kind} joint; it is left free"
        else:
            followers[joint.name] = joint.mimic
            continue
        flaws.append(Flaw(f"joint {joint.name!r}", cause, code="mimic-ignored", line=joint.line, common=common))
    circle = _cycle({name: mimic.leader for name, mimic in followers.items()})
    if circle:
        fault = "it mimics itself" if len(circle) == 1 else f"joints mimic in a circle: {_listed(circle)}"
        raise DocumentError(fault, owner=f"joint {circle[0]!r}", line=by_name[circle[0]].line)
    resolved = _ultimate_leaders(followers, {joint.name: joint.line for joint in joints})
    return [replace(joint, mimic=resolved.get(joint.name)) for joint in joints]


def _ultimate_leaders(followers: Mapping[str, Mimic], lines: Mapping[str, int | None]) -> dict[str, Mimic]:
    """The mimic of every follower, composed along its chain; without recursion, as chains may be long.

    `lines` are those of the joints.
    """
    resolved: dict[str, Mimic] = {}
    for start in followers:
        chain = []
        name = start
        while name in followers and name not in resolved:
            chain.append(name)
            name = followers[name].leader
        for name in reversed(chain):
            mimic = followers[name]
            if mimic.leader in resolved:
                mimic = mimic.after(resolved[mimic.leader])
            if not (abs(mimic.multiplier) <= FARTHEST and abs(mimic.offset) <= FARTHEST):
                cause = (
                    f"it mimics {mimic.leader!r} with multiplier {mimic.multiplier:g} and offset {mimic.offset:g}, "
                    f"which must be at most {FARTHEST:g}"
                )
                raise DocumentError(cause, owner=f"joint {name!r}", line=lines[name])
            resolved[name] = mimic
    return resolved


def _cycle(above: Mapping[str, str]) -> list[str]:
    """The names on one cycle, each followed by the one above it; empty if there is no cycle."""
    seen: set[str] = set()
    for start in above:
        walk: dict[str, None] = {}
        name = start
        while name in above and name not in seen:
            if name in walk:
                names = list(walk)
                return names[names.index(name) :]
            walk[name] = None
            name = above[name]
        seen.update(walk)
    return []


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(repr(name) for name in names[:6])
    return shown if len(names) <= 6 else f"{shown} and {len(names) - 6} more"
