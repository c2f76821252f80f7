"""Answers polished within the tolerance: exact where the pose can be reached, never worse than without."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import pinik
from engines import needs_native
from judge import judge
from pinik import Status, Target
from robots import load_quietly

ENGINES = ["python", pytest.param("native", marks=needs_native)]
TIP = "panda_hand_tcp"


def questions(robot, frame, count, seed):
    rng = np.random.default_rng(seed)
    return [(robot.placement(frame, robot.random(rng)), robot.random(rng)) for _ in range(count)]


@needs_native
@pytest.mark.parametrize(("name", "frame"), [("ur5", "tool0"), ("panda", TIP), ("z1", "gripperMover")])
def test_reachable_poses_are_answered_to_nanometres_by_default(name, frame):
    robot = load_quietly(name)
    asked = questions(robot, frame, 400, seed=11)
    poses = np.array([pose.homogeneous for pose, _ in asked])
    many = pinik.solve_many(robot, frame, poses, q0=np.array([q0 for _, q0 in asked]), threads=1)
    errors = [judge(robot, Target(frame, placement=pose), q) for (pose, _), q in zip(asked, many.q, strict=True)]
    exact = sum(e.position < 1e-8 and e.orientation < 1e-7 for e in errors)
    assert many.success.all()
    assert exact >= 0.99 * len(asked)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd", "jt"])
def test_polished_answers_are_never_worse_and_never_fail(engine, method, panda):
    for pose, q0 in questions(panda, TIP, 8, seed=12):
        asked = {"placement": pose, "q0": q0, "method": method, "engine": engine, "restarts": 10}
        plain = panda.solve(TIP, polish=False, **asked)
        polished = panda.solve(TIP, **asked)
        assert polished.success == plain.success
        if plain.success:
            assert polished.iterations >= plain.iterations
            assert polished.position_error <= max(plain.position_error, 1e-8)
            assert (panda.lower <= polished.q).all()
            assert (polished.q <= panda.upper).all()
        if method in ("ccd", "jt"):
            assert polished.iterations == plain.iterations


@pytest.mark.parametrize("engine", ENGINES)
def test_a_trace_shows_the_polishing_steps(engine, panda):
    (pose, q0), *_ = questions(panda, TIP, 1, seed=13)
    s = panda.solve(TIP, placement=pose, q0=q0, engine=engine, trace=True)
    last = [state for state in s.trace if state.attempt == s.trace[-1].attempt]
    within = [state for state in last if state.position_error <= 1e-4 and state.orientation_error <= 1e-3]
    assert len(within) > 1
    assert [state.status for state in within[:-1]] == [None] * (len(within) - 1)
    assert within[-1].status is Status.CONVERGED
    assert within[-1].residual == min(state.residual for state in last)
    assert [state.iteration for state in last] == list(range(len(last)))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_state_that_is_exact_already_takes_no_further_step(engine, panda):
    q0 = panda.random(5)
    s = panda.solve(TIP, placement=panda.placement(TIP, q0), q0=q0, engine=engine)
    assert s.iterations == 0


@pytest.mark.parametrize("engine", ENGINES)
def test_polishing_ends_at_the_last_iteration(engine, panda):
    q0 = 0.5 * (panda.lower + panda.upper)
    pose = panda.placement(TIP, q0 + 0.2)
    plain = panda.solve(TIP, placement=pose, q0=q0, engine=engine, restarts=0, polish=False)
    assert plain.success
    asked = {"placement": pose, "q0": q0, "engine": engine, "restarts": 0, "max_iterations": plain.iterations}
    polished = panda.solve(TIP, **asked)
    assert polished.success
    assert polished.iterations == plain.iterations


@pytest.mark.parametrize("engine", ENGINES)
def test_targets_that_contradict_each_other_within_tolerance_still_converge(engine, panda):
    q0 = panda.random(6)
    place = panda.placement(TIP, q0).translation
    apart = np.array([0.0, 0.0, 5e-5])
    targets = [Target(TIP, place + apart), Target(TIP, place - apart)]
    s = pinik.solve(panda, targets, q0=panda.random(7), engine=engine, tolerance=(1e-4, 1e-3))
    assert s.success
    assert all(error.position <= 1e-4 for error in s.errors)


@pytest.mark.parametrize("engine", ENGINES)
def test_polishing_stays_inside_the_limits(engine, panda):
    """The pose lies with a joint exactly at its limit: steps towards it come from both sides."""
    rng = np.random.default_rng(14)
    for _ in range(10):
        q = panda.random(rng)
        k = rng.integers(7)
        q[k] = panda.upper[k]
        s = panda.solve(TIP, placement=panda.placement(TIP, q), q0=panda.random(rng), engine=engine, trace=True)
        assert (s.q >= panda.lower).all()
        assert (s.q <= panda.upper).all()


def test_moved_targets_are_polished_anew(panda):
    q0 = panda.random(8)
    first, second = (panda.placement(TIP, panda.random(k)) for k in (9, 10))
    states = pinik.iterate(panda, TIP, placement=first, q0=q0, max_iterations=500)
    for state in states:
        if state.position_error < 1e-4 and state.orientation_error < 1e-3:
            break
    state = states.send(Target(TIP, placement=second))
    for state in states:  # noqa: B007
        pass
    assert state.status is Status.CONVERGED
    errors = judge(panda, Target(TIP, placement=second), state.q)
    assert errors.position < 1e-8


def test_a_method_of_ones_own_is_polished_if_it_says_so(panda):
    @dataclasses.dataclass(frozen=True, kw_only=True)
    class Newton(pinik.JacobianSolver):
        max_step: float = 0.3

        def direction(self, J, e):
            return np.linalg.pinv(J) @ e

    @dataclasses.dataclass(frozen=True, kw_only=True)
    class Polished(Newton):
        converges_quadratically = True

    (pose, q0), *_ = questions(panda, TIP, 1, seed=13)
    plain, polished = (panda.solve(TIP, placement=pose, q0=q0, method=method) for method in (Newton, Polished))
    assert plain.success
    assert polished.iterations > plain.iterations
    assert polished.position_error < 1e-8 < plain.position_error
