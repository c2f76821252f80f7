"""The checker in Python: Pinocchio places the solids, and coal compares them pair by pair."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import coal
import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.robot_model import RobotModel
from .solids import Solid, Surface
from .touch import Gap, Pair, Touch

__all__ = ["CoalChecker"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Body:
    """coal's objects for one solid.

    Attributes:
        exact: Decides whether it touches: a primitive, or the surface of a mesh.
        hull: Its convex hull as a solid; None for a flat mesh.
    """

    exact: Any
    hull: Any | None


class CoalChecker:
    """Pairs of solids in Pinocchio's `GeometryModel`."""

    def __init__(self, robot: RobotModel, solids: Sequence[Solid], pairs: Sequence[Pair]) -> None:
        self._model = robot.model
        self._pairs = list(pairs)
        self._geometry = pinocchio.GeometryModel()
        bodies: dict[int, _Body] = {}
        self._bodies = []
        for number, solid in enumerate(solids):
            key = id(solid if solid.surface is None else solid.surface)
            body = bodies[key] = bodies.get(key) or _body(solid)
            self._bodies.append(body)
            self._geometry.addGeometryObject(
                pinocchio.GeometryObject(f"{solid.owner}/{number}", solid.joint, solid.placement, body.exact)
            )
        for pair in self._pairs:
            self._geometry.addCollisionPair(pinocchio.CollisionPair(pair.first, pair.second))
        self._local = threading.local()

    def report(self, q: Array) -> list[Touch]:
        """All pairs that touch at q (nq,), in the order of the pairs."""
        return [self._touch(pair, placements) for pair, placements in self._touching(q)]

    def clearance(self, q: Array) -> Gap | None:
        """The pair that is the least apart at q (nq,); None without pairs."""
        touching = self.report(q)
        if touching:
            deepest = max(touching, key=lambda touch: touch.depth)
            return Gap(deepest.group, -deepest.depth, deepest.points)
        data = self._data()
        gaps = []
        for pair in range(len(self._pairs)):
            found = pinocchio.computeDistance(self._geometry, data, pair)
            points = _point(found.getNearestPoint1()), _point(found.getNearestPoint2())
            gaps.append(Gap(self._pairs[pair].group, max(found.min_distance, 0.0), points))
        return min(gaps, key=lambda gap: gap.distance, default=None)

    def touches(self, Q: Array) -> NDArray[np.bool_]:
        """Whether anything touches at each of N configurations (N, nq)."""
        return np.array([next(self._touching(q), None) is not None for q in Q], dtype=bool)

    def counts(self, Q: Array) -> NDArray[np.int64]:
        """In how many of N configurations (N, nq) each group touches."""
        counts = np.zeros(max((pair.group + 1 for pair in self._pairs), default=0), dtype=np.int64)
        for q in Q:
            counts[list({self._pairs[pair].group for pair, _ in self._touching(q)})] += 1
        return counts

    def _data(self) -> Any:
        """This thread's own memory."""
        if not hasattr(self._local, "data"):
            self._local.data = self._geometry.createData()
            for request in self._local.data.collisionRequests:
                # Else coal overlooks some shapes that go deep into each other, such as two coaxial cylinders.
                request.enable_contact = True
            self._local.kinematics = self._model.createData()
        return self._local.data

    def _touching(self, q: Array) -> Iterator[tuple[int, Any]]:
        """The pairs that touch at q, with the placements of all solids."""
        data = self._data()
        pinocchio.updateGeometryPlacements(self._model, self._local.kinematics, self._geometry, data, q)
        for pair in range(len(self._pairs)):
            if pinocchio.computeCollision(self._geometry, data, pair):
                yield pair, data.oMg

    def _touch(self, pair: int, placements: Any) -> Touch:
        """The depth of a pair that touches."""
        numbers = self._pairs[pair][:2]
        first, second = (self._bodies[number] for number in numbers)
        at = [coal.Transform3s(placements[n].rotation, placements[n].translation) for n in numbers]
        request = coal.CollisionRequest(coal.CollisionRequestFlag.CONTACT, 1)
        result = coal.CollisionResult()
        if first.hull is not None and second.hull is not None:
            coal.collide(first.hull, at[0], second.hull, at[1], request, result)
        if not result.isCollision():
            coal.collide(first.exact, at[0], second.exact, at[1], request, result)
        contact = result.getContact(0)
        depth = max(-contact.penetration_depth, 0.0)  # coal's is a signed distance
        points = _point(contact.getNearestPoint1()), _point(contact.getNearestPoint2())
        solids = self._geometry.geometryObjects
        joints = solids[numbers[0]].parentJoint, solids[numbers[1]].parentJoint
        return Touch(self._pairs[pair].group, depth, _point(contact.normal), points, joints)


def _point(vector: Array) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z


def _body(solid: Solid) -> _Body:
    if solid.surface is not None:
        return _mesh(solid.surface)
    make = {"box": coal.Box, "sphere": coal.Sphere, "cylinder": coal.Cylinder, "capsule": coal.Capsule}[solid.kind]
    primitive = make(*solid.size)
    return _Body(primitive, primitive)


def _mesh(surface: Surface) -> _Body:
    vertices, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    vertices.extend(list(surface.vertices))
    triangles.extend([coal.Triangle(*corners) for corners in surface.faces.tolist()])
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(triangles), len(vertices))
    model.addSubModel(vertices, triangles)
    model.endModel()
    try:
        model.buildConvexHull(True, "Qt")
    except Exception:  # qhull makes no hull of a flat mesh
        return _Body(model, None)
    return _Body(model, model.convex)
