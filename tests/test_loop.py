"""The one loop: stopping, limits, restarts, and the three ways to run."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

import pinik
from by_hand import axis, limit, origin
from pinik import Status, Target
from robots import load_quietly
from urdf_texts import joint, link
from urdf_texts import robot as robot_text

FOUR = ["ccd", "jt", "pinv", "dls"]
JACOBIAN_METHODS = ["jt", "pinv", "dls"]


def straight_chain(bones: int, low: float = -3.0, high: float = 3.0) -> pinik.Robot:
    """`bones` hinges about z, one bone of 1 m each along x, frame "tip"."""
    links = [link("b0"), *(link(f"b{i}") for i in range(1, bones + 1)), link("tip")]
    joints = [
        joint(f"j{i}", f"b{i - 1}", f"b{i}", origin((float(i > 1), 0, 0)), axis(0, 0, 1), limit=limit(low, high))
        for i in range(1, bones + 1)
    ]
    end = joint("end", f"b{bones}", "tip", origin((1, 0, 0)), kind="fixed", limit="")
    return load_quietly(robot_text(*links, *joints, end))


@pytest.mark.parametrize("method", JACOBIAN_METHODS)
def test_a_straight_arm_pulled_inwards_holds_the_jacobian_methods_fast(method):
    robot = straight_chain(4)
    s = robot.solve("tip", position=[1.5, 0.0, 0.0], method=method, restarts=0)
    assert s.status is Status.STALLED
    assert s.position_error == pytest.approx(2.5)
    assert np.array_equal(s.q, robot.neutral())


def test_ccd_folds_the_straight_arm_when_the_target_is_nearer_to_the_base_than_the_last_joint():
    robot = straight_chain(4)
    s = robot.solve("tip", position=[1.5, 0.0, 0.0], method="ccd", restarts=0)
    assert s.success, s.message


def test_ccd_is_stuck_too_when_the_target_lies_between_last_joint_and_tip():
    robot = straight_chain(4)
    s = robot.solve("tip", position=[3.5, 0.0, 0.0], method="ccd", restarts=0)
    assert s.status is Status.STALLED
    assert np.array_equal(s.q, robot.neutral())


@pytest.mark.parametrize("method", FOUR)
@pytest.mark.parametrize("x", [1.5, 3.5])
def test_restarts_free_all_four(method, x):
    s = straight_chain(4).solve("tip", position=[x, 0.0, 0.0], method=method)
    assert s.success, s.message
    assert s.restarts >= (0 if method == "ccd" else 1)


def largest_change_after_settling(robot, frame, position, solver, *, steps=300, last=60):
    """One update per simulation step towards a still target: the largest joint change of the last ones [rad]."""
    q, changes = robot.random(1), []
    target = Target(frame, position)
    for _ in range(steps):
        *_, state = pinik.iterate(robot, target, solver, q, limits=False, max_iterations=1)
        changes.append(np.abs(state.q - q).max())
        q = state.q
    return max(changes[-last:]), state.position_error


@pytest.mark.parametrize(
    ("name", "frame", "position", "reach"),
    [("arm", "tip", (1.5, 0.3, 1.6), None), ("two_link", "tip", (1.5, 0.4, 0.0), 0.9)],
)
def test_stretched_out_the_pseudo_inverse_swings_and_dls_comes_to_rest(name, frame, position, reach):
    """Thesis §3: pseudo-inverse oscillates at unreachable targets, DLS far less, the less the larger λ; D_max helps."""
    robot = load_quietly(name)

    def settled(solver):
        return largest_change_after_settling(robot, frame, position, solver)

    pseudo_inverse, _ = settled(pinik.PseudoInverse(max_step=math.inf, cutoff=0.0))
    light, _ = settled(pinik.DampedLeastSquares(rule="constant", damping=0.3))
    heavy, _ = settled(pinik.DampedLeastSquares(rule="constant", damping=1.1))
    still, still_error = settled(pinik.DampedLeastSquares(max_residual=0.1))
    ccd, ccd_error = settled(pinik.CCD())
    assert pseudo_inverse > 0.5
    assert heavy <= max(light, 1e-9) <= pseudo_inverse
    assert heavy < 1e-5
    assert still < 1e-6
    assert ccd < 1e-6
    assert still_error == pytest.approx(ccd_error, abs=1e-6)  # at rest where CCD is: stretched to the full
    if reach is not None:
        assert still_error == pytest.approx(math.hypot(*position) - reach, abs=1e-6)


@pytest.mark.parametrize("alpha", [1.0, None])
def test_stretched_out_the_transpose_swings_and_less_when_d_max_shortens_its_pull(arm, alpha):
    position = (1.5, 0.3, 1.6)
    swing = [
        largest_change_after_settling(
            arm, "tip", position, pinik.JacobianTranspose(alpha=alpha, max_step=math.inf, max_residual=d_max)
        )[0]
        for d_max in (math.inf, 0.05)
    ]
    assert swing[0] > 0.5
    assert swing[1] < 0.05 * swing[0]


@pytest.mark.parametrize("method", FOUR)
def test_an_unreachable_target_is_proved_and_answered_with_the_nearest_point(method, two_link):
    position = np.array([0.0, 1.4, 0.0])
    s = two_link.solve("tip", position=position, method=method)
    assert s.status is Status.UNREACHABLE
    assert s.position_error == pytest.approx(0.5, abs=1e-3)  # 1.4 m off, 0.9 m long
    assert "unreachable" in s.message
    assert "50 cm" in s.message


@pytest.mark.parametrize("method", FOUR)
def test_a_target_in_the_hole_around_the_base_is_proved_unreachable(method, two_link):
    s = two_link.solve("tip", position=[0.03, 0.04, 0.0], method=method)
    assert s.status is Status.UNREACHABLE
    assert s.position_error == pytest.approx(0.05, abs=1e-3)  # |0.5 − 0.4| − 0.05
    assert "hole" in s.message


@pytest.mark.parametrize("method", FOUR)
def test_what_is_out_of_the_limits_but_not_of_the_bound_is_stalled_not_unreachable(method):
    robot = straight_chain(3, -0.2, 0.2)
    s = robot.solve("tip", position=[0.0, 2.0, 0.0], method=method)
    assert s.status in (Status.STALLED, Status.MAX_ITERATIONS)
    assert set(s.active_limits) == {"j1", "j2", "j3"}
    assert "j1, j2, j3 at their upper limits" in s.message


@pytest.mark.parametrize("method", FOUR)
def test_every_yielded_configuration_is_inside_the_limits(method, panda):
    rng = np.random.default_rng(4)
    for _ in range(3):
        target = Target("panda_hand_tcp", placement=panda.placement("panda_hand_tcp", panda.random(rng)))
        for state in pinik.iterate(panda, target, method, panda.random(rng), max_iterations=40):
            assert (state.q >= panda.lower).all()
            assert (state.q <= panda.upper).all()


@pytest.mark.parametrize("method", FOUR)
def test_a_start_outside_is_put_inside(method, panda):
    outside = panda.upper + 0.05
    *_, last = pinik.iterate(panda, Target("panda_hand_tcp", [0.4, 0.1, 0.5]), method, outside, max_iterations=1)
    first = next(pinik.iterate(panda, Target("panda_hand_tcp", [0.4, 0.1, 0.5]), method, outside))
    assert np.array_equal(first.q, panda.upper)
    assert (last.q <= panda.upper).all()


def test_a_start_that_is_whole_turns_off_is_turned_back_not_clipped():
    robot = straight_chain(1, -3.0, 3.0)
    first = next(
        pinik.iterate(robot, Target("tip", [0.0, 1.0, 0.0]), "dls", robot.configuration({"j1": 1.0 + 4 * math.pi}))
    )
    assert first.q[0] == pytest.approx(1.0)


@pytest.mark.parametrize("method", JACOBIAN_METHODS)
def test_an_answer_that_is_whole_turns_outside_is_turned_inside(method):
    """The first joint's range lies around 2π: the step from its lower end leads below it."""
    robot = straight_chain(1, 0.1, 6.2)
    wanted = -0.5
    s = robot.solve("tip", position=[math.cos(wanted), math.sin(wanted), 0.0], method=method, restarts=0, q0=[0.2])
    assert s.success, s.message
    assert s.angles["j1"] == pytest.approx(wanted + 2 * math.pi, abs=1e-3)


