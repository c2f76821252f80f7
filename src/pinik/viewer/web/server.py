"""The live view's server: the page, one websocket a tab, and who may talk to them."""

from __future__ import annotations

import ipaddress
import json
import re
import secrets
import socket
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import tornado.ioloop
import tornado.web
import tornado.websocket

from .scene import meshcat_script
from .show import Later, Show

__all__ = ["is_own_host", "later_in_threads", "make_application"]

PAGE = Path(__file__).parents[1] / "page"
_LARGEST_MESSAGE = 65_536  # bytes; the longest set-up is a third of it
_LOOPBACK = ("localhost", "127.0.0.1", "::1")


def make_application(show: Show, host: str, mark: str = "") -> tornado.web.Application:
    """The routes of one show, for requests that address `host`; `mark` is what a notebook knows it by."""
    common = {"show": show, "host": host}
    return tornado.web.Application(
        [
            (r"/", _Index, common),
            (r"/page/([\w-]+\.(?:js|css|svg))", _File, {"path": str(PAGE), "host": host}),
            (r"/meshcat/(main\.min\.js)", _File, {"path": str(meshcat_script().parent), "host": host}),
            (r"/ws", _Socket, common),
            (rf"/api/alive/{mark}\.svg", _Alive, common),
            (r"/api/state", _State, common),
            (r"/api/statistics\.csv", _StatisticsTable, common),
            (r"/api/animation\.html", _Animation, common),
        ],
        websocket_ping_interval=20,
        websocket_max_message_size=_LARGEST_MESSAGE,
        log_function=lambda handler: None,
    )


def is_own_host(host_header: str, served: str) -> bool:
    """Whether a request addresses this server by a name that nobody else's DNS can give it.

    That is localhost or an address of the loopback, whatever the port; where the server was told to listen
    elsewhere also any bare address, its own name, and the name it was given.
    """
    name = urlsplit(f"//{host_header}").hostname or ""
    if name in _LOOPBACK:
        return True
    if served in _LOOPBACK:
        return False
    return name in (served.lower(), socket.gethostname().lower()) or _is_address(name)


def _framers(host_header: str) -> str:
    """Who may show the page in a frame: pages of the machine it is on, such as Jupyter's, and VS Code's.

    Any other could replace what runs by the set-up in the frame's address. An IPv6 address cannot be told to browsers.
    """
    hosts = dict.fromkeys(("localhost", "127.0.0.1", urlsplit(f"//{host_header}").hostname or ""))
    named = [host for host in hosts if re.fullmatch(r"[a-z0-9-]+(\.[a-z0-9-]+)*", host)]
    origins = [f"{scheme}://{host}:*" for host in named for scheme in ("http", "https")]
    return " ".join((*origins, "vscode-webview:", "vscode-file:"))


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def later_in_threads(loop: tornado.ioloop.IOLoop, workers: ThreadPoolExecutor) -> Later:
    """Do work in the workers' threads, and what follows it on the loop."""

    def later(work: Callable[[], Any], then: Callable[[Any], None]) -> None:
        def run() -> None:
            result: Any
            try:
                result = work()
            except Exception as error:
                result = error
            loop.add_callback(then, result)

        workers.submit(run)

    return later


class _Guarded(tornado.web.RequestHandler):
    """A request is answered only when it addresses this server by its own name."""

    _host: str

    def prepare(self) -> None:
        try:
            own = is_own_host(self.request.host, self._host)
        except ValueError:
            own = False
        if not own:
            raise tornado.web.HTTPError(403, reason="This server does not go by that name")

    def set_default_headers(self) -> None:
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Cache-Control", "no-cache")
        self.clear_header("Server")

    def write_error(self, status_code: int, **kwargs: Any) -> None:
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(f"{status_code} {self._reason}\n")


class _Handler(_Guarded):
    def initialize(self, show: Show, host: str) -> None:
        self.show, self._host = show, host


class _Index(_Handler):
    def get(self) -> None:
        nonce = secrets.token_urlsafe(16)
        here = self.request.host
        policy = {
            "default-src": "'self'",
            # The page evaluates no text, and takes away meshcat's one command that does; programs that drive
            # browsers, such as playwright, evaluate theirs.
            "script-src": f"'self' 'nonce-{nonce}' 'unsafe-eval'",
            "style-src": "'self' 'unsafe-inline'",
            "img-src": "'self' data: blob:",
            "connect-src": f"'self' ws://{here} wss://{here}",
            "object-src": "'none'",
            "base-uri": "'none'",
            "frame-ancestors": f"'self' {_framers(here)}",
        }
        self.set_header("Content-Security-Policy", "; ".join(f"{name} {value}" for name, value in policy.items()))
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.finish((PAGE / "index.html").read_text("utf-8").replace("{{nonce}}", nonce))


class _File(_Guarded, tornado.web.StaticFileHandler):
    def initialize(self, path: str, host: str) -> None:  # type: ignore[override]
        tornado.web.StaticFileHandler.initialize(self, path)
        self._host = host


class _Alive(_Handler):
    """An image of nothing, for a notebook that asks whether the view it showed is still there."""

    def get(self) -> None:
        self.set_header("Content-Type", "image/svg+xml")
        self.finish('<svg xmlns="http://www.w3.org/2000/svg" width="1" height="1"/>')


class _State(_Handler):
    def get(self) -> None:
        self.set_header("Content-Type", "application/json")
        self.finish(json.dumps(self.show.state()))


class _StatisticsTable(_Handler):
    def get(self) -> None:
        self._as_download(self.show.statistics_csv(), "text/csv; charset=utf-8", "statistics.csv")

    def _as_download(self, content: str, kind: str, name: str) -> None:
        self.set_header("Content-Type", kind)
        self.set_header("Content-Disposition", f'attachment; filename="pinik-{name}"')
        self.finish(content)


class _Animation(_StatisticsTable):
    def get(self) -> None:
        self._as_download(self.show.animation(), "text/html; charset=utf-8", "animation.html")


class _Socket(_Handler, tornado.websocket.WebSocketHandler):
    """One tab. That its page comes from here is seen to by tornado: Origin and Host have to agree."""

    def open(self, *args: str, **kwargs: str) -> None:
        self.set_nodelay(True)
        self.show.join(self)

    def on_message(self, message: str | bytes) -> None:
        self.show.receive(self, message if isinstance(message, str) else "")

    def on_close(self) -> None:
        self.show.leave(self)

    def send(self, message: str | bytes) -> None:
        """Give a message on its way; one to a tab that has just gone is lost, as it would be a moment later."""
        try:
            sent = self.write_message(message, binary=isinstance(message, bytes))
        except tornado.websocket.WebSocketClosedError:
            return
        sent.add_done_callback(lambda future: future.exception())
