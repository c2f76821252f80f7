"""The numerical constants that both engines share, as passed to the compiled engine."""

from __future__ import annotations

from typing import Any

from ... import checks
from ...engine import load
from ...model import configurations, joint, limits
from ...problem import problem, reach, slack, targets, tolerance
from ...solvers import ccd, chaser, damped_least_squares, pseudo_inverse
from .. import aims, attempts, changes, choice, colliding, continuum, run, search, spread, starts, walk, way_out

__all__ = ["CONSTANTS", "make_constants", "make_way_out"]

CONSTANTS = {
    "farthest": checks.FARTHEST,
    "widest_range": joint.WIDEST_RANGE,
    "unit_rounding": configurations.UNIT_ROUNDING,
    "largest_unit_error": configurations.LARGEST_UNIT_ERROR,
    "barely_outside": limits.BARELY_OUTSIDE,
    "radian": problem.RADIAN,
    "no_direction": targets.NO_DIRECTION,
    "reach_rounding": reach.ROUNDING,
    "slack_share": slack.SHARE,
    "wide_angle": tolerance.WIDE_ANGLE,
    "smallest_damping_squared": damped_least_squares.SMALLEST_DAMPING_SQUARED,
    "smallest_cutoff": pseudo_inverse.SMALLEST_CUTOFF,
    "ccd_rounding": ccd.ROUNDING,
    "ccd_suspect": ccd.SUSPECT,
    "ccd_no_column": ccd.NO_COLUMN,
    "ccd_halvings": ccd.HALVINGS,
    "ccd_wide_position": chaser.WIDE_POSITION,
    "bold_part_of_distance": run.BOLD_SHARE,
    "part_of_chain": run.SHARE_OF_CHAIN,
    "polishing_gain": run.POLISHING_GAIN,
    "exact_part_of_chain": run.EXACT_SHARE_OF_CHAIN,
    "restarts_when_unreachable": attempts.RESTARTS_WHEN_UNREACHABLE,
    "exact_attempts": attempts.EXACT_ATTEMPTS,
    "colliding_least": colliding.LEAST_ATTEMPTS,
    "colliding_since": colliding.SINCE_NEW,
    "same_answer": choice.SAME_ANSWER,
    "nothing_new_share": choice.NOTHING_NEW_SHARE,
    "table_size": starts.SIZE,
    "table_nearest": starts.NEAREST,
    "table_key": starts.OF_THE_TABLE,
    "spread_size": spread.SIZE,
    "spread_nearest": spread.NEAREST,
    "exact_answer": search.EXACT,
    "search_least": search.LEAST,
    "search_since": search.SINCE,
    "search_samples": search.SAMPLES,
    "search_ranks": search.RANKS,
    "search_rank_threshold": continuum.RANK_THRESHOLD,
    "search_approach": search.APPROACH,
    "search_basin": search.BASIN,
    "search_outside": search.OUTSIDE,
    "search_spacing": search.SPACING,
    "search_nearly_singular": search.NEARLY_SINGULAR,
    "search_alike": search.ALIKE,
    "continuum_singular": continuum.SINGULAR,
    "continuum_aside": continuum.ASIDE,
    "continuum_iterations": continuum.ITERATIONS,
    "continuum_parts": continuum.PARTS,
    "continuum_few_parts": continuum.FEW_PARTS,
    "jump_floor": changes.JUMP_FLOOR,
    "jump_factor": changes.JUMP_FACTOR,
    "jump_damping": changes.JUMP_DAMPING,
    "opposite": aims.OPPOSITE,
    "creep_halvings": walk.CREEP_HALVINGS,
    "tick_iterations": walk.TICK_ITERATIONS,
}
"""The value of each constant that is one number, by its name in the compiled engine."""

PATIENCES = {"to_the_end": run.TO_THE_END, "search_patience": search.PATIENCE}
"""The patience of runs, likewise."""


OF_WAY_OUT = {
    "ways": attempts.WAYS_OUT,
    "steps": way_out.STEPS,
    "iterations": way_out.ITERATIONS,
    "longest_step": way_out.LONGEST_STEP,
    "gap": way_out.GAP_SHARE_OF_CHAIN,
    "probe": way_out.PROBE,
    "same_rank": way_out.SAME_RANK,
    "stuck": way_out.STUCK,
    "damping": way_out.DAMPING,
}
"""The constants of the way out, likewise."""


def make_constants() -> Any:
    """Build the compiled engine's copy of the constants."""
    native = load()
    constants = native.Constants()
    for name, value in CONSTANTS.items():
        setattr(constants, name, value)
    for name, patience in PATIENCES.items():
        setattr(constants, name, native.Patience(patience.iterations, patience.progress))
    return constants


def make_way_out() -> Any:
    """Build the compiled engine's copy of the constants of the way out."""
    settings = load().WayOutSettings()
    for name, value in OF_WAY_OUT.items():
        setattr(settings, name, value)
    return settings
