"""The options of `pinik reach`: what is mapped, how, where to, and how it is shown."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ...errors import UnknownNameError
from ...workspace.voxel_map import WORKSPACES, as_least_share

__all__ = [
    "Approach", "Bases", "Box", "Branches", "By", "Cell", "DirectionCount", "MapFile", "Output", "PageFile",
    "PictureFile", "Quantity", "Resume", "RollCount", "Samples", "Scheduler", "SlicesFile", "Targets", "Workers",
    "Workspace", "workspace_of",
]  # fmt: skip


def _map(help: str, metavar: str, *names: str) -> Any:
    return typer.Option(*names, metavar=metavar, help=help, rich_help_panel="The map")


def _file(help: str, metavar: str, *names: str) -> Any:
    return typer.Option(*names, metavar=metavar, help=help, rich_help_panel="Files and pictures")


def _job(help: str, metavar: str) -> Any:
    return typer.Option(metavar=metavar, help=help, rich_help_panel="The work")


Targets = Annotated[
    str | None,
    typer.Argument(
        metavar="[TARGETS]",
        help="A list of places instead of a map, one a line, as for 'pinik track' without times; - is stdin.",
        show_default=False,
    ),
]
By = Annotated[str, _map("How to find what is reached; with both, the two maps are compared.", "sampling|solving|both")]
Cell = Annotated[float | None, _map("The length of a cell's edges, in metres; about a twelfth of the reach.", "M")]
Box = Annotated[
    tuple[float, float, float, float, float, float] | None,
    _map("Map only this box, from its lower to its upper corner, in metres.", "X Y Z X Y Z"),
]
Samples = Annotated[
    int | None, _map("The number of random configurations; 10 million, or 2 million for positions alone.", "N")
]
DirectionCount = Annotated[
    int | None,
    _map("How many approach directions are told apart; 0 if any orientation counts; 48 from five joints on.", "N"),
]
RollCount = Annotated[
    int | None,
    _map("How many rolls about each; 0 if any roll counts; 12 from six joints on.", "N", "--rolls"),
]
Approach = Annotated[str, _map("The axis of the frame that approaches.", "x|y|z|-x|-y|-z")]
Branches = Annotated[
    bool,
    typer.Option(
        "--branches", help="Count the distinct answers to each pose, with --by solving.", rich_help_panel="The map"
    ),
]
MapFile = Annotated[
    Path | None, _file("Show the map in this file, which --output wrote, instead of making one.", "FILE", "--map")
]
Output = Annotated[
    Path | None, _file("Write the map here: .npz, .parquet, or .h5 in reuleaux's layout.", "FILE", "--output")
]
PictureFile = Annotated[
    Path | None, _file("Draw the robot in the map, cut open, into this file.", "FILE.png", "--picture")
]
SlicesFile = Annotated[Path | None, _file("Draw three slices through the map into this file.", "FILE.png", "--slices")]
PageFile = Annotated[
    Path | None,
    _file("Write one page on which the map turns and slices, without a server.", "FILE.html", "--page"),
]
Quantity = Annotated[str, _file("What the colours stand for.", "share|manipulability|room|branches")]
Workspace = Annotated[
    str, _file("The cells to draw, or the share of orientations that they need.", "any|down|dexterous|SHARE")
]
Bases = Annotated[
    int | None,
    typer.Option("--bases", metavar="N", help="With TARGETS, map the robot, and list the N best places for its base."),
]
Resume = Annotated[
    bool,
    typer.Option(
        "--resume", help="Go on with an earlier run to --output that was interrupted.", rich_help_panel="The work"
    ),
]
Workers = Annotated[int | None, _job("Work in this many processes, as a Dask cluster on this machine.", "N")]
Scheduler = Annotated[str | None, _job("Work on the Dask cluster of this scheduler.", "ADDRESS")]


def workspace_of(text: str) -> str | float:
    """A workspace by its name, or the least share of the orientations."""
    try:
        share = float(text)
    except ValueError:
        if text not in WORKSPACES:
            raise UnknownNameError("workspace", text, WORKSPACES) from None
        return text
    return as_least_share(share)
