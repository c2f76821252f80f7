"""How many rows a second `pinik.batch` answers, where the time goes, how much memory it takes, and whether it survives.

    python benchmarks/batch.py                       # rows a second: each format to each, and where the time goes
    python benchmarks/batch.py --memory              # a hundred thousand, a million and ten million rows
    python benchmarks/batch.py --kills 100           # one run, killed at a hundred random moments and resumed
    python benchmarks/batch.py --workers 1 2         # scaling on the workers of a Dask cluster on this machine

The table holds random poses of a Panda's hand, made from random configurations inside the limits; each run is a process
of its own, and the robot is loaded before the clock starts. Both the clock and the processor time are shown: other work
on the machine lengthens the first alone, and the second, shared by the processors, says what the machine could do
without it. Memory is the largest of the process; for it the rows are positions of the planar arm two_link, answered by
its closed form, which makes ten million rows quick and changes nothing in how they are read, kept and written. With
`--kills`, a result that differs in one byte is exit status 1.
"""

from __future__ import annotations

import argparse
import itertools
import json
import platform
import random
import resource
import subprocess
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pinocchio

import pinik
from pinik.scale.columns import Columns
from pinik.scale.jobs.parts import parts_folder
from pinik.scale.tables.formats import FORMATS, format_of, open_source
from pinik.scale.tables.table import Column
from pinik.solving.processors import processors

NAMES = ("x", "y", "z", "qx", "qy", "qz", "qw")
FRAMES = {"panda": "panda_hand_tcp", "two_link": "tip"}
BLOCK = 100_000


def make_table(path: Path, rows: int, name: str = "panda") -> None:
    """Write a table of random reachable poses, or positions of two_link, block by block."""
    robot = pinik.load(name)
    rng = np.random.default_rng(0)
    form = format_of(path, None)
    names = NAMES if name == "panda" else NAMES[:3]
    columns = [Column("id", "whole"), *(Column(own, "number") for own in names)]
    writer = FORMATS[form].writer
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        parts = _Parts(Path(folder))
        for begin in range(0, rows, BLOCK):
            count = min(BLOCK, rows - begin)
            Q = rng.uniform(robot.lower_q, robot.upper_q, (count, robot.model.nq))
            places = robot.placements(FRAMES[name], Q)
            numbers = places[:, :3, 3]
            if name == "panda":
                turns = [pinocchio.Quaternion(M).coeffs() for M in np.ascontiguousarray(places[:, :3, :3])]
                numbers = np.hstack([numbers, turns])
            parts.add(writer.encode(columns, [np.arange(begin, begin + count), *np.ascontiguousarray(numbers.T)]))
        with path.open("wb") as file:
            writer.assemble(columns, parts, file)


class _Parts:
    """Parts of a table, in files."""

    def __init__(self, folder: Path) -> None:
        self._paths: list[Path] = []
        self._folder = folder

    def add(self, content: bytes) -> None:
        self._paths.append(self._folder / str(len(self._paths)))
        self._paths[-1].write_bytes(content)

    def __len__(self) -> int:
        return len(self._paths)

    def __iter__(self):
        return (path.read_bytes() for path in self._paths)

    def open(self, number: int):
        return self._paths[number].open("rb")


