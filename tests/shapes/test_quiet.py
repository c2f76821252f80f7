"""Readers are quiet in their own thread alone."""

from __future__ import annotations

import logging
import threading
import warnings

import numpy as np

from pinik.shapes.meshes import load_shapes
from pinik.shapes.quiet import quiet
from pinik.viewer.web.notebook import draw_beside
from robots import load_quietly


def test_what_a_reader_logs_is_dropped_in_its_thread_and_heard_in_others(caplog):
    logger = logging.getLogger("a reader")
    with quiet(logger):
        with quiet(logger):
            logger.warning("inside")
        logger.warning("still inside")
        other = threading.Thread(target=logger.warning, args=("in another thread",))
        other.start()
        other.join()
    logger.warning("afterwards")
    assert caplog.messages == ["in another thread", "afterwards"]


def test_floating_point_errors_are_no_warnings_within_and_are_again_afterwards():
    with quiet(logging.getLogger("a reader")):
        np.divide(1.0, np.zeros(1))
    assert np.geterr()["divide"] == "warn"


def test_reading_meshes_never_changes_the_filters_of_warnings(monkeypatch):
    """They belong to all threads, and two that change them for a while may leave the wrong ones behind."""

    def refuse(*args, **kwargs):
        raise AssertionError("the filters were changed")

    robots = [load_quietly(name) for name in ("panda", "kinova", "two_link")]  # COLLADA, STL and shapes of URDF
    with monkeypatch.context() as patched:
        patched.setattr(warnings, "catch_warnings", refuse)
        found = [load_shapes(robot) for robot in robots]
        picture = draw_beside(robots[-1], [robots[-1].neutral()], [])
    assert all(shapes and not faults for shapes, faults in found)
    assert picture.pixels.any()
