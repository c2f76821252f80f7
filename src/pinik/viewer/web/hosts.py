"""Which hosts a request may address, and which pages may embed the live view in a frame."""

from __future__ import annotations

import ipaddress
import re
import socket
from urllib.parse import urlsplit

__all__ = ["frame_ancestors", "is_own_host"]

_LOOPBACK = ("localhost", "127.0.0.1", "::1")


def is_own_host(host_header: str, served: str) -> bool:
    """Return whether a request addresses this server by a name that nobody else's DNS can point to it.

    Such names are localhost and the loopback addresses, with any port. If the server listens on another address, they
    are also any bare IP address, the machine's own name, and the name it was told to listen on.

    Raises:
        ValueError: The header is malformed.
    """
    name = urlsplit(f"//{host_header}").hostname or ""
    if name in _LOOPBACK:
        return True
    if served in _LOOPBACK:
        return False
    return name in (served.lower(), socket.gethostname().lower()) or _is_address(name)


def frame_ancestors(host_header: str) -> str:
    """Return the origins that may embed the page: those of its own machine, such as Jupyter's, and VS Code.

    Any other page could replace the session by a set-up in the frame's address. IPv6 addresses are left out because a
    content security policy cannot name them.
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
