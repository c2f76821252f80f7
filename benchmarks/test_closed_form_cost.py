"""What a million targets cost two bones; the aim is half a second, and for certified answers of a robot four.

python -m pytest benchmarks/test_closed_form_cost.py --benchmark-enable --benchmark-only
"""

from __future__ import annotations

import numpy as np

import pinik

COUNT = 1_000_000


def test_a_million_targets_in_the_plane(benchmark):
    targets = np.random.default_rng(0).uniform(-1.0, 1.0, (COUNT, 2))
    benchmark(pinik.two_bone, 0.5, 0.4, targets)


def test_a_million_targets_in_space(benchmark):
    rng = np.random.default_rng(0)
    targets, poles = rng.uniform(-1.0, 1.0, (COUNT, 3)), rng.normal(size=(COUNT, 3))
    benchmark(pinik.two_bone, 0.5, 0.4, targets, poles)


def test_a_million_solves_of_a_robot(benchmark):
    robot = pinik.load("two_link")
    targets = np.column_stack([np.random.default_rng(0).uniform(-0.6, 0.6, (COUNT, 2)), np.zeros(COUNT)])
    many = benchmark.pedantic(pinik.solve_many, (robot, "tip", targets, "two_bone"), rounds=1)
    assert many.success.mean() > 0.5


def test_the_points_of_a_million_answers(benchmark):
    targets = np.random.default_rng(0).uniform(-1.0, 1.0, (COUNT, 2))
    benchmark.pedantic(lambda answers: answers.tips, setup=lambda: ((pinik.two_bone(0.5, 0.4, targets),), {}), rounds=5)
