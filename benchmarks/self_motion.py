"""The Panda's self-motion: its cost, and whether it agrees with frankik's closed form over the seventh joint.

    python benchmarks/self_motion.py [--count 50] [--samples 61] [--starts 60] [--seed 0]

For each of `--count` random poses inside the limits, the families of solutions are found without frankik: from the
answers that `solve` finds from random starts, each of which begins a new family unless it is on a known one. Then
frankik, in an environment of its own, lists its answers for `--samples` values of the seventh joint. Those inside the
limits that plain Pinocchio confirms to 1e-6 m and rad must lie on one of the families, within 1e-3 rad.

In turn, frankik is asked for configurations of the families by their seventh joint. It knows one of the two triangles
that shoulder, elbow and wrist can make, so that those with joint 4 near its upper limit are not among its answers.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "tests"))  # the judge

from comparison.environments import CannotInstallError, python_with
from comparison.machine import about_machine
from comparison.peer_list import FRANKIK_REQUIREMENTS

import pinik
from judge import judge

FRAME = "panda_link8"  # which frankik places
ADAPTER = Path(__file__).parent / "adapters" / "franka_families.py"
CONFIRMED = (1e-6, 1e-6)
NEAR = 1e-3  # [rad]
TURN = 2.0 * np.pi


def families(robot: pinik.Robot, target: pinik.Target, q: np.ndarray, starts: int) -> tuple[list, list[float]]:
    """The self-motions through `q` and through other answers from random starts, and the processor time of each [s]."""
    found: list[pinik.SelfMotion] = []
    times = []
    for number in range(starts):
        answer = q if number == 0 else robot.solve(target, q0=robot.random(number), restarts=0).q
        if not judge(robot, target, answer).are_within(CONFIRMED) or any(own.contains(answer, NEAR) for own in found):
            continue
        began = time.process_time()
        found.append(robot.self_motion(target, answer))
        times.append(time.process_time() - began)
    return found, times


def frankik(python: Path, places: np.ndarray, sevenths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """frankik's answers (K, 7) for all placements (N, 4, 4) and values of the seventh joint (M,), with their owners."""
    with tempfile.TemporaryDirectory() as folder:
        asked, answered = Path(folder) / "asked.npz", Path(folder) / "answered.npz"
        np.savez(asked, places=places, sevenths=sevenths)
        subprocess.run([python, ADAPTER, asked, answered], check=True)
        with np.load(answered) as found:
            return found["answers"], found["owners"]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--samples", type=int, default=61)
    parser.add_argument("--starts", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    warnings.simplefilter("ignore", pinik.UrdfWarning)
    try:
        python = python_with(FRANKIK_REQUIREMENTS, "frankik")
    except CannotInstallError as error:
        sys.exit(f"frankik cannot be installed: {error}")
    robot = pinik.load("panda")
    rng = np.random.default_rng(asked.seed)
    origins = [robot.random(rng) for _ in range(asked.count)]
    targets = [pinik.Target(FRAME, placement=robot.placement(FRAME, q)) for q in origins]
    places = np.array([robot.placement(FRAME, q).homogeneous for q in origins])
    sevenths = np.linspace(robot.lower[6], robot.upper[6], asked.samples)
    print(about_machine())
    print(f"pinik {pinik.__version__}, {', '.join(FRANKIK_REQUIREMENTS)}; {vars(asked)}")

    robot.self_motion(targets[0], origins[0])  # so that nothing is loaded within the first measurement
    known, times = [], []
    for target, q in zip(targets, origins, strict=True):
        found, took = families(robot, target, q, asked.starts)
        known.append(found)
        times += took
    counts = [len(found) for found in known]
    print(f"families a pose: {np.mean(counts):.2f} ({min(counts)} to {max(counts)})")
    usual, slowest = 1e3 * np.median(times), 1e3 * max(times)
    print(f"a self-motion of 200 points: median {usual:.1f} ms of processor time, at most {slowest:.1f} ms")

    answers, owners = frankik(python, places, sevenths)
    full = np.zeros((len(answers), robot.model.nq))
    full[:, :7] = answers
    on, missing = 0, []
    for q, owner in zip(full, owners, strict=True):
        inside = ((q >= robot.lower_q) & (q <= robot.upper_q)).all()
        if not inside or not judge(robot, targets[owner], q).are_within(CONFIRMED):
            continue
        if any(own.contains(q, NEAR) for own in known[owner]):
            on += 1
        else:
            missing.append((int(owner), q[:7].tolist()))
    print(f"frankik's answers inside the limits: {on + len(missing)}, on a family: {on}")
    for owner, q in missing:
        print(f"  not on a family: pose {owner}, q = {q}")

    met = asked_of = 0
    for number, found in enumerate(known):
        configurations = np.vstack([arc.q[10::40, :7] for own in found for arc in own.arcs] or [np.zeros((0, 7))])
        if not len(configurations):
            continue
        theirs, _ = frankik(python, places[number : number + 1], configurations[:, 6])
        away = configurations[:, np.newaxis] - theirs
        distances = np.abs(away - TURN * np.round(away / TURN)).max(axis=2).min(axis=1)
        asked_of += len(configurations)
        met += int((distances < NEAR).sum())
    print(f"configurations of the families: {asked_of}, among frankik's answers: {met}")


if __name__ == "__main__":
    main()
