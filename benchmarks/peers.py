"""pinik beside other inverse kinematics: the same arms, targets and starts, judged by plain Pinocchio.

Each peer works in an environment of its own, made once in the user's cache folder. `docs/peers.md` says what is
asked, how each peer is set, and how to read the tables.

    python benchmarks/peers.py --robots panda,ur5 --peers pinik,rtb,tracik --tasks poses,path --count 1000
"""

from __future__ import annotations

import argparse
import datetime
import json
import platform
import shlex
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "tests"))  # the judge

from comparison.arms import ARMS, write_arm
from comparison.contestant import compare, one_line
from comparison.environments import CannotInstallError, python_with
from comparison.machine import Yardstick, about_machine, all_cores, can_pin
from comparison.markdown import as_markdown, replace_part
from comparison.peer import Peer
from comparison.peer_list import PEERS, pinik_by
from comparison.problems import TASKS, make_problems
from comparison.quoting import read_before_quoting
from comparison.summary import batches_of, ratios_of
from comparison.tables import Row, as_json, as_text
from comparison.verdicts import NEAR

WHOLE_BATCH = ("batch", "forward")  # the tasks with a count of their own


def main() -> None:
    """Run what was asked for, print the tables, write the JSON and the Markdown."""
    arguments = _arguments()
    peers = [*(peer for peer in PEERS if peer.key in arguments.peers), *map(pinik_by, arguments.methods)]
    pythons = {
        peer.environment: _python_or_reason(peer) for peer in {each.environment: each for each in peers}.values()
    }
    about = {
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "machine": about_machine(),
        "core": arguments.core,
        "python": platform.python_version(),
        "count": arguments.count,
        "batch": arguments.batch,
        "seed": arguments.seed,
        "rounds": arguments.rounds,
        "budget_seconds": arguments.budget,
        "solved_within": {"metres": NEAR[0], "radians": NEAR[1]},
    }
    print("# Read before quoting", *read_before_quoting(about, peers, None), sep="\n# * ", flush=True)
    rows: list[Row] = []
    versions: dict[str, dict[str, str]] = {}
    whole = Yardstick(arguments.core)
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.robots:
            arm = write_arm(name, Path(folder))
            for task in arguments.tasks:
                chosen = [(peer, pythons[peer.environment]) for peer in peers if task in peer.tasks]
                if task == "tolerance":
                    chosen = [(peer.at(most), python) for most in arguments.tolerances for peer, python in chosen]
                if not chosen:
                    print(f"\n## {name}, {task}: none of the chosen peers has a row here")
                    continue
                count = arguments.batch if task in WHOLE_BATCH else arguments.count
                problems = make_problems(arm, task, count, arguments.seed)
                yardstick = Yardstick(arguments.core)
                found, known = compare(
                    arm, problems, chosen, arguments.rounds, arguments.budget, arguments.core, yardstick
                )
                versions.update({key: those for key, those in known.items() if those})
                rows += found
                whole.nanoseconds += yardstick.nanoseconds
                print(f"\n{as_text(found, yardstick.noise())}", flush=True)
    _report(about, peers, rows, versions, whole.noise(), arguments)


def _report(
    about: dict[str, Any],
    peers: list[Peer],
    rows: list[Row],
    versions: dict[str, dict[str, str]],
    noise: tuple[float, float],
    arguments: argparse.Namespace,
) -> None:
    """The end of the run: the summary and the versions, and the files that were asked for."""
    grids = [ratios_of(rows), batches_of(rows)]
    print("\n## pinik against the others (the worst and the best robot), and all in one call")
    for grid in grids:
        for cells in grid:
            print(f"{cells[0]:40} " + " ".join(f"{cell:>22}" for cell in cells[1:]))
    packages = sorted({f"{package} {version}" for those in versions.values() for package, version in those.items()})
    print(f"\n# the machine meanwhile: the same work took {noise[0]:+.0f} % to {noise[1]:+.0f} % of its median time")
    print("# " + ", ".join(packages))
    if arguments.json:
        told = {"schema": 2, **about, "noise_percent": noise, "versions": versions, "rows": as_json(rows)}
        arguments.json.write_text(json.dumps(told, indent=2) + "\n", encoding="utf-8")
    if arguments.write:
        points = [*read_before_quoting(about, peers, noise), f"Versions: {', '.join(packages)}."]
        replace_part(arguments.write, as_markdown(points, grids, rows, _command()))


def _command() -> str:
    """How to run this again: the options given, without the file of the JSON, which is nobody else's."""
    words = sys.argv[1:]
    if "--json" in words:
        at = words.index("--json")
        del words[at : at + 2]
    return shlex.join(["python", "benchmarks/peers.py", *words])


def _arguments() -> argparse.Namespace:
    keys, tasks = [peer.key for peer in PEERS], list(TASKS)
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robots", type=_names(list(ARMS)), default=list(ARMS), help=f"of {','.join(ARMS)}")
    parser.add_argument("--peers", type=_names(keys), default=keys, help=f"of {','.join(keys)}")
    parser.add_argument("--methods", type=_names(["pinv", "jt", "ccd"]), default=[], help="further rows of pinik's")
    parser.add_argument("--tasks", type=_names(tasks), default=tasks, help=f"of {','.join(tasks)}")
    parser.add_argument("--tolerances", type=_tolerances, default=[1e-4, 1e-5, 1e-6, 1e-7, 1e-8], help="metres")
    parser.add_argument("--count", type=_positive(int), default=1000, help="targets per robot and task")
    parser.add_argument("--batch", type=_positive(int), default=100_000, help=f"targets of {', '.join(WHOLE_BATCH)}")
    parser.add_argument("--rounds", type=_positive(int), default=20, help="turns that the peers take")
    parser.add_argument("--budget", type=_positive(float), default=20.0, help="seconds per peer, robot and task")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--core", type=_core, default=_last_core(), help='where one thread runs; "none" for anywhere')
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all figures there, too")
    parser.add_argument(
        "--write", type=Path, metavar="FILE", help="write the tables between the marks of this document"
    )
    return parser.parse_args()


def _names(known: list[str]) -> Any:
    def read(text: str) -> list[str]:
        names = text.split(",")
        for name in names:
            if name not in known:
                raise argparse.ArgumentTypeError(f"{name!r} is none of {', '.join(known)}")
        return names

    return read


def _positive(kind: type) -> Any:
    def read(text: str) -> Any:
        value = kind(text)
        if not value > 0 or not np.isfinite(value):
            raise argparse.ArgumentTypeError(f"{text} is not positive")
        return value

    return read


def _tolerances(text: str) -> list[float]:
    return [_positive(float)(each) for each in text.split(",")]


def _last_core() -> int | None:
    return all_cores()[-1] if can_pin() else None


def _core(text: str) -> int | None:
    if text == "none":
        return None
    if not can_pin() or not text.isdecimal() or int(text) not in all_cores():
        raise argparse.ArgumentTypeError(f'the core must be "none" or one of {all_cores()}; got {text}')
    return int(text)


def _one_of_each_environment(peers: list[Peer]) -> list[Peer]:
    return list({peer.environment: peer for peer in peers}.values())


def _python_or_reason(peer: Peer) -> Path | str:
    try:
        return python_with(peer.requirements, peer.environment)
    except CannotInstallError as error:
        return f"cannot be installed: {one_line(error)}"


if __name__ == "__main__":
    main()
