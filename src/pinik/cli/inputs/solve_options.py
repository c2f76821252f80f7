"""The options of `pinik solve`, `solve-all`, `track` and `reach`, in the panels of their help."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from ...problem.tolerance import Tolerance

__all__ = [
    "At",
    "Axis",
    "Choose",
    "ChooseWeight",
    "Direction",
    "Engine",
    "Frame",
    "Lock",
    "MaxIterations",
    "Method",
    "MethodParameter",
    "NoLimits",
    "NoPolish",
    "Position",
    "QuatXyzw",
    "RelativeTo",
    "Restarts",
    "Rpy",
    "Seed",
    "Start",
    "StartPose",
    "TargetsFile",
    "TimeLimit",
    "ToleranceBox",
    "Tolerances",
    "Tool",
    "tolerance_of",
]

Vector = tuple[float, float, float]


def _target(help: str, metavar: str, **more: Any) -> Any:
    return typer.Option(metavar=metavar, help=help, rich_help_panel="The target", **more)


def _solver(help: str, metavar: str, **more: Any) -> Any:
    return typer.Option(metavar=metavar, help=help, rich_help_panel="The solver", **more)


def _start(help: str, metavar: str) -> Any:
    return typer.Option(metavar=metavar, help=help, rich_help_panel="Start and limits")


Frame = Annotated[str | None, _target("The frame to move.", "F")]
Position = Annotated[
    tuple[str, str, str] | None, _target("Target position, in metres; - leaves an axis free, as in - - 0.3.", "X Y Z")
]
Rpy = Annotated[Vector | None, _target("Target orientation as fixed-axis roll, pitch, yaw.", "R P Y")]
QuatXyzw = Annotated[
    tuple[float, float, float, float] | None, _target("Target orientation as a quaternion, scalar last.", "X Y Z W")
]
Axis = Annotated[
    str | None,
    _target(
        "Point this axis of the frame (-x, -y, -z too) along --direction or towards --at; the rotation about it is "
        "free.",
        "x|y|z",
    ),
]
Direction = Annotated[Vector | None, _target("The direction that --axis points along.", "X Y Z")]
At = Annotated[Vector | None, _target("The point that --axis points towards, in metres.", "X Y Z")]
Tool = Annotated[Vector | None, _target("The tool point to move, given in the frame, in metres.", "X Y Z")]
RelativeTo = Annotated[
    str | None, _target("Express the target in this frame instead of the world; it may move, too.", "FRAME")
]
TargetsFile = Annotated[
    str | None,
    _target(
        "Read several targets from a JSON list instead, in metres and radians (see docs/json.md); - is stdin.",
        "FILE.json",
    ),
]
Method = Annotated[str, _solver("The method: one of those listed below, or module:Class for your own.", "NAME")]
MethodParameter = Annotated[
    list[str] | None,
    _solver(
        "Set a parameter of the method (listed below); the value is read as JSON or as a word; repeatable.",
        "NAME=VALUE",
    ),
]
Tolerances = Annotated[
    tuple[float, float] | None,
    _solver("The largest errors that count as solved, in metres and radians.", "M RAD", show_default="0.0001 0.001"),
]
ToleranceBox = Annotated[
    Vector | None,
    _solver("The largest position errors along the target's own axes, in metres, instead of M.", "X Y Z"),
]
MaxIterations = Annotated[int | None, _solver("The most iterations of one attempt.", "N")]
TimeLimit = Annotated[float | None, _solver("The most seconds in all.", "S")]
Restarts = Annotated[int | None, _solver("The most restarts from other configurations; 0 for the bare method.", "N")]
Seed = Annotated[int, _solver("The seed of the restarts.", "N")]
Engine = Annotated[str, _solver("The engine to use; auto takes native if it is available.", "auto|python|native")]
Choose = Annotated[
    str,
    _solver("Take the first answer, or of several the one nearest to the start.", "first|nearest"),
]
ChooseWeight = Annotated[
    list[str] | None,
    _solver("With --choose nearest, a factor on the change of this joint; repeatable.", "JOINT=W"),
]
Start = Annotated[
    list[str] | None,
    _start(
        "Start this joint at a value (rad, or m for a sliding joint); repeatable. All other joints start at 0.",
        "JOINT=ANGLE",
    ),
]
StartPose = Annotated[str | None, _start("Start from this named pose ('pinik info' lists them).", "NAME")]
Lock = Annotated[list[str] | None, _start("Keep this joint at its start value; repeatable.", "JOINT")]
NoPolish = Annotated[
    bool,
    typer.Option(
        "--no-polish",
        help="Stop as soon as the target is within tolerance; dls and pinv otherwise go on to nanometres.",
        rich_help_panel="The solver",
    ),
]
NoLimits = Annotated[
    bool, typer.Option("--no-limits", help="Ignore the joint limits.", rich_help_panel="Start and limits")
]


def tolerance_of(pair: tuple[float, float] | None, box: Vector | None) -> Any:
    """The tolerance of `--tolerance`, with the sides of `--tolerance-box` in place of its metres."""
    return pair if box is None else (box, pair[1] if pair else Tolerance().orientation)
