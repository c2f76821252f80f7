"""What a check of a robot's collisions costs, beside Pinocchio's, and that both say the same of every configuration.

Both are asked about the same random configurations inside the limits, in turns, one at a time and for yes or no alone:

* pinik: the compiled checker, over all pairs that count, from one array of configurations.
* Pinocchio: `computeCollisions` through Python, with the geometry model that it reads itself from the robot's files and
  the same pairs; it stops at the first pair that touches, as pinik does.

    python benchmarks/collisions.py panda ur5 z1 --count 5000

With `--all` the robots are all of example-robot-data that have collision shapes, and all pairs of links on different
bodies are compared one by one, disabled ones too; `--count` is then the number of configurations for each robot. A
disagreement is exit status 1.
"""

from __future__ import annotations

import argparse
import platform
import sys
import time
import warnings
from collections.abc import Sequence
from importlib.metadata import version

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
    names = sorted(set(plain.all_names))
    if not {link for pair in names for link in pair} <= {solid.owner for solid in solids}:
        print(f"{name}: the two do not read the same shapes")
    checker = make_checker(robot, solids, solid_pairs(solids, names))
    rng = np.random.default_rng(seed)
    wrong: set[Names] = set()
    differing = 0
    for _ in range(count):
        q = robot.random(rng)
        other = {names[touch.group] for touch in checker.report(q)} ^ plain.touching(q)
        wrong |= other
        differing += len(other)
    print(f"{name}: {len(solids)} shapes, {count * len(names)} pairs of links compared, {differing} differ", *wrong)
    return count * len(names), differing


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
