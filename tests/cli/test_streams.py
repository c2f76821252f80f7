"""What only a process of its own shows: streams, signals, terminals."""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
import sys

import pytest

import pinik
from pinik.cli import ExitStatus, main
from pinik.cli.commands import solve

SOLVE = ("solve", "arm", "--frame", "tip", "--position", "0.3", "0.1")


def test_data_on_stdout_and_nothing_else(run_process):
    solved = run_process(*SOLVE, "0.8", "--json")
    assert (solved.status, solved.err) == (0, "")
    assert solved.json["schema"] == 1
    assert solved.out.count("\n") == 1
    missed = run_process(*SOLVE, "2.8")
    assert (missed.status, missed.err) == (1, "")
    assert missed.out.startswith("unreachable")


def test_words_on_stderr_and_nothing_else(run_process):
    wrong = run_process("solve", "arm", "--frame", "tipp", "--position", "0", "0", "1", "--json")
    assert (wrong.status, wrong.out) == (2, "")
    assert wrong.err == "error: no frame 'tipp'; did you mean 'tip'?\n"
    none = run_process("solve", "armm", "--frame", "tip", "--position", "0", "0", "1", "--json")
    assert (none.status, none.out) == (3, "")
    assert none.err.startswith("error: no robot 'armm'; did you mean 'arm' or")


def test_warnings_do_not_mix_with_the_data(run_process):
    result = run_process("fk", "romeo", "--frame", "torso", "--pose", "half_sitting", "--json")
    assert result.json["robot"] == "romeo"
    assert all(line.startswith("warning: romeo: ") for line in result.err.splitlines())


@pytest.mark.parametrize("encoding", ["ascii", "latin-1"])
def test_any_encoding_of_stdout_is_good_enough(run_process, encoding):
    result = run_process(*SOLVE, "0.8", "--rpy", "0.3", "0", "0", "--json", PYTHONIOENCODING=encoding)
    assert json.loads(result.out)["schema"] == 1
    assert run_process("info", "double_pendulum_continuous", PYTHONIOENCODING=encoding).status == 0


@pytest.mark.parametrize(
    ("arguments", "status"), [([*SOLVE, "2.8"], 1), (["solve", "--help"], 0)], ids=["an answer", "the help"]
)
def test_a_reader_that_leaves_ends_nothing_noisily(environment, arguments, status):
    process = subprocess.Popen(
        [sys.executable, "-m", "pinik", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment,
    )
    process.stdout.close()
    err = process.stderr.read()
    process.stderr.close()
    assert (process.wait(timeout=30), err) == (status, b"")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_disk_is_said_in_words(environment):
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "pinik", *SOLVE, "0.8"],
            stdout=full,
            stderr=subprocess.PIPE,
            env=environment,
            timeout=30,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr.decode() == "error: cannot write the answer: No space left on device\n"


def test_an_interrupt_is_one_word_and_status_130(environment):
    locked = [name for i in range(2, 7) for axis in "xz" for name in ("--lock", f"bone{i}_{axis}")]
    endless = [*SOLVE, "0.8", *locked, "--restarts", "1000000000"]
    script = f"""
import signal, sys, pinik, pinik.cli

class Telling(pinik.JacobianTranspose):
    name = "telling"
    def direction(self, J, e):
        print("solving", flush=True)
        type(self).direction = pinik.JacobianTranspose.direction
        return super().direction(J, e)

signal.signal(signal.SIGINT, signal.default_int_handler)  # whatever the tests' own parent made of it
pinik.SOLVERS["telling"] = Telling
sys.exit(pinik.cli.main({[*endless, "--method", "telling"]!r}))
"""
    process = subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
    )
    try:
        assert process.stdout.readline() == b"solving\n"
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=30)
    finally:
        process.kill()
        process.wait()
    assert (process.returncode, out, err) == (130, b"", b"interrupted\n")


def test_an_interrupt_anywhere_in_a_command_is_status_130(run, monkeypatch):
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(sys.modules["pinik.cli.commands.solve"], "solve_targets", interrupted)
    assert run(*SOLVE, "0.8")[:] == (ExitStatus.INTERRUPTED, "", "interrupted\n")


def in_terminal(environment: dict[str, str], *arguments: str) -> str:
    """What a terminal gets to see."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "pinik", *arguments], stdout=theirs, stderr=theirs, env=environment
    )
    os.close(theirs)
    seen = b""
    try:
        while chunk := os.read(ours, 65536):
            seen += chunk
    except OSError:  # the terminal's other end is closed
        pass
    os.close(ours)
    process.wait(timeout=30)
    return seen.decode()


def test_colours_in_a_terminal_only_and_not_with_no_color(environment, run):
    terminal = environment | {"TERM": "xterm-256color"}
    seen = in_terminal(terminal, *SOLVE, "2.8")
    assert "\x1b[31m" in seen
    assert "bone1_x" in seen
    without = in_terminal(terminal | {"NO_COLOR": "1"}, *SOLVE, "2.8")
    assert "\x1b[3" not in without
    assert "unreachable" in without
    assert "\x1b" not in run(*SOLVE, "2.8").out


def test_the_version_and_an_empty_command_line(run):
    assert run("--version")[:] == (0, f"pinik {pinik.__version__}\n", "")
    assert run().status == 2
    assert "--help" in run().err
    unknown = run("slove")
    assert unknown.status == 2
    assert "solve" in unknown.err


def test_python_dash_m_and_the_entry_point_are_one(run_process):
    assert run_process("--version").out == f"pinik {pinik.__version__}\n"
    assert main.__module__.startswith("pinik.cli")
    assert solve.__name__ == "pinik.cli.commands.solve"
