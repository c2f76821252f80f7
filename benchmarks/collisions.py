"""What a check of a robot's collisions costs, beside Pinocchio's, and that both say the same of every configuration.

Both are asked about the same random configurations inside the limits, in turns, one at a time and for yes or no alone:

* pinik: the compiled checker, over all pairs that count, from one array of configurations.
* Pinocchio: `computeCollisions` through Python, with the geometry model that it reads itself from the robot's files and
  the same pairs; it stops at the first pair that touches, as pinik does.

    python benchmarks/collisions.py panda ur5 z1 --count 5000

With `--all` the robots are all of example-robot-data that have collision shapes, and all pairs of links on different
bodies are compared one by one, disabled ones too; `--count` is then the number of configurations for each robot. Pairs that
are within 1e-6 m of just touching, which is coal's own tolerance, are ties. Links whose meshes Pinocchio reads with other
triangles are left out and named: coal 3.0.3 confuses the corners of a COLLADA file's second part. A disagreement is exit
status 1.
"""

from __future__ import annotations

import argparse
import platform
import sys
import time
import warnings
from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

import coal
import numpy as np
import pinocchio
from numpy.typing import NDArray

import pinik
from pinik.description.shares import example_robot_data
from pinik.shapes.checker import make_checker
from pinik.shapes.collisions import shapes_of
from pinik.shapes.pairs import solid_pairs

Array = NDArray[np.float64]
Names = tuple[str, str]

TIE = 1e-6  # [m]


class Pinocchio:
    """Pinocchio's own reading of a robot's shapes, with some pairs of its links, or all."""

    def __init__(self, robot: pinik.Robot, pairs: Sequence[Names] | None = None) -> None:
        robots = example_robot_data()
        assert robots is not None
        folders = [str(folder) for folder in (robots.parents[1], robots.parent, robots)]
        self.model, self.data = robot.model, robot.model.createData()
        self.geometry = pinocchio.buildGeomFromUrdf(
            robot.model, str(robot.description.path), pinocchio.COLLISION, package_dirs=folders
        )
        self.geometry.addAllCollisionPairs()
        if pairs is not None:
            known = set(pairs)
            kept = [(pair.first, pair.second) for pair in self.geometry.collisionPairs if self.names(pair) in known]
            self.geometry.removeAllCollisionPairs()
            for numbers in kept:
                self.geometry.addCollisionPair(pinocchio.CollisionPair(*numbers))
        self.all_names = [self.names(pair) for pair in self.geometry.collisionPairs]
        self.results = self.geometry.createData()
        for request in self.results.collisionRequests:
            request.enable_contact = True  # else coal overlooks some shapes that go deep into each other

    def names(self, pair: pinocchio.CollisionPair) -> Names:
        shapes = self.geometry.geometryObjects
        a, b = (self.model.frames[shapes[k].parentFrame].name for k in (pair.first, pair.second))
        return (a, b) if a <= b else (b, a)

    def touches(self, q: Array) -> bool:
        found: bool = pinocchio.computeCollisions(self.model, self.data, self.geometry, self.results, q, True)
        return found

    def touching(self, q: Array) -> set[Names]:
        pinocchio.computeCollisions(self.model, self.data, self.geometry, self.results, q, False)
        results = self.results.collisionResults
        return {name for k, name in enumerate(self.all_names) if results[k].isCollision()}

    def distance(self, q: Array, names: Names) -> float:
        """The least signed distance of two links [m]."""
        pinocchio.updateGeometryPlacements(self.model, self.data, self.geometry, self.results, q)
        numbers = [k for k, own in enumerate(self.all_names) if own == names]
        return min(pinocchio.computeDistance(self.geometry, self.results, k).min_distance for k in numbers)

    def misread(self, robot: pinik.Robot) -> set[str]:
        """The links of which this model has other triangles than pinik."""
        ours: dict[str, set[Any]] = {}
        for solid in shapes_of(robot).solids:
            if solid.surface is not None:
                ours.setdefault(solid.owner, set()).update(_triangles(solid.surface.vertices, solid.surface.faces))
        theirs: dict[str, set[Any]] = {}
        for shape in self.geometry.geometryObjects:
            mesh, link = shape.geometry, self.model.frames[shape.parentFrame].name
            if isinstance(mesh, coal.BVHModelBase):
                faces = [[mesh.tri_indices(k)[i] for i in range(3)] for k in range(mesh.num_tris)]
                theirs.setdefault(link, set()).update(_triangles(np.array(mesh.vertices()), np.array(faces)))
        # A few triangles without area, or corners that round to another digit, make no other mesh.
        return {link for link, own in ours.items() if len(own ^ theirs[link]) > 0.02 * len(own)}


