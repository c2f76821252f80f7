"""What parts count adds up to the same bits in any order, and survives its own file."""

from __future__ import annotations

import itertools

import numpy as np

from pinik.workspace.counts import QUANTA, Counts


def part(seed, cells):
    rng = np.random.default_rng(seed)
    own = Counts.empty(np.sort(rng.choice(cells, 6, replace=False)), 10)
    for _ in range(3):
        size = 50
        own.add(rng.integers(0, 6, size), rng.integers(0, 10, size), rng.uniform(0, 3, size), rng.uniform(0, 1, size))
    return own.touched()


def test_parts_add_up_to_the_same_bits_in_any_order():
    cells = np.arange(3, 40)
    parts = [part(seed, cells) for seed in range(4)]
    sums = set()
    for order in itertools.permutations(parts):
        whole = Counts.empty(cells, 10)
        for one in order:
            whole.merge(one)
        sums.add(whole.to_bytes())
    assert len(sums) == 1


def test_sums_are_those_of_the_measures():
    own = Counts.empty(np.array([5, 9]), 4)
    own.add(np.array([0, 0, 1]), np.array([2, 2, 3]), np.array([0.25, 0.5, 2.0]), np.array([1.0, 0.0, 0.5]))
    assert own.found.tolist() == [2, 1]
    assert (own.manipulability / QUANTA).tolist() == [0.75, 2.0]
    assert (own.room / QUANTA).tolist() == [1.0, 0.5]
    assert own.reached.tolist() == [[False, False, True, False], [False, False, False, True]]


def test_counts_survive_their_bytes():
    own = part(1, np.arange(20))
    back = Counts.from_bytes(own.to_bytes(), 10)
    for name, values in vars(own).items():
        np.testing.assert_array_equal(getattr(back, name), values)
