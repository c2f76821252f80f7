"""One robot with one solver against steps worked out by plain numpy and Pinocchio."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pinocchio
import pytest

import pinik
from judge import is_inside, plain_placement
from pinik.model.home import home_configuration
from pinik.solvers.registry import make_solver
from pinik.viewer.simulation.instance import Instance
from pinik.viewer.simulation.standing import STATUSES
from pinik.viewer.simulation.step_settings import StepSettings
from robots import load_quietly
from stand_ins import Clock

FAR = [9.0, 0.0, 0.0]
REACHABLE = [0.3, 0.1, 0.8]


@dataclass(frozen=True, kw_only=True)
class Lame(pinik.JacobianSolver):
    """Never moves; counts how often it is asked."""

    name = "lame"
    calls = []  # noqa: RUF012 - the test's handle

    def direction(self, J, e):
        self.calls.append(len(e))
        return np.zeros(J.shape[1])


class Tenth(pinik.JacobianSolver):
    """A tenth of the transpose's step; counts its calls."""

    name = "tenth"
    calls = []  # noqa: RUF012 - all instances share it on purpose

    def direction(self, J, e):
        self.calls.append(1)
        return 0.1 * J.T @ e


@dataclass(frozen=True, kw_only=True)
class Moody(pinik.JacobianSolver):
    """Raises while `moods` says so."""

    name = "moody"
    moods = []  # noqa: RUF012 - the test's handle

    def direction(self, J, e):
        if self.moods and self.moods.pop(0):
            raise ZeroDivisionError("not today")
        return np.linalg.pinv(J) @ e


def instance(robot, solver="dls", clock=None, **settings):
    return Instance(robot, make_solver(solver), home_configuration(robot), StepSettings(**settings), clock or Clock())


def distance(robot, q, frame, position):
    return float(np.linalg.norm(plain_placement(robot, frame, q).translation - position))


def test_one_iteration_is_one_step_of_the_solver(arm):
    """q ⊕ 0.1·Jᵀe, by Pinocchio's own Jacobian."""
    Tenth.calls.clear()
    one = instance(arm, Tenth, until_reached=False, at_most=1, limits=False)
    q = one.q
    data = arm.model.createData()
    for count in range(1, 4):
        J = pinocchio.computeFrameJacobian(arm.model, data, q, arm.frame_id("tip"), pinocchio.LOCAL_WORLD_ALIGNED)
        e = np.array(REACHABLE) - plain_placement(arm, "tip", q).translation
        expected = pinocchio.integrate(arm.model, q, 0.1 * J[:3].T @ e)
        one.step([pinik.Target("tip", REACHABLE)])
        assert np.allclose(one.q, expected, atol=1e-12)
        assert (one.last.iterations, len(Tenth.calls), one.status) == (1, count, "MAX_ITERATIONS")
        assert one.last.jump == pytest.approx(np.abs(expected - q).max())
        assert one.last.error == pytest.approx(distance(arm, expected, "tip", REACHABLE))
        assert not one.last.reached
        q = expected


@pytest.mark.parametrize("at_most", [1, 3, 7])
def test_a_step_takes_so_many_iterations_and_no_more(arm, at_most):
    Tenth.calls.clear()
    some = instance(arm, Tenth, until_reached=False, at_most=at_most)
    target = pinik.Target("tip", REACHABLE)
    for step in range(1, 4):
        some.step([target])
        assert (some.last.iterations, len(Tenth.calls)) == (at_most, step * at_most)


@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
def test_until_reached_ends_within_tolerance_by_plain_forward_kinematics(arm, method):
    one = instance(arm, method)
    target = pinik.Target("tip", REACHABLE)
    for _ in range(20):
        one.step([target])
    assert one.status == "CONVERGED"
    assert distance(arm, one.q, "tip", REACHABLE) <= 1e-4
    assert is_inside(arm, one.q)
    verdict = one.verdict()
    assert verdict.status == "CONVERGED"
    assert verdict.position_error == pytest.approx(distance(arm, one.q, "tip", REACHABLE))
    assert verdict.orientation_error is None


def test_a_step_with_nothing_to_do_costs_nothing_and_does_not_count(arm):
    one = instance(arm)
    target = pinik.Target("tip", REACHABLE)
    while one.status != "CONVERGED":
        one.step([target])
    q = one.q
    one.step([target])
    assert not one.counted
    assert one.q is q
    assert one.last[:3] == (0.0, 0, 0)
    assert (one.last.jump, one.last.reached, one.last.idle) == (0.0, True, True)
    one.step([pinik.Target("tip", REACHABLE)])  # another target, if an equal one: its ball was moved there
    assert one.counted
    assert not one.last.idle