def _triangles(vertices: Array, faces: NDArray[Any]) -> set[Any]:
    """The triangles, each as its corners to 10 µm in order."""
    corners = np.rint(vertices[faces] / 1e-5).astype(np.int64)
    return {tuple(sorted(map(tuple, triangle))) for triangle in corners.tolist()}


def compare_times(name: str, count: int, seed: int) -> int:
    """Print the times of one robot; how many verdicts differ."""
    robot = pinik.load(name)
    pairs = robot.collision_pairs.counting
    checker, plain = shapes_of(robot).guard(robot).checker, Pinocchio(robot, pairs)
    rng = np.random.default_rng(seed)
    Q = np.array([robot.random(rng) for _ in range(count)])
    checker.touches(Q)
    ours, theirs = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    spent = np.zeros((2, count))
    for block in np.array_split(np.arange(count), max(count // 100, 1)):
        start = time.perf_counter()
        ours[block] = checker.touches(np.ascontiguousarray(Q[block]))
        spent[0, block] = (time.perf_counter() - start) / len(block)
        for k in block:
            start = time.perf_counter()
            theirs[k] = plain.touches(Q[k])
            spent[1, k] = time.perf_counter() - start
    free = np.ascontiguousarray(Q[~ours])
    start = time.perf_counter()
    checker.touches(free)
    alone = (time.perf_counter() - start) / max(len(free), 1)
    free_theirs = spent[1, ~ours].mean() if len(free) else np.nan
    wrong = int((ours != theirs).sum())
    shapes, shape_pairs = len(shapes_of(robot).solids), len(plain.all_names)
    print(
        f"{name}: {shapes} shapes, {shape_pairs} pairs of shapes, {ours.mean():.1%} touch; mean of all: pinik "
        f"{1e6 * spent[0].mean():.1f} µs, Pinocchio {1e6 * spent[1].mean():.1f} µs; of free ones: pinik "
        f"{1e6 * alone:.2f} µs, Pinocchio {1e6 * free_theirs:.1f} µs ({free_theirs / alone:.0f} times); "
        f"{wrong} of {count} verdicts differ"
    )
    return wrong


def compare_pairs(name: str, count: int, seed: int) -> tuple[int, int]:
    """(Pairs compared, those on which the two disagree) for one robot, or (0, 0) without collision shapes."""
    robot = pinik.load(name)
    try:
        solids = shapes_of(robot).solids
    except pinik.InputError:
        return 0, 0
    plain = Pinocchio(robot)
    misread = plain.misread(robot)
    names = sorted(pair for pair in set(plain.all_names) if misread.isdisjoint(pair))
    checker = make_checker(robot, solids, solid_pairs(solids, names))
    rng = np.random.default_rng(seed)
    wrong: list[Names] = []
    ties = 0
    for _ in range(count):
        q = robot.random(rng)
        other = {names[touch.group] for touch in checker.report(q)} ^ (plain.touching(q) & set(names))
        tied = {pair for pair in other if abs(plain.distance(q, pair)) < TIE}
        ties += len(tied)
        wrong += sorted(other - tied)
    notes = [f"{ties} ties"] * bool(ties) + [f"Pinocchio misreads {', '.join(sorted(misread))}"] * bool(misread)
    print(
        f"{name}: {len(solids)} shapes, {count * len(names)} pairs of links compared, {len(wrong)} differ",
        *sorted(set(wrong)),
        *notes,
        flush=True,
    )
    return count * len(names), len(wrong)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", default=["panda", "ur5", "z1", "kinova"])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--all", action="store_true")
    given = parser.parse_args()
    machine = platform.processor() or platform.machine()
    libraries = ", ".join(f"{name} {version(name)}" for name in ("pinik", "pin", "coal"))
    print(f"{machine}, {platform.platform()}; {libraries}; seed {given.seed}")
    warnings.simplefilter("ignore", pinik.UrdfWarning)
    if not given.all:
        return 1 if sum(compare_times(name, given.count, given.seed) for name in given.robots) else 0
    compared = differing = 0
    for name in pinik.catalog():
        try:
            one, other = compare_pairs(name, given.count, given.seed)
        except (pinik.RobotLoadError, ValueError) as error:
            print(f"{name}: skipped, {str(error)[:120]}")
            continue
        compared, differing = compared + one, differing + other
    print(f"{compared} pairs compared, {differing} differ")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
