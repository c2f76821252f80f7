"""`pinik batch` as a command: streams, statuses, what stderr says, and runs that end early."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import signal
import subprocess
import sys
import time

import pytest

from pinik.cli.terminal.progress import report
from pinik.scale.jobs.job import Tally
from pinik.scale.jobs.parts import parts_folder
from start_up import unmeasured

GOOD = "id,x,y,z\na,0.2,0.2,0.9\nb,0.1,0.3,0.8\n"


def rows(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_a_table_through_pipes(run_process):
    done = run_process("batch", "arm", "-", "--frame", "tip", "--output", "-", stdin=GOOD)
    assert done.status == 0
    assert [(row["id"], row["status"]) for row in rows(done.out)] == [("a", "CONVERGED"), ("b", "CONVERGED")]
    assert re.fullmatch(r"2 of 2 rows solved; [\d,]+ rows/s in \S+ s\n", done.err)


def test_formats_by_option(run, tmp_path):
    table = tmp_path / "poses.txt"
    table.write_text(GOOD)
    done = run("batch", "arm", table, "--targets-format", "csv", "--frame", "tip", "--output", "-", "--format", "jsonl")
    assert [json.loads(line)["id"] for line in done.out.splitlines()] == ["a", "b"]
    done = run("batch", "arm", table, "--frame", "tip", "--output", "-")
    assert (done.status, done.out) == (2, "")
    assert done.err == f"error: {table} must end in .csv, .jsonl, .ndjson, .npz, .parquet; or name its format\n"


def test_a_missed_row_is_status_1_and_its_best_answer_is_there(run, tmp_path):
    table = tmp_path / "poses.csv"
    table.write_text(GOOD + "far,9,9,9\n")
    done = run("batch", "arm", table, "--frame", "tip", "--output", tmp_path / "out.csv", "--json")
    assert done.status == 1
    assert done.json == {
        "schema": 1,
        "robot": "arm",
        "success": False,
        "rows": 3,
        "solved": 2,
        "by_status": {"CONVERGED": 2, "UNREACHABLE": 1},
        "skipped": 0,
        "resumed": 0,
        "time_s": done.json["time_s"],
    }
    assert done.err.startswith("2 of 3 rows solved (1 UNREACHABLE); ")
    assert rows((tmp_path / "out.csv").read_text())[2]["angle.bone1_x"]


def test_bad_rows_are_status_2_and_with_skip_bad_listed_and_status_1(run, tmp_path):
    table = tmp_path / "poses.csv"
    table.write_text(GOOD + "c,nan,0,1\na,0.2,0.2,0.9\n")
    out = tmp_path / "out.csv"
    done = run("batch", "arm", table, "--frame", "tip", "--output", out)
    assert (done.status, done.out) == (2, "")
    assert done.err == (
        f"error: {table}: line 4: column x: must be a finite number; got nan; 1 more row is faulty; --skip-bad "
        "(skip_bad=True) leaves out faulty rows\n"
    )
    assert not out.exists()
    done = run("batch", "arm", table, "--frame", "tip", "--output", out, "--skip-bad")
    assert done.status == 1
    warnings = done.err.splitlines()[:2]
    assert warnings == [
        f"warning: {table}: line 4: column x: must be a finite number; got nan",
        f"warning: {table}: line 5: column id: comes a second time, after line 2",
    ]
    assert [row["id"] for row in rows(out.read_text())] == ["a", "b"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["-", "-", "--output", "-"], "the robot and the targets cannot both come from stdin"),
        (["arm", "-", "--output", "-", "--json"], "--json prints the summary to stdout, which --output - needs"),
        (["arm", "nowhere.csv", "--output", "-"], "nowhere.csv: cannot read the file: No such file or directory"),
        (["arm", ".", "--output", "-"], ".: cannot read the file: Is a directory"),
        (["arm", "-", "--output", "nowhere/out.csv"], "--output nowhere/out.csv: no such folder"),
        (["arm", "-", "--output", "out.txt"], "out.txt must end in .csv"),
        (["arm", "-", "--output", "-", "--resume"], "--resume must be False for a stream"),
        (["arm", "-", "--output", "-", "--threads", "0"], "--threads must be"),
        (["arm", "-", "--output", "-", "--frame", "tipp"], "no frame 'tipp'; did you mean 'tip'"),
        (["arm", "-", "--output", "-", "--format", "xls"], "no format 'xls'; available: 'csv'"),
        (["arm", "-", "--output", "-"], "there is no frame to move; give one for all rows by --frame F"),
        (["arm", "-", "--output", "-", "--frame", "tip", "--scheduler", "nowhere"], "no Dask scheduler answers at"),
    ],
)
def test_wrong_usage_is_status_2_in_words(run, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("pinik.scale.jobs.cluster._SECONDS_TO_CONNECT", 0.2)
    done = run("batch", *arguments, stdin=GOOD)
    assert done.status == 2
    assert done.err.startswith("error: ")
    assert words in done.err
    assert len(done.err.splitlines()) == 1


@pytest.fixture
def many(tmp_path):
    """1000 rows, half of which take longer, as they cannot be reached and that is not proved."""
    line = "0.2,0.2,0.9,0,0,0,1\n0.75,0.2,0.9,1,0,0,0\n"
    (tmp_path / "many.csv").write_text("x,y,z,qx,qy,qz,qw\n" + line * 500)
    return tmp_path / "many.csv"


@pytest.mark.parametrize(
    ("number", "status", "word"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
def test_an_interrupt_keeps_what_is_finished_and_resume_goes_on(run, many, environment, tmp_path, number, status, word):
    out, whole = tmp_path / "out.csv", tmp_path / "whole.csv"
    words = ["batch", "arm", str(many), "--frame", "tip", "--restarts", "5", "--output"]
    process = subprocess.Popen(
        [sys.executable, "-m", "pinik", *words, str(out), "--chunk", "20"],
        env=environment,
        stderr=subprocess.PIPE,
        text=True,
    )
    while len(list(parts_folder(out).glob("*.part"))) < 2 and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(number)
    _, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (
        status,
        f"finished chunks are kept in {parts_folder(out)}; the same command with --resume goes on with them\n{word}\n",
    )
    finished = len(list(parts_folder(out).glob("*.part")))
    refused = run(*words, out, "--chunk", "20")
    assert refused.status == 2
    assert refused.err.startswith("error: "), "nothing advises --resume to a command that is refused"
    assert f"holds {finished} of 50 chunks of a run that was not finished" in refused.err
    other = run(*words, out, "--chunk", "21", "--resume")
    assert other.status == 2
    assert other.err.startswith("error: ")
    assert "belongs to another run: chunk was 20 and is 21" in other.err
    done = run(*words, out, "--chunk", "20", "--resume")
    assert done.status == 1
    assert f", {20 * finished:,} of them in an earlier run; " in done.err
    run(*words, whole, "--chunk", "20")
    assert out.read_bytes() == whole.read_bytes()
    assert not parts_folder(out).exists()


@pytest.mark.parametrize(("blocks", "kept"), [(96, 10), (8, 0)])
def test_a_full_disk_is_status_2_in_words_and_resume_goes_on_when_there_is_room(
    run, many, environment, tmp_path, blocks, kept
):
    """Files that may not grow beyond a few blocks look to the process like a full disk, first to the whole output."""
    out = tmp_path / "out.csv"
    out.write_text("old")
    command = [sys.executable, "-m", "pinik", "batch", "arm", str(many), "--frame", "tip", "--output", str(out)]
    command += ["--restarts", "5", "--chunk", "100"]
    limited = ["/bin/sh", "-c", f'ulimit -f {blocks}; exec "$@"', "sh", *command]
    env = unmeasured(environment) | {"PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(limited, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    hint = f"finished chunks are kept in {parts_folder(out)}; the same command with --resume goes on with them\n"
    assert done.stderr == (hint if kept else "") + f"error: --output {out}: cannot write it: File too large\n"
    assert out.read_text() == "old"
    assert len(list(parts_folder(out).glob("*.part"))) == kept
    again = run(*command[3:], "--resume")
    assert again.status == 1
    assert (", 1,000 of them in an earlier run; " in again.err) == bool(kept)
    assert len(rows(out.read_text())) == 1000


def test_a_reader_that_goes_away_ends_the_work(many, environment):
    command = f"{sys.executable} -m pinik batch arm {many} --frame tip --output - --chunk 10 | head -3"
    began = time.monotonic()
    done = subprocess.run(
        ["sh", "-c", command], env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert len(done.stdout.splitlines()) == 3
    assert done.stderr == ""
    assert time.monotonic() - began < 40.0


def test_two_workers_of_dask_write_the_same_bytes(run, run_process, many, tmp_path):
    common = ("batch", "arm", many, "--frame", "tip", "--restarts", "2", "--chunk", "300", "--output")
    here = run(*common, tmp_path / "here.csv")
    there = run_process(*common, tmp_path / "there.csv", "--workers", "2")
    assert (here.status, there.status) == (1, 1), there.err
    assert (tmp_path / "here.csv").read_bytes() == (tmp_path / "there.csv").read_bytes()
    assert re.search(r"^500 of 1,000 rows solved \(.*\); .*\n", there.err, re.MULTILINE)


def test_progress_names_rate_share_and_time_left():
    tally = Tally(10, finished=5, resumed=2, notes={"rows": 5000, "CONVERGED": 4990}, earlier={"rows": 2000})
    assert report(tally, 10_000, 60.0) == "5,000 of 10,000 rows, 99.8 % solved, 50 rows/s, 1 min 40 s left"
    assert report(Tally(10), 10_000, 0.0) == "0 of 10,000 rows"
    tally = Tally(10, finished=1, notes={"rows": 1000, "CONVERGED": 1000})
    assert report(tally, 10_000_000, 1.0).endswith(", 1,000 rows/s, 2 h 46 min left")
    assert report(Tally(120, finished=40, resumed=20), None, 30.0) == "40 of 120 parts, 2 min 00 s left"


def test_progress_in_a_terminal_is_one_line_that_goes_away(many, environment, tmp_path):
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    command = [
        sys.executable,
        "-m",
        "pinik",
        "batch",
        "arm",
        many,
        "--frame",
        "tip",
        "--chunk",
        "50",
        "--output",
        "o.csv",
    ]
    process = subprocess.Popen(command, env=environment, stderr=theirs, cwd=tmp_path)
    os.close(theirs)
    seen = b""
    while True:
        try:
            piece = os.read(ours, 4096)
        except OSError:
            break
        if not piece:
            break
        seen += piece
    os.close(ours)
    assert process.wait() == 1
    lines = seen.decode().split("\r\x1b[K")
    assert any(re.fullmatch(r"[\d,]+ of 1,000 rows, \d+\.\d % solved, [\d,]+ rows/s, .* left", line) for line in lines)
    assert re.fullmatch(r"500 of 1,000 rows solved \(.*\r\n", lines[-1])
