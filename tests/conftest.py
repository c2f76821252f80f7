"""Robots that many tests share, each loaded once; oracles that read URDFs without pinik."""

from __future__ import annotations

import functools
import warnings
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

import pinik

settings.register_profile(
    "pinik", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)
settings.load_profile("pinik")


@functools.cache
def _loaded(source: str, options: tuple[tuple[str, Any], ...]) -> pinik.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pinik.UrdfWarning)
        return pinik.load(source, **dict(options))


def load_quietly(source: str, **options: Any) -> pinik.Robot:
    """`pinik.load` without its `UrdfWarning`s, once per source and options in a session; do not modify the robot."""
    return _loaded(source, tuple(sorted(options.items())))


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
