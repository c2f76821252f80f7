"""`pinik collisions`: which pairs of links count as collisions, and what touches at given angles."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path
from typing import Annotated, Any

import typer

from ...robot import Robot
from ...shapes.collisions import Clearance, Collision
from ...shapes.disabled_pairs import written_disabled_pairs
from ...shapes.pairs import CollisionPairs
from ..inputs.assignments import configuration
from ..inputs.files import check_file, write_file
from ..inputs.loading import check_folders, load_robot
from ..inputs.obstacles import read_world
from ..inputs.options import (
    AllowOutside,
    AsJson,
    Degrees,
    JointAngles,
    PackageDirs,
    PoseName,
    RobotSource,
    Root,
    XacroArgs,
)
from ..reports.configuration_json import configuration_fields
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.tables import emit_table
from ..terminal.units import Units, counted

__all__ = ["collisions"]

# The words that MoveIt's setup assistant writes for the same reasons.
_SRDF_REASONS = {"adjacent": "Adjacent", "at rest": "Default", "always": "Always", "never": "Never", "srdf": "User"}


def collisions(
    robot: RobotSource,
    joint_angles: JointAngles = None,
    pose: PoseName = None,
    world: Annotated[
        Path | None, typer.Option("--world", metavar="CELL.urdf", help="What stands around the robot, as a URDF.")
    ] = None,
    write_srdf: Annotated[
        Path | None,
        typer.Option("--write-srdf", metavar="OUT", help="Write an SRDF that disables the pairs that do not count."),
    ] = None,
    degrees: Degrees = False,
    root: Root = "fixed",
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Show which pairs of links count as collisions and why, and what touches at the given angles.

    The pairs are those of the robot's SRDF file if it disables any. Else they are
    found out, which may take seconds, and kept in your cache folder.

    Example:

      pinik collisions panda --set panda_joint4=-3
    """
    if write_srdf is not None:
        check_file(write_srdf, "--write-srdf")
    check_folders(package_dir)
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    q = configuration(machine, pose, joint_angles, "--set", Units(degrees))
    around = None if world is None else read_world(world, package_dir)
    pairs = machine.collision_pairs
    touching, nearest = machine.collisions(q, around), machine.clearance(q, around)
    if write_srdf is not None:
        disabled = {pair: _SRDF_REASONS[why] for pair, why in pairs.left_out.items() if why in _SRDF_REASONS}
        write_file(write_srdf, written_disabled_pairs(machine.description.name, disabled).encode(), "--write-srdf")
    if as_json:
        output.emit_json(
            {
                "schema": 1,
                "robot": machine.name,
                **_pair_fields(pairs),
                "collisions": [_touch_fields(one) for one in touching],
                **_clearance_fields(nearest),
                **configuration_fields(machine, q),
            }
        )
    else:
        _emit(machine, pairs, touching, nearest)
    return ExitStatus.ANSWERED


def _pair_fields(pairs: CollisionPairs) -> dict[str, Any]:
    return {
        "source": pairs.source,
        "counting": [list(pair) for pair in pairs.counting],
        "left_out": [{"pair": list(pair), "reason": reason} for pair, reason in pairs.left_out.items()],
        "without_shapes": list(pairs.without_shapes),
    }


def _touch_fields(one: Collision) -> dict[str, Any]:
    return {
        "pair": list(one.pair),
        "with_world": one.with_world,
        "depth_m": one.depth,
        "normal": one.normal.tolist(),
        "points": one.points.tolist(),
    }


def _clearance_fields(nearest: Clearance) -> dict[str, Any]:
    return {
        "clearance_m": nearest.distance if math.isfinite(nearest.distance) else None,
        "nearest": None if nearest.pair is None else list(nearest.pair),
        "nearest_with_world": nearest.with_world,
        "nearest_points": None if nearest.points is None else nearest.points.tolist(),
    }


def _emit(robot: Robot, pairs: CollisionPairs, touching: list[Collision], nearest: Clearance) -> None:
    source = "its SRDF file says which" if pairs.source == "srdf" else "pinik found out which"
    every = len(pairs.counting) + len(pairs.left_out)
    output.emit(f"{robot.name}: {len(pairs.counting)} of {counted(every, 'pair')} of links count; {source}")
    reasons = Counter(pairs.left_out.values())
    if reasons:
        output.emit("left out: " + ", ".join(f"{count} {reason}" for reason, count in reasons.items()))
    if pairs.without_shapes:
        output.emit("without collision shapes, so they touch nothing: " + ", ".join(pairs.without_shapes))
    output.emit("")
    rows = [(a, b, "counts") for a, b in pairs.counting] + [(a, b, why) for (a, b), why in pairs.left_out.items()]
    emit_table(("link", "link ", ""), rows)
    output.emit("")
    if touching:
        rows = [(*_names(one), f"{one.depth:.4f}") for one in touching]
        emit_table(("touches", "", "depth [m]"), rows, numeric=("depth [m]",))
    elif nearest.pair is None:
        output.emit("nothing can touch: no pair counts")
    else:
        first, second = _names(nearest)
        output.emit(f"nothing touches; the nearest are {first} and {second}, {nearest.distance:.4f} m apart")


def _names(both: Collision | Clearance) -> tuple[str, str]:
    """The two names in words, where there are two; the second may be an object with the name of a link."""
    assert both.pair is not None
    link, other = both.pair
    return link, f"the object {other}" if both.with_world else other
