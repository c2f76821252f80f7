"""Budgets and turns, with a clock that the test advances."""

from __future__ import annotations

import asyncio

import pytest

from pinik.viewer.web.budget import Budget, Turns
from stand_ins import PATIENCE, Clock


@pytest.fixture
def clock():
    return Clock()


def test_a_budget_can_be_spent_at_once_and_then_at_its_pace(clock):
    budget = Budget(10.0, 5.0, clock)
    for _ in range(5):
        assert budget.delay == 0.0
        budget.spend(1.0)
    budget.spend(1.0)
    assert budget.delay == pytest.approx(0.1)
    clock.now += 0.1
    assert budget.delay == pytest.approx(0.0)


def test_a_budget_never_saves_more_than_its_most(clock):
    budget = Budget(10.0, 5.0, clock)
    clock.now += 1000.0
    budget.spend(6.0)
    assert budget.delay == pytest.approx(0.1)


def test_a_budget_is_full_again_once_all_of_it_has_grown_back(clock):
    budget = Budget(10.0, 5.0, clock)
    assert budget.is_full
    budget.spend(1.0)
    clock.now += 0.05
    assert not budget.is_full
    clock.now += 0.06
    assert budget.is_full


def test_work_is_done_in_the_order_in_which_it_is_asked_for_and_takes_at_most_a_quarter_of_the_time(monkeypatch):
    clock, done = Clock(), []

    async def sleep(seconds):
        clock.now += seconds + 1e-6  # no sleep is exact

    def work(name):
        done.append(name)
        clock.now += 0.1

    async def ask():
        monkeypatch.setattr(asyncio, "sleep", sleep)
        turns = Turns(clock, clock)
        return await asyncio.gather(*(turns.take(lambda k=k: work(k)) for k in range(20)))

    spent = asyncio.run(asyncio.wait_for(ask(), PATIENCE))
    assert done == list(range(20))
    assert spent == pytest.approx([0.1] * 20)
    assert 0.2 < 20 * 0.1 / clock.now <= 0.25


def test_work_that_fails_gives_up_its_turn():
    def fail():
        raise ZeroDivisionError

    async def ask():
        turns = Turns()
        with pytest.raises(ZeroDivisionError):
            await turns.take(fail)
        return await turns.take(lambda: None)

    assert asyncio.run(asyncio.wait_for(ask(), PATIENCE)) >= 0.0
