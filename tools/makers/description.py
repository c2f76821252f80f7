"""A robot's links, joints, shapes and named poses, to be written as a URDF and an SRDF."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from xml.sax.saxutils import quoteattr

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)

EFFORT = 100.0  # [N m]; URDF requires a value, kinematics does not use it
VELOCITY = 3.0  # [rad/s]


def number(value: float) -> str:
    """The shortest decimal that reads back as the same float, rounded to micrometres if that changes nothing."""
    rounded = round(value, 6)
    return repr(float(rounded if abs(rounded - value) < 1e-12 else value) + 0.0)


def vector(values: Iterable[float]) -> str:
    return " ".join(number(v) for v in values)


@dataclass(frozen=True)
class Visual:
    """One shape of a link: a URDF geometry element, where it sits, and its material's name."""

    geometry: str
    material: str
    xyz: Vector = ZERO
    rpy: Vector = ZERO


@dataclass(frozen=True)
class Collision:
    """One shape of a link that other shapes can touch: a URDF geometry element, and where it sits."""

    geometry: str
    xyz: Vector = ZERO
    rpy: Vector = ZERO


def box(size: Vector, xyz: Vector = ZERO, rpy: Vector = ZERO) -> Collision:
    return Collision(f'<box size="{vector(size)}"/>', xyz, rpy)


def sphere(radius: float, xyz: Vector = ZERO) -> Collision:
    return Collision(f'<sphere radius="{number(radius)}"/>', xyz)


def cylinder(radius: float, start: Vector, end: Vector) -> Collision:
    """A cylinder around the line from the middle of one face to that of the other."""
    along = tuple(b - a for a, b in zip(start, end, strict=True))
    middle = tuple((a + b) / 2 for a, b in zip(start, end, strict=True))
    length, across = math.hypot(*along), math.hypot(along[0], along[1])
    turn = (0.0, math.atan2(across, along[2]), math.atan2(along[1], along[0]) if across else 0.0)
    geometry = f'<cylinder radius="{number(radius)}" length="{number(round(length, 6))}"/>'
    return Collision(geometry, _rounded(middle), _rounded(turn))


def capsule(radius: float, start: Vector, end: Vector) -> list[Collision]:
    """A cylinder with round ends, whose middles are given; URDF has no such shape, so it is made of three."""
    return [cylinder(radius, start, end), sphere(radius, start), sphere(radius, end)]


def _rounded(values: Iterable[float]) -> Vector:
    x, y, z = (round(value, 6) for value in values)
    return x, y, z


def mesh_visual(
    address: str, material: str, *, rpy: Vector = ZERO, scale: float = 1.0, mirrored: bool = False
) -> Visual:
    """A mesh file in millimetres, with left and right exchanged if `mirrored`."""
    size = 0.001 * scale
    scales = (size, -size if mirrored else size, size)
    return Visual(f'<mesh filename="{address}" scale="{vector(scales)}"/>', material, rpy=rpy)


@dataclass
class Description:
    """Collects a robot's parts in order and writes them to files."""

    name: str
    summary: str
    materials: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    links: dict[str, list[Visual]] = field(default_factory=dict)
    collisions: dict[str, list[Collision]] = field(default_factory=dict)
    joints: list[str] = field(default_factory=list)
    moving: list[str] = field(default_factory=list)
    poses: dict[str, dict[str, float]] = field(default_factory=dict)
    files: dict[str, bytes] = field(default_factory=dict)

    def link(self, name: str, visuals: Iterable[Visual] = ()) -> None:
        if name in self.links:
            raise ValueError(f"link {name!r} twice")
        self.links[name] = list(visuals)

    def solid(self, link: str, shapes: Iterable[Collision]) -> None:
        """Give a link what can touch others."""
        self.collisions.setdefault(link, []).extend(shapes)

    def fixed(self, parent: str, child: str, xyz: Vector = ZERO, rpy: Vector = ZERO) -> None:
        self.joints.append(f'  <joint name="{child}_fixed" type="fixed">\n{_ends(parent, child, xyz, rpy)}  </joint>')

    def revolute(
        self,
        name: str,
        parent: str,
        child: str,
        *,
        axis: Vector,
        limits: tuple[float, float],
        xyz: Vector = ZERO,
        rpy: Vector = ZERO,
    ) -> None:
        """A hinge; `limits` in radians."""
        lower, upper = limits
        self.moving.append(name)
        self.joints.append(
            f'  <joint name="{name}" type="revolute">\n{_ends(parent, child, xyz, rpy)}'
            f'    <axis xyz="{vector(axis)}"/>\n'
            f'    <limit lower="{number(lower)}" upper="{number(upper)}" effort="{number(EFFORT)}"'
            f' velocity="{number(VELOCITY)}"/>\n  </joint>'
        )

    def pose(self, name: str, **degrees: float) -> None:
        """Add a named pose; joints that are not listed are at zero."""
        unknown = set(degrees) - set(self.moving)
        if unknown:
            raise ValueError(f"pose {name!r} sets joints that do not exist: {sorted(unknown)}")
        self.poses[name] = {joint: math.radians(degrees.get(joint, 0.0)) for joint in self.moving}

    def urdf(self) -> str:
        lines = [
            '<?xml version="1.0"?>',
            f"<!-- {self.summary} Made by tools/make_robots.py; change it there. -->",
            f'<robot name="{self.name}">',
        ]
        for name, rgb in self.materials.items():
            lines.append(f'  <material name="{name}"><color rgba="{vector((*rgb, 1.0))}"/></material>')
        for name, visuals in self.links.items():
            solids = self.collisions.get(name, [])
            if not visuals and not solids:
                lines.append(f'  <link name="{name}"/>')
                continue
            lines.append(f'  <link name="{name}">')
            for visual in visuals:
                lines.append(
                    f"    <visual>{_origin(visual.xyz, visual.rpy)}<geometry>{visual.geometry}</geometry>"
                    f"<material name={quoteattr(visual.material)}/></visual>"
                )
            lines += [
                f"    <collision>{_origin(solid.xyz, solid.rpy)}<geometry>{solid.geometry}</geometry></collision>"
                for solid in solids
            ]
            lines.append("  </link>")
        return "\n".join([*lines, *self.joints, "</robot>"]) + "\n"

    def srdf(self) -> str:
        lines = ['<?xml version="1.0"?>', f'<robot name="{self.name}">', '  <group name="all">']
        lines += [f'    <joint name="{joint}"/>' for joint in self.moving]
        lines.append("  </group>")
        for name, angles in self.poses.items():
            lines.append(f'  <group_state name="{name}" group="all">')
            lines += [
                f'    <joint name="{joint}" value="{number(round(angle, 6))}"/>' for joint, angle in angles.items()
            ]
            lines.append("  </group_state>")
        return "\n".join([*lines, "</robot>"]) + "\n"


def _origin(xyz: Vector, rpy: Vector) -> str:
    return "" if xyz == rpy == ZERO else f'<origin xyz="{vector(xyz)}" rpy="{vector(rpy)}"/>'


def _ends(parent: str, child: str, xyz: Vector, rpy: Vector) -> str:
    origin = _origin(xyz, rpy)
    return (f"    {origin}\n" if origin else "") + f'    <parent link="{parent}"/>\n    <child link="{child}"/>\n'
