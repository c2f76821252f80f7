"""The function `reach`: a map of what a robot can reach, or what it reaches of a list of targets."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike

from ..checks import FARTHEST, as_count, as_positive_number
from ..errors import InputError, UnknownNameError
from ..files import check_writable
from ..problem.reach import reach_bounds
from ..problem.targets import Target
from ..problem.tolerance import Tolerance
from ..robot import Robot
from ..scale.jobs.run import OnProgress
from ..scale.jobs.runners import runner_of
from ..shapes.avoid import Avoided
from ..solvers.registry import Method
from ..solving.options import OPTION_NAMES, Options
from ..solving.origin import Origin
from ..solving.sampling import Sampler
from ..solving.words import check_words
from .counts import Counts
from .files import check_suffix, content_of
from .grid import Grid, readable_size
from .orientations import Orientations
from .plan import Plan, size_of_parts
from .reach_map import ReachMap
from .run import run_plan, run_plan_to

__all__ = ["WAYS", "reach"]

WAYS = ("sampling", "solving")
"""The ways to find what is reached."""

DIRECTIONS, ROLLS = 48, 12
RESTARTS = 16
MAX_ITERATIONS = 20

_SAMPLES, _SAMPLES_OF_POSITIONS = 10_000_000, 2_000_000
_CELLS = 12  # between the base and the edge of what is reached
_PROBES = 2**14
_MOST_BINS = 2**32  # as many bytes
_KEYWORDS = ("by", "cell", "box", "samples", "directions", "rolls", "axis", "branches", "tool", "relative_to", "q0",
             "output", "resume", "workers", "scheduler",
             "on_progress", *OPTION_NAMES)  # fmt: skip


def reach(
    robot: Robot,
    frame: str,
    method: Method = "dls",
    *,
    by: str = "sampling",
    cell: float | None = None,
    box: ArrayLike | None = None,
    samples: int | None = None,
    directions: int | None = None,
    rolls: int | None = None,
    axis: str | ArrayLike = "z",
    branches: bool = False,
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    q0: ArrayLike | Mapping[str, float] | None = None,
    limits: bool = True,
    locked: Iterable[str] = (),
    restarts: int = RESTARTS,
    seed: int = 0,
    max_iterations: int = MAX_ITERATIONS,
    tolerance: Tolerance | ArrayLike | None = None,
    engine: str = "auto",
    avoid: Avoided = None,
    output: str | os.PathLike[str] | None = None,
    resume: bool = False,
    workers: int | None = None,
    scheduler: str | None = None,
    on_progress: OnProgress | None = None,
    **solver_parameters: Any,
) -> ReachMap:
    """Map what a frame can reach: for each cell of a grid, in which orientations, how well, and how near the limits.

    By sampling, random configurations say where the frame can be: millions of them a minute, and a cell counts in an
    orientation as soon as one of them is there. By solving, the middle of each cell is solved for in each orientation,
    which takes longer, but misses nothing that the solver finds.

    Args:
        robot: The robot.
        frame: The name of the frame.
        method: The method of the solves, as for `pinik.solve`.
        by: "sampling" or "solving".
        cell: The length of the cells' edges [m]; when None, a round number about a twelfth of the frame's reach.
        box: The lower and the upper corner (2, 3) [m] of the part of space to map; all that is within reach when None.
        samples: The number of random configurations; 10 million when None, or 2 million if only positions count.
        directions: The number of approach directions that are told apart, evenly spread; 0 if any orientation counts.
            When None, 48 if at least five joint axes move the frame, else 0.
        rolls: The number of rolls about each direction; 0 if any roll counts. When None, 12 if at least six joint axes
            move the frame, else 0.
        axis: The approach axis of the frame: "x", "y", "z", "-x", "-y", "-z" or three numbers.
        branches: Whether to count the distinct answers to each pose that is reached; by solving, and only where the
            joint axes are as many as the numbers that are asked for.
        tool: The point of the frame that reaches, or its placement in the frame, as for `Target`.
        relative_to: The frame that takes the place of the world.
        q0: The configuration of all joints that do not move the frame; neutral when None. Solves start near each place.
        limits, locked, seed, engine: As for `pinik.solve`.
        restarts, max_iterations: As for `pinik.solve`, but fewer by default: most poses that are not found within these
            cannot be reached.
        tolerance: The errors that count as reached by a solve; 1e-4 m and 1e-3 rad when None.
        avoid: What must not be touched: "self", a World, or both, as for `pinik.solve`.
        output: A file for the map, as for `ReachMap.save`. What is finished before it is whole is kept in the folder
            OUTPUT.parts.
        resume: Whether to go on with an earlier call with this output that was interrupted.
        workers: The number of worker processes; threads of this process when None.
        scheduler: The address of a Dask scheduler whose workers do the work instead.
        on_progress: Is told how far the work is: called with a tally of its parts, `finished` of `chunks`.
        **solver_parameters: Parameters of the solver.

    Returns:
        The map. It does not depend on the number of processors.

    Raises:
        UnknownNameError, InputError, EngineError: As for `pinik.solve`.
        MissingExtraError: The packages for the file or the cluster are not installed.
        ClusterError: The cluster cannot be used.
        OSError: The file cannot be written.
    """
    check_words(method, solver_parameters, _KEYWORDS)
    options = Options.of(
        method, solver_parameters, limits=limits, locked=locked, restarts=restarts, seed=seed,
        max_iterations=max_iterations, tolerance=tolerance, engine=engine, polish=False, avoid=avoid,
    )  # fmt: skip
    plan = make_plan(
        robot, frame, options, by=by, cell=cell, box=box, samples=samples, directions=directions, rolls=rolls,
        axis=axis, branches=branches, tool=tool, relative_to=relative_to, q0=q0,
    )  # fmt: skip
    runner = runner_of(workers, scheduler)
    if output is None:
        if resume:
            raise InputError("needs output=, the file of the earlier call", argument="resume")
        return map_of(plan, robot, run_plan(plan, runner, on_progress))
    path = Path(output)
    check_suffix(path)
    check_writable(path)

    def write(counts: Counts) -> bytes:
        return content_of(map_of(plan, robot, counts), path)

    counts = run_plan_to(plan, path, write, runner, resume=resume, on_progress=on_progress)
    return ReachMap.load(path, robot) if counts is None else map_of(plan, robot, counts)


def make_plan(
    robot: Robot,
    frame: str,
    options: Options,
    *,
    by: str,
    cell: float | None,
    box: ArrayLike | None,
    samples: int | None,
    directions: int | None,
    rolls: int | None,
    axis: str | ArrayLike,
    branches: bool,
    tool: pinocchio.SE3 | ArrayLike | None,
    relative_to: str | None,
    q0: ArrayLike | Mapping[str, float] | None,
) -> Plan:
    """The plan for the arguments of `reach`, which are checked."""
    if not isinstance(robot, Robot):
        raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
    if by not in WAYS:
        raise UnknownNameError("way", by, WAYS)
    target = Target(frame, (0.0, 0.0, 0.0), tool=tool, relative_to=relative_to)
    start = Origin.of(robot, q0, searches=False).q
    sampler = Sampler(robot, target, start, locked=options.locked, limits=options.limits)
    axes = len(sampler.drawn)
    if not axes:
        raise InputError(f"must be one that joints move; none moves {frame!r}", argument="frame")
    if directions is None:
        directions = DIRECTIONS if axes >= 5 else 0
    if rolls is None:
        rolls = ROLLS if axes >= 6 else 0
    orientations = Orientations(directions, rolls, axis)
    if by == "solving":
        if samples is not None:
            raise InputError('needs by="sampling"', argument="samples")
        count = 0
    else:
        usual = _SAMPLES if orientations.directions else _SAMPLES_OF_POSITIONS
        count = usual if samples is None else as_count(samples, "samples")
    if branches:
        _check_branches(count, axes, orientations)
    grid = _grid(sampler, cell, box)
    if len(grid) * len(orientations) > _MOST_BINS:
        raise InputError(
            f"{len(grid)} cells times {len(orientations)} orientations are too many; at most {_MOST_BINS} are "
            "possible: choose larger cells, a smaller box, or fewer directions and rolls"
        )
    size = size_of_parts(count, len(orientations))
    return Plan(robot, target, grid, orientations, count, bool(branches), sampler.start, options, size)


def _check_branches(samples: int, axes: int, orientations: Orientations) -> None:
    numbers = 3 if not orientations.directions else 5 if not orientations.rolls else 6
    if samples:
        raise InputError('needs by="solving"', argument="branches")
    if axes > numbers:
        raise InputError(
            f"{axes} joint axes for {numbers} numbers that are asked for leave infinitely many answers; lock joints, "
            "or ask for more",
            argument="branches",
        )


def _grid(sampler: Sampler, cell: float | None, box: ArrayLike | None) -> Grid:
    """The cells: those of the box, or of all that may be within reach."""
    size = None if cell is None else as_positive_number(cell, "cell", "metres")
    if size is not None and size > FARTHEST:
        raise InputError(f"must be at most {FARTHEST:g} m; got {size:g}", argument="cell")
    bounds = reach_bounds(sampler.problem.terms[0], sampler.limits)
    points = sampler.placements(sampler.configurations(0, _PROBES))[:, :3, 3]
    lower, upper = points.min(axis=0), points.max(axis=0)
    if bounds is not None:
        center, half = bounds.base, np.full(3, bounds.reach)
        flat = upper - lower < 1e-9 * (1.0 + bounds.reach)  # an arm in a plane needs one layer of cells
        center = np.where(flat, 0.5 * (lower + upper), center)
        half = np.where(flat, 0.0, half)
    else:
        center, half = 0.5 * (lower + upper), 0.6 * (upper - lower)
    if size is None:
        size = readable_size(max(float(half.max()), 1e-6) / _CELLS)
    return Grid.around(center, half, size) if box is None else Grid.in_box(box, size)


def map_of(plan: Plan, robot: Robot, counts: Counts) -> ReachMap:
    """The map that a plan came to."""
    target = plan.target
    return ReachMap(
        robot=robot.name,
        frame=target.frame,
        relative_to=target.relative_to,
        tool=None if target.tool is None else np.array(target.tool.homogeneous),
        grid=plan.grid,
        orientations=plan.orientations,
        samples=plan.samples,
        counts_branches=plan.branches,
        unit=plan.unit,
        counts=counts,
        machine=robot,
    )
