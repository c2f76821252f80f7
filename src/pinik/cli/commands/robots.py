"""`pinik robots`: the robots that can be loaded by name."""

from __future__ import annotations

from ...description import catalog as robot_catalog
from ..inputs.options import AsJson
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.tables import emit_names

__all__ = ["robots"]


def robots(as_json: AsJson = False) -> ExitStatus:
    """List the robots of the catalogue, whose names every command accepts.

    The file of one of them, ur3_empty, holds no robot; loading it fails with a message that says so.

    Example:

      pinik robots
    """
    names = robot_catalog.catalog()
    if as_json:
        output.emit_json({"schema": 1, "robots": [_fields(robot_catalog.find(name)) for name in names]})
    else:
        emit_names(names)
    return ExitStatus.ANSWERED


def _fields(entry: robot_catalog.CatalogEntry) -> dict[str, str | None]:
    return {
        "name": entry.name,
        "urdf": str(entry.urdf),
        "srdf": None if entry.srdf is None else str(entry.srdf),
    }
