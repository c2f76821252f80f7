"""Listening sockets: which port they get, and what a browser calls them."""

from __future__ import annotations

import socket

import pytest

import pinik
from pinik.viewer.web import sockets
from pinik.viewer.web.sockets import addressed, listen


@pytest.mark.parametrize(
    ("host", "address"),
    [
        ("127.0.0.1", "127.0.0.1"),
        ("localhost", "localhost"),
        ("lab.example", "lab.example"),
        ("0.0.0.0", "127.0.0.1"),
        ("::", "127.0.0.1"),
        ("::1", "[::1]"),
    ],
)
def test_a_browser_reaches_every_host_by_an_address_of_its_own_machine(host, address):
    assert addressed(host) == address


def test_without_a_port_busy_ones_are_skipped(monkeypatch):
    with socket.socket() as busy, socket.socket() as free:
        free.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # keeps its port for the listener
        for one in (busy, free):
            one.bind(("127.0.0.1", 0))
        busy.listen()
        monkeypatch.setattr(sockets, "_PORTS", [busy.getsockname()[1], free.getsockname()[1]])
        (listening,) = listen("127.0.0.1", None)
        with listening:
            assert listening.getsockname()[1] == sockets._PORTS[1]


def test_a_busy_port_is_an_error_and_leaves_no_socket_open(monkeypatch):
    opened = []
    plain = socket.socket

    def noted(*arguments):
        opened.append(plain(*arguments))
        return opened[-1]

    with plain() as busy:
        busy.bind(("127.0.0.1", 0))
        busy.listen()
        monkeypatch.setattr(sockets.socket, "socket", noted)
        with pytest.raises(
            pinik.InputError, match=f"cannot listen on 127.0.0.1, port {busy.getsockname()[1]}: .*in use"
        ):
            listen("127.0.0.1", busy.getsockname()[1])
    assert [one.fileno() for one in opened] == [-1]


def test_all_addresses_of_a_name_share_one_port(monkeypatch):
    found = [
        (socket.AF_INET, socket.SOCK_STREAM, 6, "", (address, 0)) for address in ("127.0.0.1", "127.0.0.2", "192.0.2.1")
    ]
    monkeypatch.setattr(sockets.socket, "getaddrinfo", lambda *_, **__: found)
    try:
        listening = listen("many.example", 0)
    except pinik.InputError:
        pytest.skip("this machine has only one loopback address")
    names = [one.getsockname() for one in listening]
    for one in listening:
        one.close()
    assert [host for host, _ in names] == ["127.0.0.1", "127.0.0.2"]  # the third is not an address of this machine
    assert len({port for _, port in names}) == 1
