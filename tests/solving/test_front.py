"""The one loop: stopping, limits, restarts, and the three ways to run."""

from __future__ import annotations

import itertools
import math
import time

import numpy as np
import pytest

import pinik
from by_hand import axis, limit, origin
from engines import needs_native
from judge import assert_good, assert_honest, is_good, is_inside
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
    assert_good(s)


def test_ccd_is_stuck_too_when_the_target_lies_between_last_joint_and_tip():
    robot = straight_chain(4)
    s = robot.solve("tip", position=[3.5, 0.0, 0.0], method="ccd", restarts=0)
    assert s.status is Status.STALLED
    assert np.array_equal(s.q, robot.neutral())


@pytest.mark.parametrize("method", FOUR)
@pytest.mark.parametrize("x", [1.5, 3.5])
def test_restarts_free_all_four(method, x):
    s = straight_chain(4).solve("tip", position=[x, 0.0, 0.0], method=method)
    assert_good(s)
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

    def settled(solver, steps=300):
        return largest_change_after_settling(robot, frame, position, solver, steps=steps)

    pseudo_inverse, _ = settled(pinik.PseudoInverse(max_step=math.inf, cutoff=0.0))
    light, _ = settled(pinik.DampedLeastSquares(rule="constant", damping=0.3))
    heavy, _ = settled(pinik.DampedLeastSquares(rule="constant", damping=1.1))
    still, still_error = settled(pinik.DampedLeastSquares(max_residual=0.1), steps=1200)
    by_default = {method: settled(pinik.SOLVERS[method]())[0] for method in FOUR}
    _, ccd_error = settled(pinik.CCD())
    assert pseudo_inverse > 0.5
    assert heavy <= max(light, 1e-9) <= pseudo_inverse
    assert heavy < 1e-5
    assert still < 1e-6
    assert by_default["pinv"] > 0.4
    assert by_default["dls"] < 1e-6
    assert by_default["ccd"] < 1e-6
    assert by_default["jt"] < 0.01
    assert still_error == pytest.approx(ccd_error, abs=1e-6)  # at rest where CCD is: stretched to the full
    if reach is not None:
        assert still_error == pytest.approx(math.hypot(*position) - reach, abs=1e-6)


@pytest.mark.parametrize("rule", ["residual", "sugihara"])
@pytest.mark.parametrize(
    ("name", "base", "reach"), [("arm", (0.0, 0.0, 0.12), 1.2), ("two_link", (0.0, 0.0, 0.0), 0.9)]
)
@pytest.mark.parametrize("beyond", [0.02, 0.1, 0.28, 0.6, 2.0])
def test_dls_rests_at_full_stretch_however_little_is_missing(name, base, reach, beyond, rule):
    """A thesis's wish: full stretch towards the target, without jitter."""
    robot = load_quietly(name)
    direction = np.array([0.6, 0.3, 0.6]) / 0.9 if name == "arm" else np.array([0.8, 0.6, 0.0])
    solver = pinik.DampedLeastSquares(rule=rule, damping=math.sqrt(0.5) if rule == "residual" else 1e-3)
    position = base + (reach + beyond) * direction
    change, error = largest_change_after_settling(robot, "tip", position, solver, steps=900)
    assert change < 1e-9
    assert error == pytest.approx(beyond, abs=1e-9)


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
def test_a_bare_dls_ends_at_full_stretch_in_both_engines(arm, engine):
    position = np.array([0.0, 0.0, 0.12]) + 1.3 * np.array([0.6, 0.3, 0.6]) / 0.9
    s = arm.solve(
        "tip", position=position, q0=arm.poses["relaxed"], limits=False, restarts=0, max_iterations=300, engine=engine
    )
    assert s.position_error == pytest.approx(0.1, abs=1e-6)


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
            assert is_inside(panda, state.q)


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
    s = robot.solve("tip", position=[math.cos(wanted), math.sin(wanted), 0.0], method=method, q0=[0.2])
    assert_good(s)
    assert s.restarts == 0
    assert s.angles["j1"] == pytest.approx(wanted + 2 * math.pi, abs=1e-3)


