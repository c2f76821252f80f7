"""Calls that are equal to the last one are solved directly, and all others are not taken for it."""

from __future__ import annotations

import copy
import gc
import inspect
import math
import pickle
import pydoc
import threading
import weakref
from dataclasses import dataclass

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from judge import assert_good
from pinik import SOLVERS, InputError, Tolerance
from pinik.solving import front
from pinik.solving.kept import kept_of
from robots import load_quietly

TIP = "panda_hand_tcp"


class DetourError(Exception):
    """Raised where a call leaves the direct way."""


@pytest.fixture
def place(panda):
    return np.ascontiguousarray(panda.placement(TIP, panda.random(1)).homogeneous)


@pytest.fixture
def only_recalled(monkeypatch):
    """Call this to make every call fail that is not recalled."""

    def fail(*_):
        raise DetourError

    def switch():
        monkeypatch.setattr(front, "answer", fail)
        monkeypatch.setattr(pinik.robot, "answer", fail)

    return switch


@needs_native
@pytest.mark.parametrize(
    "options",
    [{}, {"seed": 3}, {"method": "ccd"}, {"restarts": 2, "time_limit": 5.0}, {"damping": 0.1}, {"locked": ()}],
)
def test_an_equal_call_needs_no_detour(options, panda, place):
    others = [np.ascontiguousarray(panda.placement(TIP, panda.random(seed)).homogeneous) for seed in range(2, 5)]
    starts = [panda.random(7), None, "nearest"]

    def solve(way, place, q0):
        if way == "method":
            return panda.solve(TIP, placement=place, q0=q0, **options)
        return pinik.solve(panda, TIP, placement=place, q0=q0, **options)

    for way in ("method", "function"):
        with pytest.MonkeyPatch.context() as patch:
            for _ in range(2):  # the first call compiles the problem, and the second one finds it
                solve(way, place, None)
            for module in (front, pinik.robot):
                patch.setattr(module, "answer", lambda *_: pytest.fail("a detour"))
            found = [solve(way, M, q0) for M, q0 in zip(others, starts, strict=True)]
        for s, M, q0 in zip(found, others, starts, strict=True):
            expected = pinik.prepare(panda, TIP, placement=M, **options)(M, q0)
            np.testing.assert_array_equal(s.q, expected.q)
            assert (s.status, s.iterations, s.restarts) == (expected.status, expected.iterations, expected.restarts)
            np.testing.assert_array_equal(s.targets[0].rotation, M[:3, :3])
            assert_good(s, {"frame": TIP, "placement": pinocchio.SE3(M)})


@needs_native
def test_positions_and_placements_are_recalled_in_any_form_that_needs_no_conversion(panda, place, only_recalled):
    for _ in range(2):
        panda.solve(TIP, np.array([0.4, 0.1, 0.5]))
    only_recalled()
    assert panda.solve(TIP, np.array([0.4, 0.1, 0.4])).success
    with pytest.raises(DetourError):
        panda.solve(TIP, placement=place)


@needs_native
@pytest.mark.parametrize(
    "other",
    [
        {"seed": 1},
        {"limits": False},
        {"restarts": 0},
        {"method": "jt"},
        {"engine": "native"},
        {"trace": True},
        {"locked": ("panda_joint1",)},
        {"tolerance": (1e-4, 1e-3)},
        {"damping": 0.3},
        {"tool": [0.0, 0.0, 0.1]},
        {"relative_to": "panda_link0"},
        {"weight": 2.0},
        {"limits": 1},
    ],
    ids=str,
)
def test_any_other_argument_is_another_call(other, panda, place, only_recalled):
    for _ in range(2):
        panda.solve(TIP, placement=place, q0=None)
    only_recalled()
    assert panda.solve(TIP, placement=place, q0=None).success
    for arguments in ({"placement": place, "q0": None, **other}, {"placement": place, **other}):
        with pytest.raises(DetourError):
            panda.solve(TIP, **arguments)
    with pytest.raises(DetourError):
        panda.solve("panda_link8", placement=place, q0=None)


@needs_native
def test_another_robot_is_another_call(place, only_recalled):
    one, other = pinik.load("panda"), pinik.load("panda")
    for _ in range(2):
        one.solve(TIP, placement=place)
    only_recalled()
    assert one.solve(TIP, placement=place).robot is one
    with pytest.raises(DetourError):
        other.solve(TIP, placement=place)


def test_arguments_that_change_afterwards_are_read_anew(panda, place):
    tolerance, stiffness, locked = np.array([1e-4, 1e-3]), {"panda_joint1": 1.0}, ["panda_joint1"]
    options = {"tolerance": tolerance, "stiffness": stiffness, "locked": locked}
    for _ in range(3):
        panda.solve(TIP, placement=place, **options)
    tolerance[:], locked[:] = (math.nan, 1.0), []
    with pytest.raises(InputError, match="tolerance"):
        panda.solve(TIP, placement=place, **options)
    tolerance[:] = 1e-3, 1e-2
    stiffness["panda_joint9"] = 1.0
    with pytest.raises(pinik.UnknownNameError, match="panda_joint9"):
        panda.solve(TIP, placement=place, **options)
    assert panda.solve(TIP, placement=place, tolerance=Tolerance(1e-3, 1e-2)).success


