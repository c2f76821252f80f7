"""The properties of transpose, pseudo-inverse and damped least squares, on Jacobians of any shape and rank."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from engines import needs_native
from judge import assert_good
from pinik import DampedLeastSquares, JacobianTranspose, PseudoInverse
from robots import load_quietly
from urdf_texts import joint, link
from urdf_texts import robot as robot_text


@st.composite
def linear_problems(draw, *, full_rank=False):
    """(J, e) with rows of metres and radians; often with columns of zeros or of low rank."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    m, n = draw(st.sampled_from([(3, 2), (3, 7), (6, 6), (6, 7), (6, 12), (12, 9)]))
    J = rng.normal(size=(m, n))
    if not full_rank:
        rank = draw(st.integers(0, min(m, n)))
        left, sigma, right = np.linalg.svd(J, full_matrices=False)
        sigma[rank:] = 0.0
        J = (left * sigma) @ right
    return J, rng.normal(size=m) * draw(st.sampled_from([1e-6, 1.0, 30.0]))


@given(linear_problems())
def test_the_transpose_with_its_alpha_never_increases_the_linearised_error(problem):
    J, e = problem
    dq = JacobianTranspose().direction(J, e)
    before, after = np.linalg.norm(e), np.linalg.norm(e - J @ dq)
    assert after <= before * (1 + 1e-12)
    for factor in (0.9, 1.1):  # no other length does better along that line
        assert after <= np.linalg.norm(e - factor * (J @ dq)) + 1e-12 * before


def test_the_transpose_with_a_fixed_alpha_is_that_multiple_of_the_gradient(arm):
    """One step of the loop at α = 0.01, by hand."""
    q0 = arm.random(1)
    target = pinik.Target("tip", [0.5, 0.1, 0.7])
    states = list(pinik.iterate(arm, target, JacobianTranspose(alpha=0.01), q0, limits=False, max_iterations=1))
    J = arm.jacobian("tip", q0)[:3]
    e = target.position - arm.placement("tip", q0).translation
    assert np.allclose(states[1].q - q0, 0.01 * J.T @ e, atol=1e-14)


@given(linear_problems())
def test_the_pseudo_inverse_is_the_minimum_norm_least_squares_step(problem):
    J, e = problem
    dq = PseudoInverse(cutoff=1e-9).direction(J, e)
    expected, *_ = np.linalg.lstsq(J, e, rcond=1e-9)  # LAPACK's gelsd: another algorithm
    assert np.allclose(dq, expected, atol=1e-9 * max(1.0, np.linalg.norm(expected)))


@given(linear_problems(), st.integers(0, 2**32 - 1))
def test_the_null_space_term_does_not_move_the_effector(problem, seed):
    J, e = problem
    pull = np.random.default_rng(seed).normal(size=J.shape[1])
    solver = PseudoInverse(cutoff=1e-9)
    moved = solver.direction(J, e, pull) - solver.direction(J, e)
    assert np.abs(J @ moved).max() <= 1e-9 * max(1.0, np.abs(J).max())
    assert moved @ pull >= -1e-12  # and it goes towards the rest posture, or nowhere


def test_small_singular_values_are_dropped():
    J = np.diag([1.0, 0.5, 1e-5])
    e = np.array([1.0, 1.0, 1.0])
    assert np.allclose(PseudoInverse(cutoff=1e-3).direction(J, e), [1.0, 2.0, 0.0])
    assert np.allclose(PseudoInverse(cutoff=1e-6).direction(J, e), [1.0, 2.0, 1e5])


@given(linear_problems(full_rank=True))
def test_damped_least_squares_tends_to_the_pseudo_inverse(problem):
    J, e = problem
    exact = np.linalg.pinv(J) @ e
    condition = np.linalg.cond(J)
    gaps = []
    for damping in (1e-1, 1e-2, 1e-3):
        dq = DampedLeastSquares(rule="constant", damping=damping, factorization="svd").direction(J, e)
        gaps.append(np.linalg.norm(dq - exact))
    smallest = np.linalg.svd(J, compute_uv=False)[-1]
    bound = (1e-3 / smallest) ** 2 * np.linalg.norm(exact)
    assert gaps[2] <= bound + 1e-9 * condition * np.linalg.norm(exact)
    assert gaps[2] <= gaps[1] + 1e-12 <= gaps[0] + 2e-12


