"""What a check of a robot's collisions costs, beside Pinocchio's, and that both say the same of every configuration.

Both are asked about the same random configurations inside the limits, block by block in turns, for yes or no alone:

* pinik: the compiled checker, over all pairs that count, from one array of configurations.
* Pinocchio: `computeCollisions` through Python, with the geometry model that it reads itself from the robot's files and
  the same pairs; it stops at the first pair that touches, as pinik does.

    python benchmarks/collisions.py panda ur5 z1 --count 5000

With `--all` the robots are all of example-robot-data that have collision shapes, and all pairs of links on different
bodies are compared one by one, disabled ones too; `--count` is then the number of configurations for each robot. Pairs
within 1e-6 m of just touching, which is coal's own tolerance, are ties. Where the two disagree about a link whose mesh
Pinocchio reads with other triangles, the link is named instead: coal 3.0.3 confuses the corners of a COLLADA file's
second part. Any other disagreement is exit status 1.

With `--solve` each robot solves random reachable poses with `avoid="self"` and without, in turns, by the thread's
clock. Pinocchio says which answers are free. A pose is known to have a free answer if one of `solve_all`'s answers is
free, which for arms of more than six joints are a sample; or if the configuration that the pose was made of is. An
answer that is said to be free and is not, or a pose in a hundred with a free answer among `solve_all`'s that is not
solved, is exit status 1.
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
from pinik.shapes.checker import Checker, make_checker
from pinik.shapes.collisions import shapes_of
from pinik.shapes.pairs import solid_pairs

Array = NDArray[np.float64]
Names = tuple[str, str]

TIE = 1e-6  # [m]
BLOCK = 250  # configurations that one of the two is asked about before it is the other's turn


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
        # Some triangles without area, or corners that round to another digit, make no other mesh.
        return {link for link, own in ours.items() if len(own ^ theirs[link]) > 0.2 * len(own)}


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
    ours = checker.touches(Q)
    wrong, mean, theirs_mean = in_turns(checker, plain, Q)
    _, free, theirs_free = in_turns(checker, plain, Q[~ours])
    shapes, shape_pairs = len(shapes_of(robot).solids), len(plain.all_names)
    print(
        f"{name}: {shapes} shapes, {shape_pairs} pairs, {ours.mean():.1%} touch; a free configuration: pinik "
        f"{free:.2f} µs, Pinocchio {theirs_free:.1f} µs, {theirs_free / free:.0f} times; any: pinik {mean:.2f} µs, "
        f"Pinocchio {theirs_mean:.1f} µs; {wrong} of {count} verdicts differ",
        flush=True,
    )
    return wrong


def in_turns(checker: Checker, plain: Pinocchio, Q: Array) -> tuple[int, float, float]:
    """(Verdicts that differ, pinik's time, Pinocchio's): medians of blocks, by the thread's own clock [µs a check]."""
    wrong, spent = 0, []
    for block in np.array_split(Q, max(len(Q) // BLOCK, 1)):
        moments = [time.thread_time()]
        ours = checker.touches(np.ascontiguousarray(block))
        moments.append(time.thread_time())
        theirs = [plain.touches(q) for q in block]
        moments.append(time.thread_time())
        spent.append(np.diff(moments) / len(block))
        wrong += int((ours != np.array(theirs)).sum())
    mine, others = 1e6 * np.median(spent, axis=0)
    return wrong, float(mine), float(others)


def compare_pairs(name: str, count: int, seed: int) -> tuple[int, int]:
    """(Pairs compared, those on which the two disagree) for one robot, or (0, 0) without collision shapes."""
    robot = pinik.load(name)
    try:
        solids = shapes_of(robot).solids
    except pinik.InputError:
        return 0, 0
    plain = Pinocchio(robot)
    names = sorted(set(plain.all_names))
    checker = make_checker(robot, solids, solid_pairs(solids, names))
    rng = np.random.default_rng(seed)
    wrong: list[Names] = []
    ties = 0
    for _ in range(count):
        q = robot.random(rng)
        other = {names[touch.group] for touch in checker.report(q)} ^ plain.touching(q)
        tied = {pair for pair in other if abs(plain.distance(q, pair)) < TIE}
        ties += len(tied)
        wrong += sorted(other - tied)
    misread = plain.misread(robot) if wrong else set()
    blamed = {link for pair in wrong for link in misread.intersection(pair)}
    wrong = [pair for pair in wrong if blamed.isdisjoint(pair)]
    notes = [f"{ties} ties"] * bool(ties) + [f"Pinocchio misreads {', '.join(sorted(blamed))}"] * bool(blamed)
    print(
        f"{name}: {len(solids)} shapes, {count * len(names)} pairs of links compared, {len(wrong)} differ",
        *sorted(set(wrong)),
        *notes,
        flush=True,
    )
    return count * len(names), len(wrong)


def compare_solves(name: str, frame: str, count: int, seed: int) -> int:
    """Print what solves with and without `avoid="self"` cost and come to; how many claims do not hold."""
    robot = pinik.load(name)
    plain = Pinocchio(robot, robot.collision_pairs.counting)
    rng = np.random.default_rng(seed)
    made_of = [robot.random(rng) for _ in range(count)]
    poses = [np.array(robot.placement(frame, q).homogeneous) for q in made_of]
    choices: list[dict[str, Any]] = [{}, {"avoid": "self"}]
    for words in choices:
        robot.solve(frame, placement=poses[0], **words)
    spent = np.zeros((2, count))
    answers = []
    for k, pose in enumerate(poses):
        both = []
        for which, words in enumerate(choices):
            start = time.thread_time_ns()
            both.append(robot.solve(frame, placement=pose, **words))
            spent[which, k] = 1e-3 * (time.thread_time_ns() - start)
        answers.append(both)
    free = np.array([[answer.success and not plain.touches(answer.q) for answer in both] for both in answers])
    said = np.array([both[1].success for both in answers])
    found = np.array([any(not plain.touches(q) for q in robot.solve_all(frame, placement=pose)) for pose in poses])
    known = found | np.array([not plain.touches(q) for q in made_of])
    false = int((said & ~free[:, 1]).sum())
    missed = int((found & ~free[:, 1]).sum())
    median, slow = np.median(spent, axis=1), np.percentile(spent[1], 95)
    print(
        f'{name}: {count} poses; median without {median[0]:.1f} µs, with avoid="self" {median[1]:.1f} µs (of those '
        f"solved {np.median(spent[1, said]):.1f} µs, 95th percentile of all {slow:.0f} µs); free without "
        f"{free[:, 0].mean():.1%}, with {free[:, 1].mean():.1%}; {false} answers said to be free touch; solved of "
        f"{found.sum()} poses with a free answer among solve_all's {1 - missed / found.sum():.2%}, of {known.sum()} "
        f"known to have one {(known & free[:, 1]).sum() / known.sum():.2%}",
        flush=True,
    )
    return false + int(missed > 0.01 * found.sum())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", default=["panda", "ur5", "z1", "kinova"])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--solve", metavar="FRAME", help="solve for this frame, such as panda_hand_tcp")
    given = parser.parse_args()
    machine = platform.processor() or platform.machine()
    libraries = ", ".join(f"{name} {version(name)}" for name in ("pinik", "pin", "coal"))
    print(f"{machine}, {platform.platform()}; {libraries}; seed {given.seed}")
    warnings.simplefilter("ignore", pinik.UrdfWarning)
    if given.solve:
        return 1 if sum(compare_solves(name, given.solve, given.count, given.seed) for name in given.robots) else 0
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
