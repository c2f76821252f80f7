"""What one iteration costs in the Python engine, beside the Pinocchio calls that it cannot do without.

    python -m pytest benchmarks --benchmark-enable --benchmark-only

Timings differ from machine to machine; compare the rows of one run.
"""

from __future__ import annotations

import pinocchio
import pytest

import pinik
from pinik.model.limits import Limits
from pinik.problem.kinematics import Kinematics
from pinik.solving.stepping import advance

NEVER = pinik.Tolerance(1e-30, 1e-30)
FRAME = "panda_hand_tcp"


@pytest.fixture(scope="module")
def panda() -> pinik.Robot:
    return pinik.load("panda")


@pytest.fixture(scope="module")
def target(panda: pinik.Robot) -> pinik.Target:
    return pinik.Target(FRAME, placement=panda.placement(FRAME, panda.random(1)))


@pytest.mark.parametrize("method", list(pinik.SOLVERS))
def test_an_iteration_on_a_panda_pose(benchmark, panda, target, method):
    """Linearise, step, keep the limits: one turn of the loop (for CCD, a sweep over seven joints)."""
    solver = pinik.SOLVERS[method]()
    kinematics = Kinematics(panda, [target])
    limits = Limits.of(panda, True)
    q = panda.random(2)

    def iteration():
        return advance(solver, kinematics, limits, kinematics.linearize(q), NEVER)

    benchmark(iteration)


def test_the_bare_pinocchio_calls_of_such_an_iteration(benchmark, panda):
    model, data = panda.model, panda.model.createData()
    q, dq, frame = panda.random(2), 0.01 * panda.random(3), panda.frame_id(FRAME)

    def calls():
        pinocchio.computeFrameJacobian(model, data, q, frame, pinocchio.LOCAL_WORLD_ALIGNED)
        pinocchio.log3(data.oMf[frame].rotation)
        return pinocchio.integrate(model, q, dq)

    benchmark(calls)


@pytest.mark.parametrize("method", list(pinik.SOLVERS))
def test_a_solve_of_a_panda_position(benchmark, panda, method):
    target = pinik.Target(FRAME, panda.placement(FRAME, panda.random(1)).translation)
    q0 = panda.random(2)
    assert benchmark(lambda: pinik.solve(panda, target, method, q0=q0)).success
