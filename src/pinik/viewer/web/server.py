"""The live view's web server: the page and its files, the answers over HTTP, and who may ask for them."""

from __future__ import annotations

import asyncio
import json
import secrets
from contextlib import suppress
from typing import Any

import tornado.httpserver
import tornado.iostream
import tornado.web

from ...errors import InputError, PinikError
from ...export.glb import glb_of
from ...export.scene import scene_of
from ..protocol.copying import texts_to_copy
from .budget import Turns
from .document import document
from .guests import Guests
from .heartbeat import Heartbeat
from .hosts import frame_ancestors, is_own_host
from .scene import meshcat_script
from .show import Show
from .statistics_csv import statistics_csv
from .tab import LARGEST_MESSAGE, WebSocket

__all__ = ["make_server"]

_LARGEST_HEAD = 16_384  # bytes; a browser's has about one thousand
_LARGEST_BODY = 1024  # bytes; no request needs one
_PATIENCE = 30.0  # [s] for a whole request, and between two requests of a connection
_LONGEST_DELAY = 2.0  # [s]; a request that would have to wait longer is refused
_DOWNLOADS = 4  # animations that are sent at one time; each takes some megabytes
_PIECE = 65_536  # bytes
_ANIMATIONS = {"html": "text/html; charset=utf-8", "glb": "model/gltf-binary"}


def make_server(
    show: Show, heartbeat: Heartbeat, guests: Guests, host: str, mark: str
) -> tornado.httpserver.HTTPServer:
    """Return the server of one show.

    Args:
        show: The show.
        heartbeat: What makes the show go on; requests wake it.
        guests: Who is connected.
        host: The host that the server listens on; requests must address it.
        mark: Identifies this server to a notebook that embeds its page.
    """
    guard = {"guests": guests, "host": host}
    common = {**guard, "show": show, "heartbeat": heartbeat}
    downloads = asyncio.Semaphore(_DOWNLOADS)
    application = tornado.web.Application(
        [
            (r"/", _Index, common),
            (r"/meshcat/(main\.min\.js)", _File, {**guard, "path": str(meshcat_script().parent)}),
            (r"/ws", _Socket, {**common, "turns": Turns()}),
            (rf"/api/alive/{mark}\.svg", _Alive, common),
            (r"/api/state", _State, common),
            (r"/api/copy/([0-3])\.json", _Copy, common),
            (r"/api/statistics\.csv", _StatisticsTable, common),
            (r"/api/animation\.(html|glb)", _Animation, {**common, "downloads": downloads}),
        ],
        default_handler_class=_Nothing,
        default_handler_args=common,
        websocket_ping_interval=20,
        websocket_ping_timeout=20,
        websocket_max_message_size=LARGEST_MESSAGE,
        log_function=lambda handler: None,
    )
    return tornado.httpserver.HTTPServer(
        application,
        idle_connection_timeout=_PATIENCE,
        body_timeout=_PATIENCE,
        max_header_size=_LARGEST_HEAD,
        max_body_size=_LARGEST_BODY,
    )


class _Guarded(tornado.web.RequestHandler):
    """Refuses requests that do not address this server by its own name, that other pages make, or that are too many."""

    _guests: Guests
    _host: str
    cost = 1.0
    """How many requests it counts as in the budget of its address."""
    open_to_pages = False
    """Whether pages of other origins may load it."""

    async def prepare(self) -> None:
        if not is_own_host(self.request.host, self._host):
            raise tornado.web.HTTPError(403, reason="This server does not have that name")
        if self.request.headers.get("Sec-Fetch-Site") == "cross-site" and not self.open_to_pages:
            raise tornado.web.HTTPError(403, reason="Other pages may not load this")
        own, all_requests = self._guests.budget(self.request.remote_ip or ""), self._guests.all_requests
        delay, whose = max((own.delay, "from this address"), (all_requests.delay, "from all addresses together"))
        if delay > _LONGEST_DELAY:
            await asyncio.sleep(_LONGEST_DELAY)
            self.set_header("Retry-After", "5")
            raise tornado.web.HTTPError(429, reason=f"Too many requests {whose}; try again in a few seconds")
        own.spend(self.cost)  # at once, so that those who wait are answered one after the other and not all together
        all_requests.spend(self.cost)
        await asyncio.sleep(delay)

    def set_default_headers(self) -> None:
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Cache-Control", "no-cache")
        self.clear_header("Server")

    def write_error(self, status_code: int, **kwargs: Any) -> None:
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(f"{status_code} {self._reason}\n")