@given(linear_problems(), st.sampled_from([1e-2, 0.3, 1.1]))
def test_damped_least_squares_minimises_its_objective(problem, damping):
    """‖J dq − e‖² + λ²‖dq‖², as one least-squares problem (thesis, eq. 3.3.2)."""
    J, e = problem
    n = J.shape[1]
    stacked = np.vstack([J, damping * np.eye(n)])
    expected, *_ = np.linalg.lstsq(stacked, np.concatenate([e, np.zeros(n)]), rcond=None)
    dq = DampedLeastSquares(rule="constant", damping=damping).direction(J, e)
    assert np.allclose(dq, expected, atol=1e-6 * max(1.0, np.linalg.norm(expected)))


@given(
    linear_problems(),
    st.sampled_from(["constant", "residual", "sugihara", "manipulability"]),
    st.sampled_from([0.05, 0.2236, 1.1]),
)
def test_ldlt_and_svd_give_the_same_step(problem, rule, damping):
    J, e = problem
    ldlt = DampedLeastSquares(rule=rule, damping=damping, factorization="ldlt")
    svd = DampedLeastSquares(rule=rule, damping=damping, factorization="svd")
    lambda_squared = svd.damping_squared(J, float(np.linalg.norm(e)))
    condition = (np.linalg.norm(J) ** 2 + lambda_squared) / lambda_squared
    a, b = ldlt.direction(J, e), svd.direction(J, e)
    assert np.linalg.norm(a - b) <= 1e-14 * condition * max(np.linalg.norm(b), np.linalg.norm(e))


def test_the_damping_rules_are_their_formulas():
    J = np.array([[1.0, 0.2, 0.0], [0.0, 0.1, 0.3]])
    residual = 0.7
    w = math.sqrt(np.linalg.det(J @ J.T))
    expected = {
        "constant": 0.4**2,
        "residual": 0.4**2 * residual**2,
        "sugihara": 0.5 * residual**2 + 0.4**2,
        "manipulability": 0.4**2 * (1 - w / 0.5) ** 2,
    }
    assert 0.0 < w < 0.5
    for rule, value in expected.items():
        solver = DampedLeastSquares(rule=rule, damping=0.4, manipulability=0.5)
        assert solver.damping_squared(J, residual) == pytest.approx(value, abs=1e-11)
    regular = DampedLeastSquares(rule="manipulability", damping=0.4, manipulability=0.9 * w)
    assert regular.damping_squared(J, residual) == pytest.approx(0.0, abs=1e-11)


@pytest.mark.parametrize("rule", ["constant", "residual", "sugihara", "manipulability"])
@pytest.mark.parametrize("factorization", ["ldlt", "svd"])
def test_every_damping_solves(rule, factorization, panda):
    wanted = panda.placement("panda_hand_tcp", panda.random(4))
    damping = {"constant": 0.05, "residual": 0.2, "sugihara": 0.03, "manipulability": 0.1}[rule]
    s = panda.solve("panda_hand_tcp", placement=wanted, rule=rule, factorization=factorization, damping=damping)
    assert_good(s)


def test_the_rest_posture_is_tended_to_while_the_effector_does_not_notice(panda):
    """Long after the target is reached, the null space brings the elbow nearer to rest than it was without."""
    rest = {name: angle for name, angle in panda.angles(panda.poses["default"]).items() if name not in panda.mimics}
    target = pinik.Target("panda_hand_tcp", [0.4, 0.2, 0.5])
    q = panda.configuration({"panda_joint1": 1.0, "panda_joint3": -1.0, "panda_joint4": -1.5, "panda_joint6": 1.0})
    q = panda.solve(target, method="pinv", q0=q).q
    distance = {}
    for gain in (0.0, 0.2):
        solver = PseudoInverse(rest_posture=rest, rest_gain=gain)
        now = q
        for _ in range(60):
            # a tolerance that is never met: the chase goes on at the target
            *_, last = pinik.iterate(panda, target, solver, now, max_iterations=1, tolerance=(1e-30, 1e-30))
            now = last.q
        assert last.position_error < 2e-3
        angles = panda.angles(now)
        distance[gain] = math.hypot(*(angles[name] - rest[name] for name in rest))
    assert distance[0.2] < 0.7 * distance[0.0]


