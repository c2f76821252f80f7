"""The handle of a live view: a server in a thread of this process."""

from __future__ import annotations

import asyncio
import concurrent.futures
import html
import json
import os
import secrets
import socket
import threading
import time
import webbrowser
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Any, TypeVar

import tornado.ioloop
from numpy.typing import ArrayLike, NDArray

from ... import errors
from ...export.live_recording import LiveRecording
from ...files import write_whole
from ...picture.camera import Camera
from ...picture.picture import Picture
from ...robot import Robot
from ..simulation.method_menu import Methods
from ..simulation.session import Session
from .door import Door
from .guests import Guests
from .heartbeat import Heartbeat
from .later import later_in_threads
from .notebook import as_html, draw_beside
from .server import make_server
from .show import Show
from .sockets import addressed, listen
from .watch import SECONDS

__all__ = ["LiveView"]

T = TypeVar("T")

_SHORT = 0.05  # [s]


class LiveView:
    """A running live view. As a context manager it frees the port on leaving.

    A notebook displays the page in a frame, or a picture once the server is gone. `send` can change whatever the page
    can: every row of the table in docs/live-protocol.md is a message, as in `view.send("motion", motion="random")`.

    Attributes:
        url: The page's address.
        port: The port that the server listens on.
    """

    def __init__(
        self,
        robot: Robot,
        methods: Methods,
        *,
        view: int | None,
        port: int | None,
        host: str,
        motion: str,
        running: bool,
        version: str,
        reload: Callable[[], Robot] | None = None,
    ) -> None:
        """Start the server; `pinik.live` documents the arguments."""
        session = Session(robot, methods, view=view)
        session.set_motion(motion)
        session.running = running
        sockets = listen(host, port)
        self.port: int = sockets[0].getsockname()[1]
        self.url = f"http://{addressed(host)}:{self.port}/"
        self._mark = secrets.token_hex(8)
        self._workers = ThreadPoolExecutor(2, thread_name_prefix="pinik-live-worker")
        self._closed = threading.Event()
        ready: Future[tuple[tornado.ioloop.IOLoop, Show, Heartbeat]] = Future()
        arguments = (session, host, sockets, version, reload, ready)
        self._thread = threading.Thread(target=self._serve, args=arguments, name="pinik-live", daemon=True)
        self._thread.start()
        self._loop, self._show, self._heartbeat = ready.result()

    def _serve(
        self,
        session: Session,
        host: str,
        sockets: list[socket.socket],
        version: str,
        reload: Callable[[], Robot] | None,
        ready: Future[Any],
    ) -> None:
        """Run the server. Only this thread ever touches the session."""
        asyncio.set_event_loop(asyncio.new_event_loop())
        loop = tornado.ioloop.IOLoop.current()
        try:
            show = Show(session, later_in_threads(loop, self._workers), version, reload=reload)
            heartbeat, guests = Heartbeat(show.tick, show.is_lively), Guests()
            server = make_server(show, heartbeat, guests, host, self._mark)
        except BaseException as error:
            for listening in sockets:
                listening.close()
            self._workers.shutdown(wait=False)
            loop.close()
            ready.set_exception(error)
            return
        door = Door(server, guests, sockets)

        def look_at_files() -> None:
            if show.look_at_files():
                heartbeat.wake()

        look = tornado.ioloop.PeriodicCallback(look_at_files, 1000 * SECONDS)
        if reload is not None:
            look.start()
        loop.add_callback(ready.set_result, (loop, show, heartbeat))
        loop.start()
        heartbeat.stop()
        look.stop()
        door.close()
        loop.run_sync(server.close_all_connections, timeout=2.0)
        loop.close(all_fds=True)

    def __repr__(self) -> str:
        return f"<LiveView of {self._show.session.robot.name!r}: {'closed' if self._closed.is_set() else self.url}>"

    def __enter__(self) -> LiveView:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()

    def _repr_html_(self) -> str:
        """Return what a notebook displays: the page in a frame, or a picture of this moment if the server is gone."""
        if self._closed.is_set():
            return html.escape(repr(self))
        methods = [instance["method"] for instance in self.state["instances"]]
        caption = f"{self.robot.name}, seen by pinik.live"
        if len(methods) > 1:
            caption += f"; from left to right: {', '.join(methods)}"
        return as_html(self.url, self._mark, self.picture(), caption)

    def picture(
        self, view: str | tuple[float, float] | Camera = "angle", size: tuple[int, int] = (720, 360)
    ) -> Picture:
        """Draw the visible instances side by side as they are now; `view` and `size` are as for `pinik.draw`."""

        def now() -> tuple[Robot, list[NDArray[Any]], list[tuple[NDArray[Any], bool]]]:
            session = self._show.session
            balls = [(ball.position.copy(), ball.mode == "pinned") for ball in session.balls if ball.mode != "off"]
            return session.robot, [instance.q.copy() for instance in session.seen], balls

        return draw_beside(*self._do(now), view=view, size=size)

    def close(self) -> None:
        """Stop the server and free the port. Closing twice is harmless."""
        if self._closed.is_set():
            return
        self._closed.set()
        self._loop.add_callback(self._loop.stop)
        self._thread.join()
        self._workers.shutdown(wait=False, cancel_futures=True)

    def wait(self) -> None:
        """Block until the view is closed or Ctrl-C is pressed."""
        self._thread.join()

    def open(self) -> bool:
        """Open the page in the browser; return False if there is none."""
        return webbrowser.open(self.url)

    def send(self, type: str, **fields: Any) -> None:
        """Send a message as a page would, such as `send("method", instance=0, method="ccd")`.

        Raises:
            InputError, UnknownNameError: The message is wrong, or cannot be carried out.
        """
        message = json.loads(json.dumps({"type": type, **fields}, default=_plain))
        self._do(lambda: self._show.do(message))

    def move_ball(self, position: ArrayLike, index: int = 0) -> None:
        """Move a ball to a point (3,) [m] in the robot's world; this ends any motion of the balls."""
        self.send("ball", index=index, position=position)

    @property
    def robot(self) -> Robot:
        """The robot on show."""
        return self._show.session.robot

    @property
    def state(self) -> dict[str, Any]:
        """The current state, as `GET /api/state` returns it; docs/live-protocol.md explains the fields."""
        return self._do(self._show.state)

    @property
    def configurations(self) -> list[NDArray[Any]]:
        """The configuration q (nq,) of each visible instance."""
        return self._do(lambda: [instance.q.copy() for instance in self._show.session.seen])

    def save_animation(self, path: str | os.PathLike[str]) -> None:
        """Write the last 20 seconds as one HTML file, whole or not at all, that plays without a server.

        Just after the start it waits until the robot's shapes are read.

        Raises:
            OSError: The file cannot be written.
        """
        while self._do(lambda: self._show.reads_shapes):
            time.sleep(_SHORT)
        write_whole(path, self._do(self._show.animation))

    def recording(self) -> LiveRecording:
        """Return the last 20 seconds as data, which `save_glb` and `save_rrd` of `pinik.export` write as a file."""
        return self._do(self._show.recorded)

    def _do(self, work: Callable[[], T]) -> T:
        """Call `work` in the server's thread, between two steps, and return its result."""
        if self._closed.is_set():
            raise errors.InputError("this live view is closed; pinik.live(...) opens another")
        if threading.current_thread() is self._thread:  # waiting here would never end
            raise errors.InputError("a live view cannot be used from within its own steps, for example by a solver")
        done: Future[T] = Future()

        def run() -> None:
            self._heartbeat.wake()
            try:
                done.set_result(work())
            except BaseException as error:
                done.set_exception(error)

        self._loop.add_callback(run)
        while not concurrent.futures.wait([done], timeout=0.5).done:
            if not self._thread.is_alive():  # another thread has just closed the view
                raise errors.InputError("this live view is closed; pinik.live(...) opens another")
        return done.result()


def _plain(value: Any) -> Any:
    """Convert arrays and numpy numbers for JSON."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise errors.InputError(f"a message must consist of numbers, texts and lists; got {value!r}")
