"""The branches that `solve_all` finds, beside those of EAIK and ssik, which know the closed forms of some arms.

Targets are placements at random configurations inside the limits. The answers of the others are brought inside the
limits by whole turns and measured by plain Pinocchio; those that miss the target or the limits do not count. Poses
where a branch of either side is near a singular configuration are told apart. Each of the others works in an
environment of its own, made once in the user's cache folder.

    python benchmarks/branches.py --robots ur5,z1,puma,kinova --count 1000
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio
from numpy.typing import NDArray

import pinik

sys.path.append(str(Path(__file__).parents[1] / "tests"))  # the judge, and the arms in numpy

from comparison.arms import ARMS, Arm, ArmSource, write_arm
from comparison.environments import CannotInstallError, python_with
from comparison.machine import about_machine
from comparison.peer import Peer
from comparison.peer_list import EAIK, EAIK_REQUIREMENTS
from comparison.workers import Worker, WorkerError

import every_answer

Array = NDArray[np.float64]

ROBOTS = ("ur5", "z1", "puma", "kinova")
KINOVA = ArmSource("kinova", "base", "j2s6s200_end_effector")
ORACLES = (
    Peer("eaik", "EAIK", ("eaik_closed.py", "All"), EAIK, EAIK_REQUIREMENTS),
    Peer("ssik", "ssik", ("ssik_analytic.py", "All"), ("ssik",), ("ssik[urdf]==8.2.0",)),
)
EXACT = 1e-6  # [m], and in entries of a rotation matrix: what counts as an answer of the others
APART = 0.01  # [rad]: what counts as distinct, as for pinik
ROOM = 64  # the most answers that the others may give


@dataclass
class Found:
    """What pinik found.

    Attributes:
        branches: For each pose the branches (n, k), in the order of the arm's joints.
        seconds: For each pose the time of the search, and of the whole call [s].
        starts: For each pose the number of starts.
    """

    branches: list[Array] = field(default_factory=list)
    seconds: list[tuple[float, float]] = field(default_factory=list)
    starts: list[int] = field(default_factory=list)


def main() -> None:
    """Measure what was asked for, and print a table in Markdown."""
    arguments = _arguments()
    print(f"{about_machine()}; pinocchio {pinocchio.__version__}, numpy {np.__version__}, seed {arguments.seed}")
    print(
        f"A pose is near a singular one if a branch has a singular value below {arguments.singular:g}: of its Jacobian,"
    )
    print("with lengths in units of the way along the arm.\n")
    _print_row(
        "robot", "beside", "regular poses", "same branches", "missing", "extra", "near singular", "same there",
        "branches", "search, µs", "call, µs", "starts", "its time, µs",
    )  # fmt: skip
    _print_row(*["---"] * 13)
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.robots:
            arm = _arm(name, Path(folder))
            rng = np.random.default_rng(arguments.seed)
            poses = [arm.placement(arm.random(rng)) for _ in range(arguments.count)]
            found = _solve(arm, poses)
            for oracle in ORACLES:
                try:
                    _compare(arm, poses, found, oracle, arguments.singular)
                except (CannotInstallError, WorkerError) as error:
                    _print_row(name, oracle.label, f"none: {str(error).splitlines()[0][:80]}", *[""] * 10)


def _arm(name: str, folder: Path) -> Arm:
    if name == "puma":
        file = folder / "puma_text.urdf"
        file.write_text(every_answer.puma((-3.1, 3.1)), encoding="utf-8")
        return write_arm(name, folder, ArmSource(str(file), "l0", "tip"))
    return write_arm(name, folder, ARMS.get(name, KINOVA))


def _solve(arm: Arm, poses: Sequence[pinocchio.SE3]) -> Found:
    """Let pinik search, from the neutral configuration."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pinik.UrdfWarning)
        robot = pinik.load(arm.urdf)
    robot.solve_all(arm.tip, placement=poses[0])  # compiles the question and makes the table
    found = Found()
    for pose in poses:
        began = time.perf_counter()
        branches = robot.solve_all(arm.tip, placement=pose)
        found.seconds.append((branches.time, time.perf_counter() - began))
        found.starts.append(branches.starts)
        rows = [[angles[joint] for joint in arm.joints] for angles in branches.angles]
        found.branches.append(np.array(rows).reshape(-1, len(arm.joints)))
    return found


def _compare(arm: Arm, poses: Sequence[pinocchio.SE3], found: Found, oracle: Peer, singular: float) -> None:
    """Print the row of one robot beside one oracle."""
    rest = np.zeros((len(poses), ROOM * len(arm.joints)))
    with Worker(
        python_with(oracle.requirements, oracle.environment), oracle, arm, (poses[:3], rest[:3]), None
    ) as worker:
        reply = worker.solve(poses, rest, carry=False, seconds=3600.0)
    if reply["errors"]:
        raise WorkerError(reply["errors"][0])
    in_numpy = every_answer.Arm(arm.urdf.read_text(encoding="utf-8"), arm.tip)
    regular, near = [], []
    for pose, ours, row in zip(poses, found.branches, reply["answers"], strict=True):
        given = row[np.isfinite(row)].reshape(-1, len(arm.joints))
        theirs = _distinct(every_answer.inside([q for q in given if _meets(arm, q, pose)], arm.lower, arm.upper))
        missing, extra = every_answer.unlike(ours, theirs, APART)
        values = [in_numpy.least_singular_value(q) for q in (*ours, *theirs)]
        (regular if min(values, default=1.0) >= singular else near).append((len(missing), len(extra)))
    search, call = 1e6 * np.median(found.seconds, axis=0)
    _print_row(
        arm.name, oracle.label, len(regular), _share(regular), sum(m for m, _ in regular), sum(e for _, e in regular),
        len(near), _share(near), f"{np.mean([len(ours) for ours in found.branches]):.2f}", f"{search:.0f}",
        f"{call:.0f}", f"{np.mean(found.starts):.1f}", f"{np.median(reply['nanoseconds']) / 1000:.0f}",
    )  # fmt: skip


def _meets(arm: Arm, q: Array, pose: pinocchio.SE3) -> bool:
    return bool(np.abs(arm.placement(q).homogeneous - pose.homogeneous).max() <= EXACT)


def _distinct(answers: Sequence[Array]) -> list[Array]:
    """The answers without those that differ by whole turns or hardly at all from earlier ones."""
    kept: list[Array] = []
    for q in answers:
        if all(np.abs(every_answer.turned_near(q - other)).max() > APART for other in kept):
            kept.append(q)
    return kept


def _share(counts: Sequence[tuple[int, int]]) -> str:
    same = sum(pair == (0, 0) for pair in counts)
    return f"{100.0 * same / len(counts):.2f} %" if counts else "–"


def _print_row(*cells: object) -> None:
    print(f"| {' | '.join(map(str, cells))} |", flush=True)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robots", type=lambda text: text.split(","), default=ROBOTS, help=f"of {','.join(ROBOTS)}")
    parser.add_argument("--count", type=int, default=1000, help="poses per robot")
    parser.add_argument("--singular", type=float, default=0.01, help="the smallest singular value of regular branches")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    unknown = set(arguments.robots) - set(ROBOTS)
    if unknown:
        parser.error(f"--robots must be some of {','.join(ROBOTS)}; got {','.join(sorted(unknown))}")
    return arguments


if __name__ == "__main__":
    main()