@pytest.mark.parametrize("method", [JacobianTranspose, PseudoInverse, DampedLeastSquares], ids=lambda m: m.name)
def test_no_joint_moves_further_than_max_step(method, panda):
    target = pinik.Target("panda_hand_tcp", [0.4, -0.3, 0.4], rpy=[3.0, 0.1, 0.5])
    solver = method(max_step=0.05)
    states = list(pinik.iterate(panda, target, solver, panda.random(11), max_iterations=40, limits=False))
    steps = np.abs(np.diff([state.q for state in states], axis=0))
    assert steps.max() <= 0.05 + 1e-12
    assert steps.max() > 0.049  # the clamp was at work


@pytest.mark.parametrize("method", [JacobianTranspose, PseudoInverse, DampedLeastSquares], ids=lambda m: m.name)
def test_d_max_shortens_the_pull_and_keeps_its_direction(method, arm):
    """A target 100 D_max off pulls as one D_max off on the same line does, but for the damping that sees it all."""
    q0 = arm.random(2)
    p = arm.placement("tip", q0).translation
    line = np.array([0.6, 0.0, 0.8])
    rule = {"rule": "constant", "damping": 0.1} if method is DampedLeastSquares else {}
    steps = []
    for far, d_max in ((0.02, math.inf), (2.0, 0.02)):
        solver = method(max_residual=d_max, **rule)
        *_, last = pinik.iterate(arm, pinik.Target("tip", p + far * line), solver, q0, limits=False, max_iterations=1)
        steps.append(last.q - q0)
    assert np.linalg.norm(steps[0]) > 1e-4
    assert np.allclose(*steps, atol=1e-10)


@pytest.mark.parametrize("method", [JacobianTranspose, PseudoInverse, DampedLeastSquares], ids=lambda m: m.name)
def test_the_target_jacobian_reaches_targets_as_well(method, arm):
    s = arm.solve("tip", position=[0.3, 0.2, 0.8], method=method, target_jacobian=True)
    assert_good(s)


WEIGHTS = {"bone1_x": 0.25, "bone3_z": 0.04, "bone6_x": 0.5}


def one_step(arm, solver, q0):
    """(step, J, e, √w) of the loop's first iteration from q0, by plain arithmetic but for the step."""
    target = pinik.Target("tip", [0.5, 0.1, 0.7])
    states = list(pinik.iterate(arm, target, solver, q0, limits=False, max_iterations=1))
    e = target.position - arm.placement("tip", q0).translation
    roots = np.sqrt([WEIGHTS.get(name, 1.0) for name in arm.joint_names])
    return states[1].q - q0, arm.jacobian("tip", q0)[:3], e, roots


def test_stiffness_weighs_the_transpose_s_gradient(arm):
    """Welman's way: Δq_i = α w_i (Jᵀe)_i."""
    solver = JacobianTranspose(alpha=0.1, max_step=math.inf, stiffness=WEIGHTS)
    dq, J, e, roots = one_step(arm, solver, arm.random(1))
    assert np.allclose(dq, 0.1 * roots**2 * (J.T @ e), atol=1e-14)


def test_stiffness_weighs_the_pseudo_inverse_s_norm(arm):
    """Of all steps with J dq = e the one with the smallest Σ dq² / w."""
    dq, J, e, roots = one_step(arm, PseudoInverse(max_step=math.inf, stiffness=WEIGHTS), arm.random(1))
    assert np.allclose(J @ dq, e, atol=1e-12)
    _, _, right = np.linalg.svd(J)
    kernel = right[3:]
    assert np.allclose(kernel @ (dq / roots**2), 0.0, atol=1e-12)  # no way along the null space makes it smaller


def test_stiffness_weighs_the_damping(arm):
    """‖J dq − e‖² + λ² Σ dq² / w, as one least-squares problem."""
    solver = DampedLeastSquares(rule="constant", damping=0.3, stiffness=WEIGHTS)
    dq, J, e, roots = one_step(arm, solver, arm.random(1))
    stacked = np.vstack([J, 0.3 * np.diag(1.0 / roots)])
    expected, *_ = np.linalg.lstsq(stacked, np.concatenate([e, np.zeros(len(roots))]), rcond=None)
    assert np.allclose(dq, expected, atol=1e-12)