@pytest.mark.parametrize("method", JACOBIAN_METHODS)
def test_joints_at_their_limits_leave_their_part_to_the_others(method):
    """j1 sits at its limit and is pushed outwards: one step of the rest still makes what it can of the pull."""
    robot = straight_chain(3, -0.5, 0.5)
    q0 = robot.configuration({"j1": 0.5, "j2": 0.1, "j3": -0.1})
    target = Target("tip", robot.placement("tip", q0).translation + np.array([-0.02, 0.05, 0.0]))
    solver = pinik.SOLVERS[method]()
    *_, state = pinik.iterate(robot, target, solver, q0, max_iterations=1)
    J = robot.jacobian("tip", q0)[:3]
    assert (J.T @ (target.position - robot.placement("tip", q0).translation))[0] > 0  # it is pushed outwards
    J[:, 0] = 0.0
    expected = solver.direction(J, target.position - robot.placement("tip", q0).translation)
    assert np.allclose(state.q - q0, expected, atol=1e-12)


@pytest.mark.parametrize("method", FOUR)
def test_limits_off_lets_joints_pass_them(method):
    robot = straight_chain(2, -0.2, 0.2)
    s = robot.solve("tip", position=[0.0, 1.5, 0.0], method=method, limits=False)
    assert s.success, s.message
    assert max(abs(angle) for angle in s.angles.values()) > 0.2
    assert s.active_limits == ()
    assert not robot.solve("tip", position=[0.0, 1.5, 0.0], method=method).success


