"""A robot's collision shapes: the `<collision>` elements of a URDF as solids at its joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pinocchio

from ..description.flaw import Flaw
from ..description.shape_tags import ShapeTag
from ..extras import needed_by
from ..model.robot_model import RobotModel
from .solids import Solid, Surface

__all__ = ["robot_solids"]

if TYPE_CHECKING:
    from .mesh_files import MeshFiles


def robot_solids(robot: RobotModel) -> tuple[tuple[Solid, ...], list[Flaw]]:
    """The collision shapes of a robot in the order of its file; a link without collision shapes has none.

    Returns:
        The solids, and one flaw for each shape that could not be read.

    Raises:
        MissingExtraError: There are meshes, and trimesh, which reads them, is not installed.
    """
    tags = [(link.name, tag) for link in robot.description.link_tags for tag in link.collisions]
    files = _mesh_files(robot) if any(tag.kind == "mesh" for _, tag in tags) else None
    surfaces: dict[tuple[str, tuple[float, ...]], Surface] = {}
    solids, flaws = [], []
    for link, tag in tags:
        surface = None
        if files is not None and tag.kind == "mesh":
            key = (tag.filename, tag.size)
            try:
                surface = surfaces[key] = surfaces.get(key) or _surface(files, tag)
            except Exception as fault:  # trimesh may raise anything
                flaws.append(_flaw(link, tag, fault))
                continue
        frame = robot.model.frames[robot.frame_id(link)]
        size = () if surface is not None else tag.size
        solids.append(Solid(link, frame.parentJoint, frame.placement * _origin(tag), tag.kind, size, surface))
    expanded = robot.description.expanded
    return tuple(solids), [flaw.of_expansion() for flaw in flaws] if expanded else flaws


def _mesh_files(robot: RobotModel) -> MeshFiles:
    with needed_by("collision meshes", "pictures"):
        from .mesh_files import MeshFiles  # over a second to import

        return MeshFiles(robot.surroundings)


def _surface(files: MeshFiles, tag: ShapeTag) -> Surface:
    """All parts of a mesh file as one surface."""
    vertices, faces, count = [], [], 0
    for mesh, _ in files.parts(tag.filename, np.array(tag.size)):
        vertices.append(mesh.vertices)
        faces.append(mesh.faces + count)
        count += len(mesh.vertices)
    return Surface.of(np.vstack(vertices), np.vstack(faces))


def _flaw(link: str, tag: ShapeTag, fault: Exception) -> Flaw:
    from .mesh_files import flaw_of

    return flaw_of(f"link {link!r}", tag.line, fault)


def _origin(tag: ShapeTag) -> pinocchio.SE3:
    return pinocchio.SE3(pinocchio.rpy.rpyToMatrix(np.array(tag.rpy)), np.array(tag.xyz))
