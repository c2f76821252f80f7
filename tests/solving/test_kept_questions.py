"""What `solve` compiled for one question is used again for the same one, and for no other."""

from __future__ import annotations

import math
import pickle
import sys
from dataclasses import dataclass

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from pinik import SOLVERS, Target
from robots import load_quietly

TIP = "panda_hand_tcp"


@dataclass(frozen=True, kw_only=True)
class Lazy(pinik.JacobianSolver):
    """Goes nowhere: whoever uses it fails."""

    name = "lazy"

    def direction(self, J, e):
        return 0.0 * (J.T @ e)


@pytest.fixture(params=["place", "position", "targets"])
def solve(request, panda):
    """`Robot.solve` and `pinik.solve` by the ways in which they keep what they compiled."""
    pose = pinocchio.SE3(np.diag([1.0, -1.0, -1.0]), np.array([0.45, 0.1, 0.4]))
    if request.param == "place":
        return lambda **options: panda.solve(TIP, placement=pose, **options)
    if request.param == "position":
        return lambda **options: panda.solve(TIP, [0.45, 0.1, 0.4], **options)
    return lambda **options: pinik.solve(panda, Target(TIP, placement=pose), **options)


VARIANTS = [
    {}, {"tolerance": (1e-9, 1e-9)}, {"tolerance": (1e-9, 1e-3)}, {"tolerance": [1e-9, 1e-9]}, {"method": "pinv"},
    {"method": "ccd"}, {"method": "dls", "damping": 1}, {"damping": 0.1}, {"limits": False}, {"restarts": 0},
    {"restarts": 0, "max_iterations": 2}, {"locked": ("panda_joint1",)}, {"locked": ["panda_joint2"]}, {"locked": []},
    {"method": "pinv", "rest_posture": {"panda_joint1": 1.0}},
    {"method": "pinv", "rest_posture": {"panda_joint1": -1.0}},
    {"engine": "python"}, {"trace": True}, {"step_size": 0.5}, {"target_jacobian": True}, {"seed": 3},
    {"method": pinik.CCD}, {"method": pinik.CCD(relaxation=1.0)}, {"method": pinik.CCD(relaxation=1.5)},
    {"method": Lazy}, {"time_limit": 5.0}, {"max_step": 0.1}, {"q0": "nearest"},
]  # fmt: skip


def test_options_are_part_of_the_question(solve):
    """Asked in turn, with others between, each gives what a robot gives that was never asked before."""
    fresh = {}
    for k, options in enumerate(VARIANTS):
        load_quietly("panda").kept.clear()
        fresh[k] = solve(**options)
    for order in (range(len(VARIANTS)), reversed(range(len(VARIANTS)))):
        for k in order:
            again = solve(**VARIANTS[k])
            np.testing.assert_array_equal(again.q, fresh[k].q)
            assert (again.status, again.iterations, again.errors, again.engine, again.method) == (
                fresh[k].status, fresh[k].iterations, fresh[k].errors, fresh[k].engine, fresh[k].method,
            )  # fmt: skip
            assert (again.trace is None) == (fresh[k].trace is None)
            assert again.parameters == fresh[k].parameters


def test_true_is_not_one(solve):
    assert solve(restarts=1, limits=True)
    for wrong, words in (
        ({"restarts": True}, "restarts must be"),
        ({"seed": False}, "seed"),
        ({"max_iterations": True}, "max"),
    ):
        solve(**{name: int(value) for name, value in wrong.items()})
        with pytest.raises(pinik.InputError, match=words):
            solve(**wrong)
    solve(damping=1)
    with pytest.raises(pinik.InputError, match="damping"):
        solve(damping=True)
    solve(target_jacobian=True)
    with pytest.raises(pinik.InputError, match="target_jacobian is true or false"):
        solve(target_jacobian=1)


