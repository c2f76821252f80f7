"""Robots that many tests share, as fixtures, and the settings of the property tests."""

from __future__ import annotations

import os
import sys

import pytest
from hypothesis import HealthCheck, settings

import pinik
from robots import load_quietly

settings.register_profile(
    "pinik",
    deadline=None,
    derandomize=True,
    # Mutation testing runs a test several times in one process, each time as the method of another object.
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.differing_executors],
    print_blob=True,
)
settings.load_profile("pinik")


def pytest_sessionfinish() -> None:
    """Save what coverage has measured: a worker that takes long to end is killed, and would lose it."""
    coverage = sys.modules.get("coverage")
    measuring = coverage.Coverage.current() if coverage else None
    if measuring:
        measuring.save()


@pytest.fixture(scope="session", autouse=True)
def cache_of_our_own(tmp_path_factory: pytest.TempPathFactory) -> None:
    """No test writes into the user's cache folder, nor reads what another version left there."""
    os.environ["PINIK_CACHE_DIR"] = str(tmp_path_factory.mktemp("cache"))


@pytest.fixture(scope="session")
def arm() -> pinik.Robot:
    return load_quietly("arm")


@pytest.fixture(scope="session")
def lion() -> pinik.Robot:
    return load_quietly("lion")


@pytest.fixture(scope="session")
def two_link() -> pinik.Robot:
    return load_quietly("two_link")


@pytest.fixture(scope="session")
def panda() -> pinik.Robot:
    return load_quietly("panda")


@pytest.fixture(scope="session")
def ur5() -> pinik.Robot:
    return load_quietly("ur5")


@pytest.fixture(scope="session")
def z1() -> pinik.Robot:
    return load_quietly("z1")


@pytest.fixture(scope="session")
def kinova() -> pinik.Robot:
    return load_quietly("kinova")


@pytest.fixture(scope="session")
def tiago() -> pinik.Robot:
    return load_quietly("tiago")
