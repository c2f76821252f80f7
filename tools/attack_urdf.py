"""Attack pinik's reader of URDF files with mutated robots.

    python tools/attack_urdf.py --count 10000 --seed 1
    python tools/attack_urdf.py --minutes 5 --atheris

Every input must end in a `RobotLoadError`, or in a robot whose links yourdfpy places as pinik does; never in another
exception, a crash, 5 seconds of computing, 2 GB of memory, or a read outside the robot's packages. The exit status is 1
if one did not; the first input of each kind of fault is then in build/attack.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from urdf_attack.report import Report

CHUNK = 500


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=10_000, help="the number of inputs")
    parser.add_argument("--seed", type=int, default=0, help="other seeds give other inputs")
    parser.add_argument("--first", type=int, default=0, help="the number of the first input")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="stop after so many minutes")
    parser.add_argument("--out", type=Path, default=Path("build/attack"), help="a folder for inputs that show a fault")
    parser.add_argument(
        "--atheris", action="store_true", help="let atheris choose the inputs by the branches that they reach"
    )
    given = parser.parse_args()
    report = Report(f"seed {given.seed}", given.out)
    if given.atheris:
        from urdf_attack.guided import attack

        attack(given.count, given.seed, given.minutes, report)
    from urdf_attack.workers import Worker, case_of  # imports pinik, which atheris must do itself

    worker = Worker()
    try:
        for begin in range(given.first, given.first + given.count, CHUNK):
            if report.minutes > given.minutes:
                break
            numbers = range(begin, min(begin + CHUNK, given.first + given.count))
            for number, outcome in worker.judged_range(given.seed, numbers):
                if report.is_new(outcome):
                    report.keep(number, case_of(given.seed, number), outcome)
    except KeyboardInterrupt:
        pass  # the report tells how far it came
    finally:
        worker.close()
    print(report)
    return 1 if report.faults else 0


if __name__ == "__main__":
    sys.exit(main())
