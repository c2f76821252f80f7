"""What must not be touched: `--avoid-self` and `--world`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from ...errors import InputError, RobotLoadError
from ...shapes.avoid import Avoid
from ...shapes.world import World
from ..terminal.exits import CommandError, ExitStatus

__all__ = ["AvoidSelf", "WorldFile", "avoided", "read_world"]

AvoidSelf = Annotated[
    bool,
    typer.Option(
        "--avoid-self",
        help="Take no answer at which links of the robot touch each other; 'pinik collisions' shows which count.",
        rich_help_panel="Collisions",
    ),
]
WorldFile = Annotated[
    Path | None,
    typer.Option(
        "--world",
        metavar="CELL.urdf",
        help="Take no answer at which the robot touches what stands around it, given as a URDF.",
        rich_help_panel="Collisions",
    ),
]


def avoided(itself: bool, world: Path | None, package_dirs: Sequence[Path] | None) -> Avoid:
    """What both options together say.

    Raises:
        CommandError: The world cannot be loaded.
    """
    around = () if world is None else read_world(world, package_dirs).solids
    return Avoid(itself, around)


def read_world(path: Path, package_dirs: Sequence[Path] | None) -> World:
    """The world of a URDF.

    Raises:
        CommandError: It cannot be loaded.
    """
    try:
        return World.from_urdf(path, package_dirs or ())
    except (RobotLoadError, InputError) as error:
        raise CommandError(f"--world {path}: {error}", ExitStatus.NO_ROBOT) from None
