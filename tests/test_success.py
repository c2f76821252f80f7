"""A sample of the success table: what each method solves at its default settings, judged by plain Pinocchio.

`benchmarks/success.py` makes the whole table, 1,000 targets a row.
"""

from __future__ import annotations

import pytest
from success import PROBLEMS, Row, measure


def solved(method: str, robot: str, frame: str, kind: str, count: int) -> Row:
    row = measure((robot, frame, kind, method, count, 20, {}))
    assert row.wrong_claims == 0
    return row


def rows(*kinds: str) -> pytest.MarkDecorator:
    chosen = [problem for problem in PROBLEMS if problem[2] in kinds]
    return pytest.mark.parametrize(("robot", "frame", "kind"), chosen, ids=["-".join(problem) for problem in chosen])


@rows("pose", "position")
@pytest.mark.parametrize("method", ["dls", "pinv"])
def test_damped_least_squares_and_pseudo_inverse_solve_every_reachable_target(method, robot, frame, kind):
    assert solved(method, robot, frame, kind, 40).solved == 100.0


@rows("position")
def test_ccd_solves_every_reachable_position(robot, frame, kind):
    assert solved("ccd", robot, frame, kind, 20).solved == 100.0


@rows("pose")
def test_ccd_solves_at_least_95_percent_of_the_poses(robot, frame, kind):
    assert solved("ccd", robot, frame, kind, 20).solved >= 95.0


@rows("position")
def test_the_transpose_solves_at_least_99_percent_of_the_positions(robot, frame, kind):
    assert solved("jt", robot, frame, kind, 20).solved >= 99.0
