"""Jobs: the same bytes however they are run, however often they are killed, and never those of another job."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from pinik import InputError
from pinik.scale.jobs.parts import Parts, parts_folder
from pinik.scale.jobs.run import run, stream
from pinik.scale.jobs.threads import Threads
from toy_jobs import Work, expected, join, toy, whole


@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("chunks", [0, 1, 13])
def test_the_output_is_all_chunks_in_order_and_the_folder_is_gone(tmp_path, count, chunks):
    tally = run(toy(chunks), tmp_path / "out", join, Threads(count))
    assert (tmp_path / "out").read_bytes() == whole(chunks)
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert (tally.chunks, tally.finished, tally.resumed) == (chunks, chunks, 0)
    assert tally.notes.get("rows", 0) == sum(range(chunks))


@pytest.mark.parametrize("count", [1, 3])
def test_a_stream_is_in_order_too(count):
    read: list[bytes] = []
    tally = stream(toy(200, Work(seconds=0.0001)), read.append, Threads(count))
    assert b"".join(read) == whole(200)
    assert tally.notes == {"rows": sum(range(200)), "odd": 100}


def test_a_stream_waits_for_a_slow_chunk_instead_of_keeping_all_others(tmp_path):
    begun: list[int] = []

    class FirstIsSlow(Work):
        def __call__(self, payload, pause):
            begun.append(payload)
            if payload == 0:
                time.sleep(0.5)
                begun.append(-1)
            return super().__call__(payload, pause)

    read: list[bytes] = []
    stream(toy(2000, FirstIsSlow()), read.append, Threads(3))
    assert b"".join(read) == whole(2000)
    assert begun.index(-1) < 100


def test_a_failing_chunk_ends_the_run_and_what_was_finished_stays(tmp_path):
    out, log = tmp_path / "out", tmp_path / "log"
    with pytest.raises(ValueError, match="chunk 6 is no good"):
        run(toy(10, Work(log, fails_at=6)), out, join, Threads(1))
    assert not out.exists()
    tally = run(toy(10, Work(log)), out, join, Threads(2), resume=True)
    assert out.read_bytes() == whole(10)
    assert (tally.resumed, tally.earlier["rows"], tally.notes["rows"]) == (6, 15, 45)
    worked = [int(line.split()[0]) for line in log.read_text().splitlines()]
    assert sorted(worked) == list(range(10)), "each chunk is worked on once"


def unfinished(tmp_path: Path, **fingerprint: object) -> Path:
    """An output of ten chunks of which six are finished."""
    out = tmp_path / "out"
    with pytest.raises(ValueError, match="no good"):
        run(toy(10, Work(fails_at=6), **fingerprint), out, join, Threads(1))
    return out


def test_an_unfinished_run_is_not_overwritten_unasked(tmp_path):
    out = unfinished(tmp_path)
    with pytest.raises(InputError, match=r"out\.parts holds 6 of 10 chunks .* --resume"):
        run(toy(10), out, join, Threads(1))
    assert len(list(parts_folder(out).glob("*.part"))) == 6


@pytest.mark.parametrize(
    ("job", "words"),
    [
        (toy(10, options={"seed": 2}), "options.seed was 1 and is 2"),
        (toy(10, options={"seed": 1, "frame": "tip"}), 'options.frame was not given and is "tip"'),
        (toy(10, options={}), "options.seed was 1 and is not given"),
        (toy(11, options={"seed": 1}), "chunks was 10 and is 11"),
    ],
)
def test_another_job_is_refused_in_words(tmp_path, job, words):
    out = unfinished(tmp_path, options={"seed": 1})
    with pytest.raises(InputError, match=words.replace(".", r"\.")):
        run(job, out, join, Threads(1), resume=True)
    run(toy(10, options={"seed": 1}), out, join, Threads(1), resume=True)
    assert out.read_bytes() == whole(10)


@pytest.mark.parametrize("damage", ["cut", "changed", "emptied"])
def test_a_damaged_part_is_worked_on_again(tmp_path, damage):
    out = unfinished(tmp_path)
    part = sorted(parts_folder(out).glob("*.part"))[2]
    content = part.read_bytes()
    part.write_bytes({"cut": content[:-1], "changed": content.replace(b"chunk", b"Chunk"), "emptied": b""}[damage])
    tally = run(toy(10), out, join, Threads(1), resume=True)
    assert out.read_bytes() == whole(10)
    assert tally.resumed == 5


def test_two_runs_at_once_are_refused(tmp_path):
    out = unfinished(tmp_path)
    with Parts(parts_folder(out), toy(10), resume=True), pytest.raises(InputError, match="another process is at work"):
        run(toy(10), out, join, Threads(1), resume=True)


def test_an_assembly_that_fails_loses_nothing(tmp_path):
    out = tmp_path / "out"
    out.write_bytes(b"old")

    def full(parts, file):
        file.write(parts.read(0))
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space left"):
        run(toy(4), out, full, Threads(1))
    assert out.read_bytes() == b"old"
    assert run(toy(4), out, join, Threads(1), resume=True).resumed == 4
    assert out.read_bytes() == whole(4)


def test_an_interrupt_stops_the_work_soon_and_keeps_what_is_finished(tmp_path):
    out = tmp_path / "out"
    began = time.monotonic()
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        run(toy(4, Work(seconds=60.0)), out, join, Threads(2))
    assert time.monotonic() - began < 5.0
    assert run(toy(4), out, join, Threads(2), resume=True).finished == 4


KILLED = """
import sys
from pathlib import Path
from pinik.scale.jobs.run import run
from pinik.scale.jobs.threads import Threads
from toy_jobs import Work, join, toy
folder = Path(sys.argv[1])
run(toy(60, Work(folder / "log", 0.005)), folder / "out", join, Threads(2), resume=True)
"""


def test_a_run_killed_at_random_moments_resumes_to_the_same_bytes(tmp_path):
    """Each chunk whose part is on the disk is worked on once, however often the process dies."""
    rng = random.Random(0)
    paths = os.pathsep.join([str(Path(__file__).parents[2]), *filter(None, sys.path)])
    out, kills = tmp_path / "out", 0
    for _ in range(8):
        kept = {path.name for path in parts_folder(out).glob("*.part")}
        process = subprocess.Popen([sys.executable, "-c", KILLED, tmp_path], env=os.environ | {"PYTHONPATH": paths})
        while not parts_folder(out).exists() and process.poll() is None:
            time.sleep(0.005)
        time.sleep(rng.uniform(0.0, 0.06))
        process.kill()
        if process.wait() == 0:
            break
        kills += 1
        assert not out.exists() or not kept - {path.name for path in parts_folder(out).glob("*.part")}
    run(toy(60, Work(tmp_path / "log", 0.005)), out, join, Threads(2), resume=True)
    assert out.read_bytes() == whole(60)
    worked = [int(line.split()[0]) for line in (tmp_path / "log").read_text().splitlines()]
    assert set(worked) == set(range(60))
    assert len(worked) - 60 <= 2 * kills, "only chunks under way were worked on again"
    assert {path.name for path in tmp_path.iterdir()} == {"out", "log"}


@pytest.mark.parametrize("removed", [0, 3])
def test_a_run_that_died_while_it_tidied_up_is_finished_without_any_work(tmp_path, removed):
    out, log = tmp_path / "out", tmp_path / "log"
    with Parts(parts_folder(out), toy(4), resume=False) as parts:
        for number in range(4):
            parts.write(number, Work()(number, lambda: None))
        with open(parts.unpublished, "wb") as file:
            join(parts, file)
        parts.publish(out, {"chunks": 4, "finished": 4, "resumed": 4, "notes": {"rows": 6}, "earlier": {"rows": 6}})
    for part in sorted(parts_folder(out).glob("*.part"))[:removed]:
        part.unlink()
    tally = run(toy(4, Work(log)), out, join, Threads(1), resume=True)
    assert (tally.finished, tally.resumed, tally.notes) == (4, 4, {"rows": 6})
    assert not log.exists()
    assert out.read_bytes() == b"".join(expected(k) for k in range(4))
    assert not parts_folder(out).exists()


def test_progress_is_told_from_the_beginning_to_the_end(tmp_path):
    seen: list[tuple[int, int]] = []
    run(
        toy(5),
        tmp_path / "out",
        join,
        Threads(2),
        on_progress=lambda tally: seen.append((tally.finished, tally.chunks)),
    )
    assert seen[0] == (0, 5)
    assert seen[-1] == (5, 5)
    assert seen == sorted(seen)
