"""What a million placements and 100,000 Jacobians of a Panda's hand cost, on all processor cores.

python -m pytest benchmarks/test_batch_cost.py --benchmark-enable --benchmark-only
"""

from __future__ import annotations

import numpy as np
import pytest

import pinik

FRAME = "panda_hand_tcp"


@pytest.fixture(scope="module")
def panda() -> pinik.Robot:
    return pinik.load("panda")


def configurations(robot: pinik.Robot, count: int) -> np.ndarray:
    return np.random.default_rng(0).uniform(robot.lower_q, robot.upper_q, (count, robot.model.nq))


def test_a_million_placements(benchmark, panda):
    Q = configurations(panda, 1_000_000)
    assert benchmark(panda.placements, FRAME, Q).shape == (1_000_000, 4, 4)


def test_a_hundred_thousand_jacobians(benchmark, panda):
    Q = configurations(panda, 100_000)
    assert benchmark(panda.jacobians, FRAME, Q).shape == (100_000, 6, panda.model.nv)


def test_a_thousand_placements_one_by_one(benchmark, panda):
    Q = configurations(panda, 1000)
    benchmark(lambda: [panda.placement(FRAME, q) for q in Q])
