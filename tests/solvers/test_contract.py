"""What every solver owes, the four and a user's own ten lines alike."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pinocchio
import pytest

import pinik
from judge import assert_good, assert_honest
from pinik import Status, Target


@dataclass(frozen=True, kw_only=True)
class Steepest(pinik.JacobianSolver):
    """A user's own: steepest descent with a fixed gain."""

    name = "steepest"
    max_iterations = 400
    gain: float = pinik.parameter(0.5, "factor on the gradient", low=0.0)

    def direction(self, J, e):
        return self.gain * J.T @ e


METHODS = [pinik.CCD, pinik.JacobianTranspose, pinik.PseudoInverse, pinik.DampedLeastSquares, Steepest]
every_method = pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)


def problems(robot: pinik.Robot, frame: str, count: int, seed: int):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield robot.placement(frame, robot.random(rng)).translation.copy(), robot.random(rng)


@every_method
def test_a_success_is_one_by_plain_pinocchio_and_inside_the_limits(method, arm):
    solved = 0
    for wanted, q0 in problems(arm, "tip", 12, seed=1):
        s = arm.solve("tip", position=wanted, method=method, q0=q0, restarts=3)
        assert_honest(s, {"frame": "tip", "position": wanted})
        solved += s.success
    assert solved >= 11


@every_method
def test_no_input_is_changed(method, panda):
    q0 = panda.random(3)
    q0_before = q0.copy()
    position = np.array([0.3, 0.2, 0.6])
    rotation = pinocchio.rpy.rpyToMatrix(0.1, 0.2, 0.3)
    target = Target("panda_hand_tcp", position, rotation=rotation, tool=[0.0, 0.0, 0.05])
    described = target.to_dict()
    solver = method()
    parameters = solver.parameters
    names = [frame.name for frame in panda.model.frames]
    panda.solve(target, method=solver, q0=q0, restarts=1, max_iterations=40)
    assert np.array_equal(q0, q0_before)
    assert np.array_equal(position, [0.3, 0.2, 0.6])
    assert target.to_dict() == described
    assert solver.parameters == parameters
    assert [frame.name for frame in panda.model.frames] == names


@every_method
def test_the_same_seed_gives_the_same_answer_and_another_seed_other_starts(method, ur5):
    wanted = ur5.placement("tool0", ur5.random(8))
    target = Target("tool0", placement=wanted)
    options = {"method": method, "restarts": 2, "max_iterations": 30, "tolerance": (1e-18, 1e-18), "trace": True}
    first, again, other = (ur5.solve(target, seed=seed, **options) for seed in (4, 4, 5))
    assert np.array_equal(first.q, again.q)
    assert first.iterations == again.iterations
    starts = [[s.q for s in solution.trace if s.iteration == 0 and s.attempt > 0] for solution in (first, other)]
    assert starts[0]
    assert not np.allclose(starts[0][0], starts[1][0])


@every_method
def test_counters_count(method, arm):
    calls = []

    if issubclass(method, pinik.SweepingSolver):

        class Counting(method):
            def sweep(self, *args):
                q, updates = super().sweep(*args)
                calls.append(updates)
                return q, updates

        limits = True
    else:

        class Counting(method):
            def direction(self, *args):
                calls.append(0)
                return super().direction(*args)

        limits = False  # with limits, a step along them asks for the direction twice

    s = arm.solve(
        "tip", position=[0.9, 0.0, 0.1], method=Counting, restarts=2, max_iterations=7, limits=limits, trace=True
    )
    assert s.iterations == len(calls)
    assert s.joint_updates == sum(calls)
    begun = [state.attempt for state in s.trace if state.iteration == 0]
    assert begun == list(range(len(begun)))  # every run has a number of its own, the last one too
    assert s.restarts in (len(begun) - 1, len(begun) - 2)
    lasts = [
        now for now, after in zip(s.trace, [*s.trace[1:], None], strict=True) if after is None or after.iteration == 0
    ]
    assert s.iterations == sum(state.iteration for state in lasts)
    assert s.joint_updates == sum(state.joint_updates for state in lasts)


@every_method
@pytest.mark.parametrize("limits", [True, False])
def test_the_best_found_is_kept_on_failure(method, limits, two_link):
    s = two_link.solve("tip", position=[1.4, 0.1, 0.0], method=method, limits=limits, trace=True, restarts=3)
    assert not s.success
    assert s.position_error <= min(state.position_error for state in s.trace) + 1e-12


@every_method
def test_joints_that_move_no_frame_asked_for_stay(method, lion):
    q0 = lion.random(2)
    s = lion.solve("left_fore_paw", position=[0.6, 0.2, 0.3], method=method, q0=q0, restarts=2, max_iterations=50)
    moved = {name for name in lion.joint_names if lion.angles(s.q)[name] != lion.angles(q0)[name]}
    assert moved
    paw_chain = {lion.model.names[i] for i in lion.model.supports[lion.model.getJointId("left_wrist")]}
    assert moved <= paw_chain | {"left_fore_toes_pitch"}


