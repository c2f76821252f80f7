"""Robots, problems and solvers handed over to the compiled engine."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
import pinocchio

from ...model.limits import Limits
from ...model.robot_model import Robot
from ...problem.kinematics import Kinematics
from ...problem.reach import reach_bounds
from ...solvers.base import JacobianSolver, Solver
from ...solvers.ccd import CCD
from ...solvers.damped_least_squares import DampedLeastSquares
from ...solvers.pseudo_inverse import PseudoInverse
from ...solvers.transpose import JacobianTranspose
from ..attempts import Settings
from .constants import make_constants
from .module import load

__all__ = ["make_engine"]

if TYPE_CHECKING:
    from ..._native import Engine

_MOST = 2**62  # restarts and iterations beyond it are not told apart; the engine counts in 64 bits
_IDENTITY = pinocchio.SE3.Identity()
_ROBOTS: WeakKeyDictionary[Robot, Any] = WeakKeyDictionary()


def make_engine(settings: Settings) -> Engine:
    """Build the compiled engine for these settings. Their start is not used: each call brings its own."""
    module = load()
    kinematics, limits = settings.kinematics, settings.limits
    robot = _robot(kinematics.robot)
    problem = _problem(robot, kinematics)
    asked = module.Settings()
    asked.solver = _solver(settings.solver, kinematics)
    asked.patience = module.Patience(settings.solver.patience.iterations, settings.solver.patience.progress)
    asked.tolerance = module.Tolerance(*settings.tolerance)
    asked.limits = limits.enabled
    asked.restarts = min(settings.restarts, _MOST)
    asked.seed = settings.seed & 0xFFFFFFFFFFFFFFFF
    asked.max_iterations = min(settings.max_iterations, _MOST)
    asked.iterations_to_the_end = min(settings.iterations_to_the_end, _MOST)
    asked.time_limit = settings.time_limit
    asked.trace = settings.trace
    engine: Engine = module.Engine(robot, problem, asked)
    return engine


def _robot(robot: Robot) -> Any:
    """The engine's copy of a robot, which is built once and then kept."""
    if robot not in _ROBOTS:
        _ROBOTS[robot] = _make_robot(robot)
    return _ROBOTS[robot]


def _make_robot(robot: Robot) -> Any:
    native, kinds = load().Robot(), load().JointKind
    leaders = {joint.leader for joint in robot.joints}
    model = robot.model
    for joint in robot.joints:
        placement = model.jointPlacements[joint.id]
        native.add_joint(
            kind=kinds[joint.kind],
            parent=model.parents[joint.id],
            rotation=placement.rotation,
            translation=placement.translation,
            axis=np.array(joint.axis),
            idx_q=joint.idx_q,
            nq=joint.nq,
            idx_v=joint.idx_v,
            nv=joint.nv,
            follows=joint.leader is not None,
            multiplier=joint.multiplier,
            offset=joint.offset,
            lower=float(robot.lower_q[joint.idx_q]) if joint.nq == 1 else -math.inf,
            upper=float(robot.upper_q[joint.idx_q]) if joint.nq == 1 else math.inf,
            shared=joint.name in leaders,
        )
    native.finish()
    return native


def _problem(robot: Any, kinematics: Kinematics) -> Any:
    problem = load().Problem(robot, make_constants())
    free, limited = Limits.of(kinematics.robot, False), Limits.of(kinematics.robot)
    for term in kinematics.terms:
        target = term.target
        bounds = [reach_bounds(term, kinematics.model, limits) for limits in (free, limited)]
        base = next((b.base for b in bounds if b is not None), np.zeros(3))
        reference = term.reference_placement or _IDENTITY
        problem.add_term(
            robot=robot,
            frame_joint=term.frame_joint,
            frame_rotation=term.frame_placement.rotation,
            frame_translation=term.frame_placement.translation,
            has_reference=term.reference_placement is not None,
            reference_joint=term.reference_joint,
            reference_rotation=reference.rotation,
            reference_translation=reference.translation,
            asks_position=target.position is not None,
            asks_rotation=target.rotation is not None,
            asks_axis=target.axis is not None,
            asks_at=target.at is not None,
            axis=np.array([1.0, 0.0, 0.0]) if target.axis is None else target.axis,
            weight=term.weight,
            has_bounds=any(b is not None for b in bounds),
            base=base,
            reach=[math.inf if b is None else b.reach for b in bounds],
            hole=[0.0 if b is None else b.hole for b in bounds],
        )
    for coordinate in kinematics.coordinates:
        joint = coordinate.joint
        problem.add_coordinate(
            joint=joint.id,
            index=coordinate.index,
            entry=joint.idx_q if joint.nq == 1 else -1,
            movers=[(mover.id, multiplier) for mover, multiplier in coordinate.movers],
            moved=[(j.id, j.multiplier) for j in kinematics.robot.joints if joint.name in (j.name, j.leader)],
        )
    problem.finish(lightest=kinematics.lightest, size_of_chain=kinematics.size_of_chain)
    return problem


def _solver(solver: Solver, kinematics: Kinematics) -> Any:
    module = load()
    native = module.Solver()
    native.method = module.Method[solver.name]
    native.max_step, native.max_residual = solver.max_step, solver.max_residual
    if isinstance(solver, CCD):
        if solver.stiffness:
            native.stiffness = [solver.stiffness.get(c.joint.name, 1.0) for c in kinematics.coordinates]
        native.relaxation = solver.relaxation_for(kinematics)
        native.position_weight = solver.position_weight
        native.printed_scaling = solver.scaling == "printed"
        return native
    assert isinstance(solver, JacobianSolver)
    roots = solver.roots(kinematics)
    if roots is not None:
        native.stiffness = [roots[c.joint.idx_v + c.index] ** 2 for c in kinematics.coordinates]
    native.step_size, native.target_jacobian = solver.step_size, solver.target_jacobian
    if isinstance(solver, JacobianTranspose):
        native.alpha = solver.alpha or 0.0
    elif isinstance(solver, PseudoInverse):
        native.cutoff, native.rest_gain = solver.cutoff, solver.rest_gain
        robot = kinematics.robot
        native.rest_posture = [(robot.joint(name).id, angle) for name, angle in solver.rest_posture.items()]
    elif isinstance(solver, DampedLeastSquares):
        native.damping, native.manipulability = solver.damping, solver.manipulability
        native.rule, native.by_svd = module.DampingRule[solver.rule], solver.factorization == "svd"
    return native