@pytest.mark.parametrize("method", JACOBIAN_METHODS)
def test_joints_at_their_limits_leave_their_part_to_the_others(method):
    """j1 sits at its limit and is pushed outwards: one step of the rest still makes what it can of the pull."""
    robot = straight_chain(3, -0.5, 0.5)
    q0 = robot.configuration({"j1": 0.5, "j2": 0.1, "j3": -0.1})
    target = Target("tip", robot.placement("tip", q0).translation + np.array([-0.02, 0.05, 0.0]))
    solver = pinik.DampedLeastSquares(rule="constant", damping=0.1) if method == "dls" else pinik.SOLVERS[method]()
    *_, state = pinik.iterate(robot, target, solver, q0, max_iterations=1)
    J = robot.jacobian("tip", q0)[:3]
    assert (J.T @ (target.position - robot.placement("tip", q0).translation))[0] > 0  # it is pushed outwards
    J[:, 0] = 0.0
    expected = solver.direction(J, target.position - robot.placement("tip", q0).translation)
    assert np.allclose(state.q - q0, expected, atol=1e-12)


@pytest.mark.parametrize("method", FOUR)
def test_joints_of_a_single_value_stay_there(method):
    robot = load_quietly(
        robot_text(
            *(link(name) for name in ("base", "a", "b", "tip")),
            joint("dead", "base", "a", axis(0, 0, 1), limit=limit(0.0, 0.0)),
            joint("live", "a", "b", origin((1, 0, 0)), axis(0, 0, 1), limit=limit(-3.0, 3.0)),
            joint("end", "b", "tip", origin((1, 0, 0)), kind="fixed", limit=""),
        )
    )
    s = robot.solve("tip", position=[1.0, 1.0, 0.0], method=method, trace=True)
    assert_good(s)
    assert all(state.q[0] == 0.0 for state in s.trace)


@pytest.mark.parametrize("method", FOUR)
def test_limits_off_lets_joints_pass_them(method):
    robot = straight_chain(2, -0.2, 0.2)
    s = robot.solve("tip", position=[0.0, 1.5, 0.0], method=method, limits=False)
    assert_good(s, limits=False)
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


OPPOSED = [Target("nose", [1.0, 0.1, 1.0]), Target("nose", [1.0, -0.1, 1.0])]


@pytest.mark.parametrize("method", FOUR)
@pytest.mark.parametrize("options", [{"restarts": 0, "max_iterations": 500}, {"restarts": 500, "max_iterations": 1}])
def test_the_time_limit_stops_a_solve_within_an_iteration(method, options, lion, monkeypatch):
    """The clock advances by 10 ms at each reading, so that the limit is five readings away."""
    readings = itertools.count()
    monkeypatch.setattr(time, "perf_counter", lambda: 0.01 * next(readings))
    s = lion.solve(OPPOSED, method=method, time_limit=0.05, engine="python", **options)
    monkeypatch.undo()
    assert s.status is Status.TIME_LIMIT
    assert "out of time" in s.message
    assert 1 <= s.iterations <= 6
    assert 5 <= next(readings) <= 8


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
def test_the_time_limit_stops_a_solve_of_a_million_restarts(engine, lion):
    """Measured in processor time, which does not pass while other processes run."""
    began = time.thread_time()
    s = lion.solve(OPPOSED, method="jt", time_limit=0.02, restarts=10**6, engine=engine)
    assert s.status is Status.TIME_LIMIT
    assert time.thread_time() - began < 1.0


