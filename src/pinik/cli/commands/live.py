"""`pinik live`: the live view in the browser."""

from __future__ import annotations

from functools import partial
from typing import Annotated

import typer

from ...loading import load_in_silence
from ...viewer.live import live as open_view
from ..inputs.assignments import solver_with
from ..inputs.loading import load_robot, xacro_arguments
from ..inputs.options import AllowOutside, PackageDirs, Root, XacroArgs
from ..terminal import output
from ..terminal.exits import CommandError, ExitStatus

__all__ = ["live"]


def live(
    robot: Annotated[
        str,
        typer.Argument(
            metavar="[ROBOT]",
            help="The name of a robot in the catalogue ('pinik robots' lists them), or the path of a URDF file.",
            show_default="arm",
        ),
    ] = "arm",
    methods: Annotated[
        str,
        typer.Option(metavar="A,B,…", help="One to four methods, one for each robot; module:Class for your own."),
    ] = "ccd,jt,pinv,dls",
    view: Annotated[
        int | None,
        typer.Option(metavar="1|2|4", help="The number of robots shown.", show_default="one for each method"),
    ] = None,
    motion: Annotated[
        str, typer.Option(metavar="hand|curve|random", help="How the ball moves at the start.")
    ] = "curve",
    root: Root = "fixed",
    port: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="The port to listen on; 0 for any free port.", show_default="the first free one from 7007"
        ),
    ] = None,
    host: Annotated[
        str,
        typer.Option(
            metavar="ADDRESS", help="The address to listen on; any other than the default gives other machines access."
        ),
    ] = "127.0.0.1",
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Print the address of the page without opening it.")
    ] = False,
    watch: Annotated[
        bool, typer.Option("--watch", help="Load the robot again when its file, its SRDF or a mesh changes.")
    ] = False,
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
) -> ExitStatus:
    """Open a page on which robots chase a ball side by side, each with its own method.

    Drag the ball, and change any setting while it runs. Press Ctrl-C to end it.

    Examples:

      pinik live
      pinik live lion --root free_flyer --methods ccd,dls
      pinik live path/to/robot.urdf --view 1 --methods pinv
      pinik live path/to/robot.urdf --watch
    """
    solvers = [solver_with(name.strip(), None) for name in methods.split(",")]
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    reload = partial(
        load_in_silence,
        robot,
        root=root,
        package_dirs=package_dir or (),
        xacro_args=xacro_arguments(xacro_arg),
        allow_outside=allow_outside,
    )
    if watch and machine.description.path is None:
        raise CommandError("--watch needs the path of a robot's file")
    with open_view(
        machine, solvers, view=view, motion=motion, port=port, host=host, watch=reload if watch else False
    ) as page:
        output.emit(page.url)
        output.say("Press Ctrl-C to end the live view.")
        if not no_browser and not page.open():
            output.say(f"No browser was found; open {page.url} in one.")
        page.wait()
    return ExitStatus.ANSWERED
