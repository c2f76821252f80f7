"""The live view: instances of a robot chase a ball side by side, in the browser."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ..extras import needed_by
from ..loading import load
from ..robot import Robot
from ..solvers.base import Solver
from ..version import __version__

if TYPE_CHECKING:
    from .web.live_view import LiveView

__all__ = ["live"]


def live(
    robot: str | os.PathLike[str] | Robot = "arm",
    methods: str | type[Solver] | Solver | Iterable[str | type[Solver] | Solver] = ("ccd", "jt", "pinv", "dls"),
    *,
    view: int | None = None,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    motion: str = "curve",
    running: bool = True,
    port: int | None = None,
    host: str = "127.0.0.1",
) -> LiveView:
    """Open a live view: a page on which instances of a robot chase the same balls, each with its own method.

    Returns at once; a notebook shows the page as a frame, elsewhere `open()` shows it in the browser. Close it with
    `close()`, or use it in a with statement.

    Args:
        robot: What `pinik.load` takes, or a robot that it returned.
        methods: One to four solvers, by name ("ccd,dls" are two), class or instance: one for each instance of the
            robot.
        view: How many instances are seen: 1, 2 or 4; enough for the methods when None.
        root: As for `pinik.load`; a robot that is loaded already keeps its own.
        package_dirs: As for `pinik.load`.
        motion: How the balls move at first: "hand", "curve" or "random".
        running: Whether it steps at once.
        port: Where to listen; the first free port from 7007 when None, any free one when 0.
        host: The address to listen on. With another than this machine's own loopback, everybody who reaches that
            address can watch and change the view.

    Raises:
        RobotLoadError, UnknownNameError: As `pinik.load`; or no such method.
        InputError: More than four methods, another view, or a port that cannot be had.
        MissingExtraError: The packages of pinik[live] are not installed.
    """
    with needed_by("the live view", "live"):
        from .web.live_view import LiveView

    machine = robot if isinstance(robot, Robot) else load(robot, root=root, package_dirs=package_dirs)
    return LiveView(
        machine, methods, view=view, port=port, host=host, motion=motion, running=running, version=__version__
    )
