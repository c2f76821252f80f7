"""Robots that many tests share, each loaded once in a session."""

from __future__ import annotations

import functools
import warnings
from typing import Any

import pinik


def load_quietly(source: str, **options: Any) -> pinik.Robot:
    """`pinik.load` without its warnings, once per source and options; the robot is shared: do not modify it."""
    return _loaded(source, tuple(sorted(options.items())))


@functools.cache
def _loaded(source: str, options: tuple[tuple[str, Any], ...]) -> pinik.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pinik.UrdfWarning)
        return pinik.load(source, **dict(options))
