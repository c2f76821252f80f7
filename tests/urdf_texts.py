"""URDF texts for the tests, from as few words as possible."""

from __future__ import annotations

from collections.abc import Iterable

LIMIT = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'


def robot(*parts: str) -> str:
    return f'<robot name="r">{"".join(parts)}</robot>'


def link(name: str, *parts: str) -> str:
    return f'<link name="{name}">{"".join(parts)}</link>'


def joint(name: str, parent: str, child: str, *parts: str, kind: str = "revolute", limit: str = LIMIT) -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{limit}{"".join(parts)}</joint>'


def pair(*joint_parts: str, kind: str = "revolute", limit: str = LIMIT) -> str:
    """Two links and the joint 'j' between them."""
    return robot(link("a"), link("b"), joint("j", "a", "b", *joint_parts, kind=kind, limit=limit))


def chain(count: int, kind: str) -> str:
    """`count` joints in one line."""
    links: Iterable[str] = (link(f"l{i}") for i in range(count + 1))
    joints = (joint(f"j{i:05d}", f"l{i}", f"l{i + 1}", kind=kind) for i in range(count))
    return robot(*links, *joints)