def one_run(targets: Path, output: Path, name: str, options: dict) -> None:
    """In a process of its own: run, and print the figures as JSON."""
    robot = pinik.load(name)
    began, used = time.perf_counter(), time.process_time()
    summary = pinik.batch.run(robot, targets, FRAMES[name], output=output, **options)
    figures = {
        "rows": summary.rows,
        "solved": summary.solved,
        "wall": time.perf_counter() - began,
        "cpu": time.process_time() - used,
        "megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    print(json.dumps(figures))


def measured(targets: Path, output: Path, name: str = "panda", **options: object) -> dict[str, float]:
    """The figures of one run."""
    command = [sys.executable, __file__, "--one", str(targets), str(output), name, json.dumps(options)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    figures: dict[str, float] = json.loads(done.stdout)
    return figures


def show_speed(folder: Path, rows: int, pairs: list[tuple[str, str]], start: str | None) -> None:
    titles = f"{'from':8} {'to':8} {'rows/s':>9} {'µs of processor a row':>22} {'rows/s, whole machine':>22} {'MB':>6}"
    print(f"{titles}  solved")
    for source, target in pairs:
        path = folder / f"poses.{source}"
        if not path.exists():
            make_table(path, rows)
        output = folder / f"answers.{target}"
        own = measured(path, output, **({} if start is None else {"q0": start}))
        each = own["cpu"] / own["rows"]
        print(
            f"{source:8} {target:8} {own['rows'] / own['wall']:9,.0f} {1e6 * each:22.2f} {processors() / each:22,.0f} "
            f"{own['megabytes']:6.0f}  {own['solved'] / own['rows']:.4%}",
            flush=True,
        )
        output.unlink()


def show_parts(folder: Path, rows: int) -> None:
    """Where the processor time of a row goes: reading, solving and writing, each alone in one thread."""
    robot = pinik.load("panda")
    print(f"\n{'µs of processor a row':24} " + " ".join(f"{form:>9}" for form in FORMATS))
    reads, writes = [], []
    rng = np.random.default_rng(1)
    for form in FORMATS:
        path = folder / f"poses.{form}"
        if not path.exists():
            make_table(path, rows)
        source = open_source(path, form, 8192)
        cells = Columns.of(source.names, robot).cells
        began = time.thread_time()
        count = sum(len(source.decode(source.raw(number), cells)) for number in range(source.chunks))
        reads.append(1e6 * (time.thread_time() - began) / count)
        source.close()
        columns = [Column("id", "whole"), Column("success", "truth"), Column("status", "text")]
        columns += [Column(f"n{k}", "number") for k in range(10)] + [Column(f"w{k}", "whole") for k in range(2)]
        contents = [np.arange(8192), np.ones(8192, dtype=bool), ["CONVERGED"] * 8192]
        contents += [*rng.normal(size=(10, 8192)), *rng.integers(0, 99, (2, 8192))]
        began = time.thread_time()
        for _ in range(10):
            FORMATS[form].writer.encode(columns, contents)
        writes.append(1e6 * (time.thread_time() - began) / 81_920)
    print(f"{'read once (done twice)':24} " + " ".join(f"{one:9.2f}" for one in reads))
    print(f"{'write':24} " + " ".join(f"{one:9.2f}" for one in writes))
    Q = rng.uniform(robot.lower_q, robot.upper_q, (20_000, robot.model.nq))
    places = robot.placements(FRAMES["panda"], Q)
    pinik.solve_many(robot, FRAMES["panda"], places[:1000])
    began = time.process_time()
    pinik.solve_many(robot, FRAMES["panda"], places)
    print(f"{'solve':24} {1e6 * (time.process_time() - began) / 20_000:9.2f}")


def show_memory(folder: Path, counts: list[int]) -> None:
    print(f"{'rows':>12} {'from':8} {'to':8} {'MB':>6} {'µs of processor a row':>22}")
    for form, rows in itertools.product(("parquet", "csv", "npz"), counts):
        path, output = folder / f"points.{form}", folder / f"answers.{form}"
        make_table(path, rows, "two_link")
        own = measured(path, output, "two_link", method="two_bone")
        assert own["solved"] == rows
        each = 1e6 * own["cpu"] / rows
        print(f"{rows:12,} {form:8} {form:8} {own['megabytes']:6.0f} {each:22.2f}", flush=True)
        path.unlink()
        output.unlink()


def survive(folder: Path, rows: int, kills: int, form: str) -> bool:
    """Whether a run that is killed again and again ends with the bytes of one that is not."""
    targets = folder / "poses.csv"
    make_table(targets, rows)
    whole, output = folder / f"whole.{form}", folder / f"answers.{form}"
    chunk = max(1, rows // (20 * kills))
    figures = measured(targets, whole, chunk=chunk)
    command = [sys.executable, __file__, "--one", str(targets), str(output), "panda"]
    command.append(json.dumps({"chunk": chunk, "resume": True}))
    rng, done, lost, moments = random.Random(0), 0, 0, {"work": 0, "before": 0, "end": 0}
    while done < kills:
        before = {part.name for part in parts_folder(output).glob("*.part")}
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        began = time.monotonic()
        # As many kills as are wanted have to fall into the work, which is why each run gets its share of it.
        until = before if rng.random() < 0.1 else None  # a tenth falls anywhere, also into loading and surveying
        share = rng.uniform(0.0, 2.0) * len(range(0, rows, chunk)) / kills
        while process.poll() is None:
            new = sum(1 for _ in parts_folder(output).glob("*.part")) - len(before)
            if (until is None and new >= share) or (until is not None and time.monotonic() - began > rng.uniform(0, 3)):
                break
            time.sleep(0.001)
        time.sleep(rng.uniform(0.0, 0.02))
        process.kill()
        _, words = process.communicate()
        if process.returncode == 0:
            print(f"the run ended after {done} kills, and a new one begins")
            if output.read_bytes() != whole.read_bytes():
                return False
            continue
        assert process.returncode == -9, words
        done += 1
        after = {part.name for part in parts_folder(output).glob("*.part")}
        lost += 0 if output.exists() else len(before - after)
        moments["work" if after - before else "before" if after == before else "end"] += 1
    measured(targets, output, chunk=chunk, resume=True)
    same = output.read_bytes() == whole.read_bytes()
    print(
        f"{form}: {rows:,} rows in chunks of {chunk}, killed {done} times ({moments['work']} in the work, "
        f"{moments['before']} before it or in its first chunk, {moments['end']} at the end); finished chunks lost: "
        f"{lost}; {'the same' if same else 'OTHER'} bytes; one run without kills takes {figures['wall']:.1f} s"
    )
    return same and not lost and not parts_folder(output).exists()


def show_scaling(folder: Path, rows: int, workers: list[int]) -> None:
    path = folder / "poses.parquet"
    make_table(path, rows)
    here = measured(path, folder / "here.parquet")
    print(f"threads of this process: {here['rows'] / here['wall']:,.0f} rows/s")
    for count in workers:
        robot = pinik.load("panda")
        summary = pinik.batch.run(robot, path, FRAMES["panda"], output=folder / "there.parquet", workers=count)
        same = (folder / "here.parquet").read_bytes() == (folder / "there.parquet").read_bytes()
        bytes_words = "the same bytes" if same else "OTHER BYTES"
        print(f"{count} workers of Dask: {summary.rate:,.0f} rows/s with their start, {bytes_words}")


def main() -> int:
    if sys.argv[1:2] == ["--one"]:
        one_run(Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4], json.loads(sys.argv[5]))
        return 0
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=200_000)
    parser.add_argument("--formats", nargs="*", help="from:to pairs, such as csv:csv", default=None)
    parser.add_argument("--start", help="the start of each solve, such as nearest")
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--workers", type=int, nargs="*")
    parser.add_argument("--memory", type=int, nargs="*", help="numbers of rows")
    given = parser.parse_args()
    libraries = ", ".join(f"{name} {version(name)}" for name in ("pin", "numpy", "pyarrow", "distributed"))
    print(f"pinik {pinik.__version__}, {libraries}; {processors()} processors, {platform.machine()}; seed 0")
    with tempfile.TemporaryDirectory(prefix="pinik-batch-") as name:
        folder = Path(name)
        if given.kills:
            return 0 if all([survive(folder, given.rows, given.kills, form) for form in ("csv", "parquet")]) else 1
        if given.memory is not None:
            show_memory(folder, given.memory or [100_000, 1_000_000, 10_000_000])
            return 0
        if given.workers:
            show_scaling(folder, given.rows, given.workers)
            return 0
        pairs = [tuple(pair.split(":")) for pair in given.formats or []] or [
            (form, form) for form in ("parquet", "csv", "npz", "jsonl")
        ]
        show_speed(folder, given.rows, pairs, given.start)
        if not given.formats:
            show_parts(folder, given.rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
