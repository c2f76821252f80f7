"""Inspect a URDF file with pinik's own reader and lint, with Pinocchio, with trimesh (its meshes) and with yourdfpy."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...description.flaw import Flaw
from ...description.lint.front import NOTES, lint
from ...description.packages import Found
from ...echoes import shortened
from ...errors import RobotLoadError, UnknownNameError
from ...extras import needed_by
from ...loading import Fetched, Located, fetch, locate, srdf_of
from ...robot import Robot
from ...shapes.mesh_checks import UNDRAWN
from ..inputs.files import STDIN
from .flaw_json import MOST_LISTED, flaw_fields

if TYPE_CHECKING:
    from ...shapes.second_opinion import SecondOpinion

__all__ = ["Fault", "Inspection", "inspect"]

_MISSING = ("missing-mesh", "mesh-outside")
_MESHES = frozenset((*_MISSING, *UNDRAWN))


@dataclass(frozen=True)
class Fault:
    """Why a file cannot be loaded.

    Attributes:
        element: The faulty element, such as "joint 'elbow'"; None if the whole file is at fault.
        message: The cause.
    """

    element: str | None
    message: str


@dataclass(frozen=True)
class Inspection:
    """The result of an inspection; the counts are 0 if the file cannot be loaded.

    Attributes:
        file: What reports call the file; "stdin" if the URDF came through stdin.
        robot: The robot's name; None if the file cannot be loaded.
        faults: Why the file cannot be loaded.
        flaws: What pinik repaired or ignored, what looks wrong, and the meshes that cannot be drawn.
        links, joints, meshes, shapes: Their numbers; only joints that move, and each mesh address once.
        second_opinion: What yourdfpy says; None if the file cannot be loaded.
        path: The file; None if the URDF came through stdin.
        document: The bytes that were read; None if there are none.
        expanded: Whether xacro made these bytes from the file, so that lines are those of its result.
    """

    file: str
    path: Path | None = None
    robot: str | None = None
    faults: tuple[Fault, ...] = ()
    flaws: tuple[Flaw, ...] = ()
    links: int = 0
    joints: int = 0
    meshes: int = 0
    shapes: int = 0
    second_opinion: SecondOpinion | None = None
    document: bytes | None = None
    expanded: bool = False

    @property
    def loads(self) -> bool:
        """Whether the robot can be loaded."""
        return not self.faults

    @property
    def warnings(self) -> tuple[Flaw, ...]:
        """The flaws without those that are worth knowing only."""
        return tuple(flaw for flaw in self.flaws if flaw.code not in NOTES)

    def passes(self, *, strict: bool) -> bool:
        """Whether the robot can be loaded and, if `strict`, there is no warning."""
        return self.loads and not (strict and self.warnings)

    def to_dict(self, *, strict: bool = False) -> dict[str, Any]:
        """The JSON form; docs/json.md explains the fields."""
        missing = dict.fromkeys(flaw.mesh or "" for flaw in self.flaws if flaw.code in _MISSING)
        unreadable = [flaw for flaw in self.flaws if flaw.code in UNDRAWN]
        others = [flaw for flaw in self.warnings if flaw.code not in _MESHES]
        counts = Counter(flaw.code for flaw in self.flaws)
        listed: Counter[str] = Counter()
        rows = []
        for flaw in self.flaws:
            listed[flaw.code] += 1
            if listed[flaw.code] <= MOST_LISTED:
                rows.append(flaw_fields(flaw))
        return {
            "schema": 1,
            "loads": self.loads,
            "strict": strict,
            "passes": self.passes(strict=strict),
            "file": self.file,
            "robot": None if self.robot is None else shortened(self.robot),
            "faults": [
                {"element": fault.element and shortened(fault.element), "message": shortened(fault.message)}
                for fault in self.faults[:MOST_LISTED]
            ],
            "flaws": rows,
            "counts": dict(sorted(counts.items())),
            "warnings": _listed(others),
            "missing_meshes": _listed(missing),
            "mesh_faults": _listed(unreadable),
            "links": self.links,
            "joints": self.joints,
            "meshes": self.meshes,
            "shapes": self.shapes,
            "second_opinion": None if self.second_opinion is None else self.second_opinion.to_dict(),
        }


def inspect(
    source: str | bytes,
    package_dirs: Sequence[Path],
    xacro_args: Mapping[str, str] | None = None,
    allow_outside: bool = False,
) -> Inspection:
    """Read a file and everything that it refers to.

    Args:
        source: A file, the name of a robot in the catalogue, or the bytes of a URDF from stdin.
        package_dirs: Folders that are searched first for packages.
        xacro_args: The arguments of a xacro file.
        allow_outside: Whether meshes may lie outside the folders that belong to the robot.
    """
    fetched: Fetched | None = None
    try:
        located = _located(source)
        folders = (*(folder.expanduser() for folder in package_dirs), *located.package_dirs)
        fetched = fetch(located, package_dirs=folders, xacro_args=xacro_args)
        description = fetched.read()
        srdf = srdf_of(located, description)
        robot = Robot(description, package_dirs=folders, srdf=srdf, allow_outside=allow_outside)
    except RobotLoadError as error:
        label, path = (STDIN, None) if isinstance(source, bytes) else (error.source, Path(error.source))
        faults = tuple(Fault(one.element, one.cause) for one in (error, *error.others))
        if fetched is None:
            return Inspection(label, path, faults=faults)
        flaws, expanded = lint(fetched.document), fetched.remarks is not None
        return Inspection(label, path, faults=faults, flaws=flaws, document=fetched.document, expanded=expanded)
    found = lint(description.document, description)
    shapes, about_shapes = _shapes(robot)
    collisions = _missing_collisions(robot, {flaw.mesh for flaw in about_shapes})
    about = [*found, *about_shapes, *collisions]
    if description.expanded:
        about = [flaw.of_expansion() for flaw in about]
    about += _about_poses(robot)
    return Inspection(
        file=STDIN if isinstance(source, bytes) else str(located.source),
        path=located.source if isinstance(located.source, Path) else None,
        robot=robot.name,
        flaws=_in_order(robot.warnings, about),
        links=len(description.links),
        joints=len(robot.joints),
        meshes=len(description.meshes),
        shapes=shapes,
        second_opinion=_second_opinion(robot),
        document=fetched.document,
        expanded=description.expanded,
    )


def _in_order(warnings: Iterable[str], found: Sequence[Flaw]) -> tuple[Flaw, ...]:
    """All flaws by line; warnings of the robot that were found here too, with more about them, are left out."""
    said = set(map(str, found))
    others = [words for words in dict.fromkeys(warnings) if str(words) not in said]
    flaws = [words if isinstance(words, Flaw) else Flaw("<robot>", words, code="other") for words in others]
    return tuple(sorted([*flaws, *found], key=lambda flaw: flaw.line or 0))


def _listed(texts: Iterable[str]) -> list[str]:
    return [shortened(str(text)) for text, _ in zip(texts, range(MOST_LISTED), strict=False)]


def _located(source: str | bytes) -> Located:
    if isinstance(source, bytes):
        return Located(source)
    try:
        located = locate(source)
    except UnknownNameError:
        located = Located(Path(source))
    return located if isinstance(located.source, Path) else Located(Path(source))


def _shapes(robot: Robot) -> tuple[int, list[Flaw]]:
    """The number of shapes that can be drawn, and a flaw for each one that cannot, or that has an unlikely size."""
    with needed_by("pinik check", "check"):
        from ...shapes.meshes import load_shapes
        from ...shapes.sizes import size_flaws

    shapes, flaws = load_shapes(robot)
    corners = ((shape.link, shape.name, shape.mesh.vertices) for shape in shapes)
    return len(shapes), [*flaws, *size_flaws(robot, corners)]


def _about_poses(robot: Robot) -> list[Flaw]:
    """A flaw for each pose of the SRDF that is left out, or the one for which none of them can be read."""
    try:
        return list(robot.srdf_poses.left_out.values())
    except RobotLoadError as error:
        cause = f"{error.cause}; no pose can be read from {Path(error.source).name}"
        return [Flaw(error.element or "<srdf>", cause, code="bad-srdf")]


def _missing_collisions(robot: Robot, known: set[str | None]) -> list[Flaw]:
    """A flaw for each mesh that is used for collisions only and is not found."""
    flaws = []
    found: dict[str, Found] = {}
    for link in robot.description.link_tags:
        for shape in link.collisions:
            address = shape.filename
            if shape.kind != "mesh" or address in known:
                continue
            if address not in found:
                found[address] = robot.surroundings.find(address)
            if found[address].path is None:
                about = found[address]
                cause = f"there is no mesh {address!r}: {about.why}"
                owner = f"link {link.name!r}, collision"
                flaws.append(Flaw(owner, cause, code=about.code, line=shape.line, mend=about.mend, mesh=address))
    return flaws


def _second_opinion(robot: Robot) -> SecondOpinion:
    with needed_by("pinik check", "check"):
        from ...shapes.second_opinion import ask_yourdfpy

    return ask_yourdfpy(robot, robot.description.document)
