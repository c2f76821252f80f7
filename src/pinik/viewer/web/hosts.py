"""Which hosts a request may address, and which pages may embed the live view in a frame."""

from __future__ import annotations

import ipaddress
import re
import socket

__all__ = ["frame_ancestors", "is_own_host"]

_LOOPBACK = ("localhost", "127.0.0.1", "::1")


# A name or an IPv4 address, or an IPv6 address in brackets; then perhaps a port.
_HOST = re.compile(r"(?:([A-Za-z0-9-]+(?:\.[A-Za-z0-9-]+)*)|\[([0-9A-Fa-f:.]{2,45})\])(?::[0-9]{1,5})?")
_LONGEST = 260  # characters; a name has at most 253


def _host_name(host_header: str) -> str:
    """Return the name in a Host header, in lower case and without brackets; "" if any part of the header is malformed.

    Only letters, digits, dots, hyphens, colons and a pair of brackets may occur, so that the header can be quoted in a
    content security policy.
    """
    match = _HOST.fullmatch(host_header) if len(host_header) <= _LONGEST else None
    return (match[1] or match[2]).lower() if match else ""


def is_own_host(host_header: str, served: str) -> bool:
    """Return whether a request addresses this server by a name that nobody else's DNS can point to it.

    Such names are localhost and the loopback addresses, with any port. If the server listens on another address, they
    are also any bare IP address, the machine's own name, and the name it was told to listen on.
    """
    name = _host_name(host_header)
    if name in _LOOPBACK:
        return True
    if served in _LOOPBACK or not name:
        return False
    return name in (served.lower(), socket.gethostname().lower()) or _is_address(name)


def frame_ancestors(host_header: str) -> str:
    """Return the origins that may embed the page: those of its own machine, such as Jupyter's, and VS Code.

    Any other page could replace the session by a set-up in the frame's address. IPv6 addresses are left out because a
    content security policy cannot name them.
    """
    hosts = dict.fromkeys(("localhost", "127.0.0.1", _host_name(host_header)))
    origins = [f"{scheme}://{host}:*" for host in hosts if host and ":" not in host for scheme in ("http", "https")]
    return " ".join((*origins, "vscode-webview:", "vscode-file:"))


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