@every_method
def test_locked_joints_hold_still(method, panda):
    q0 = panda.random(5)
    locked = ["panda_joint2", "panda_joint5"]
    s = panda.solve("panda_hand_tcp", position=[0.4, 0.1, 0.5], method=method, q0=q0, locked=locked, restarts=2)
    for name in locked:
        assert s.angles[name] == panda.angles(q0)[name]


@every_method
def test_a_start_at_the_target_takes_no_step(method, arm):
    q0 = arm.random(6)
    s = arm.solve("tip", position=arm.placement("tip", q0).translation, method=method, q0=q0)
    assert s.status is Status.CONVERGED
    assert (s.iterations, s.joint_updates, s.restarts) == (0, 0, 0)
    assert np.array_equal(s.q, q0)


@every_method
def test_a_frame_that_no_joint_moves_is_said_so(method, arm):
    s = arm.solve("base", position=[0.0, 0.0, 0.1], method=method)
    assert not s.success
    assert "no free joint moves frame 'base'" in s.message
    assert s.restarts == 0


@every_method
def test_a_far_target_gives_finite_numbers_and_the_bound_that_proves_it(method, panda):
    for position in ([1e6, 0.0, 0.0], [0.0, 0.0, -1e9], [2.0, 1.0, 0.5]):
        s = panda.solve("panda_hand_tcp", position=position, method=method, max_iterations=60)
        assert s.status is Status.UNREACHABLE
        assert np.isfinite(s.q).all()
        assert math.isfinite(s.position_error)
        assert "unreachable" in s.message


@pytest.mark.parametrize("method", [m for m in METHODS if issubclass(m, pinik.JacobianSolver)], ids=lambda m: m.name)
def test_a_solver_whose_step_is_not_finite_cannot_spoil_the_answer(method, arm):
    class Broken(method):
        def direction(self, *args):
            return super().direction(*args) * np.nan

    s = arm.solve("tip", position=[0.4, 0.2, 0.9], method=Broken, restarts=2)
    assert s.status is Status.STALLED
    assert np.isfinite(s.q).all()


@every_method
def test_several_effectors_are_served_at_once(method, lion):
    rng = np.random.default_rng(9)
    middle = 0.5 * (lion.lower + lion.upper)
    goal = lion.configuration(
        {
            name: m + 0.5 * rng.uniform(-1, 1) * (h - m)
            for name, m, h in zip(lion.joint_names, middle, lion.upper, strict=True)
        }
    )
    frames = ["left_fore_paw", "right_fore_paw", "nose", "tail_tip"]
    targets = [Target(frame, lion.placement(frame, goal).translation) for frame in frames]
    tolerance = (1e-3, 1e-2)
    s = lion.solve(targets, method=method, q0=lion.poses["relaxed"], max_iterations=1500, tolerance=tolerance)
    assert_good(s, targets, tolerance=tolerance)
    assert len(s.errors) == 4


@every_method
@pytest.mark.parametrize("root", ["free_flyer", "planar"])
def test_a_moving_root_moves_too_unless_locked(method, root):
    robot = pinik.load("two_link", root=root)
    target = Target("tip", [2.0, 1.0, 0.0])
    s = robot.solve(target, method=method)
    assert_good(s, target)
    held = robot.solve(target, method=method, locked=["root_joint"], restarts=1)
    assert not held.success
    assert np.allclose(held.joint_placements["root_joint"].homogeneous, np.eye(4))


@every_method
@pytest.mark.parametrize(
    "keywords",
    [
        {"axis": "z", "direction": [1.0, 0.5, -0.3]},
        {"axis": "-x", "at": [0.9, 0.4, 0.2]},
        {"position": [0.4, 0.2, 0.5], "axis": "z", "direction": [0.0, 0.3, -1.0]},
        {"position": [0.4, 0.0, 0.5], "tool": [0.05, 0.0, 0.1]},
        {"position": [0.25, 0.0, 0.35], "relative_to": "panda_link2"},
    ],
    ids=["direction", "at", "position and direction", "tool", "relative"],
)
def test_every_kind_of_target_is_reached(method, keywords, panda):
    s = panda.solve("panda_hand_tcp", method=method, tolerance=(1e-3, 1e-2), max_iterations=2000, **keywords)
    assert_good(s, {"frame": "panda_hand_tcp", **keywords}, tolerance=(1e-3, 1e-2))


@every_method
def test_mimicking_joints_move_with_their_leaders(method, panda):
    s = panda.solve(
        "panda_leftfinger",
        position=[0.03, 0.0, 0.0],
        relative_to="panda_rightfinger",
        method=method,
        max_iterations=1500,
    )
    missed = abs(s.position_error)
    opening = s.angles["panda_finger_joint1"]
    assert s.angles["panda_finger_joint2"] == opening
    # the fingers part along the hand's y: the nearest they get to 3 cm along x is closed, 3 cm off
    assert missed == pytest.approx(0.03, abs=1e-4)
    assert opening == pytest.approx(0.0, abs=1e-4)


@every_method
@pytest.mark.parametrize("bad", [{"no_such": 1.0}, {"max_step": -1.0}, {"max_step": math.nan}, {"max_residual": "far"}])
def test_bad_parameters_are_named(method, bad):
    with pytest.raises(pinik.PinikError) as error:
        method.make(**bad)
    assert next(iter(bad)) in str(error.value)
