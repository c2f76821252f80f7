"""The conversion of problems and solvers for the compiled engine."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio

from ...engine import load
from ...model.compiled import native_robot
from ...model.limits import Limits
from ...problem.problem import Problem
from ...problem.reach import reach_bounds
from ...problem.tolerance import Tolerance
from ...solvers.base import JacobianSolver, Solver
from ...solvers.ccd import CCD
from ...solvers.damped_least_squares import DampedLeastSquares
from ...solvers.pseudo_inverse import PseudoInverse
from ...solvers.transpose import JacobianTranspose
from ..question import Question
from .constants import make_constants, make_way_out

__all__ = ["make_engine"]

if TYPE_CHECKING:
    from ..._native import Engine

_MOST = 2**62  # the engine counts restarts and iterations in 64 bits; larger limits are reduced to this
_IDENTITY = pinocchio.SE3.Identity()


def make_engine(question: Question) -> Engine:
    """Build the compiled engine for a question."""
    module = load()
    options, problem = question.options, question.problem
    robot = native_robot(problem.robot)
    asked = module.Settings()
    asked.solver = _solver(question.solver, problem)
    asked.patience = module.Patience(question.solver.patience.iterations, question.solver.patience.progress)
    asked.limits = options.limits
    asked.restarts = min(options.restarts_at_most, _MOST)
    asked.seed = options.seed & 0xFFFFFFFFFFFFFFFF
    asked.max_iterations = min(options.iterations_at_most, _MOST)
    asked.iterations_to_the_end = min(options.iterations_to_the_end, _MOST)
    asked.time_limit = options.time_limit
    asked.trace = options.trace
    asked.choose_nearest = options.choose == "nearest"
    asked.choose_weights = [options.choose_weights.get(c.joint.name, 1.0) for c in problem.coordinates]
    asked.polish = options.polish and question.solver.converges_quadratically
    if question.guard is not None:
        asked.avoid(question.guard.native_shapes)
    asked.way_out = make_way_out()
    engine: Engine = module.Engine(robot, _problem(robot, problem), asked)
    return engine


def _problem(robot: Any, asked: Problem) -> Any:
    problem = load().Problem(robot, make_constants())
    free, limited = Limits.of(asked.robot, False), Limits.of(asked.robot)
    for term in asked.terms:
        target, chain = term.pattern, term.chain
        bounds = [reach_bounds(term, limits) for limits in (free, limited)]
        base = next((b.base for b in bounds if b is not None), np.zeros(3))
        reference, tool = chain.reference_placement or _IDENTITY, target.tool or _IDENTITY
        frame = asked.robot.model.frames[asked.robot.frame_id(target.frame)].placement
        problem.add_term(
            robot=robot,
            frame_joint=chain.frame_joint,
            frame_rotation=frame.rotation,
            frame_translation=frame.translation,
            has_tool=target.tool is not None,
            tool_rotation=tool.rotation,
            tool_translation=tool.translation,
            has_reference=chain.reference_placement is not None,
            reference_joint=chain.reference_joint,
            reference_rotation=reference.rotation,
            reference_translation=reference.translation,
            asks_position=target.position is not None,
            asks_rotation=target.rotation is not None,
            asks_axis=target.axis is not None,
            asks_at=target.at is not None,
            along=np.array(target.along, dtype=np.float64),
            tolerance=_tolerance(term.tolerance),
            axis=np.array([1.0, 0.0, 0.0]) if target.axis is None else target.axis,
            weight=term.weight,
            has_bounds=any(b is not None for b in bounds),
            base=base,
            reach=[math.inf if b is None else b.reach for b in bounds],
            hole=[0.0 if b is None else b.hole for b in bounds],
        )
    for coordinate in asked.coordinates:
        joint = coordinate.joint
        problem.add_coordinate(
            joint=joint.id,
            index=coordinate.index,
            entry=joint.idx_q if joint.nq == 1 else -1,
            movers=[(mover.id, multiplier) for mover, multiplier in coordinate.movers],
            moved=[(j.id, j.multiplier) for j in asked.robot.joints if joint.name in (j.name, j.leader)],
        )
    problem.finish(lightest=asked.lightest, size_of_chain=asked.size_of_chain, is_wide=asked.is_wide)
    return problem


def _tolerance(tolerance: Tolerance) -> Any:
    box = tolerance.box
    return load().Tolerance(
        position=tolerance.farthest,
        orientation=tolerance.orientation,
        is_box=box is not None,
        box=np.zeros(3) if box is None else np.array(box),
    )


def _solver(solver: Solver, problem: Problem) -> Any:
    module = load()
    native = module.Solver()
    native.method = module.Method[solver.name]
    native.max_step, native.max_residual = solver.max_step, solver.max_residual
    if isinstance(solver, CCD):
        if solver.stiffness:
            native.stiffness = [solver.stiffness.get(c.joint.name, 1.0) for c in problem.coordinates]
        native.relaxation = solver.relaxation_for(problem)
        native.loose_relaxation = solver.relaxation_for(problem, loose=True)
        native.position_weight = solver.position_weight
        native.printed_scaling = solver.scaling == "printed"
        return native
    assert isinstance(solver, JacobianSolver)
    roots = solver.roots(problem)
    if roots is not None:
        native.stiffness = [roots[c.joint.idx_v + c.index] ** 2 for c in problem.coordinates]
    native.step_size, native.target_jacobian = solver.step_size, solver.target_jacobian
    if isinstance(solver, JacobianTranspose):
        native.alpha = solver.alpha or 0.0
    elif isinstance(solver, PseudoInverse):
        native.cutoff, native.rest_gain = solver.cutoff, solver.rest_gain
        robot = problem.robot
        native.rest_posture = [(robot.joint(name).id, angle) for name, angle in solver.rest_posture.items()]
    elif isinstance(solver, DampedLeastSquares):
        native.damping, native.manipulability = solver.damping, solver.manipulability
        native.rule, native.by_svd = module.DampingRule[solver.rule], solver.factorization == "svd"
    return native
