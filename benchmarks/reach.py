"""Maps of what a Panda reaches: the speed of both ways, how far they agree, and each against an oracle.

    python benchmarks/reach.py [--cell 0.1] [--samples 32000000] [--checks 2000] [--seed 0]

Both ways map all that the hand reaches, in 48 approach directions and 12 rolls. Rates are for each second of processor
time, since the machine may be busy with other things, and by the clock. After doublings of the number of samples, the
maps are compared. Then random poses of the map by solving are asked again with all restarts, and judged by plain
Pinocchio. The ring of two hinges is compared with its area for smaller and smaller cells.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "tests"))  # the judge

from comparison.machine import about_machine

import pinik
from judge import plain_placement

FRAME = "panda_hand_tcp"


def timed(words: str, unit: str, count: int | None, **options) -> pinik.ReachMap:
    """Make a map, and print how long it took for each of `count`, or of the poses that were asked for."""
    robot = pinik.load("panda")
    clock, processor = time.perf_counter(), time.process_time()
    found = pinik.reach(robot, FRAME, **options)
    clock, processor = time.perf_counter() - clock, time.process_time() - processor
    if count is None:
        count = int((found.counts.found > 0).sum()) * len(found.orientations)
    print(f"{words}: {found}")
    print(
        f"  {count:,} {unit}: {processor:.1f} s of processor time, {count / processor:,.0f} {unit} a second; "
        f"{clock:.1f} s by the clock, {60 * count / clock / 1e6:.1f} million {unit} a minute",
        flush=True,
    )
    return found


def check_poses(found: pinik.ReachMap, checks: int, rng: np.random.Generator) -> None:
    """Ask random poses of the map by solving again, with all restarts."""
    robot = pinik.load("panda")
    rows = rng.choice(np.flatnonzero(found.counts.found), checks)
    turns = rng.integers(len(found.orientations), size=checks)
    places = np.tile(np.eye(4), (checks, 1, 1))
    places[:, :3, :3] = found.orientations.rotations[turns]
    places[:, :3, 3] = found.grid.centers(found.counts.cells[rows])
    said = found.counts.reached[rows, turns]
    answers = pinik.solve_many(robot, FRAME, places)
    errors = [
        np.abs(plain_placement(robot, FRAME, q).inverse().homogeneous @ place - np.eye(4)).max()
        for q, place in zip(answers.q[answers.success], places[answers.success], strict=True)
    ]
    both = (said & answers.success).sum()
    print(f"{checks} random poses: {said.sum()} by the map, {answers.success.sum()} by all restarts, {both} by both")
    print(f"  the map misses {1 - both / answers.success.sum():.2%}; plain Pinocchio's largest error {max(errors):.1e}")


def ring() -> None:
    """The area of the ring of two hinges, by cells of several sizes."""
    robot, area = pinik.load("two_link"), np.pi * (0.9**2 - 0.1**2)
    for cell in (0.1, 0.05, 0.02, 0.01):
        areas = [
            pinik.reach(robot, "tip", cell=cell, **way).volume() / cell
            for way in ({"by": "solving"}, {"samples": 4_000_000})
        ]
        solved, sampled = (f"{100 * (one / area - 1):+.2f} %" for one in areas)
        print(f"ring in cells of {cell:g} m: by solving {solved} of its area, by sampling {sampled}", flush=True)


def main() -> None:
    """Run all of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cell", type=float, default=0.1)
    parser.add_argument("--samples", type=int, default=32_000_000)
    parser.add_argument("--checks", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    print(about_machine())
    solved = timed("by solving", "poses", None, by="solving", cell=asked.cell)
    count = asked.samples
    counts = [count // 16, count // 8, count // 4, count // 2, count]
    for samples in counts:
        sampled = timed("by sampling", "samples", samples, samples=samples, cell=asked.cell, seed=asked.seed)
        agreement = solved.agreement(sampled)
        reached = agreement["both"] + agreement["only_this"]
        print(
            f"  of {reached:,} cells and orientations by solving, {agreement['both'] / reached:.2%} are sampled; "
            f"{agreement['only_other'] / reached:.2%} more are only sampled; of cells {agreement['cells']:.1%} agree"
        )
    check_poses(solved, asked.checks, np.random.default_rng(asked.seed))
    ring()


if __name__ == "__main__":
    main()
