"""Explanations against plain Pinocchio's Jacobian and numpy's singular values, and against the step that follows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio
import pytest

import pinik
from judge import plain_placement
from pinik.model.home import home_configuration
from pinik.solvers.registry import make_solver
from pinik.viewer.simulation.by_iteration import step_iteration
from pinik.viewer.simulation.explainer import Explainer
from pinik.viewer.simulation.instance import Instance
from pinik.viewer.simulation.session import Session
from pinik.viewer.simulation.step_settings import StepSettings
from robots import load_quietly
from stand_ins import Clock

NEAR = [0.05, 0.12, -0.09]  # [m] from where the effector is


def begin(robot, solver, frames=("tip",), by=NEAR, **settings):
    """An instance in the home pose, targets a little away from its effectors, and what the method does next."""
    home = home_configuration(robot)
    one = Instance(robot, make_solver(solver), home, StepSettings(**settings), Clock())
    targets = [pinik.Target(f, plain_placement(robot, f, home).translation + by) for f in frames]
    return one, targets, Explainer().explain(one, targets)


def plain_jacobian(robot, q, frames):
    """The position rows of Pinocchio's frame Jacobians along the world's axes."""
    data = robot.model.createData()
    world = pinocchio.LOCAL_WORLD_ALIGNED
    return np.vstack(
        [pinocchio.computeFrameJacobian(robot.model, data, q, robot.model.getFrameId(f), world)[:3] for f in frames]
    )


def of_columns(robot, names, vector):
    """The entries of a tangent vector that belong to joints of one axis, in the order of their names."""
    return np.array([vector[robot.model.joints[robot.model.getJointId(name)].idx_v] for name in names])


def plain_origins(robot, q):
    """The origins of the Panda's seven arm joints and of its tool at `q`."""
    data = robot.model.createData()
    pinocchio.forwardKinematics(robot.model, data, q)
    joints = [data.oMi[robot.model.getJointId(f"panda_joint{k}")].translation for k in range(1, 8)]
    return np.array([*joints, plain_placement(robot, "panda_hand_tcp", q).translation])


def change_of(robot, entry, change):
    """A configuration that is zero but for one entry."""
    return change * np.eye(robot.model.nq)[entry]


@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
@pytest.mark.parametrize(("machine", "frames"), [("arm", ("tip",)), ("panda", ("panda_hand_tcp",))])
def test_singular_values_are_those_of_the_plain_jacobian(request, machine, frames, method):
    robot = request.getfixturevalue(machine)
    one, _, told = begin(robot, method, frames)
    J = plain_jacobian(robot, one.q, frames)
    left, sigma, _ = np.linalg.svd(J)
    assert told.rows == tuple(f"{f} {axis}" for f in frames for axis in "xyz")
    columns = np.column_stack([of_columns(robot, told.columns, row) for row in J]).T
    np.testing.assert_allclose(told.J, columns, atol=1e-12)
    np.testing.assert_allclose(told.spectrum.sigma, sigma, rtol=1e-9)
    np.testing.assert_allclose(told.e, NEAR, atol=1e-12)
    np.testing.assert_allclose(abs(told.spectrum.parts), abs(left.T @ NEAR), atol=1e-9)
    np.testing.assert_allclose(told.spectrum.gradient, columns.T @ NEAR, atol=1e-12)
    null = np.eye(len(told.columns)) - np.linalg.pinv(columns) @ columns
    np.testing.assert_allclose(told.spectrum.freedom, null.diagonal(), atol=1e-9)
    assert told.spectrum.nullity == len(told.columns) - np.linalg.matrix_rank(columns)


def test_the_residual_of_two_effectors_has_the_rows_of_both(lion):
    frames = ("nose", "left_fore_paw")
    one, _, told = begin(lion, "dls", frames)
    assert len(told.rows) == 6
    sigma = np.linalg.svd(plain_jacobian(lion, one.q, frames), compute_uv=False)
    np.testing.assert_allclose(told.spectrum.sigma, sigma, rtol=1e-9)


@pytest.mark.parametrize(("rule", "damping"), [("constant", 0.2), ("residual", 0.7), ("sugihara", 0.1)])
def test_damping_is_the_rules_and_bounds_every_gain(panda, rule, damping):
    one, _, told = begin(panda, pinik.DampedLeastSquares(rule=rule, damping=damping), ("panda_hand_tcp",))
    error = np.linalg.norm(NEAR)
    squared = {
        "constant": damping**2,
        "residual": damping**2 * error**2,
        "sugihara": 0.5 * error**2 + damping**2,
    }[rule]
    assert told.spectrum.value == pytest.approx(np.sqrt(squared), rel=1e-9)
    sigma = np.linalg.svd(plain_jacobian(panda, one.q, ("panda_hand_tcp",)), compute_uv=False)
    np.testing.assert_allclose(told.spectrum.gains, sigma / (sigma**2 + squared), rtol=1e-9)
    assert max(told.spectrum.gains) <= 1 / (2 * np.sqrt(squared)) + 1e-12


