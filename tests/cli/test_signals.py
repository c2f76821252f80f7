"""Signals at any moment of a command: a documented status, at most one line, and files that are whole."""

from __future__ import annotations

import os
import random
import select
import signal
import subprocess
import sys
import time

import pytest

from pinik import interrupts
from start_up import unmeasured

# Tells when Python has come to the part of a command that pinik can answer for.
TELLING = """
import os, sys
class Telling:
    def find_spec(self, name, path=None, target=None):
        if name == os.environ["TELL_BEFORE"]:
            sys.meta_path.remove(self)
            os.write(int(os.environ["TELL_TO"]), b"x")
            if "THEN_WAIT" in os.environ:
                import time
                time.sleep(60)
sys.meta_path.insert(0, Telling())
"""
# Whatever the tests' own parent made of the signals.
USUAL = """
import _signal, os, sys
_signal.signal(_signal.SIGINT, _signal.SIG_DFL)
_signal.signal(_signal.SIGTERM, _signal.SIG_DFL)
os.execv(sys.executable, [sys.executable, *sys.argv[1:]])
"""
OLD = "whole and old\n"


@pytest.fixture
def started(environment, tmp_path):
    """Start a command and wait until it imports a certain module."""
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(TELLING)
    running = []

    def start(
        *arguments: str, how: tuple[str, ...] = ("-m", "pinik"), before: str = "pinik.version", wait: bool = False
    ) -> subprocess.Popen[bytes]:
        reading, writing = os.pipe()
        told = {"TELL_BEFORE": before, "TELL_TO": str(writing)} | ({"THEN_WAIT": "1"} if wait else {})
        path = os.pathsep.join([str(tmp_path / "site"), environment["PYTHONPATH"]])
        process = subprocess.Popen(
            [sys.executable, "-c", USUAL, *how, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=unmeasured(environment) | told | {"PYTHONPATH": path},
            pass_fds=[writing],
        )
        running.append(process)
        os.close(writing)
        assert select.select([reading], [], [], 60)[0]
        assert os.read(reading, 1) == b"x"
        os.close(reading)
        return process

    yield start
    for process in running:
        process.kill()
        process.communicate()


def as_a_shell_says(status: int) -> int:
    """A process that ends itself by a signal, as Python does at times after an interrupt, has the same status there."""
    return status if status >= 0 else 128 - status


SIGNALS = {signal.SIGINT: (130, b"interrupted\n"), signal.SIGTERM: (143, b"terminated\n")}


@pytest.mark.parametrize("number", SIGNALS)
@pytest.mark.parametrize("before", ["signal", "pinik.interrupts", "pinik.errors", "typer", "pinik.cli.commands.robots"])
def test_a_signal_while_modules_load_is_one_word_and_its_status(started, number, before):
    process = started("robots", before=before, wait=True)
    process.send_signal(number)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out, err) == (SIGNALS[number][0], b"", SIGNALS[number][1])


@pytest.mark.parametrize("before", ["signal", "threading", "typing", "pinik.errors"])
def test_the_installed_script_is_the_command_too(started, tmp_path, before):
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "pinik").write_text("import sys\nfrom pinik.cli import main\nsys.exit(main())\n")
    process = started("robots", how=(str(tmp_path / "bin" / "pinik"),), before=before, wait=True)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=30) == (b"", b"interrupted\n")
    assert process.returncode == 130


def test_sigterm_ends_the_live_view_in_one_word(started):
    process = started("live", "two_link", "--no-browser", "--port", "0")
    assert process.stdout.readline().startswith(b"http://")
    assert process.stderr.readline() == b"Press Ctrl-C to end the live view.\n"
    process.terminate()
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out, err) == (143, b"", b"terminated\n")


def test_signals_at_random_moments(started, tmp_path):
    """A command that reads a path and writes a file; the moments are repeatable as far as the machine's pace is."""
    path, file = tmp_path / "path.csv", tmp_path / "angles.csv"
    path.write_text("x,y,z\n" + "".join(f"0.2,0.2,{0.7 + k / 1000}\n" for k in range(200)))
    moments = random.Random(20)
    statuses = set()
    for attempt in range(9):
        file.write_text(OLD)
        number = (signal.SIGINT, signal.SIGTERM, signal.SIGPIPE)[attempt % 3]
        process = started("track", "arm", str(path), "--frame", "tip", "--output", str(file))
        time.sleep(moments.uniform(0.0, 1.2))
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
        status = as_a_shell_says(process.returncode)
        statuses.add(status)
        expected, word = SIGNALS.get(number, (0, b""))
        assert out == b""
        assert status in (0, expected)
        said = err.removeprefix(b"200 of 200 points reached in ").partition(b" s\n")
        note = b"200 of 200 points reached"
        assert (said[2] if err.startswith(note) else err) in ((word,) if process.returncode > 0 else (b"", word))
        written = file.read_text()
        assert written == OLD or written.count("\n") == 201
        assert status or written != OLD
        assert sorted(entry.name for entry in tmp_path.iterdir()) == ["angles.csv", "path.csv", "site"]
    assert 0 in statuses


def test_a_library_leaves_the_signals_alone(environment):
    script = (
        "import signal; before = [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)]; import pinik; "
        "from pinik.cli import main; main(['robots']); "
        "print(before == [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout.splitlines()[-1] == "True"


def test_in_the_block_signals_are_exceptions_and_afterwards_what_they_were():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(interrupts.Terminated), interrupts.as_exceptions():
        signal.raise_signal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt), interrupts.as_exceptions():
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGTERM) == before


def test_an_interrupt_in_a_finalizer_is_not_lost(environment):
    """Python drops what is raised there, so that the command would go on."""
    script = """
import signal, time
from pinik import interrupts
class Odd:
    def __del__(self):
        signal.raise_signal(signal.SIGTERM)
with interrupts.as_exceptions():
    Odd()
    print("went on")
"""
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=False, timeout=60
    )
    assert (done.returncode, done.stdout, done.stderr) == (143, "", "terminated\n")
