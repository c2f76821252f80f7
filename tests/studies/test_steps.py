"""One method that chases a ball, held to plain Pinocchio and to closed forms."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from judge import plain_placement
from pinik.motion.figures import StepFigures
from pinik.problem.tolerance import Tolerance
from pinik.studies.steps import Rules, chase_with, in_pieces

NEAR = Tolerance(1e-4, 1e-3)


def bare(**changes):
    return Rules(tolerance=NEAR, bare=True, **changes)


def plain_jacobian(robot, frame, q):
    """The linear rows by Pinocchio alone."""
    data = robot.model.createData()
    index = robot.model.getFrameId(frame)
    return pinocchio.computeFrameJacobian(robot.model, data, q, index, pinocchio.LOCAL_WORLD_ALIGNED)[:3]


def test_one_bare_iteration_of_the_transpose_is_alpha_times_the_transpose(arm):
    q = arm.poses["reach"]
    tip = plain_placement(arm, "tip", q).translation
    e = np.array([0.02, -0.03, -0.04])
    solver = pinik.JacobianTranspose(alpha=0.3, max_step=math.inf)
    chase = chase_with(arm, "tip", solver, limits=False, rules=bare(max_iterations=1), start=q)
    step = chase.step(tip + e)
    moved = 0.3 * plain_jacobian(arm, "tip", q).T @ e
    there = plain_placement(arm, "tip", pinocchio.integrate(arm.model, q, moved)).translation
    assert step.jump == pytest.approx(np.abs(moved).max(), rel=1e-9)
    assert step.error == pytest.approx(np.linalg.norm(tip + e - there), rel=1e-9)
    assert (step.iterations, step.reached) == (1, False)


def test_a_pseudo_inverse_at_one_hundredth_leaves_37_percent_after_a_hundred_steps(arm):
    q = arm.poses["reach"]
    place = plain_placement(arm, "tip", q).translation + np.array([0.0, 0.01, -0.02])
    solver = pinik.PseudoInverse(step_size=0.01, max_step=math.inf)
    step = chase_with(arm, "tip", solver, limits=False, rules=bare(max_iterations=100), start=q).step(place)
    assert step.error / math.hypot(0.01, 0.02) == pytest.approx(0.99**100, rel=0.02)


def test_a_bare_step_knows_no_stall_and_one_of_an_engine_does(two_link):
    q = np.array([0.3, 0.5])
    far = np.array([0.0, 5.0, 0.0])
    solver = pinik.DampedLeastSquares()
    options = {"limits": False, "start": q}
    without = chase_with(two_link, "tip", solver, rules=bare(max_iterations=400), **options).step(far)
    rules = Rules(tolerance=NEAR, max_iterations=400)
    stalled = chase_with(two_link, "tip", solver, rules=rules, engine="python", **options).step(far)
    assert without.iterations == 400
    assert stalled.iterations < 400


@pytest.mark.parametrize("method", list(pinik.SOLVERS))
@pytest.mark.parametrize("rules", [bare(max_iterations=3000), Rules(tolerance=NEAR)], ids=["bare", "engine"])
def test_each_step_starts_where_the_last_one_ended(arm, method, rules):
    q = arm.poses["relaxed"]
    chase = chase_with(arm, "tip", pinik.SOLVERS[method](), limits=True, rules=rules, start=q)
    place = plain_placement(arm, "tip", q).translation + np.array([0.03, 0.02, -0.02])
    first, again = chase.step(place), chase.step(place)
    assert first.reached
    assert again.reached
    assert first.jump > 1e-3
    assert again.jump < 1e-3
    assert again.iterations <= 1


def test_ccd_counts_single_joints(arm):
    q = arm.poses["relaxed"]
    place = plain_placement(arm, "tip", q).translation + np.array([0.1, 0.2, -0.1])
    step = chase_with(arm, "tip", pinik.CCD(), limits=False, rules=bare(max_iterations=2), start=q).step(place)
    assert step.iterations == 2
    assert step.joint_updates == 24


@pytest.mark.parametrize("method", list(pinik.SOLVERS))
def test_a_bare_step_does_nothing_where_the_ball_is_reached_already(arm, method):
    q = arm.poses["relaxed"]
    near = plain_placement(arm, "tip", q).translation + np.array([0.5e-4, 0.0, 0.0])
    step = chase_with(arm, "tip", pinik.SOLVERS[method](), limits=True, rules=bare(), start=q).step(near)
    assert step[1:6] == (0, 0, True, pytest.approx(0.5e-4), 0.0)


def test_the_bare_loop_is_python_s(arm):
    with pytest.raises(pinik.EngineError, match="in the Python engine only"):
        chase_with(arm, "tip", pinik.CCD(), limits=True, rules=bare(), start=arm.poses["relaxed"], engine="native")


class Recorder:
    """A chase that writes down where it is sent."""

    engine = "none"

    def __init__(self):
        self.places = []

    def step(self, place):
        self.places.append(place.tolist())
        number = len(self.places)
        return StepFigures(0.5, 2, 3, number == 4, 1.0 / number, 5.0 - number)


def test_a_way_in_pieces_is_cut_evenly_and_summed():
    chase = Recorder()
    step = in_pieces(chase, np.array([4.0, 0.0, -8.0]), np.array([0.0, 0.0, 0.0]), 4)
    assert chase.places == [[1, 0, -2], [2, 0, -4], [3, 0, -6], [4, 0, -8]]
    assert step == StepFigures(2.0, 8, 12, True, 0.25, 4.0)