def test_nothing_asked_for_is_idle_and_the_next_target_counts_from_nothing(arm):
    one = instance(arm, Tenth, until_reached=False, at_most=2)
    target = pinik.Target("tip", REACHABLE)
    for _ in range(3):
        one.step([target])
    q = one.q
    one.step([])
    assert (one.status, one.last, one.counted, one.orientation_error) == ("IDLE", None, False, None)
    assert one.verdict() == ("IDLE", "there are no targets", None, None, ())
    assert one.q is q
    one.step([target])
    assert one.last.iterations == 2


def test_before_the_first_step_it_says_so(arm):
    one = instance(arm)
    assert one.verdict() == ("IDLE", "no step has been taken yet", None, None, ())
    one.step([pinik.Target("tip", FAR)])
    assert one.verdict().status == "UNREACHABLE"
    one.settings = StepSettings(limits=False)
    assert (one.status, one.verdict().message) == ("IDLE", "no step has been taken yet")


def test_once_other_targets_are_asked_for_the_last_result_is_void(arm):
    one = instance(arm)
    target = pinik.Target("tip", REACHABLE)
    while one.status != "CONVERGED":
        one.step([target])
    assert one.verdict([target]) == one.verdict()
    overdue = one.verdict([pinik.Target("tip", FAR)])
    assert overdue.status == "IDLE"
    assert overdue.position_error == pytest.approx(distance(arm, one.q, "tip", FAR))
    assert overdue.message == f"no step has been taken since a ball changed; {overdue.position_error:.3g} m off"
    two = one.verdict([target, pinik.Target("bone3", REACHABLE, rpy=[0.0, 0.0, 0.0])])
    assert two.position_error == pytest.approx(distance(arm, one.q, "bone3", REACHABLE))
    assert two.orientation_error > 0.0
    assert one.verdict([]) == ("IDLE", "there are no targets", None, None, ())
    assert one.verdict().status == "CONVERGED"


def test_another_solver_goes_on_from_where_the_robot_is(arm):
    one = instance(arm)
    one.step([pinik.Target("tip", REACHABLE)])
    q = one.q
    one.settings = StepSettings(until_reached=False)
    one.solver = make_solver("ccd")
    assert one.q is q
    assert one.last is None


def test_a_step_stops_at_the_tolerance_unless_it_is_polished(arm):
    place = arm.placement("tip", home_configuration(arm) + 0.1).translation
    plain, polished = (instance(arm, "dls", polish=on) for on in (False, True))
    for one in (plain, polished):
        one.step([pinik.Target("tip", place)])
    assert plain.last.iterations < polished.last.iterations
    assert distance(arm, polished.q, "tip", place) < 1e-8 < distance(arm, plain.q, "tip", place) < 1e-4


def test_limits_hold_when_they_are_on_and_only_then(arm):
    free, kept = (instance(arm, "pinv", limits=on) for on in (False, True))
    rng = np.random.default_rng(1)
    left = False
    for _ in range(20):
        target = pinik.Target("tip", rng.uniform(-0.9, 0.9, 3))
        for one in (free, kept):
            one.step([target])
        assert is_inside(arm, kept.q)
        left = left or not is_inside(arm, free.q)
    assert left
    free.settings = StepSettings(limits=True)
    free.step([target])
    assert is_inside(arm, free.q)


def test_joints_at_their_limits_are_named_with_their_side(arm):
    one = instance(arm)
    name = arm.joint_names[3]
    q = arm.neutral()
    index = arm.joint(name).idx_q
    q[index] = arm.upper_q[index]
    one.put(q)
    assert one.limit_sides() == {name: "upper"}
    q[index] = arm.lower_q[index] - 0.1
    one.put(q)
    assert one.limit_sides() == {name: "lower"}
    assert not one.verdict().active_limits


