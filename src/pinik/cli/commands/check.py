"""`pinik check`: what is wrong with a URDF file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...description.xml import MAX_BYTES
from ..inputs.files import read_bytes
from ..inputs.loading import check_folders, xacro_arguments
from ..inputs.options import AllowOutside, AsJson, PackageDirs, XacroArgs
from ..reports.check_report import emit_inspection
from ..reports.inspection import inspect
from ..reports.mended_file import check_target, write_mended
from ..terminal import output
from ..terminal.exits import CommandError, ExitStatus

__all__ = ["check"]


def check(
    file: Annotated[
        str,
        typer.Argument(
            metavar="FILE.urdf",
            help="A URDF or xacro file, the name of a robot in the catalogue, or - for a URDF on stdin.",
            show_default=False,
        ),
    ],
    strict: Annotated[
        bool, typer.Option("--strict", help="Let every warning be an error, with exit status 3.")
    ] = False,
    fix: Annotated[
        Path | None,
        typer.Option(
            metavar="OUT.urdf",
            help="Write a copy in which all flaws are mended that have one answer, and say which.",
        ),
    ] = None,
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Check a URDF file for faults, mistakes and missing meshes, and compare pinik's reading with yourdfpy's.

    The exit status is 3 if the file cannot be loaded. With --strict, any warning makes it 3 as well, even if --fix
    mends it. The comparison with yourdfpy does not change the exit status. For a xacro file, the URDF that it becomes
    is checked, and --fix writes that URDF.

    Example:

      pinik check lion
      pinik check lion --strict
    """
    if not file:
        raise CommandError("FILE.urdf must be a file, the name of a robot, or -; got an empty text")
    check_folders(package_dir)
    if fix is not None:
        fix = fix.expanduser()
        check_target(fix, file)
    given = read_bytes(file, MAX_BYTES, "a robot description") if file == "-" else file
    found = inspect(given, tuple(package_dir or ()), xacro_arguments(xacro_arg), allow_outside)
    result = None if fix is None else write_mended(found, fix)
    if as_json:
        output.emit_json(found.to_dict(strict=strict) | {"fix": None if result is None else result.to_dict()})
    else:
        emit_inspection(found)
        if result is not None:
            result.emit()
    return ExitStatus.ANSWERED if found.passes(strict=strict) else ExitStatus.NO_ROBOT