def test_weights_change_the_step_and_never_the_verdict(two_link):
    """One arm, two opposed wishes: the heavier is served better, both are judged alike."""
    wishes = ([0.6, 0.2, 0.0], [0.2, 0.6, 0.0])

    def errors(first, second):
        s = two_link.solve([Target("tip", wishes[0], weight=first), Target("tip", wishes[1], weight=second)])
        assert_honest(s)
        assert not s.success
        return [error.position for error in s.errors]

    equal, heavy = errors(1.0, 1.0), errors(5.0, 1.0)
    assert equal[0] == pytest.approx(equal[1], abs=1e-3)
    assert heavy[0] < 0.1 * heavy[1]
    assert_good(two_link.solve(Target("tip", wishes[0], weight=1e-3)))


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
    assert is_good(arm, elsewhere, state.q)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"q0": [0.0] * 3}, "q0 must be 12 finite numbers"),
        ({"q0": [math.nan] * 12}, "q0 must be 12 finite numbers"),
        ({"position": [0, 0]}, "position must be 3 finite numbers"),
        ({"position": [0, 0, math.inf]}, "position must be 3 finite numbers"),
        ({"position": [0, 0, 1e300]}, "must be a point within 1e\\+09 m of the origin"),
        ({"tolerance": 1e-3}, "tolerance must be 2 finite numbers"),
        ({"tolerance": (1e-3, 0.0)}, "two positive numbers"),
        ({"restarts": -1}, "restarts must be a whole number of at least 0"),
        ({"max_iterations": 2.5}, "max_iterations must be a whole number"),
        ({"time_limit": 0}, "time_limit must be a positive number"),
        ({"locked": "bone1_x"}, "locked must be a list"),
        ({"locked": ["bone1_q"]}, "did you mean 'bone1_z'|did you mean 'bone1_x'"),
        ({"method": "newton"}, "no method 'newton'; available: 'ccd'"),
        ({"damp": 3}, "no keyword 'damp'; did you mean 'damping'. .the method is 'dls'."),
        ({"engine": "cuda"}, "no engine 'cuda'"),
    ],
)
def test_bad_input_is_refused_in_words(options, words, arm):
    keywords = {"position": [0.3, 0.1, 0.8]} | options
    with pytest.raises(pinik.PinikError, match=words):
        arm.solve("tip", **keywords)


@pytest.mark.parametrize("targets", [None, 3, ["tip"], [None], {"frame": "tip"}])
def test_what_is_no_target_is_refused(targets, arm):
    with pytest.raises(pinik.InputError, match="targets must be Target objects"):
        pinik.solve(arm, targets)
    states = pinik.iterate(arm, Target("tip", [0, 0, 1]))
    next(states)
    with pytest.raises(pinik.InputError, match="targets must be Target objects"):
        states.send(targets if targets is not None else 3)


def test_every_front_takes_the_name_of_a_frame_with_a_targets_keywords(arm):
    wanted = arm.placement("tip", arm.poses["reach"])
    asked = {"position": wanted.translation, "axis": "z", "direction": wanted.rotation[:, 2], "tool": (0, 0, 0.1)}
    target = Target("tip", **asked)
    expected = pinik.solve(arm, target, "pinv", engine="python")
    for s in (
        arm.solve("tip", method="pinv", engine="python", **asked),
        pinik.solve(arm, "tip", "pinv", engine="python", **asked),
        pinik.prepare(arm, "tip", "pinv", engine="python", **asked)(),
    ):
        assert s.targets == (target,)
        np.testing.assert_array_equal(s.q, expected.q)
    *_, last = pinik.iterate(arm, "tip", "pinv", **asked)
    *_, same = pinik.iterate(arm, target, method="pinv")
    np.testing.assert_array_equal(last.q, same.q)


def test_iterates_old_keyword_still_works_and_warns(arm):
    target = Target("tip", [0.4, 0.2, 0.8])
    with pytest.warns(DeprecationWarning, match="use method= instead"):
        old = pinik.iterate(arm, target, solver="ccd")
    assert [state.q.tolist() for state in old] == [state.q.tolist() for state in pinik.iterate(arm, target, "ccd")]


