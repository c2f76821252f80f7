"""Many targets from a file, and their answers to a file: in chunks, resumable, and on a cluster.

pinik.batch.run(robot, "poses.csv", "tip", output="answers.csv")
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import pinocchio
from numpy.typing import ArrayLike

from .checks import as_count
from .errors import InputError, InputWarning, PinikError
from .model.robot_model import RobotModel
from .problem.target_values import as_tool
from .problem.tolerance import Tolerance
from .scale.answers import columns_of
from .scale.asked import Reading
from .scale.columns import Columns
from .scale.delivery import AnswersGiven, Delivery
from .scale.identity import identity_of_options, identity_of_robot
from .scale.jobs.fingerprint import Fingerprint, versions
from .scale.jobs.job import Job, Tally
from .scale.jobs.runners import runner_of
from .scale.solving import Solving
from .scale.summary import Summary
from .scale.survey import Survey, digest_of, survey
from .scale.tables.parquet import pyarrow_version
from .scale.targets_file import TargetsFile, TargetsGiven, opened
from .shapes.avoid import Avoided
from .solvers.registry import Method
from .solving.options import OPTION_NAMES, Options
from .solving.origin import Origin
from .solving.prepared import Prepared
from .solving.words import check_words

__all__ = ["OnProgress", "run"]

OnProgress = Callable[[Tally, int], None]
"""Is told after each chunk how far the work is, and how many rows there are."""

_ROWS_IN_A_CHUNK = 8192

_KEYWORDS = (
    "output", "form", "targets_form", "tool", "relative_to", "q0", "degrees", "skip_bad", "resume", "times", "chunk",
    "threads", "workers", "scheduler", "on_bad", "on_progress", *(name for name in OPTION_NAMES if name != "trace"),
)  # fmt: skip


def run(
    robot: RobotModel,
    targets: TargetsGiven,
    frame: str | None = None,
    method: Method = "dls",
    *,
    output: AnswersGiven,
    form: str | None = None,
    targets_form: str | None = None,
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    q0: ArrayLike | Mapping[str, float] | str | None = None,
    limits: bool = True,
    locked: Iterable[str] = (),
    restarts: int | None = None,
    seed: int = 0,
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
    time_limit: float | None = None,
    engine: str = "auto",
    polish: bool = True,
    choose: str = "first",
    choose_weights: Mapping[str, float] | None = None,
    avoid: Avoided = None,
    degrees: bool = False,
    skip_bad: bool = False,
    resume: bool = False,
    times: bool = False,
    chunk: int = _ROWS_IN_A_CHUNK,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    on_bad: Callable[[str], None] | None = None,
    on_progress: OnProgress | None = None,
    **solver_parameters: Any,
) -> Summary:
    """Answer every row of a table of targets, independently of all others, and write a table of answers.

    The formats are CSV, JSON Lines, NPZ and Parquet; docs/scale.md lists the columns. The rows keep their order. Each
    answer depends on its row, the robot and the options alone: not on the other rows, on chunks, threads or workers.
    Except for a column of times and under a time limit, the output has the same bytes in every run with the same
    versions.

    Until the output is whole, finished chunks are kept in the folder OUTPUT.parts. After an error, an interrupt or the
    death of the process, `resume` goes on with them.

    Args:
        robot: The robot.
        targets: The file with the targets, or an open binary stream of them.
        frame: The frame to move in rows that name none.
        method: As for `pinik.solve`.
        output: The file for the answers, or an open binary stream.
        form: The format of the output: "csv", "jsonl", "npz" or "parquet"; by the ending of its name when None, and
            CSV for a stream.
        targets_form: The format of the targets, likewise; for a stream by how it begins.
        tool, relative_to: As for `Target`, in all rows.
        q0: The start of rows and joints that give none, as for `pinik.solve`.
        limits, locked, restarts, seed, max_iterations, tolerance, engine, polish, choose, choose_weights, avoid: As for
            `pinik.solve`. A row's own tolerance comes first.
        time_limit: Time limit for each row [s].
        degrees: Whether angles in CSV are in degrees, in both tables; all others are in radians.
        skip_bad: Whether faulty rows are left out, instead of being an error before any work.
        resume: Whether to go on with an earlier run that did not end, if there is one.
        times: Whether the answers have a column with the duration of each solve.
        chunk: The number of rows in a chunk.
        threads: The number of threads; one for each processor available to this process when None.
        workers: The number of worker processes of a Dask cluster on this machine, in place of threads.
        scheduler: The address of the scheduler of a Dask cluster, in place of threads.
        on_bad: Takes each faulty row in words, if they are left out.
        on_progress: Is told after each chunk how far the work is, in any thread.
        **solver_parameters: Parameters of the solver.

    Raises:
        InputError: The table or a row of it is faulty; the message names file, line and column. Or an argument is
            faulty, or the earlier run was another one.
        UnknownNameError, EngineError: As for `pinik.solve`.
        MissingExtraError: Parquet needs pyarrow, a cluster dask and distributed, and they are not installed.
        ClusterError: The cluster cannot be used.
        OSError: A file cannot be read or written.

    Warns:
        InputWarning: Roll, pitch and yaw of a row look like degrees, and are taken as radians.
    """
    if not isinstance(robot, RobotModel):
        raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
    check_words(method, solver_parameters, _KEYWORDS)
    options = Options.of(
        method, solver_parameters, limits=limits, locked=locked, restarts=restarts, seed=seed,
        max_iterations=max_iterations, tolerance=tolerance, time_limit=time_limit, engine=engine,
        polish=polish, choose=choose, choose_weights=choose_weights, avoid=avoid,
    )  # fmt: skip
    runner = runner_of(workers, scheduler, threads)
    delivery = Delivery.of(output, form, resume)
    rows = as_count(chunk, "chunk")
    with opened(targets, targets_form, rows) as table:
        delivery.check_not(table.path)
        reading = _reading(robot, table, frame, tool, relative_to, options.tolerance, q0, degrees)
        found = _surveyed(table, reading, (on_bad or _unsaid) if skip_bad else None)
        _check_kinds(found, reading, options)
        if found.like_degrees:
            warnings.warn(
                f"{found.like_degrees}: roll, pitch and yaw go beyond a full turn in radians, and look like degrees; "
                "--deg (degrees=True) takes the angles of a CSV file as degrees",
                InputWarning,
                stacklevel=2,
            )
        columns = columns_of(robot, whole_ids=found.whole_ids, times=times)
        work = Solving(reading, options, columns, table.form, delivery.form, degrees and delivery.form == "csv")
        fingerprint = _fingerprint(work, digest_of(table.path), rows)
        job = Job(fingerprint, table.source.chunks, lambda number: found.chunk(table.source, number), work)
        good = found.rows - found.faulty
        began = time.perf_counter()
        tell = None if on_progress is None else lambda tally: on_progress(tally, good)
        tally = delivery.run(job, columns, runner, tell)
        return Summary.of(found.rows, found.faulty, tally, time.perf_counter() - began)


def _unsaid(words: str) -> None:
    """Faulty rows that nobody wants to hear of."""


def _reading(
    robot: RobotModel,
    table: TargetsFile,
    frame: str | None,
    tool: pinocchio.SE3 | ArrayLike | None,
    relative_to: str | None,
    tolerance: Tolerance,
    q0: ArrayLike | Mapping[str, float] | str | None,
    degrees: bool,
) -> Reading:
    for name in (frame, relative_to):
        if name is not None:
            robot.frame_id(name)
    try:
        columns = Columns.of(table.source.names, robot)
    except PinikError as error:
        raise InputError(f"{table.label}: {error}") from None
    origin = Origin.of(robot, q0)
    if origin.nearest and columns.starts:
        raise InputError(f"{table.label}: the column 'start.{columns.starts[0]}' contradicts q0='nearest'")
    point = None if tool is None else as_tool(tool, "tool")
    in_degrees = degrees and table.form == "csv"
    return Reading(robot, columns, frame, point, relative_to, tolerance, origin, in_degrees)


def _surveyed(table: TargetsFile, reading: Reading, on_bad: Callable[[str], None] | None) -> Survey:
    """The survey of a table; InputError if rows are faulty and are not to be left out.

    Args:
        table: The table.
        reading: How it is read.
        on_bad: Takes each fault, if faulty rows are left out; None if they are an error.
    """
    first: list[str] = []

    def keep_first(words: str) -> None:
        if not first:
            first.append(words)

    found = survey(table.source, reading, table.label, on_bad or keep_first)
    if found.faulty and on_bad is None:
        words = first[0]
        if found.faulty > 1:
            words += f"; {found.faulty - 1:,} more {'row is' if found.faulty == 2 else 'rows are'} faulty"
        raise InputError(f"{words}; --skip-bad (skip_bad=True) leaves out faulty rows")
    if found.faulty == found.rows:
        raise InputError(f"{table.label}: there is no row without a fault")
    return found


def _check_kinds(found: Survey, reading: Reading, options: Options) -> None:
    """Check before any work that the method can answer each kind of row."""
    for kind, place in found.kinds.items():
        try:
            Prepared(reading.robot, (reading.pattern(kind),), options)
        except InputError as error:
            if error.argument is not None:
                raise
            raise InputError(f"{place}: {error}") from None


def _fingerprint(work: Solving, targets: str, rows: int) -> Fingerprint:
    reading = work.reading
    origin = reading.origin
    parquet = {"pyarrow": pyarrow_version()} if work.output == "parquet" else {}
    return {
        "targets": {"sha256": targets, "format": work.form, "frame": reading.frame, "degrees": reading.degrees},
        "tool": None if reading.tool is None else reading.tool.homogeneous.tolist(),
        "relative_to": reading.relative_to,
        "start": {"q": origin.q.tolist(), "nearest": origin.nearest, "turned": dict(origin.turned)},
        "options": identity_of_options(work.options),
        "robot": identity_of_robot(reading.robot, work.options),
        "output": {"format": work.output, "degrees": work.degrees, "columns": [column.name for column in work.columns]},
        "chunk": rows,
        "versions": {**versions(), **parquet},
    }
