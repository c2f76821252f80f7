"""Disks that are full and homes that cannot be written: errors in words, and the files that were there before."""

from __future__ import annotations

import subprocess
import sys

import pytest

from start_up import unmeasured

OLD = b"what was there before\n"
PLOT = ("accuracy", "--problems", "1", "--digits", "1", "--joints", "3", "--plot", "out.svg")
COMMANDS = {
    "--output out.csv": ("track", "arm", "path.csv", "--frame", "tip", "--output", "out.csv"),
    "--plot out.svg": PLOT,
}


@pytest.fixture
def run_on_full_disk(environment, tmp_path):
    """Run a command in a process whose files may not grow beyond one block, which looks to it like a full disk."""
    (tmp_path / "path.csv").write_text("x,y,z\n" + "0.2,0.2,0.9\n" * 20)

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["/bin/sh", "-c", 'ulimit -f 1; exec "$@"', "sh", sys.executable, "-m", "pinik", *arguments],
            cwd=tmp_path,
            env=unmeasured(environment) | {"PYTHONDONTWRITEBYTECODE": "1"},
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )

    return run


@pytest.mark.parametrize(
    ("option", "there"), [("--output out.csv", True), ("--output out.csv", False), ("--plot out.svg", True)]
)
def test_a_full_disk_is_status_2_in_words_and_the_old_file_stays(run_on_full_disk, tmp_path, option, there):
    file = tmp_path / option.split()[1]
    if there:
        file.write_bytes(OLD)
    done = run_on_full_disk(*COMMANDS[option])
    assert (done.returncode, done.stderr) == (2, f"error: {option}: cannot write it: File too large\n")
    assert (file.read_bytes() if there else file.exists()) == (OLD if there else False)
    assert {path.name for path in tmp_path.iterdir()} <= {file.name, "path.csv"}


@pytest.mark.parametrize("home", [None, "/proc/nowhere"])
def test_without_a_home_that_can_be_written_nothing_is_lost_and_nothing_else_is_said(environment, tmp_path, home):
    kept = {
        name: value for name, value in environment.items() if name != "HOME" and not name.startswith(("XDG", "MPL"))
    }
    done = subprocess.run(
        [sys.executable, "-m", "pinik", *PLOT],
        cwd=tmp_path,
        env=kept if home is None else kept | {"HOME": home},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "out.svg").read_text().rstrip().endswith("</svg>")
