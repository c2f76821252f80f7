"""How many connections an address may have, and its budget of requests."""

from __future__ import annotations

import pytest

from pinik.viewer.web.guests import Guests
from stand_ins import Clock


def test_an_address_has_at_most_64_connections_and_all_together_128():
    guests = Guests()
    assert [guests.enter("10.0.0.1") for _ in range(64)] == [""] * 64
    assert guests.enter("10.0.0.1") == "at most 64 connections may be open from one address"
    assert [guests.enter("10.0.0.2") for _ in range(64)] == [""] * 64
    assert guests.enter("10.0.0.3") == "at most 128 connections may be open"
    assert len(guests) == 128
    guests.leave("10.0.0.1")
    assert guests.enter("10.0.0.3") == ""


def test_an_address_keeps_its_debt_when_it_comes_back():
    clock = Clock()
    guests = Guests(clock)
    guests.enter("10.0.0.1")
    guests.budget("10.0.0.1").spend(500.0)
    guests.leave("10.0.0.1")
    for k in range(1000):  # more addresses than are remembered
        guests.enter(f"10.1.0.{k}")
        guests.leave(f"10.1.0.{k}")
    assert guests.budget("10.0.0.1").delay == pytest.approx(1.0)
    assert guests.budget("10.0.0.2").delay == 0.0


def test_addresses_that_owe_nothing_are_forgotten():
    guests = Guests()
    for k in range(10_000):
        guests.enter(f"10.{k // 256}.0.{k % 256}")
        guests.leave(f"10.{k // 256}.0.{k % 256}")
    assert len(guests._guests) <= 256


def test_all_addresses_together_have_a_budget_of_requests():
    clock = Clock()
    guests = Guests(clock)
    guests.all_requests.spend(1200.0)
    assert guests.all_requests.delay == 0.0
    guests.all_requests.spend(600.0)
    assert guests.all_requests.delay == pytest.approx(2.0)