@pytest.mark.parametrize("method", FOUR)
def test_iterations_are_those_allowed(method, arm):
    s = arm.solve(
        "tip", position=[0.5, 0.3, 0.5], method=method, max_iterations=2, restarts=0, tolerance=(1e-12, 1e-12)
    )
    assert s.status is Status.MAX_ITERATIONS
    assert s.iterations == 2
    assert "out of iterations" in s.message


def test_the_time_limit_stops_a_solve(lion):
    targets = [Target(frame, [9.0, 9.0, 9.0]) for frame in ("nose", "tail_tip")]
    began = time.perf_counter()
    s = lion.solve(targets, method="ccd", time_limit=0.05, tolerance=(1e-9, 1e-9), limits=False, max_iterations=10**6)
    assert s.status in (Status.TIME_LIMIT, Status.UNREACHABLE)
    assert time.perf_counter() - began < 0.5
    opposed = [Target("nose", [1.0, 0.1, 1.0]), Target("nose", [1.0, -0.1, 1.0])]
    s = lion.solve(opposed, method="jt", time_limit=0.02, restarts=10**6)
    assert s.status is Status.TIME_LIMIT
    assert "out of time" in s.message


def test_weights_change_the_step_and_never_the_verdict(two_link):
    """One arm, two opposed wishes: the heavier is served better, both are judged alike."""
    wishes = ([0.6, 0.2, 0.0], [0.2, 0.6, 0.0])

    def errors(first, second):
        s = two_link.solve([Target("tip", wishes[0], weight=first), Target("tip", wishes[1], weight=second)])
        assert not s.success
        assert s.position_error == max(error.position for error in s.errors)
        return [error.position for error in s.errors]

    equal, heavy = errors(1.0, 1.0), errors(5.0, 1.0)
    assert equal[0] == pytest.approx(equal[1], abs=1e-3)
    assert heavy[0] < 0.1 * heavy[1]
    alone = two_link.solve(Target("tip", wishes[0], weight=1e-3))
    assert alone.success
    assert alone.position_error <= 1e-4


