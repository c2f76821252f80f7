"""Collisions as Pinocchio alone finds them: it reads URDF, meshes and SRDF by itself, and calls coal."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import coal
import numpy as np
import pinocchio
from numpy.typing import NDArray

import pinik
from pinik.description.shares import example_robot_data

Array = NDArray[np.float64]


class PlainCollisions:
    """Pinocchio's geometry model of a robot's file, in the robot's own kinematic model, with all pairs of its shapes.

    Attributes:
        links: The link of each shape.
        pairs: All pairs of shapes on two different bodies, by their indices.
    """

    def __init__(self, robot: pinik.Robot) -> None:
        robots = example_robot_data()
        assert robots is not None
        folders = [str(robots.parents[1]), str(robots.parent), str(robots)]
        self.model = robot.model
        self.geometry = pinocchio.buildGeomFromUrdf(
            robot.model, str(robot.description.path), pinocchio.COLLISION, package_dirs=folders
        )
        self.geometry.addAllCollisionPairs()
        self._data, self._geometry_data = robot.model.createData(), self.geometry.createData()
        for request in self._geometry_data.collisionRequests:
            request.enable_contact = True  # else coal overlooks some shapes that go deep into each other
        self.links = [robot.model.frames[shape.parentFrame].name for shape in self.geometry.geometryObjects]
        self.pairs = [(pair.first, pair.second) for pair in self.geometry.collisionPairs]

    def touching(self, q: Array) -> set[tuple[str, str]]:
        """The pairs of links that touch at q, each with its names in order."""
        pinocchio.computeCollisions(self.model, self._data, self.geometry, self._geometry_data, q, False)
        results = self._geometry_data.collisionResults
        return {self.names(k) for k in range(len(self.pairs)) if results[k].isCollision()}

    def touching_when_moved(self, q: Array, pair: tuple[str, str], way: Array) -> bool:
        """Whether two links touch at q after the first one was moved by `way` (3,) along the axes of the world [m]."""
        pinocchio.updateGeometryPlacements(self.model, self._data, self.geometry, self._geometry_data, q)
        shapes = self.geometry.geometryObjects
        for a, b in itertools.product(range(len(self.links)), repeat=2):
            if (self.links[a], self.links[b]) == pair:
                at, other = (self._geometry_data.oMg[k] for k in (a, b))
                moved = coal.Transform3s(at.rotation, at.translation + way)
                still = coal.Transform3s(other.rotation, other.translation)
                result = coal.CollisionResult()
                if coal.collide(shapes[a].geometry, moved, shapes[b].geometry, still, coal.CollisionRequest(), result):
                    return True
        return False

    def names(self, pair: int) -> tuple[str, str]:
        """The links of a pair of shapes, in order."""
        first, second = (self.links[number] for number in self.pairs[pair])
        return (first, second) if first <= second else (second, first)

    def distances(self, q: Array) -> dict[tuple[str, str], float]:
        """The least distance of each pair of links at q [m]."""
        pinocchio.computeDistances(self.model, self._data, self.geometry, self._geometry_data, q)
        found: dict[tuple[str, str], float] = {}
        for pair, result in enumerate(self._geometry_data.distanceResults):
            name = self.names(pair)
            found[name] = min(found.get(name, np.inf), result.min_distance)
        return found


def all_pairs(robot: pinik.Robot, links: list[str]) -> Iterator[tuple[str, str]]:
    """All pairs of these links that are on two different bodies, each with its names in order."""
    body = {name: robot.model.frames[robot.frame_id(name)].parentJoint for name in links}
    for pair in itertools.combinations(sorted(set(links)), 2):
        if body[pair[0]] != body[pair[1]]:
            yield pair
