"""Say how many branches of src/pinik the tests take, by coverage.py's JSON report; exit with 1 if they are too few.

python tools/branch_coverage.py build/coverage/report.json 95
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path


def main(report: str, least: str) -> int:
    measured = json.loads(Path(report).read_text())
    taken: Counter[str] = Counter()
    all_of: Counter[str] = Counter()
    for file, about in measured["files"].items():
        room = Path(file.partition("pinik/")[2]).parts[0].removesuffix(".py")
        taken[room] += about["summary"]["covered_branches"]
        all_of[room] += about["summary"]["num_branches"]
    for room in sorted(all_of, key=lambda room: (taken[room] - all_of[room], room)):
        if taken[room] < all_of[room]:
            print(f"{room:12} {taken[room]:5} of {all_of[room]:5} branches")
    percent = 100.0 * taken.total() / all_of.total()
    print(f"{'all':12} {taken.total():5} of {all_of.total():5} branches, {percent:.2f} %")
    return 0 if percent >= float(least) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
