"""One part of a plan by solves: the middle of each cell, in each orientation."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..problem.targets import Target
from ..scale.jobs.job import Pause, never_pause
from ..solving.attempts import Outcomes
from ..solving.many import attempt_all
from ..solving.native.codec import goals_of, targets_of
from ..solving.prepared import Prepared
from ..solving.solve_all import find_all
from ..solving.spread import NEAREST
from ..solving.state import Status
from .counts import Counts
from .measures import manipulabilities, rooms
from .plan import Plan

__all__ = ["SolvedParts"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


class SolvedParts:
    """Does the parts of a plan by solves, with its problems compiled once."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan

    @cached_property
    def _position(self) -> Prepared:
        """The problem of each cell, whatever the orientation."""
        return Prepared(self.plan.robot, self.plan.target, self.plan.options)

    @cached_property
    def _posed(self) -> Prepared:
        """The problem of each cell and orientation."""
        plan, orientations = self.plan, self.plan.orientations
        if not orientations.directions:
            return self._position
        asked = plan.target
        common: dict[str, Any] = {"tool": asked.tool, "relative_to": asked.relative_to}
        if orientations.rolls:
            target = Target(asked.frame, (0.0, 0.0, 0.0), rotation=np.eye(3), **common)
        else:
            target = Target(asked.frame, (0.0, 0.0, 0.0), axis=orientations.axis, direction=(0.0, 0.0, 1.0), **common)
        return Prepared(plan.robot, target, plan.options)

    @cached_property
    def _poses(self) -> Array:
        """The numbers of the targets for each orientation (n, 18), at the origin."""
        orientations = self.plan.orientations
        goals = np.tile(goals_of(self._posed.targets), (len(orientations), 1))
        if orientations.rolls:
            goals[:, 3:12] = orientations.rotations.reshape(-1, 9)
        elif orientations.directions:
            goals[:, 12:15] = orientations.vectors
        return goals

    def __call__(self, part: int, pause: Pause = never_pause) -> Counts:
        """Solve for the cells of a part, and count what is reached.

        A cell whose middle cannot be reached in any orientation is not asked for each of them.
        """
        plan = self.plan
        size = plan.part_size
        cells = plan.asked[part * size : (part + 1) * size]
        counts = Counts.empty(cells, len(plan.orientations))
        centers = plan.grid.centers(cells)
        goals = np.zeros((len(cells), 1, 18))
        goals[:, 0, :3] = centers
        rows = np.arange(len(cells))
        if plan.orientations.directions:
            reached = self._solve(self._position, goals).status == Status.CONVERGED
            rows = np.flatnonzero(reached)
        for row in rows:
            pause()
            self._ask(counts, int(row), centers[row])
        return counts.touched()

    def _ask(self, counts: Counts, row: int, center: Array) -> None:
        """Solve for the middle of one cell in each orientation."""
        plan = self.plan
        goals = self._poses.copy()[:, None]
        goals[:, 0, :3] = center
        found = self._solve(self._posed, goals)
        reached = np.flatnonzero(found.status == Status.CONVERGED)
        q, rows = found.q[reached], np.full(len(reached), row)
        measures = manipulabilities(plan.sampler, q, plan.rows) / plan.unit, rooms(plan.sampler, q)
        counts.add(rows, reached, *measures)
        if plan.branches:
            counts.branches[row] += sum(self._branches(goals[k]) for k in reached)

    def _solve(self, prepared: Prepared, goals: Array) -> Outcomes:
        return attempt_all(prepared, goals, self.plan.start[None], nearest=True, threads=1, numbered=False)

    def _branches(self, goals: Array) -> int:
        """The number of distinct answers for a pose that is reached; at least the one that reaches it."""
        findings = find_all(self._searched, targets_of(self._searched.targets, goals), self.plan.start)
        return max(1, len(findings.q))

    @cached_property
    def _searched(self) -> Prepared:
        options = replace(self._posed.options, restarts=NEAREST, max_iterations=None, polish=True)
        return Prepared(self.plan.robot, self._posed.targets, options)