def test_the_transposes_alpha_is_the_one_that_leaves_the_smallest_residual(panda):
    one, _, told = begin(panda, "jt", ("panda_hand_tcp",))
    J = plain_jacobian(panda, one.q, ("panda_hand_tcp",))
    along = J @ J.T @ NEAR
    assert told.spectrum.value == pytest.approx(float(along @ NEAR / (along @ along)), rel=1e-9)
    np.testing.assert_allclose(told.asked, told.spectrum.value * told.spectrum.gradient, atol=1e-12)
    assert begin(panda, pinik.JacobianTranspose(alpha=0.3), ("panda_hand_tcp",))[2].spectrum.value == pytest.approx(0.3)


@pytest.mark.parametrize("method", ["jt", "pinv", "dls"])
def test_gains_times_parts_give_the_step(panda, method):
    """Δq = Σ gᵢ (uᵢᵀe) vᵢ, with numpy's own singular vectors."""
    _, _, told = begin(panda, method, ("panda_hand_tcp",))
    left, _, right = np.linalg.svd(told.J, full_matrices=False)
    np.testing.assert_allclose(told.asked, (told.spectrum.gains * (left.T @ NEAR)) @ right, atol=1e-9)
    assert told.predicted == pytest.approx(float(np.linalg.norm(NEAR - told.J @ told.step)), abs=1e-9)


def test_dropped_singular_values_gain_nothing(panda):
    _, _, told = begin(panda, pinik.PseudoInverse(cutoff=0.5), ("panda_hand_tcp",))
    sigma = told.spectrum.sigma
    assert told.spectrum.value == pytest.approx(0.5 * sigma[0])
    np.testing.assert_allclose(told.spectrum.gains, np.where(sigma > 0.5 * sigma[0], 1 / sigma, 0))
    assert 0 in told.spectrum.gains


@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
@pytest.mark.parametrize("far", [1.0, 20.0])
def test_the_iteration_that_follows_is_the_one_explained(panda, method, far):
    """Also far out of reach, where the damping and the limits matter."""
    one, targets, told = begin(panda, method, ("panda_hand_tcp",), by=np.array(NEAR) * far)
    before = one.q
    one.step_iteration(targets)
    change = pinocchio.difference(panda.model, before, one.q)
    np.testing.assert_allclose(told.step, of_columns(panda, told.columns, change), atol=1e-9)
    error = np.linalg.norm(plain_placement(panda, "panda_hand_tcp", one.q).translation - targets[0].position)
    assert told.after == pytest.approx(error, abs=1e-9)
    assert abs(change).max() > 1e-3


def test_iterations_follow_one_another_and_are_no_steps(panda):
    one, targets, told = begin(panda, pinik.JacobianTranspose(), ("panda_hand_tcp",))
    whole = Instance(panda, one.solver, one.q, StepSettings(until_reached=False, at_most=3), Clock())
    whole.step(targets)
    for taken in range(3):
        assert told.residual > told.after
        one.step_iteration(targets)
        assert "between two iterations" in one.verdict().message
        assert f"{taken + 1} taken" in one.verdict().message
        told = Explainer().explain(one, targets)
    np.testing.assert_allclose(one.q, whole.q, atol=1e-12)
    assert not one.counted
    one.step(targets)
    assert one.status == "CONVERGED"
    assert one.counted
    reached = one.q
    one.step_iteration(targets)
    assert one.q is reached
    assert Explainer().explain(one, targets).reached


def test_iterations_are_counted_since_the_ball_moved(arm):
    shown = Session(arm, ["jt"], clock=Clock())
    shown.set_motion("curve")
    for _ in range(50):
        shown.step()
    for position in ([0.3, 0.1, 0.8], [0.2, 0.3, 0.8]):
        shown.move_ball(0, position)
        for taken in range(1, 4):
            step_iteration(shown)
            assert f"between two iterations, {taken} taken" in shown.seen[0].verdict().message


