"""A solution as text: the message, the joints, the errors."""

from __future__ import annotations

from ...problem.tolerance import TargetError
from ...solving.solution import Solution
from ..terminal.output import emit, painted
from ..terminal.tables import emit_table
from ..terminal.units import Units, counted, duration, small_length

__all__ = ["emit_solution"]


def emit_solution(solution: Solution, units: Units) -> None:
    """Write a solution to stdout."""
    emit(painted(solution.message, "green" if solution.success else "red"))
    emit("")
    _emit_joints(solution, units)
    for name, placement in solution.joint_placements.items():
        emit(f"{name}: {units.show_placement(placement)}")
    if len(solution.targets) > 1:
        emit("")
        _emit_targets(solution, units)
    emit("")
    emit(f"error       {_errors(TargetError(solution.position_error, solution.orientation_error), units)}")
    emit(f"iterations  {solution.iterations}{_updates(solution)}, {counted(solution.restarts, 'restart')}")
    emit(f"time        {duration(solution.time)}")
    why = f" ({solution.why_not_native})" if solution.why_not_native else ""
    emit(f"method      {solution.method}, {solution.engine} engine{why}")


def _emit_joints(solution: Solution, units: Units) -> None:
    robot = solution.robot
    limits = dict(zip(robot.joint_names, zip(robot.lower, robot.upper, strict=True), strict=True))
    rows: list[tuple[str, ...]] = []
    marked = set()
    for name, value in solution.angles.items():
        joint = robot.joint(name)
        if joint.leader is not None:
            low = high = ""
            note = f"follows {joint.leader}"
        else:
            low, high = units.show_limits(*limits[name], joint)
            note = _limit_note(name, value, *limits[name], solution)
            if note:
                marked.add(len(rows))
        rows.append((name, units.show_scalar(value, joint), units.of(joint), low, high, note))
    if rows:
        titles = ("joint", "value", "unit", "lower", "upper", "")
        emit_table(titles, rows, numeric=("value", "lower", "upper"), marked=marked)


def _limit_note(name: str, value: float, lower: float, upper: float, solution: Solution) -> str:
    if name in solution.active_limits:
        return "at its lower limit" if value - lower < upper - value else "at its upper limit"
    if not lower <= value <= upper:
        return "outside its limits"
    return ""


def _emit_targets(solution: Solution, units: Units) -> None:
    rows = [
        (target.frame, _errors(error, units)) for target, error in zip(solution.targets, solution.errors, strict=True)
    ]
    emit_table(("target", "error"), rows)


def _errors(error: TargetError, units: Units) -> str:
    words = []
    if error.position is not None:
        words.append(f"{small_length(error.position)} m")
    if error.orientation is not None:
        words.append(f"{units.show_small_angle(error.orientation)} {units.angle}")
    return ", ".join(words)


def _updates(solution: Solution) -> str:
    return f" ({counted(solution.joint_updates, 'joint update')})" if solution.joint_updates else ""
