"""Which questions a robot keeps compiled: the last used, whatever the words they were asked in."""

from __future__ import annotations

import itertools
import threading

import numpy as np
import pinocchio
import pytest

import pinik
from pinik import SOLVERS, DampedLeastSquares, Target, Tolerance
from pinik.solving import kept as kept_module
from pinik.solving.kept import Kept, kept_of

POSE = pinocchio.SE3(np.diag([1.0, -1.0, -1.0]), np.array([0.45, 0.1, 0.4]))
TIP = "panda_hand_tcp"


@pytest.fixture
def compiled(monkeypatch):
    """How many questions were compiled."""
    made = []

    class Counted(kept_module.Prepared):
        def __init__(self, *arguments):
            made.append(arguments)
            super().__init__(*arguments)

    monkeypatch.setattr(kept_module, "Prepared", Counted)
    return made


@pytest.fixture
def robot():
    return pinik.load("panda")


WAYS = [
    {},
    {"method": "dls"},
    {"method": DampedLeastSquares},
    {"method": DampedLeastSquares()},
    {"method": DampedLeastSquares(damping=np.sqrt(0.5))},
    {"tolerance": (1e-4, 1e-3)},
    {"tolerance": [1e-4, 1e-3]},
    {"tolerance": np.array([1e-4, 1e-3])},
    {"tolerance": Tolerance()},
    {"locked": []},
    {"locked": ()},
    {"limits": True, "seed": 0, "trace": False, "engine": "auto", "restarts": None, "time_limit": None},
    {"stiffness": {}},
    {"damping": float(np.sqrt(0.5))},
]


def test_any_way_of_saying_the_same_question_is_the_same_question(robot, compiled):
    for _ in range(3):
        for way in WAYS:
            robot.solve(TIP, placement=POSE, **way)
            robot.solve(TIP, placement=POSE.homogeneous, **way)
            pinik.solve(robot, Target(TIP, placement=POSE), **way)
            pinik.solve(robot, TIP, placement=POSE, **way)
    assert len(compiled) == 1


def test_equal_methods_with_mappings_are_one(robot, compiled):
    for stiffness in ({"panda_joint1": 0.5}, {"panda_joint1": 0.5}):
        robot.solve(TIP, placement=POSE, method="ccd", stiffness=stiffness)
        robot.solve(TIP, placement=POSE, method=pinik.CCD(stiffness=stiffness))
    assert len(compiled) == 1
    robot.solve(TIP, placement=POSE, method="ccd", stiffness={"panda_joint1": 0.6})
    assert len(compiled) == 2


def test_many_kinds_in_turn_are_compiled_once_each(robot, compiled):
    """Seventeen in turn: one more than an older pinik kept."""
    for _ in range(3):
        for seed in range(17):
            robot.solve(TIP, placement=POSE, seed=seed)
    assert len(compiled) == 17


def test_the_one_used_longest_ago_is_dropped(monkeypatch, compiled):
    monkeypatch.setattr(kept_module, "_MOST", 3)
    robot = pinik.load("panda")
    for seed in (0, 1, 2, 0, 3):  # 3 takes the place of 1: 0 was used since
        robot.solve(TIP, placement=POSE, seed=seed)
    assert len(compiled) == 4
    for seed in (0, 2, 3):
        robot.solve(TIP, placement=POSE, seed=seed)
    assert len(compiled) == 4
    robot.solve(TIP, placement=POSE, seed=1)
    assert len(compiled) == 5
    assert len(kept_of(robot)) == 3


def test_large_robots_keep_fewer():
    """What a question keeps grows with the cube of the degrees of freedom."""
    small, large = Kept(pinik.load("panda")), Kept(pinik.load("talos", mimic=False))
    assert small.most == 256
    assert 1 <= large.most < 256


def test_every_thread_keeps_its_own(robot):
    robot.solve(TIP, placement=POSE)
    lengths = []
    thread = threading.Thread(target=lambda: lengths.append(len(kept_of(robot))))
    thread.start()
    thread.join()
    assert lengths == [0]
    assert len(kept_of(robot)) == 1


@pytest.mark.parametrize("name", SOLVERS)
def test_solvers_hash_and_compare_by_their_parameters(name):
    solver = SOLVERS[name]
    assert hash(solver()) == hash(solver())
    assert {solver(), solver(max_step=0.25), solver()} == {solver(), solver(max_step=0.25)}
    for one, other in itertools.permutations([SOLVERS[other]() for other in SOLVERS], 2):
        assert one != other