def test_the_last_run_of_a_failed_solve_has_a_number_of_its_own(panda):
    opposed = [Target("panda_hand_tcp", [0.4, y, 0.5]) for y in (-0.2, 0.2)]
    s = pinik.solve(panda, opposed, restarts=3, max_iterations=5, trace=True, engine="python")
    assert not s.success
    assert s.restarts == 3
    begun = [state for state in s.trace if state.iteration == 0]
    assert [state.attempt for state in begun] == [0, 1, 2, 3, 4]
    assert [state.attempt for state in s.trace] == sorted(state.attempt for state in s.trace)


def test_the_name_of_a_frame_says_nothing_of_its_place(arm):
    for front in (pinik.solve, pinik.prepare, pinik.iterate):
        with pytest.raises(pinik.InputError, match="target 'tip': nothing is asked for; give position="):
            front(arm, "tip")
    states = pinik.iterate(arm, Target("tip", [0, 0, 1]))
    next(states)
    with pytest.raises(pinik.InputError, match="targets must be Target objects; got 'tip'"):
        states.send("tip")


@pytest.mark.parametrize("locked", [None, 3, "bone1_x"])
def test_locked_that_is_no_list_is_refused(locked, arm):
    with pytest.raises(pinik.InputError, match="locked must be a list"):
        arm.solve("tip", position=[0, 0, 1], locked=locked)


def test_a_robot_is_needed():
    with pytest.raises(pinik.InputError, match=r"robot must be what pinik.load returns; got 'arm'"):
        pinik.solve("arm", Target("tip", [0, 0, 1]))


def test_targets_may_come_from_a_generator(arm):
    assert pinik.solve(arm, (Target(frame, [0.3, 0.1, 0.9]) for frame in ["tip"])).success


def test_an_unknown_frame_lists_near_ones(arm):
    with pytest.raises(pinik.UnknownNameError, match="no frame 'tipp'; did you mean 'tip'"):
        arm.solve("tipp", position=[0, 0, 1])


def test_targets_that_are_none_are_refused(arm):
    with pytest.raises(pinik.InputError, match="at least one target"):
        arm.solve([])
    with pytest.raises(pinik.InputError, match="targets must be Target objects"):
        arm.solve([[0.1, 0.2, 0.3]])
    with pytest.raises(pinik.InputError, match=r"pass it to Target\(...\)"):
        arm.solve([Target("tip", [0, 0, 1])], rpy=[0, 0, 0])


def test_sent_targets_have_iterations_of_their_own(arm):
    states = pinik.iterate(arm, Target("tip", [0.4, 0.2, 0.8]), "jt", max_iterations=3, tolerance=(1e-12, 1e-12))
    state = next(states)
    for _ in range(3):
        taken = 0
        while state.status is None:
            state = next(states)
            taken += 1
        assert state.status is Status.MAX_ITERATIONS
        state = states.send(Target("tip", [0.3, -0.2, 0.9]))
        assert state.status is None
        assert taken >= 2


def test_iterate_takes_the_solvers_parameters(arm):
    *_, last = pinik.iterate(arm, Target("tip", [0.4, 0.2, 0.8]), "ccd", stiffness={"bone1_x": 0.5})
    assert last.status is Status.CONVERGED


def test_without_restarts_a_solve_is_what_iterate_does(panda):
    rng = np.random.default_rng(6)
    for _ in range(5):
        target = Target("panda_hand_tcp", placement=panda.placement("panda_hand_tcp", panda.random(rng)))
        q0 = panda.random(rng)
        s = panda.solve(target, q0=q0, restarts=0, trace=True, engine="python")
        states = list(pinik.iterate(panda, target, q0=q0))
        assert len(s.trace) == len(states)
        assert all(np.array_equal(a.q, b.q) for a, b in zip(s.trace, states, strict=True))


@pytest.mark.parametrize("method", ["dls", "pinv"])
@pytest.mark.parametrize("weight", [1e-2, 1e-3, 1e3])
def test_a_light_target_is_reached_all_the_same(method, weight, arm):
    rng = np.random.default_rng(3)
    for _ in range(5):
        wanted = arm.placement("tip", arm.random(rng))
        targets = [Target("tip", wanted.translation, weight=weight), Target("tip", rotation=wanted.rotation)]
        s = arm.solve(targets, method=method)
        assert_good(s)


