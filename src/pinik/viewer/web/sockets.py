"""Listening sockets: on a given port, or on the first free one."""

from __future__ import annotations

import errno
import os
import socket

from ...errors import InputError

__all__ = ["addressed", "listen"]

_PORTS = range(7007, 7027)


def addressed(host: str) -> str:
    """Return how a browser on this machine addresses a server that listens on `host`."""
    if host in ("", "0.0.0.0", "::"):
        return "127.0.0.1"
    return f"[{host}]" if ":" in host else host


def listen(host: str, port: int | None) -> list[socket.socket]:
    """Listen on a port, or on the first free one from 7007 if None; any free port if 0.

    Raises:
        InputError: The port is in use or invalid, or this machine does not have the address.
    """
    if port is not None and not (type(port) is int and 0 <= port <= 65535):
        raise InputError(f"port must be a whole number from 0 to 65535; got {port!r}")
    if not isinstance(host, str) or not host:
        raise InputError(f"host must be an address of this machine, such as '127.0.0.1'; got {host!r}")
    for candidate in (*_PORTS, 0) if port is None else (port,):
        try:
            return _listen(host, candidate)
        except (OSError, UnicodeError) as error:
            fault = getattr(error, "strerror", None) or str(error)
    hint = "; leave the port out to let pinik find a free one" if port else ""
    where = host if port is None else f"{host}, port {port}"
    raise InputError(f"cannot listen on {where}: {fault}{hint}")


def _listen(host: str, port: int) -> list[socket.socket]:
    """Open one socket for each address that the host's name resolves to, all on one port.

    Tornado's `bind_sockets` does the same, but leaves a socket open if the port is in use.
    """
    sockets: list[socket.socket] = []
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
        for family, kind, protocol, _, address in dict.fromkeys(found):
            listening = socket.socket(family, kind, protocol)
            sockets.append(listening)
            listening.setblocking(False)
            if os.name != "nt":
                listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            if family == socket.AF_INET6:
                listening.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
            port = port or (sockets[0].getsockname()[1] if len(sockets) > 1 else 0)
            try:
                listening.bind((address[0], port, *address[2:]))
            except OSError as error:
                if error.errno != errno.EADDRNOTAVAIL or len(found) == 1:
                    raise
                sockets.pop().close()  # for example ::1 for "localhost" on a machine without IPv6
                continue
            listening.listen(128)
    except BaseException:
        for listening in sockets:
            listening.close()
        raise
    return sockets