def test_a_joint_goes_to_the_rest_posture_by_its_weight(arm):
    """φ leads joint i gain · w_i of the way, as far as the tip stays where it is."""
    q0 = arm.random(1)
    target = pinik.Target("tip", arm.placement("tip", q0).translation)
    rest = dict.fromkeys(arm.joint_names, 0.3)
    solver = PseudoInverse(rest_posture=rest, rest_gain=0.5, max_step=math.inf, stiffness=WEIGHTS)
    kinematics = pinik.Kinematics(arm, target)
    roots = np.sqrt([WEIGHTS.get(name, 1.0) for name in arm.joint_names])
    seen = kinematics.linearize(q0)
    dq = roots * solver.step(seen._replace(J=seen.J * roots), kinematics)
    weighted = seen.J * roots
    pull = roots * 0.5 * (0.3 - q0)
    expected = roots * (pull - np.linalg.pinv(weighted) @ (weighted @ pull))
    assert np.allclose(dq, expected, atol=1e-12)
    assert np.abs(seen.J @ dq).max() < 1e-12


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
@pytest.mark.parametrize("method", ["jt", "pinv", "dls"])
def test_a_joint_of_stiffness_zero_stays_and_the_answer_is_still_found(arm, method, engine):
    wanted = arm.placement("tip", arm.random(5)).translation
    q0 = arm.random(6)
    s = arm.solve("tip", position=wanted, method=method, q0=q0, stiffness={"bone2_z": 0.0}, engine=engine)
    assert s.success
    assert s.q[arm.joint_names.index("bone2_z")] == q0[arm.joint_names.index("bone2_z")]


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
@pytest.mark.parametrize("method", ["jt", "pinv", "dls"])
def test_only_the_ratios_of_stiffness_weights_count(arm, method, engine):
    wanted = arm.placement("tip", arm.random(5)).translation
    asked = {"position": wanted, "method": method, "q0": arm.random(6), "restarts": 0, "engine": engine}
    free = arm.solve("tip", **asked)
    for weight in (0.3, 1e-4):
        alike = arm.solve("tip", **asked, stiffness=dict.fromkeys(arm.joint_names, weight))
        assert alike.iterations == free.iterations
        assert np.allclose(alike.q, free.q, atol=1e-9)


@pytest.mark.parametrize(("lightest", "kept"), [(1.0, 2), (0.1, 3)])
def test_the_cutoff_is_relative_to_the_largest_singular_value_and_to_the_lightest_row(lightest, kept):
    J, e = np.diag([1.0, 1.0, 0.0008]), np.array([0.3, -0.2, 0.1])
    expected = np.linalg.pinv(J, rcond=0.001 * lightest) @ e
    assert np.count_nonzero(expected) == kept
    dq = PseudoInverse(cutoff=0.001).direction(J, e, None, lightest)
    np.testing.assert_allclose(dq, expected, rtol=1e-12, atol=0.0)


def test_with_a_rest_posture_a_light_target_is_served_as_without():
    """Two slides with a target each, one of a thousandth of the other's weight; neither has a null space."""
    slide = {"kind": "prismatic", "limit": '<limit lower="-1" upper="1" effort="1" velocity="1"/>'}
    axis = '<axis xyz="0 0 1"/>'
    robot = load_quietly(
        robot_text(*map(link, "abc"), joint("up", "a", "b", axis, **slide), joint("off", "a", "c", axis, **slide))
    )
    targets = [pinik.Target("b", [0.0, 0.0, 0.3]), pinik.Target("c", [0.0, 0.0, -0.2], weight=1e-3)]
    kinematics = pinik.Kinematics(robot, targets)
    solver = PseudoInverse(cutoff=0.1, rest_posture={"up": 0.5, "off": 0.5})
    step = solver.step(kinematics.linearize(robot.neutral()), kinematics)
    wanted = robot.configuration({"up": 0.3, "off": -0.2})
    np.testing.assert_allclose(step, wanted, atol=1e-12)


def test_the_cutoff_does_not_grow_with_the_number_of_large_singular_values():
    J, e = np.diag([1.0, 1.0, 1.0, 0.0012]), np.ones(4)
    np.testing.assert_allclose(PseudoInverse(cutoff=0.001).direction(J, e), np.linalg.pinv(J, rcond=0.001) @ e)


def test_a_given_residual_replaces_the_norm_of_e_in_the_rules():
    """On J = 1 the step is e / (1 + λ²), with λ² = damping² residual²."""
    J, e = np.eye(3), np.array([0.3, 0.0, 0.4])
    solver = DampedLeastSquares(damping=2.0, rule="residual")
    assert solver.direction(J, e) == pytest.approx(e / (1.0 + 4.0 * 0.25))
    assert solver.direction(J, e, 3.0) == pytest.approx(e / (1.0 + 4.0 * 9.0))
