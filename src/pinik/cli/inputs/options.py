"""The arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

__all__ = [
    "AsJson",
    "Degrees",
    "MethodParameters",
    "PackageDirs",
    "PoseName",
    "RelativeTo",
    "RobotSource",
    "Root",
    "Settings",
]

RobotSource = Annotated[
    str,
    typer.Argument(
        metavar="ROBOT",
        help="A name of the catalogue ('pinik robots' lists them) or the path of a URDF file.",
        show_default=False,
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object, always in metres and radians.")]
Degrees = Annotated[
    bool,
    typer.Option(
        "--deg",
        help="Angles in options and tables are degrees (tolerances, --param and JSON stay in radians).",
    ),
]
Root = Annotated[
    str,
    typer.Option("--root", metavar="fixed|free_flyer|planar", help="How the root link hangs in the world."),
]
PackageDirs = Annotated[
    list[Path] | None,
    typer.Option("--package-dir", metavar="DIR", help="Where package:// addresses are looked up first; repeatable."),
]
PoseName = Annotated[
    str | None,
    typer.Option("--pose", metavar="NAME", help="Take the joints from this named pose ('pinik info' lists them)."),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="JOINT=ANGLE",
        help="A joint's value (rad, or m where it slides); repeatable. The rest is 0.",
    ),
]
RelativeTo = Annotated[
    str | None,
    typer.Option("--relative-to", metavar="FRAME", help="Express it in this frame instead of the world."),
]
MethodParameters = Annotated[
    list[str] | None,
    typer.Option(
        "--param",
        metavar="METHOD.NAME=VALUE",
        help="A parameter of one of the methods, such as jt.alpha=0.1 ('pinik solve --help' lists them); repeatable.",
    ),
]