def test_a_sweep_turns_each_joint_to_its_best_angle(panda):
    """Each turn is the best of its joint by brute force, and each begins where the last one ended."""
    one, targets, told = begin(panda, "ccd", ("panda_hand_tcp",))
    goal, q = np.array(targets[0].position), one.q.copy()
    names = [turn.joint for turn in told.turns]
    assert names == [f"panda_joint{k}" for k in (7, 6, 5, 4, 3, 2, 1)]
    for turn in told.turns:
        entry = panda.model.joints[panda.model.getJointId(turn.joint)].idx_q
        data = panda.model.createData()
        pinocchio.forwardKinematics(panda.model, data, q)
        placement = data.oMi[panda.model.getJointId(turn.joint)]
        np.testing.assert_allclose(turn.axis, placement.rotation[:, 2], atol=1e-12)
        np.testing.assert_allclose(np.cross(turn.origin - placement.translation, turn.axis), 0, atol=1e-12)
        np.testing.assert_allclose(turn.before, plain_placement(panda, "panda_hand_tcp", q).translation, atol=1e-9)
        arc = pinocchio.exp3(turn.axis * turn.amount) @ (turn.before - turn.origin) + turn.origin
        np.testing.assert_allclose(turn.after, arc, atol=1e-9)
        low, high = panda.model.lowerPositionLimit[entry], panda.model.upperPositionLimit[entry]
        errors = []
        for angle in np.linspace(low, high, 2001):
            turned = q.copy()
            turned[entry] = angle
            errors.append(np.linalg.norm(plain_placement(panda, "panda_hand_tcp", turned).translation - goal))
        q[entry] += turn.change
        there = plain_placement(panda, "panda_hand_tcp", q).translation
        assert np.linalg.norm(there - goal) <= min(errors) + 1e-6
        assert turn.limited == (min(q[entry] - low, high - q[entry]) < 1e-9)
        np.testing.assert_allclose(turn.chain[-1], there, atol=1e-9)
        assert len(turn.chain) == 8
        unmoved = plain_origins(panda, q - change_of(panda, entry, turn.change))
        differ = np.flatnonzero(abs(turn.chain - unmoved).max(axis=1) > 1e-9)
        assert turn.moved == (differ[0] if differ.size else 8)
    assert told.after == pytest.approx(np.linalg.norm(there - goal), abs=1e-9)


def test_a_joint_that_a_limit_holds_is_named_and_its_column_is_zero(panda):
    home = home_configuration(panda)
    upper = panda.model.upperPositionLimit
    one = Instance(panda, make_solver("dls"), home, StepSettings(), Clock())
    entry = panda.model.joints[panda.model.getJointId("panda_joint1")].idx_q
    q = home.copy()
    q[entry] = upper[entry]
    one.put(q)
    past = q.copy()
    past[entry] += 0.3
    target = pinik.Target("panda_hand_tcp", plain_placement(panda, "panda_hand_tcp", past).translation)
    told = Explainer().explain(one, [target])
    assert "panda_joint1" in told.held
    assert not told.J[:, told.columns.index("panda_joint1")].any()
    assert told.step[told.columns.index("panda_joint1")] == 0


def test_what_cannot_be_explained_gives_its_reason(panda, two_link):
    @dataclass(frozen=True, kw_only=True)
    class Bad(pinik.JacobianSolver):
        name = "bad"

        def direction(self, J, e):
            raise ZeroDivisionError("not today")

    one, _, told = begin(panda, Bad, ("panda_hand_tcp",))
    assert told == "the solver failed: ZeroDivisionError: not today"
    assert Explainer().explain(one, []) == "there are no targets"
    bones = Instance(two_link, make_solver("two_bone"), home_configuration(two_link), StepSettings(), Clock())
    asked = [pinik.Target("tip", [0.1, 0.0, 0.2], rpy=[0, 0, 0])]
    assert Explainer().explain(bones, asked).startswith("waiting: ")


def test_a_method_of_ones_own_shows_its_jacobian_and_its_step(panda):
    @dataclass(frozen=True, kw_only=True)
    class Tenth(pinik.JacobianSolver):
        name = "tenth"

        def direction(self, J, e):
            return 0.1 * J.T @ e

    _, _, told = begin(panda, Tenth, ("panda_hand_tcp",))
    assert (len(told.spectrum.gains), told.spectrum.value) == (0, None)
    np.testing.assert_allclose(told.asked, 0.1 * told.J.T @ NEAR, atol=1e-12)


def test_a_new_parameter_and_new_limits_are_explained_as_if_for_the_first_time():
    """What is kept between explanations never shows: the target is within reach without limits only, and that decides
    about the damping."""
    robot = load_quietly("double_pendulum_simple")
    kept = Explainer()
    home = home_configuration(robot)
    target = [pinik.Target("link3", [0.0375, 0.08, 0.2])]
    values = {}
    for damping, limits in [
        (0.1, True),
        (0.7, True),
        (0.7, False),
        (0.1, True),
        (0.2, True),
        (0.3, True),
        (0.4, False),
    ]:
        solver = pinik.DampedLeastSquares(damping=damping)
        one = Instance(robot, solver, home, StepSettings(limits=limits), Clock())
        told, anew = kept.explain(one, target), Explainer().explain(one, target)
        assert told.spectrum.value == anew.spectrum.value
        np.testing.assert_array_equal(told.step, anew.step)
        values[damping, limits] = told.spectrum.value
    assert values[0.7, True] != values[0.7, False]