@pytest.mark.parametrize("method", FOUR)
def test_iterate_yields_the_start_then_one_state_per_iteration(method, arm):
    states = list(pinik.iterate(arm, Target("tip", [0.4, 0.2, 0.8]), method))
    assert [state.iteration for state in states] == list(range(len(states)))
    assert np.array_equal(states[0].q, arm.neutral())
    assert [state.status for state in states[:-1]] == [None] * (len(states) - 1)
    assert states[-1].status is Status.CONVERGED


@pytest.mark.parametrize("method", FOUR)
def test_one_update_per_simulation_step_chases_a_moving_target(method, arm):
    """METHODS §1 (i): the effector follows a ball on a circle, one update a frame."""
    q, errors = arm.solve("tip", position=[0.4, 0.0, 0.8]).q, []
    for step in range(120):
        angle = 2 * math.pi * step / 240
        target = Target("tip", [0.4 * math.cos(angle), 0.4 * math.sin(angle), 0.8])
        *_, state = pinik.iterate(arm, target, method, q, max_iterations=1)
        q = state.q
        errors.append(state.position_error)
    assert max(errors[20:]) < 0.03


@pytest.mark.parametrize("method", FOUR)
def test_a_target_sent_in_moves_while_it_runs(method, arm):
    states = pinik.iterate(arm, Target("tip", [0.4, 0.2, 0.8]), method)
    state = next(states)
    while state.status is None:
        state = next(states)
    assert state.status is Status.CONVERGED
    elsewhere = Target("tip", [0.3, -0.3, 0.9])
    state = states.send([elsewhere])
    assert state.status is None
    assert state.position_error > 0.01
    while state.status is None:
        state = next(states)
    assert state.status is Status.CONVERGED
    assert np.linalg.norm(arm.placement("tip", state.q).translation - elsewhere.position) <= 1e-4


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"q0": [0.0] * 3}, "q0 takes 12 finite numbers"),
        ({"q0": [math.nan] * 12}, "q0 takes 12 finite numbers"),
        ({"position": [0, 0]}, "position takes 3 finite numbers"),
        ({"position": [0, 0, math.inf]}, "position takes 3 finite numbers"),
        ({"position": [0, 0, 1e300]}, "at most 1e\\+09 away"),
        ({"tolerance": 1e-3}, "tolerance takes 2 finite numbers"),
        ({"tolerance": (1e-3, 0.0)}, "two positive numbers"),
        ({"restarts": -1}, "restarts is a whole number of at least 0"),
        ({"max_iterations": 2.5}, "max_iterations is a whole number"),
        ({"time_limit": 0}, "time_limit is a positive number"),
        ({"locked": "bone1_x"}, "locked takes a list"),
        ({"locked": ["bone1_q"]}, "near: 'bone1_z'|near: 'bone1_x'"),
        ({"method": "newton"}, "no method 'newton'; there are: 'ccd'"),
        ({"damp": 3}, "no parameter of 'dls' 'damp'; near: 'damping'"),
        ({"engine": "cuda"}, "no engine 'cuda'"),
        ({"engine": "native"}, "no compiled engine"),
    ],
    ids=str,
)
def test_bad_input_is_refused_in_words(options, words, arm):
    keywords = {"position": [0.3, 0.1, 0.8]} | options
    with pytest.raises(pinik.PinikError, match=words):
        arm.solve("tip", **keywords)


def test_an_unknown_frame_lists_near_ones(arm):
    with pytest.raises(pinik.UnknownNameError, match="no frame 'tipp'; near: 'tip'"):
        arm.solve("tipp", position=[0, 0, 1])


def test_targets_that_are_none_are_refused(arm):
    with pytest.raises(pinik.InputError, match="at least one target"):
        arm.solve([])
    with pytest.raises(pinik.InputError, match="targets are Target objects"):
        arm.solve([[0.1, 0.2, 0.3]])
    with pytest.raises(pinik.InputError, match=r"belong into Target\(...\)"):
        arm.solve([Target("tip", [0, 0, 1])], rpy=[0, 0, 0])