@pytest.mark.parametrize("method", FOUR)
def test_equal_weights_share_equally(method):
    """One slide, two frames on it that want to be 1 m apart: each gets half."""
    robot = load_quietly(
        robot_text(
            *(link(name) for name in ("base", "sled", "near", "far")),
            joint("slide", "base", "sled", axis(1, 0, 0), kind="prismatic", limit=limit(-2.0, 2.0)),
            joint("a", "sled", "near", origin((0, 0.1, 0)), kind="fixed", limit=""),
            joint("b", "sled", "far", origin((0, 1.0, 0)), kind="fixed", limit=""),
        )
    )
    s = robot.solve([Target("near", [1.0, 0.1, 0.0]), Target("far", [0.0, 1.0, 0.0])], method=method)
    assert [error.position for error in s.errors] == pytest.approx([0.5, 0.5], abs=1e-6)


def test_a_state_put_inside_that_hits_the_target_is_a_success():
    """A step beyond the limits, cut off by max_iterations, whose clip is exact: the verdict goes by the errors."""
    robot = load_quietly(
        robot_text(
            *(link(name) for name in ("a", "b", "c", "d")),
            joint("j", "a", "b", axis(1, 0, 0), kind="prismatic", limit=limit(-1.0, 0.0)),
            joint("k", "b", "c", axis(0, 0, 1), limit=limit(0.0, 1.0)),
            joint("t", "c", "d", origin((1, 0, 0)), kind="fixed", limit=""),
        )
    )
    for method in JACOBIAN_METHODS:
        s = robot.solve("d", [0, 0, 0], method=method, q0=[-1, 0.5], max_iterations=2)
        assert_honest(s, {"frame": "d", "position": [0, 0, 0]})
        assert "  " not in s.message
        assert " ;" not in s.message


@pytest.mark.parametrize("method", FOUR)
def test_a_robot_without_joints_is_judged_where_it_stands(method):
    robot = load_quietly(robot_text(link("a"), link("b"), joint("j", "a", "b", kind="fixed", limit="")))
    s = robot.solve("b", [0, 0, 2], method=method)
    assert (s.status, s.iterations, s.restarts) == (Status.STALLED, 0, 0)
    assert s.position_error == 2.0
    assert robot.solve("b", [0, 0, 0], method=method).success


def test_angles_are_told_whole(two_link):
    s = two_link.solve("tip", rpy=[2.0, 0.0, 0.0])
    assert "115° off" in s.message


def test_a_frame_on_the_point_it_looks_at_looks_at_it(arm):
    M = arm.placement("tip", arm.neutral())
    s = arm.solve("tip", axis="x", at=M.translation + M.rotation @ [0, 0, 5e-10], restarts=0)
    assert s.success
    assert s.iterations == 0


def test_neither_a_yielded_configuration_nor_a_solutions_can_be_spoiled(arm):
    state = next(pinik.iterate(arm, Target("tip", [0.4, 0.2, 0.8])))
    with pytest.raises(ValueError, match="read-only"):
        state.q[:] = math.nan
    s = arm.solve("tip", position=[0.4, 0.2, 0.8])
    with pytest.raises(ValueError, match="read-only"):
        s.q[0] = 0.5


@pytest.mark.parametrize(
    ("ask", "word"),
    [
        (lambda arm, place: pinik.iterate(arm, "tip", position=place, restarts=3), "restarts"),
        (lambda arm, place: pinik.prepare(arm, "tip", position=place, q0=arm.neutral()), "q0"),
        (lambda arm, place: pinik.solve_many(arm, "tip", position=[place]), "position"),
    ],
)
def test_a_keyword_that_a_function_lacks_is_not_suggested_to_it(arm, ask, word):
    with pytest.raises(pinik.UnknownNameError) as caught:
        ask(arm, [0.4, 0.2, 0.8])
    assert caught.value.name == word
    assert word not in caught.value.valid
