"""Attack the solvers: random robots, targets, starts and options, with every answer checked.

    python tools/attack_solves.py --count 1000000 --seed 0

`tests/random_questions.py` says what is asked, and `tests/solve_attack.py` what must hold. Every fault is printed with
the number of its robot, and `--robot NUMBER` makes that robot again; the exit status is 1 if there was a fault.
"""

from __future__ import annotations

import argparse
import collections
import itertools
import os
import sys
import time
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / "tests"))

from solve_attack import FaultyAnswerError, attack

MOST_FAULTS = 50
LONGEST = 2000  # characters of one fault


def main() -> int:
    """Attack until `--count` solves are done, and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=10_000, help="the number of solves")
    parser.add_argument("--seed", type=int, default=0, help="another seed makes other robots")
    parser.add_argument("--robot", type=int, help="only this robot, by its number")
    asked = parser.parse_args()
    numbers = itertools.count() if asked.robot is None else [asked.robot]
    counts: collections.Counter[str] = collections.Counter()
    began = said = time.perf_counter()
    faults = 0
    for number in numbers:
        try:
            counts += attack(asked.seed, number)
        except FaultyAnswerError as fault:
            faults += 1
            print(f"FAULT {str(fault)[:LONGEST]}", flush=True)
        counts["robots"] += 1
        if time.perf_counter() - said > 60.0:
            said = time.perf_counter()
            print(_progress(counts["solves"], faults, said - began), file=sys.stderr, flush=True)
        if counts["solves"] >= asked.count or faults >= MOST_FAULTS:
            break
    for name, count in sorted(counts.items()):
        print(f"{count:>9,} {name}")
    memory = int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
    print(f"{_progress(counts['solves'], faults, time.perf_counter() - began)}; {memory:.0f} MB resident")
    return 1 if faults else 0


def _progress(solves: int, faults: int, seconds: float) -> str:
    return f"{solves:,} solves, {solves / seconds:.0f} a second: {faults} faults in {seconds:.0f} s"


if __name__ == "__main__":
    sys.exit(main())
