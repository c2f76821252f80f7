"""How many reachable targets each method solves, judged by plain Pinocchio: the table of docs/solvers.md.

Targets are placements at random configurations of each robot's own range, starts are random as well, settings are
the defaults. A target counts as solved when plain forward kinematics puts the frame within 1 mm and 0.01 rad of it
and every joint is inside its limits, whatever the solver says.

    python benchmarks/success.py --poses 1000 --methods dls pinv ccd jt --robots panda ur5
"""

from __future__ import annotations

import argparse
import json
import platform
import sys
import time
import warnings
from dataclasses import asdict, dataclass
from multiprocessing import Pool
from pathlib import Path

import numpy as np
import pinocchio

import pinik

sys.path.append(str(Path(__file__).parents[1] / "tests"))  # the judge

from judge import is_good

NEAR = (1e-3, 1e-2)  # [m], [rad]: what counts as solved

PAWS = ("left_fore_paw", "right_fore_paw", "left_hind_paw", "right_hind_paw", "nose", "tail_tip")
ARMS = {
    "panda": "panda_hand_tcp",
    "ur5": "tool0",
    "z1": "gripperStator",
    "xarm7": "link_eef",
    "kinova": "j2s6s200_end_effector",
}
PROBLEMS = [
    *[(robot, frame, "pose") for robot, frame in ARMS.items()],
    *[(robot, frame, "position") for robot, frame in ARMS.items()],
    ("so101", "gripper_frame_link", "position"),
    ("arm", "tip", "position"),
    ("two_link", "tip", "position"),
    *[("lion", frame, "position") for frame in PAWS],
]


@dataclass
class Row:
    """One robot, frame and kind of target, by one method."""

    robot: str
    frame: str
    kind: str
    method: str
    poses: int
    solved: float
    claimed: float
    wrong_claims: int
    median_ms: float
    mean_ms: float
    p99_ms: float
    mean_iterations: float
    mean_restarts: float


def measure(job: tuple[str, str, str, str, int, int, dict]) -> Row:
    """Solve all targets of one row."""
    name, frame, kind, method, poses, seed, options = job
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pinik.UrdfWarning)
        robot = pinik.load(name)
    rng = np.random.default_rng(seed)
    solved = claimed = wrong = 0
    times, iterations, restarts = [], [], []
    for _ in range(poses):
        wanted = robot.placement(frame, robot.random(rng))
        start = robot.random(rng)
        asked = {"frame": frame, **({"placement": wanted} if kind == "pose" else {"position": wanted.translation})}
        target = pinik.Target(**asked)
        began = time.perf_counter()
        s = pinik.solve(robot, target, method, q0=start, **options)
        times.append(time.perf_counter() - began)
        right = is_good(robot, asked, s.q, NEAR)
        solved += right
        claimed += s.success
        wrong += s.success and not right
        iterations.append(s.iterations)
        restarts.append(s.restarts)
    ms = 1e3 * np.array(times)
    return Row(
        name, frame, kind, method, poses, 100 * solved / poses, 100 * claimed / poses, wrong,
        float(np.median(ms)), float(ms.mean()), float(np.percentile(ms, 99)),
        float(np.mean(iterations)), float(np.mean(restarts)),
    )  # fmt: skip


def main() -> None:
    """Run the rows asked for and print them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=1000)
    parser.add_argument("--methods", nargs="+", default=list(pinik.SOLVERS))
    parser.add_argument("--robots", nargs="+")
    parser.add_argument("--kinds", nargs="+", default=["pose", "position"])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--options", type=json.loads, default={}, help="JSON of further options of solve")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    jobs = [
        (robot, frame, kind, method, arguments.poses, arguments.seed, arguments.options)
        for method in arguments.methods
        for robot, frame, kind in PROBLEMS
        if kind in arguments.kinds and (not arguments.robots or robot in arguments.robots)
    ]
    versions = f"pinocchio {pinocchio.__version__}, numpy {np.__version__}, Python {platform.python_version()}"
    about = f"{versions}, {platform.machine()}"
    print(
        f"# {about}, seed {arguments.seed}, {arguments.poses} targets a row, options {arguments.options or 'default'}"
    )
    print(f"{'robot':9} {'frame':22} {'kind':9} {'method':5} {'solved':>7} {'claimed':>8} {'wrong':>5} "
          f"{'median':>8} {'mean':>8} {'p99':>8} [ms] {'iter.':>7} {'restarts':>8}")  # fmt: skip
    rows = []
    with Pool(arguments.processes) as pool:
        for row in pool.imap(measure, jobs):
            rows.append(asdict(row))
            print(f"{row.robot:9} {row.frame:22} {row.kind:9} {row.method:5} {row.solved:6.1f}% {row.claimed:7.1f}% "
                  f"{row.wrong_claims:5} {row.median_ms:8.2f} {row.mean_ms:8.2f} {row.p99_ms:8.2f}      "
                  f"{row.mean_iterations:7.1f} {row.mean_restarts:8.2f}", flush=True)  # fmt: skip
    if arguments.json:
        print(json.dumps({"schema": 1, "about": about, "rows": rows}))


if __name__ == "__main__":
    main()
