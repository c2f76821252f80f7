"""Streams that are closed, full, or pipes without a reader: an answer that is lost is an error, lost words are not."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from itertools import cycle
from typing import IO, Any

import pytest

CLOSED, FULL, READERLESS = "closed", "full", "readerless"
STREAMS = {"stdin": 0, "stdout": 1, "stderr": 2}
POINT = ("--frame", "tip", "--position", "0.3", "0.1")
TARGET = {"frame": "tip", "position": [0.3, 0.1, 0.8]}

# One command line for each command that answers on stdout.
ANSWERS = {
    "solve": ("solve", "arm", *POINT, "0.8"),
    "track": ("track", "arm", "{path}", "--frame", "tip"),
    "fk": ("fk", "arm", "--json"),
    "jacobian": ("jacobian", "arm", "--frame", "tip"),
    "info": ("info", "arm"),
    "check": ("check", "arm"),
    "robots": ("robots",),
    "live": ("live", "two_link", "--no-browser", "--port", "0"),
    "compare": ("compare", "--steps", "1", "--json"),
    "accuracy": ("accuracy", "--problems", "1", "--digits", "1", "--joints", "3"),
    "--version": ("--version",),
    "--help": ("solve", "--help"),
}
REASONS = {CLOSED: "the stream is closed", FULL: "No space left on device"}

pytestmark = pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")


@pytest.fixture
def run_with(environment, tmp_path):
    """Run a command line with some streams lost: (status, what the other streams got)."""

    def run(arguments: tuple[str, ...], **lost: str) -> tuple[int, dict[str, bytes]]:
        path = tmp_path / "path.jsonl"
        path.write_text('{"position":[0.2,0.2,0.9]}\n')
        streams: dict[str, IO[bytes] | int] = {}
        close = [STREAMS[name] for name, how in lost.items() if how == CLOSED]
        for name, how in lost.items():
            if how == FULL:
                streams[name] = open("/dev/full", "wb")  # noqa: SIM115 - closed below
            elif how == READERLESS:
                reading, writing = os.pipe()
                os.close(reading)
                streams[name] = open(writing, "wb")  # noqa: SIM115 - closed below
        given: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        # A shell closes the streams, as users do; this process may be running threads.
        closing = "".join(f" {number}>&-" for number in close)
        process = subprocess.Popen(
            ["/bin/sh", "-c", f'exec "$@"{closing}', "sh", sys.executable, "-m", "pinik"]
            + [word.replace("{path}", str(path)) for word in arguments],
            env=environment,
            **given | streams,
        )
        out, err = process.communicate(timeout=60)
        for stream in streams.values():
            stream.close()
        return process.returncode, {"stdout": out or b"", "stderr": err or b""}

    return run


# A process takes a second, so most commands meet only one of the two.
LOSSES = dict(zip(ANSWERS, cycle([CLOSED, FULL]))) | {"solve again": FULL, "--help again": CLOSED}


@pytest.mark.parametrize(("command", "lost"), LOSSES.items())
def test_an_answer_that_is_lost_is_status_2_and_one_line(run_with, command, lost):
    status, seen = run_with(ANSWERS[command.removesuffix(" again")], stdout=lost)
    *notes, error = seen["stderr"].decode().splitlines()
    assert status == 2
    assert error in (f"error: cannot write the {what}: {REASONS[lost]}" for what in ("answer", "help"))
    assert not any(note.startswith(("error", "Traceback", " ")) for note in notes)


@pytest.mark.parametrize("command", ["solve", "track", "info", "check", "accuracy", "--help"])
def test_a_reader_that_has_gone_is_no_error(run_with, command):
    status, seen = run_with(ANSWERS[command], stdout=READERLESS)
    assert status == 0
    assert b"error" not in seen["stderr"]
    assert b"Traceback" not in seen["stderr"]


@pytest.mark.parametrize(
    ("arguments", "status", "lost"),
    [
        (("solve", "arm", *POINT, "0.8"), 0, FULL),
        (("solve", "arm", *POINT, "2.8"), 1, CLOSED),
        (("solve", "arm", "--frame", "tipp", "--position", "0", "0", "1"), 2, FULL),
        (("solve", "arm", "--frame", "tipp", "--position", "0", "0", "1"), 2, READERLESS),
        (("solve", "arm", "--colour"), 2, FULL),
        (("solve", "armm", *POINT, "0.8"), 3, CLOSED),
        (("solve", "armm", *POINT, "0.8"), 3, FULL),
        (("check", "/nowhere.urdf"), 3, FULL),
        (("track", "arm", "{path}", "--frame", "tip"), 0, READERLESS),
        ((), 2, FULL),
    ],
)
def test_words_that_are_lost_do_not_change_the_status(run_with, arguments, status, lost):
    assert run_with(arguments, stderr=lost)[0] == status


@pytest.mark.parametrize("lost", [CLOSED, FULL])
def test_when_answer_and_words_are_lost_the_status_tells_that_it_is_an_error(run_with, lost):
    assert run_with(ANSWERS["solve"], stdout=lost, stderr=lost)[0] == 2
    assert run_with(ANSWERS["--help"], stdout=lost, stderr=lost)[0] == 2


def test_all_streams_may_be_closed(run_with):
    assert run_with(ANSWERS["solve"], stdin=CLOSED, stdout=CLOSED, stderr=CLOSED)[0] == 2
    assert run_with(("solve", "armm", *POINT, "0"), stdin=CLOSED, stdout=CLOSED, stderr=CLOSED)[0] == 3


def test_a_closed_stdin_is_said_in_words_where_it_is_read(run_with):
    for reading in (("solve", "arm", "--targets", "-"), ("track", "arm", "-", "--frame", "tip")):
        status, seen = run_with(reading, stdin=CLOSED)
        assert (status, seen["stdout"]) == (2, b"")
        assert seen["stderr"] == b"error: stdin: cannot read the file: the stream is closed\n"


def test_a_closed_stdin_that_is_not_read_is_nothing(run_with):
    status, seen = run_with((*ANSWERS["solve"], "--json"), stdin=CLOSED)
    assert (status, seen["stderr"]) == (0, b"")
    assert json.loads(seen["stdout"])["success"]


def test_a_file_does_not_get_what_was_meant_for_a_closed_stream(run_with, tmp_path):
    file = tmp_path / "angles.csv"
    status, seen = run_with((*ANSWERS["track"], "--output", str(file)), stdin=CLOSED, stdout=CLOSED, stderr=CLOSED)
    assert (status, seen["stderr"]) == (0, b"")
    header, angles = file.read_text().splitlines()
    assert header.startswith("bone1_x,")
    assert len(angles.split(",")) == len(header.split(","))