def test_active_limits_are_those_that_could_move_a_target(lion):
    one = instance(lion)
    q = one.q.copy()
    tail = lion.joint("tail6_pitch").idx_q  # far from the way to the nose
    q[tail] = lion.upper_q[tail]
    one.put(q)
    one.step([pinik.Target("nose", [5.0, 0.0, 0.3])])
    assert "tail6_pitch" in one.limit_sides()
    at_a_limit = {
        joint.name
        for joint in lion.joints
        if joint.nq == 1
        and (
            one.q[joint.idx_q] <= lion.lower_q[joint.idx_q] + 1e-6
            or one.q[joint.idx_q] >= lion.upper_q[joint.idx_q] - 1e-6
        )
    }
    J = pinocchio.computeFrameJacobian(
        lion.model, lion.model.createData(), one.q, lion.frame_id("nose"), pinocchio.LOCAL_WORLD_ALIGNED
    )
    on_the_way = {joint.name for joint in lion.joints if J[:, joint.idx_v].any()}
    assert set(one.verdict().active_limits) == at_a_limit & on_the_way
    assert one.verdict().active_limits


def test_unreachable_is_said_where_it_is_proved(arm):
    """The chain's bones have a total length of 1.2 m."""
    one = instance(arm)
    for away in (1.25, 3.0):
        one.step([pinik.Target("tip", [0.0, away, 0.12])])
        assert one.verdict().status == "UNREACHABLE"
        assert f"{100 * (away - 1.2):.1f}"[:3] in one.verdict().message or "m" in one.verdict().message
    one.step([pinik.Target("tip", REACHABLE)])
    for _ in range(20):
        one.step([pinik.Target("tip", REACHABLE)])
    assert one.verdict().status == "CONVERGED"


@pytest.mark.parametrize("method", ["ccd", "jt", "dls"])
def test_a_place_that_some_configuration_has_is_never_unreachable(arm, method):
    rng = np.random.default_rng(4)
    one = instance(arm, method, until_reached=False, at_most=3)
    for _ in range(25):
        place = plain_placement(arm, "tip", arm.random(rng)).translation
        one.step([pinik.Target("tip", place)])
        verdict = one.verdict()
        assert verdict.status != "UNREACHABLE"
        assert verdict.position_error == pytest.approx(distance(arm, one.q, "tip", place))


def test_a_missed_orientation_is_no_proof(panda):
    one = instance(panda)
    target = pinik.Target("panda_hand_tcp", [0.84, 0.0, 0.3], rpy=[0.0, -math.pi / 2, 0.0])
    for _ in range(10):
        one.step([target])
    verdict = one.verdict()
    assert verdict.status in ("STALLED", "MAX_ITERATIONS")
    at = plain_placement(panda, "panda_hand_tcp", one.q)
    turn = pinocchio.rpy.rpyToMatrix(0.0, -math.pi / 2, 0.0) @ at.rotation.T
    assert verdict.orientation_error == pytest.approx(math.acos((np.trace(turn) - 1) / 2), abs=1e-6)
    assert verdict.position_error == pytest.approx(np.linalg.norm(at.translation - target.position))
    assert one.orientation_error == pytest.approx(verdict.orientation_error)


def test_time_that_runs_out_stops_a_step(arm):
    """Every reading of the clock takes a second: two at the start, one before each iteration, one at the end."""
    Tenth.calls.clear()
    one = instance(arm, Tenth, clock=Clock(each=1.0))
    target = pinik.Target("tip", REACHABLE)
    one.step([target], seconds=4.0)
    assert (one.status, one.verdict().status) == ("TIME_LIMIT", "TIME_LIMIT")
    assert len(Tenth.calls) == 3
    assert (one.last.iterations, one.last.time, one.last.reached, one.last.cut_off) == (3, 6.0, False, True)
    one.step([target], seconds=4.0)  # goes on where it was, with one iteration whatever the clock says
    assert (len(Tenth.calls), one.last.iterations) == (7, 4)
    one.step([target], seconds=0.0)
    assert (len(Tenth.calls), one.last.iterations, one.status) == (8, 1, "TIME_LIMIT")


def test_a_step_without_a_budget_goes_to_its_end(arm):
    one = instance(arm, clock=Clock(each=1.0))
    one.step([pinik.Target("tip", REACHABLE)])
    assert (one.status, one.last.cut_off) == ("CONVERGED", False)


