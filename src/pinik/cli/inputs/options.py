"""The arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

__all__ = [
    "AllowOutside",
    "AsJson",
    "Degrees",
    "Engine",
    "JointAngles",
    "MethodParameters",
    "PackageDirs",
    "PoseName",
    "RelativeTo",
    "RobotSource",
    "Root",
    "XacroArgs",
]

RobotSource = Annotated[
    str,
    typer.Argument(
        metavar="ROBOT",
        help="The name of a robot in the catalogue ('pinik robots' lists them), or of one that "
        "robot_descriptions has downloaded, the path of a URDF or xacro file, or - for a URDF on stdin.",
        show_default=False,
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object, always in metres and radians.")]
Degrees = Annotated[
    bool,
    typer.Option(
        "--deg",
        help="Read and print angles in degrees; tolerances, --param and JSON stay in radians.",
    ),
]
Engine = Annotated[
    str, typer.Option(metavar="auto|python|native", help="The engine to use; auto takes native if it is available.")
]
Root = Annotated[
    str,
    typer.Option("--root", metavar="fixed|free_flyer|planar", help="How the root link is attached to the world."),
]
PackageDirs = Annotated[
    list[Path] | None,
    typer.Option("--package-dir", metavar="DIR", help="Search this folder first for package:// addresses; repeatable."),
]
XacroArgs = Annotated[
    list[str] | None,
    typer.Option("--xacro-arg", metavar="NAME:=VALUE", help="Set an argument of a xacro file; repeatable."),
]
AllowOutside = Annotated[
    bool,
    typer.Option(
        "--allow-outside",
        help="Let the URDF open meshes outside its own folder, its packages and the folders of --package-dir.",
    ),
]
PoseName = Annotated[
    str | None,
    typer.Option("--pose", metavar="NAME", help="Use the joint values of this named pose ('pinik info' lists them)."),
]
JointAngles = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="JOINT=ANGLE",
        help="The value of a joint (rad, or m for a sliding joint); repeatable. All other joints are at 0.",
    ),
]
RelativeTo = Annotated[
    str | None,
    typer.Option("--relative-to", metavar="FRAME", help="Express the result in this frame instead of the world."),
]
MethodParameters = Annotated[
    list[str] | None,
    typer.Option(
        "--param",
        metavar="METHOD.NAME=VALUE",
        help="Set a parameter of one method, such as jt.alpha=0.1 ('pinik solve --help' lists them); repeatable.",
    ),
]
