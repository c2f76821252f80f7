"""`pinik check`: what is wrong with a URDF file."""

from __future__ import annotations

from typing import Annotated

import typer

from ...description.flaw import summarised
from ..inputs.loading import check_folders, xacro_arguments
from ..inputs.options import AllowOutside, AsJson, PackageDirs, XacroArgs
from ..reports.inspection import Inspection, inspect
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.units import counted

__all__ = ["check"]


def check(
    file: Annotated[
        str,
        typer.Argument(
            metavar="FILE.urdf",
            help="A URDF or xacro file, or the name of a robot in the catalogue.",
            show_default=False,
        ),
    ],
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Check a URDF file for faults, doubtful parts and missing meshes, and compare pinik's reading with yourdfpy's.

    The exit status is 3 if the file cannot be loaded; the comparison with yourdfpy does not change it.

    Example:

      pinik check lion
    """
    check_folders(package_dir)
    found = inspect(file, tuple(package_dir or ()), xacro_arguments(xacro_arg), allow_outside)
    if as_json:
        output.emit_json(found.to_dict())
    else:
        _emit(found)
    return ExitStatus.ANSWERED if found.loads else ExitStatus.NO_ROBOT


def _emit(found: Inspection) -> None:
    verdict = "loads" if found.loads else "cannot be loaded"
    output.emit_words(f"{found.file}: {verdict}", "green" if found.loads else "red")
    for fault in found.faults:
        output.emit_words("fault: " + (f"{fault.element}: " if fault.element else "") + fault.message)
    for words in summarised(found.warnings):
        output.emit_words(f"warning: {words}")
    for address in found.missing_meshes:
        output.emit_words(f"missing mesh: {address}")
    for words in found.mesh_faults:
        output.emit_words(f"mesh: {words}")
    opinion = found.second_opinion
    if opinion is not None:
        output.emit_words(str(opinion) if opinion.agrees else f"warning: {opinion}")
    if found.loads:
        counts = {"link": found.links, "joint": found.joints, "mesh": found.meshes, "shape": found.shapes}
        output.emit_words(", ".join(counted(count, noun) for noun, count in counts.items()))
