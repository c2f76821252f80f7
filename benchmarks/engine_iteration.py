"""What an iteration costs in the compiled engine, beside the Pinocchio calls that a plain C++ loop would make.

    python benchmarks/engine_iteration.py [--robot panda --frame panda_hand_tcp] [--count 2000]

Whole solves of poses from random starts, on one thread: all their time over all their iterations (for CCD, sweeps of
all joints). The bare calls are `computeFrameJacobian`, `log3` and `integrate`, compiled here in an environment of their
own; where that does not work, a word says why.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import tempfile
import warnings
from pathlib import Path

import numpy as np
from comparison.environments import CannotInstallError, python_with

import pinik

SOURCE = Path(__file__).parent / "pinocchio_calls"


def bare_calls(urdf: Path, frame: str) -> float | str:
    """Microseconds of Pinocchio's own calls of one iteration, or why that is not known."""
    try:
        python = python_with(["libpinocchio[build]==4.1.0", "cmeel-eigen"], "pinocchio-calls")
        prefix = subprocess.run([python, "-m", "cmeel", "cmake"], check=True, capture_output=True, text=True)
        with tempfile.TemporaryDirectory() as folder:
            setting = f"-DPython_EXECUTABLE={python}"
            _run(["cmake", str(SOURCE), setting, "-DCMAKE_BUILD_TYPE=Release"], folder)
            _run(["cmake", "--build", "."], folder)
            libraries = str(Path(prefix.stdout.strip()) / "lib")
            said = _run(["./pinocchio_calls", str(urdf), frame, "20000"], folder, LD_LIBRARY_PATH=libraries)
    except FileNotFoundError:
        return "not known: there is no cmake"
    except CannotInstallError as error:
        return f"not known: {error}"
    except subprocess.CalledProcessError as error:
        return f"not known: {error.stderr.strip() or error}"
    return float(said.split()[0])


def _run(command: list[str], folder: str, **environment: str) -> str:
    environment = {**os.environ, **environment}
    done = subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True, text=True)
    return done.stdout


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robot", default="panda")
    parser.add_argument("--frame", default="panda_hand_tcp")
    parser.add_argument("--count", type=int, default=2000)
    asked = parser.parse_args()
    warnings.simplefilter("ignore", pinik.UrdfWarning)
    robot, rng = pinik.load(asked.robot), np.random.default_rng(0)
    poses = np.array([robot.placement(asked.frame, robot.random(rng)).homogeneous for _ in range(asked.count)])
    starts = np.array([robot.random(rng) for _ in range(asked.count)])
    bare = bare_calls(Path(robot.description.source), asked.frame)
    print(f"{'bare Pinocchio calls':36} {bare if isinstance(bare, str) else f'{bare:.2f} µs'}")
    for method in ("dls", "jt", "pinv", "ccd"):
        count = asked.count if method in ("dls", "pinv") else asked.count // 10
        many = pinik.solve_many(robot, asked.frame, poses[:count], method, q0=starts[:count], threads=1)
        each = 1e6 * many.time.sum() / many.iterations.sum()
        ratio = "" if isinstance(bare, str) else f"{each / bare:6.2f} times"
        print(
            f"{method + ', an iteration of ' + many.engine:36} {each:.2f} µs {ratio}   "
            f"{100 * many.success.mean():6.2f} % solved, {many.iterations.mean():.0f} iterations"
        )


if __name__ == "__main__":
    main()