def test_a_solver_that_raises_has_failed_until_it_works_again(arm):
    Moody.moods[:] = [False, True, True]
    one = instance(arm, Moody, until_reached=False, at_most=1)
    target = pinik.Target("tip", REACHABLE)
    one.step([target])
    q = one.q
    for _ in range(2):
        one.step([target])
        assert (one.status, one.last.reached, one.last.error, one.counted) == ("FAILED", False, None, True)
        assert one.verdict() == ("FAILED", "the solver failed: ZeroDivisionError: not today", None, None, ())
        assert one.q is q
    for _ in range(30):
        one.step([target])
    assert one.verdict().status == "CONVERGED"
    assert distance(arm, one.q, "tip", REACHABLE) <= 1e-4


@pytest.mark.parametrize("answer", [np.full(12, np.nan), np.full(12, np.inf)])
def test_steps_that_are_no_numbers_do_not_move_the_robot(arm, answer):
    @dataclass(frozen=True, kw_only=True)
    class Lost(pinik.JacobianSolver):
        def direction(self, J, e):
            return answer

    one = instance(arm, Lost, until_reached=False, at_most=2)
    before = one.q.copy()
    one.step([pinik.Target("tip", REACHABLE)])
    assert np.array_equal(one.q, before)
    assert np.isfinite(one.last.error)


def test_a_step_of_the_wrong_shape_is_a_failure_in_words(arm):
    @dataclass(frozen=True, kw_only=True)
    class Short(pinik.JacobianSolver):
        def direction(self, J, e):
            return np.zeros(3)

    one = instance(arm, Short)
    one.step([pinik.Target("tip", REACHABLE)])
    assert one.status == "FAILED"
    assert "(12,)" in one.verdict().message


def test_a_solver_that_refuses_a_question_waits_for_another(arm):
    asked = []

    @dataclass(frozen=True, kw_only=True)
    class Picky(pinik.DampedLeastSquares):
        name = "picky"

        def check(self, kinematics):
            asked.append(len(kinematics.targets))
            if len(kinematics.targets) > 1:
                raise pinik.InputError("one at a time")

    one = instance(arm, Picky)
    tip, bone = pinik.Target("tip", REACHABLE), pinik.Target("bone2", [0.0, 0.0, 0.3])
    one.step([tip, bone])
    assert (one.status, one.counted, one.last) == ("REFUSED", False, None)
    assert one.verdict() == ("REFUSED", "waiting: one at a time", None, None, ())
    one.step([tip, bone])
    one.step([tip, pinik.Target("bone2", [0.0, 0.1, 0.3])])
    assert (one.status, one.counted) == ("REFUSED", False)
    assert asked == [2]  # the same kind of question is asked once: compiling it takes milliseconds
    one.step([tip])
    assert (one.status, one.counted) == ("CONVERGED", True)
    q = one.q
    one.step([tip, bone])
    assert (one.status, one.q is q) == ("REFUSED", True)
    one.step([])
    assert one.verdict().message == "there are no targets"
    one.step([tip])
    assert one.status == "CONVERGED"


def test_a_jump_of_a_free_root_is_measured_in_its_tangent():
    lion = load_quietly("lion", root="free_flyer")
    one = instance(lion, "dls", until_reached=False, at_most=1)
    before = one.q
    one.step([pinik.Target("nose", plain_placement(lion, "nose", before).translation + np.array([0.3, 0.1, 0.0]))])
    assert one.last.jump == pytest.approx(np.abs(pinocchio.difference(lion.model, before, one.q)).max())
    assert one.last.jump > 0


def test_every_status_a_solve_can_have_is_listed():
    solved = ("CONVERGED", "STALLED", "MAX_ITERATIONS", "TIME_LIMIT", "UNREACHABLE", "COLLIDING")
    assert ("IDLE", *solved, "FAILED", "REFUSED") == STATUSES


def test_a_method_that_stalled_in_its_place_is_asked_again_only_when_something_changes(arm):
    one = instance(arm, Lame)
    target = [pinik.Target("tip", REACHABLE)]

    def asked():
        Lame.calls.clear()
        one.step(target)
        return len(Lame.calls) > 0

    assert [asked() for _ in range(4)] == [True, True, False, False]
    assert (one.status, one.counted, one.last.iterations, one.last.reached) == ("STALLED", False, 0, False)
    assert one.last.error == pytest.approx(distance(arm, one.q, "tip", REACHABLE))
    target = [pinik.Target("tip", REACHABLE)]
    assert asked(), "the target moved"
    asked()
    assert not asked()
    one.settings = StepSettings(limits=False)
    assert asked()
    asked()
    assert not asked()
    one.put(arm.random(np.random.default_rng(1)))
    assert asked()
