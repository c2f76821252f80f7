"""The live view's web server: the page, one websocket per tab, and who may connect."""

from __future__ import annotations

import json
import secrets
from pathlib import Path
from typing import Any

import tornado.web
import tornado.websocket

from .hosts import frame_ancestors, is_own_host
from .scene import meshcat_script
from .show import Show
from .statistics_csv import statistics_csv

__all__ = ["make_application"]

PAGE = Path(__file__).parents[1] / "page"
_LARGEST_MESSAGE = 65_536  # bytes; about three times the longest set-up


def make_application(show: Show, host: str, mark: str = "") -> tornado.web.Application:
    """Return the routes of one show.

    Args:
        show: The show.
        host: The host that the server listens on; requests must address it.
        mark: Identifies this server to a notebook that embeds its page.
    """
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


class _Guarded(tornado.web.RequestHandler):
    """Refuses requests that do not address this server by its own name."""

    _host: str

    def prepare(self) -> None:
        try:
            own = is_own_host(self.request.host, self._host)
        except ValueError:
            own = False
        if not own:
            raise tornado.web.HTTPError(403, reason="This server does not have that name")

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
            "script-src": f"'self' 'nonce-{nonce}'",
            "style-src": "'self' 'unsafe-inline'",
            "img-src": "'self' data: blob:",
            "connect-src": f"'self' ws://{here} wss://{here}",
            "object-src": "'none'",
            "base-uri": "'none'",
            "frame-ancestors": f"'self' {frame_ancestors(here)}",
        }
        self.set_header("Content-Security-Policy", "; ".join(f"{name} {value}" for name, value in policy.items()))
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.finish((PAGE / "index.html").read_text("utf-8").replace("{{nonce}}", nonce))


class _File(_Guarded, tornado.web.StaticFileHandler):
    def initialize(self, path: str, host: str) -> None:  # type: ignore[override]
        tornado.web.StaticFileHandler.initialize(self, path)
        self._host = host


class _Alive(_Handler):
    """An empty image, by which a notebook finds out whether the view that it showed is still running."""

    def get(self) -> None:
        self.set_header("Content-Type", "image/svg+xml")
        self.finish('<svg xmlns="http://www.w3.org/2000/svg" width="1" height="1"/>')


class _State(_Handler):
    def get(self) -> None:
        self.set_header("Content-Type", "application/json")
        self.finish(json.dumps(self.show.state()))


class _StatisticsTable(_Handler):
    def get(self) -> None:
        self._as_download(statistics_csv(self.show.session), "text/csv; charset=utf-8", "statistics.csv")

    def _as_download(self, content: str, kind: str, name: str) -> None:
        self.set_header("Content-Type", kind)
        self.set_header("Content-Disposition", f'attachment; filename="pinik-{name}"')
        self.finish(content)


class _Animation(_StatisticsTable):
    def get(self) -> None:
        self._as_download(self.show.animation(), "text/html; charset=utf-8", "animation.html")


class _Socket(_Handler, tornado.websocket.WebSocketHandler):
    """One tab. Tornado checks that its page comes from this server: Origin and Host must agree."""

    def open(self, *args: str, **kwargs: str) -> None:
        self.set_nodelay(True)
        self.show.join(self)

    def on_message(self, message: str | bytes) -> None:
        self.show.receive(self, message if isinstance(message, str) else "")

    def on_close(self) -> None:
        self.show.leave(self)

    def send(self, message: str | bytes) -> None:
        """Send a message without waiting for it; one to a tab that has just closed is lost."""
        try:
            sent = self.write_message(message, binary=isinstance(message, bytes))
        except tornado.websocket.WebSocketClosedError:
            return
        sent.add_done_callback(lambda future: future.exception())