class _Handler(_Guarded):
    def initialize(self, show: Show, heartbeat: Heartbeat, guests: Guests, host: str) -> None:
        self.show, self.heartbeat, self._guests, self._host = show, heartbeat, guests, host


class _Nothing(_Handler):
    async def prepare(self) -> None:
        await super().prepare()
        raise tornado.web.HTTPError(404)


class _Index(_Handler):
    open_to_pages = True  # a notebook shows it in a frame; its policy names the pages that may

    def get(self) -> None:
        nonce = secrets.token_urlsafe(16)
        here = self.request.host
        policy = {
            "default-src": "'self'",
            "script-src": f"'nonce-{nonce}'",
            "style-src": "'self' 'unsafe-inline'",
            "img-src": "'self' data: blob:",
            "connect-src": f"'self' ws://{here} wss://{here}",
            "object-src": "'none'",
            "base-uri": "'none'",
            "frame-ancestors": f"'self' {frame_ancestors(here)}",
        }
        self.set_header("Content-Security-Policy", "; ".join(f"{name} {value}" for name, value in policy.items()))
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.finish(document("index.html", {"nonce": nonce.encode()}))


class _File(_Guarded, tornado.web.StaticFileHandler):
    def initialize(self, path: str, guests: Guests, host: str) -> None:  # type: ignore[override]
        tornado.web.StaticFileHandler.initialize(self, path)
        self._guests, self._host = guests, host


class _Alive(_Handler):
    """An empty image, by which a notebook finds out whether the view that it showed is still running."""

    open_to_pages = True  # of those that know the mark

    def get(self) -> None:
        self.set_header("Content-Type", "image/svg+xml")
        self.finish('<svg xmlns="http://www.w3.org/2000/svg" width="1" height="1"/>')


class _State(_Handler):
    cost = 5.0

    def get(self) -> None:
        self.heartbeat.wake()
        self.set_header("Content-Type", "application/json")
        self.finish(json.dumps(self.show.state()))


class _Download(_Handler):
    def name(self, kind: str, name: str) -> None:
        """Say what is sent, and under which name it is to be kept."""
        self.set_header("Content-Type", kind)
        self.set_header("Content-Disposition", f'attachment; filename="pinik-{name}"')


class _Copy(_Handler):
    cost = 5.0

    def get(self, instance: str) -> None:
        try:
            texts = texts_to_copy(self.show.session, int(instance))
        except PinikError as error:
            raise tornado.web.HTTPError(404, reason="There is no such instance") from error
        self.set_header("Content-Type", "application/json; charset=utf-8")
        self.finish(json.dumps(texts))


class _StatisticsTable(_Download):
    cost = 5.0

    def get(self) -> None:
        self.heartbeat.wake()
        self.name("text/csv; charset=utf-8", "statistics.csv")
        self.finish(statistics_csv(self.show.session))


class _Animation(_Download):
    cost = 50.0

    def initialize(self, downloads: asyncio.Semaphore, **common: Any) -> None:  # type: ignore[override]
        super().initialize(**common)
        self._downloads = downloads

    async def get(self, kind: str) -> None:
        self.heartbeat.wake()
        if self._downloads.locked():
            self.set_header("Retry-After", "5")
            raise tornado.web.HTTPError(503, reason=f"At most {_DOWNLOADS} animations are sent at one time")
        async with self._downloads:
            content = self.show.animation() if kind == "html" else await self._glb()
            self.name(_ANIMATIONS[kind], f"animation.{kind}")
            self.set_header("Content-Length", str(len(content)))
            with suppress(tornado.iostream.StreamClosedError):  # who cancels a download wants no more of it
                for start in range(0, len(content), _PIECE):  # in pieces, so that a slow client has no copy of its own
                    self.write(content[start : start + _PIECE])
                    await self.flush()

    async def _glb(self) -> bytes:
        """Make it in another thread, because reading meshes takes seconds."""
        scene = scene_of(self.show.recorded(), None, None)
        try:
            return await asyncio.to_thread(glb_of, scene)
        except InputError as error:
            raise tornado.web.HTTPError(404, reason="The robot has no shapes that can be read") from error


class _Socket(_Handler, WebSocket):
    cost = 10.0

    def initialize(self, turns: Turns, **common: Any) -> None:  # type: ignore[override]
        super().initialize(**common)
        self.turns = turns
