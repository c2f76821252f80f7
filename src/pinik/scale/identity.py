"""What identifies robots and options in the fingerprint of a job."""

from __future__ import annotations

import contextlib
import dataclasses
import inspect
from typing import Any

from ..files import FileError, read_within
from ..model.robot_model import RobotModel
from ..shapes.collisions import shapes_of
from ..shapes.solids import Solid
from ..solvers.base import Solver
from ..solving.options import Options
from .jobs.fingerprint import digest

__all__ = ["identity_of_options", "identity_of_robot"]

_MOST_BYTES = 100_000_000


def identity_of_robot(robot: RobotModel, options: Options) -> dict[str, Any]:
    """The robot: its file, how it was loaded, and its collision shapes if anything is to be avoided."""
    own: dict[str, Any] = {"name": robot.name, "urdf": digest(robot.description.document), "root": robot.root}
    own["mimics"] = sorted(robot.mimics)
    if options.avoid:
        own["shapes"] = digest(*map(_bytes_of, shapes_of(robot).solids))
        if robot.srdf is not None:
            with contextlib.suppress(FileError):
                own["srdf"] = digest(read_within(robot.srdf, _MOST_BYTES, "an SRDF file"))
    return own


def identity_of_options(options: Options) -> dict[str, Any]:
    """The options of a solve by name, as what can be written as JSON."""
    own: dict[str, Any] = {field.name: getattr(options, field.name) for field in dataclasses.fields(options)}
    own["method"] = _identity_of_solver(options.method)
    own["choose_weights"] = dict(options.choose_weights)
    own["avoid"] = {"itself": options.avoid.itself, "around": digest(*map(_bytes_of, options.avoid.around))}
    return own


def _identity_of_solver(solver: Solver) -> dict[str, Any]:
    kind = type(solver)
    own: dict[str, Any] = {"name": solver.name, "parameters": {n: repr(getattr(solver, n)) for n in solver.parameters}}
    if not kind.__module__.startswith("pinik."):
        with contextlib.suppress(OSError, TypeError):
            own["source"] = digest(inspect.getsource(kind).encode())
    return own


def _bytes_of(solid: Solid) -> bytes:
    words = repr((solid.owner, solid.joint, solid.kind, solid.size)).encode()
    surface = b"" if solid.surface is None else solid.surface.vertices.tobytes() + solid.surface.faces.tobytes()
    placement: bytes = solid.placement.homogeneous.tobytes()
    return words + placement + surface
