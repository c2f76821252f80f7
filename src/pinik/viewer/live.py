"""`live`: instances of a robot chase a ball side by side, in the browser."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING

from ..errors import InputError
from ..extras import needed_by
from ..loading import load, load_in_silence
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
    watch: bool | Callable[[], Robot] = False,
) -> LiveView:
    """Open a live view: a page on which instances of a robot chase the same balls, each with its own method.

    The function returns at once. A notebook displays the page in a frame; elsewhere, `open()` opens it in the browser.
    Close the view with `close()`, or use it in a with statement.

    Args:
        robot: A robot, or anything that `pinik.load` accepts.
        methods: One to four solvers, each a name, class or instance; "ccd,dls" means two. Each runs in an instance of
            the robot.
        view: The number of visible instances: 1, 2 or 4; by default, enough for the methods.
        root: As for `pinik.load`; ignored if `robot` is loaded already.
        package_dirs: As for `pinik.load`.
        motion: How the balls move at first: "hand", "curve" or "random".
        running: Whether the simulation starts at once.
        port: The port to listen on: the first free one from 7007 if None, any free one if 0.
        host: The address to listen on. On any address but the loopback, everybody who can reach it can watch and change
            the view.

        watch: Whether to load the robot again when its file changes: its URDF or xacro file, its SRDF or a mesh. The
            page keeps its camera, and joints keep their angles; while the file is faulty, the page says why, and shows
            the robot as it last was. Instead of True, give the function that loads it, if that takes more than its
            path.

    Raises:
        RobotLoadError: The robot cannot be loaded.
        UnknownNameError: There is no robot, method or motion of that name.
        InputError: There are more than four methods, `view` is wrong, the port or address is not available, or the
            robot that is to be watched is not given by the path of its file.
        MissingExtraError: The packages of pinik[live] are not installed.
    """
    with needed_by("the live view", "live"):
        from .web.live_view import LiveView

    folders = list(package_dirs)
    machine = robot if isinstance(robot, Robot) else load(robot, root=root, package_dirs=folders)
    reload: Callable[[], Robot] | None = watch if callable(watch) else None
    if watch is True:
        if isinstance(robot, Robot) or machine.description.path is None:
            raise InputError("must be the path of a file, so that it can be watched", argument="robot")
        reload = partial(load_in_silence, robot, root=root, package_dirs=folders)
    return LiveView(
        machine,
        methods,
        view=view,
        port=port,
        host=host,
        motion=motion,
        running=running,
        version=__version__,
        reload=reload,
    )