def test_what_a_name_of_a_method_means_is_looked_up_each_time(panda, place, monkeypatch):
    for options in ({}, {"method": "dls"}):
        for _ in range(2):
            assert panda.solve(TIP, placement=place, **options).method == "dls"
        monkeypatch.setitem(SOLVERS, "dls", pinik.PseudoInverse)
        assert pinik.solve(panda, TIP, method="dls", placement=place).method == "pinv"
        assert panda.solve(TIP, placement=place, **options).method == "pinv"
        monkeypatch.undo()
        assert panda.solve(TIP, placement=place, **options).method == "dls"


def test_what_is_wrong_is_refused_as_ever(panda, place):
    for _ in range(2):
        panda.solve(TIP, placement=place, q0=panda.neutral())
        panda.solve(TIP, np.array([0.4, 0.1, 0.5]))
    with pytest.raises(InputError, match="position must be 3 finite numbers"):
        panda.solve(TIP, place)
    panda.solve(TIP, placement=place, q0=panda.neutral())
    for wrong in (np.zeros((4, 4)), place[:3], place * math.nan, "here", [1, 2, 3]):
        with pytest.raises(InputError, match="placement must be"):
            panda.solve(TIP, placement=wrong, q0=panda.neutral())
    for wrong in (panda.neutral() * math.nan, "nearby", 3, panda.neutral()[1:]):
        with pytest.raises(InputError, match="q0 must be"):
            panda.solve(TIP, placement=place, q0=wrong)
    with pytest.raises(InputError, match="placement"):
        panda.solve(TIP, np.zeros(3), placement=place)
    with pytest.raises(TypeError):
        panda.solve(TIP, placement=place, targets=TIP)
    with pytest.raises(TypeError):
        pinik.solve()


def test_a_robot_is_freed_with_all_that_it_kept(place):
    robot = pinik.load("panda")
    for _ in range(2):
        s = robot.solve(TIP, placement=place)
    ref = weakref.ref(robot)
    del robot, s
    gc.collect()
    assert ref() is None
    assert load_quietly("panda").solve(TIP, placement=place).success


@needs_native
def test_what_was_dropped_is_compiled_again(place):
    robot = pinik.load("panda")
    expected = robot.solve(TIP, placement=place)
    for _ in range(2):
        assert robot.solve(TIP, placement=place).success
    kept_of(robot).clear()
    gc.collect()
    np.testing.assert_array_equal(robot.solve(TIP, placement=place).q, expected.q)
    assert len(kept_of(robot)) == 1


def test_each_thread_recalls_its_own_call(panda, place):
    expected = {seed: panda.solve(TIP, placement=place, q0="nearest", seed=seed).q for seed in range(4)}
    found: dict[int, list[np.ndarray]] = {}

    def work(seed: int) -> None:
        found[seed] = [panda.solve(TIP, placement=place, q0="nearest", seed=seed).q for _ in range(200)]

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for seed in range(4):
        assert len(found[seed]) == 200
        for q in found[seed]:
            np.testing.assert_array_equal(q, expected[seed])


@dataclass(frozen=True, kw_only=True)
class Asking(pinik.JacobianSolver):
    """A user's own method, which solves another problem on its way."""

    name = "asking"

    def direction(self, J, e):
        inner = load_quietly("ur5")
        for _ in range(2):
            assert inner.solve("tool0", [0.4, 0.1, 0.4]).success
        return np.linalg.lstsq(J, e, rcond=0.1)[0]


def test_a_solve_within_a_solve_is_not_taken_for_it(panda):
    for _ in range(3):
        s = panda.solve(TIP, [0.4, 0.1, 0.5], method=Asking())
        assert s.method == "asking"
        assert s.robot is panda
        assert_good(s, {"frame": TIP, "position": [0.4, 0.1, 0.5]})


def test_it_looks_like_the_function_that_it_is():
    for function in (pinik.solve, pinik.Robot.solve):
        signature = inspect.signature(function)
        assert {"placement", "q0", "tolerance", "solver_parameters"} <= set(signature.parameters)
        assert function.__name__ == "solve"
        assert (inspect.getdoc(function) or "").startswith("Find joint values")
        assert "q0" in pydoc.render_doc(function)
    assert "self" not in inspect.signature(load_quietly("arm").solve).parameters


def test_the_functions_that_recall_are_pickled_and_copied_by_name():
    for function in (pinik.solve, pinik.Robot.solve):
        assert pickle.loads(pickle.dumps(function)) is function
        assert copy.deepcopy(function) is function