def test_a_method_registered_anew_is_meant_from_then_on(solve, monkeypatch):
    assert solve(method="dls")
    monkeypatch.setitem(SOLVERS, "dls", Lazy)
    s = solve(method="dls", restarts=0)
    assert solve(method="dls").engine == s.engine == "python"
    assert s.method == "lazy"
    assert not s.success
    monkeypatch.undo()
    assert solve(method="dls").method == "dls"


def test_a_method_imported_anew_is_meant_from_then_on(solve, monkeypatch):
    name = f"{__name__}:Lazy"
    assert solve(method=name, restarts=0).method == "lazy"
    monkeypatch.setattr(sys.modules[__name__], "Lazy", pinik.CCD)
    assert solve(method=name, restarts=0).method == "ccd"


def test_a_tool_that_was_changed_is_meant_from_then_on(panda):
    target = Target(TIP, [0.4, 0.1, 0.5], tool=[0, 0, 0.1])
    assert pinik.solve(panda, target)
    target.tool.translation = np.array([0.0, 0.0, 0.2])
    s = pinik.solve(panda, target)
    got = panda.placement(TIP, s.q) * target.tool
    assert s.success == (np.linalg.norm(got.translation - target.position) <= 1e-4)


def test_only_the_last_few_kinds_are_kept():
    panda = pinik.load("panda")
    kept = []
    for seed in range(100):
        panda.solve(TIP, [0.4, 0.1, 0.5], seed=seed)
        kept.append(len(panda.kept))
    assert max(kept) == max(kept[:20])


def test_a_robot_copied_or_hung_up_otherwise_keeps_nothing_of_the_other(panda):
    assert panda.solve(TIP, [0.4, 0.1, 0.5])
    flying = panda.with_root("free_flyer")
    assert not flying.kept
    s = flying.solve(TIP, [3.0, 0.0, 0.0])
    assert s.success
    assert len(s.q) == 15


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
def test_every_axis_is_a_question_of_its_own(engine, panda):
    for axis, column in (("x", 0), ("y", 1), ("z", 2), ([0.0, 0.6, 0.8], None)):
        s = panda.solve(TIP, axis=axis, direction=[0, 0, 1], engine=engine)
        R = panda.placement(TIP, s.q).rotation
        along = R[:, column] if column is not None else R @ np.array(axis)
        assert s.success
        assert along[2] > math.cos(1.1e-3)


def test_a_position_is_no_matrix_however_often_it_is_asked_for(panda):
    panda.solve(TIP, position=[0.4, 0.1, 0.5])
    for wrong in (np.eye(4), pinocchio.SE3.Identity(), np.full(3, math.nan), np.array([0.4, math.nan, 0.5])):
        with pytest.raises(pinik.InputError, match="position must be 3"):
            panda.solve(TIP, position=wrong)


def test_no_number_of_a_placement_may_be_missing(panda):
    panda.solve(TIP, placement=np.eye(4))
    for entry in np.ndindex(3, 4):
        wrong = np.eye(4)
        wrong[entry] = math.nan
        with pytest.raises(pinik.InputError, match="finite"):
            panda.solve(TIP, placement=wrong)


def test_a_prepared_question_and_many_answers_travel_to_other_processes(panda):
    ask = pickle.loads(pickle.dumps(pinik.prepare(panda, Target(TIP, [0.4, 0.1, 0.5]), "ccd", seed=3)))
    assert ask().success
    assert ask().method == "ccd"
    many = pickle.loads(pickle.dumps(pinik.solve_many(panda, TIP, [[0.4, 0.1, 0.5], [0.3, 0.0, 0.6]])))
    assert many.success.all()
    assert many[1].success


def test_starts_that_cannot_be_drawn_are_not_tried_again():
    lion = pinik.load("lion", root="free_flyer")
    targets = [Target("nose", [5.0, 0.0, 0.0]), Target("tail_tip", [5.0, 9.0, 0.0])]
    for engine in ("python", "auto"):
        s = pinik.solve(lion, targets, locked=lion.joint_names, engine=engine)
        assert not s.success
        assert s.restarts == 0
