"""`pinik live`: the page's address on stdout, words on stderr, and how it ends."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import sys
import urllib.request

import pytest

from start_up import SOLVE, modules_after

SCRIPT = """
import signal, sys, pinik.cli
signal.signal(signal.SIGINT, signal.default_int_handler)  # whatever the tests' own parent made of it
sys.exit(pinik.cli.main())
"""
PATIENCE = 60  # seconds; nothing here takes as many, unless it is broken


@contextlib.contextmanager
def running(environment, *arguments):
    """A `pinik live` that has said where its page is: (process, address)."""
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, "live", "--no-browser", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment,
        text=True,
    )
    try:
        yield process, process.stdout.readline()
    finally:
        process.kill()
        process.communicate()


def state(address):
    with urllib.request.urlopen(f"{address.strip()}api/state", timeout=PATIENCE) as answer:
        return json.loads(answer.read())


def test_the_address_is_on_stdout_and_ctrl_c_ends_it(environment):
    with running(environment, "--port", "0") as (process, address):
        port = int(re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\n", address)[1])
        shown = state(address)
        assert (shown["robot"], shown["running"], shown["motion"]) == ("arm", True, "curve")
        assert [one["method"] for one in shown["instances"]] == ["ccd", "jt", "pinv", "dls"]
        assert process.stderr.readline() == "Press Ctrl-C to end the live view.\n"
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=PATIENCE)
    assert (process.returncode, out, err) == (130, "", "interrupted\n")
    with socket.socket() as listening:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(("127.0.0.1", port))


def test_the_closed_form_is_one_of_the_methods_where_it_can_be(environment):
    with running(environment, "two_link", "--methods", "two_bone,dls", "--port", "0") as (_, address):
        shown = state(address)
    assert [one["method"] for one in shown["instances"]] == ["two_bone", "dls"]


def test_every_option_arrives(environment):
    options = ["--root", "planar", "--methods", "dls,pinv", "--view", "1", "--motion", "random", "--host", "localhost"]
    with running(environment, "two_link", *options, "--port", "0") as (_, address):
        assert address.startswith("http://localhost:")
        shown = state(address)
    assert (shown["robot"], shown["root"], shown["view"], shown["motion"]) == ("two_link", "planar", 1, "random")
    assert [one["method"] for one in shown["instances"]] == ["dls"]


def test_a_method_of_ones_own_and_a_file(environment, tmp_path):
    (tmp_path / "own_methods.py").write_text(
        "import dataclasses, pinik\n"
        "@dataclasses.dataclass(frozen=True, kw_only=True)\n"
        "class Mine(pinik.JacobianTranspose):\n    name = 'mine'\n"
    )
    robot = tmp_path / "own.urdf"
    robot.write_text('<robot name="own"><link name="a"/></robot>')
    path = os.pathsep.join([str(tmp_path), environment["PYTHONPATH"]])
    own = environment | {"PYTHONPATH": path}
    with running(own, str(robot), "--methods", "own_methods:Mine", "--port", "0") as (_, address):
        shown = state(address)
    assert (shown["robot"], [one["method"] for one in shown["instances"]]) == ("own", ["mine"])


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["armm"], 3, "no robot 'armm'; did you mean 'arm'"),
        (["/nowhere/robot.urdf"], 3, "/nowhere/robot.urdf"),
        (["ur3_empty"], 3, "contains only macros"),
        (["--methods", "ccdd"], 2, "no method 'ccdd'; did you mean 'ccd'"),
        (["--methods", ""], 2, "no method ''"),
        (["--methods", "ccd,,dls"], 2, "no method ''"),
        (["--methods", "ccd,ccd,ccd,ccd,ccd"], 2, "one to four methods; got 5"),
        (["--methods", "nowhere:Solver"], 2, "nowhere"),
        (
            ["--methods", "two_bone,dls"],
            2,
            "two_bone cannot chase a ball here: frame 'tip' is not moved by two parallel",
        ),
        (["--view", "3"], 2, "1, 2 or 4 instances; got 3"),
        (["--view", "two"], 2, "'two' is not a whole number; see 'pinik live --help'"),
        (["--port", "70000"], 2, "port must be a whole number from 0 to 65535; got 70000"),
        (["--port", "-1"], 2, "port must be a whole number from 0 to 65535; got -1"),
        (["--port", "http"], 2, "'http' is not a whole number"),
        (["--motion", "dance"], 2, "no motion 'dance'"),
        (["--root", "ceiling"], 2, "root"),
        (["--host", "192.0.2.1"], 2, "cannot listen on 192.0.2.1"),
        (["--host", ""], 2, "host must be an address of this machine"),
        (["--package-dir", "/nowhere"], 2, "no such folder"),
        (["--colour"], 2, "pinik live --help"),
        (["arm", "lion"], 2, "pinik live --help"),
    ],
)
def test_what_cannot_be_is_said_in_words(run, arguments, status, words):
    result = run("live", "--no-browser", *(() if "--port" in arguments else ("--port", "0")), *arguments)
    assert (result.status, result.out) == (status, "")
    assert result.err.startswith("error: ")
    assert words in result.err
    assert "Traceback" not in result.err


def test_a_port_that_is_taken_is_said_in_words(run):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        result = run("live", "--no-browser", "--port", port)
    assert (result.status, result.out) == (2, "")
    assert f"cannot listen on 127.0.0.1, port {port}: Address already in use; leave the port out" in result.err


def test_the_browser_is_opened_unless_told_otherwise(run, monkeypatch):
    from pinik.viewer.web.live_view import LiveView

    opened = []
    monkeypatch.setattr(LiveView, "wait", lambda self: None)
    monkeypatch.setattr(LiveView, "open", lambda self: opened.append(self.url) or len(opened) == 1)
    result = run("live", "two_link", "--port", "0")
    assert (result.status, opened) == (0, [result.out.strip()])
    assert result.err == "Press Ctrl-C to end the live view.\n"
    result = run("live", "two_link", "--port", "0")
    assert f"No browser was found; open {result.out.strip()} in one." in result.err
    run("live", "two_link", "--port", "0", "--no-browser")
    assert len(opened) == 2


@pytest.mark.parametrize("arguments", [SOLVE, ["live", "--help"], ["robots"]], ids=lambda a: a[0])
def test_other_commands_pay_nothing_for_it(environment, arguments):
    modules = modules_after(environment, arguments)
    assert modules.isdisjoint({"tornado", "umsgpack", "meshcat", "asyncio", "zmq", "pinik.viewer.web.live_view"})
