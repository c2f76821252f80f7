"""The compiled engine follows paths as the Python one does: any robot, method, parameters and kinds of targets.

The paths are short and lie on motions of the robot itself, so that rounding does not lead the engines apart. A step
that sits at a threshold may still do so now and then.
"""

from __future__ import annotations

import collections

import numpy as np
import pinocchio
import pytest
from hypothesis import given, settings

import pinik
from engines import needs_native
from pinik.solving.aims import present
from pinik.solving.walk import Walk
from problems import Problem, problems

pytestmark = needs_native

POINTS = 4
RARELY = 0.03  # the part of paths that may sit at a threshold
SAME = 1e-6  # [rad or m]


def motion(problem: Problem):
    """(the start, the targets of each point), which the robot meets on a small motion from the start."""
    question = pinik.prepare(
        problem.robot, problem.targets, problem.method, engine="python", **problem.parameters, **problem.options
    ).question
    walk, limits = Walk(question), question.limits
    start = limits.clip(limits.wrap(problem.q0))
    step = 0.02 * np.random.default_rng(1).normal(size=problem.robot.model.nv) * question.problem.free
    points, q = [], start
    for _ in range(POINTS):
        q = limits.clip(pinocchio.integrate(problem.robot.model, q, step))
        points.append(present(walk.kinematics, question.problem.targets, q))
    return start, points


@pytest.mark.timeout(600)
def test_paths_and_ticks_are_the_same():
    counts: collections.Counter[str] = collections.Counter()
    wrong = []

    @settings(max_examples=60)
    @given(problems(most_targets=2))
    def compare(problem):
        start, points = motion(problem)
        options = {name: value for name, value in problem.options.items() if name != "trace"} | problem.parameters
        options |= {"method": problem.method, "max_iterations": 30}
        python, native = (
            pinik.track(problem.robot, points, q0=start, engine=engine, restarts=2, **options)
            for engine in ("python", "native")
        )
        counts["paths"] += 1
        if np.abs(python.q - native.q).max() > SAME or (python.status != native.status).any():
            wrong.append(("path", problem))
        trackers = [
            pinik.Tracker(problem.robot, points[0], start, velocity=0.5, engine=engine, **options)
            for engine in ("python", "native")
        ]
        for targets in points:
            ways = [tracker(targets) for tracker in trackers]
        if np.abs(ways[0] - ways[1]).max() > SAME or trackers[0].status is not trackers[1].status:
            wrong.append(("ticks", problem))

    compare()
    assert counts["paths"] >= 50
    assert len(wrong) <= 2.0 * RARELY * counts["paths"], wrong
