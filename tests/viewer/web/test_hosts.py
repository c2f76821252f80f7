"""Which hosts a request may address, and who may embed the page."""

from __future__ import annotations

import socket

import pytest

from pinik.viewer.web.hosts import frame_ancestors, is_own_host


@pytest.mark.parametrize(
    ("host", "served", "own"),
    [
        ("127.0.0.1:7007", "127.0.0.1", True),
        ("localhost", "::1", True),
        ("[::1]:7007", "localhost", True),
        ("192.168.1.5:7007", "127.0.0.1", False),
        ("", "127.0.0.1", False),
        ("localhost.evil.example", "127.0.0.1", False),
        ("192.168.1.5:7007", "0.0.0.0", True),
        ("[fe80::1]:7007", "::", True),
        ("lab.example:7007", "lab.example", True),
        (socket.gethostname().lower(), "0.0.0.0", True),
        ("evil.example", "0.0.0.0", False),
        ("evil.example", "192.168.1.5", False),
        ("", "0.0.0.0", False),
    ],
)
def test_only_names_that_nobody_elses_dns_can_give(host, served, own):
    assert is_own_host(host, served) is own


@pytest.mark.parametrize(
    ("host", "more"),
    [
        ("127.0.0.1:7007", []),
        ("lab.example:7007", ["http://lab.example:*", "https://lab.example:*"]),
        ("[fe80::1]:7007", []),  # a policy cannot name an IPv6 address
        ("a;script-src *", []),
    ],
)
def test_only_pages_of_the_same_machine_may_embed_the_page(host, more):
    own = ["http://localhost:*", "https://localhost:*", "http://127.0.0.1:*", "https://127.0.0.1:*"]
    assert sorted(frame_ancestors(host).split()) == sorted([*own, *more, "vscode-webview:", "vscode-file:"])
