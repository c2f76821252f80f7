"""`pinik.batch.run`: each row's answer is that of `pinik.solve`, in every format, and however the work is divided."""

from __future__ import annotations

import csv
import io
import itertools
import json
import math
import os
import random
import stat
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pinocchio
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import pinik
from pinik import InputError, MissingExtraError, Target, UnknownNameError
from pinik.scale.jobs.parts import parts_folder

TIP = "panda_hand_tcp"
FORMATS = ("csv", "jsonl", "npz", "parquet")
PLACE = ("x", "y", "z", "qx", "qy", "qz", "qw")


def write(path: Path, columns: dict[str, list]) -> Path:
    """A table by the plainest means of each format; None is an empty cell."""
    if path.suffix == ".csv":
        with path.open("w", newline="") as file:
            csv.writer(file).writerows([list(columns), *zip(*columns.values(), strict=True)])
    elif path.suffix == ".jsonl":
        rows = zip(*columns.values(), strict=True)
        path.write_text("".join(json.dumps(dict(zip(columns, row, strict=True))) + "\n" for row in rows))
    elif path.suffix == ".npz":
        np.savez(path, **{name: np.array(column) for name, column in columns.items()})
    else:
        pq.write_table(pa.table(columns), path, row_group_size=17)
    return path


def read(path: Path) -> dict[str, list]:
    """A table of answers by the plainest means of each format; None where there is no number."""
    if path.suffix == ".csv":
        names, *rows = csv.reader(path.read_text().splitlines())
        texts = dict(zip(names, map(list, zip(*rows, strict=True)), strict=True))
        keep = {"id": str, "status": str, "success": {"true": True, "false": False}.get}
        numbers = {"iterations": int, "restarts": int}

        def value(name, text):
            return keep[name](text) if name in keep else None if text == "" else numbers.get(name, float)(text)

        return {name: [value(name, text) for text in column] for name, column in texts.items()}
    if path.suffix == ".jsonl":
        rows = [json.loads(line) for line in path.read_text().splitlines()]
        return {name: [row[name] for row in rows] for name in rows[0]}
    if path.suffix == ".npz":
        with np.load(path) as archive:
            return {
                name: [None if isinstance(v, float) and math.isnan(v) else v for v in archive[name].tolist()]
                for name in archive.files
            }
    return pq.read_table(path).to_pydict()


def angles_of(answers: dict[str, list], row: int, robot: pinik.Robot) -> dict[str, float]:
    return {name: answers[f"angle.{name}"][row] for name in robot.joint_names}


def own_angles(solution: pinik.Solution, robot: pinik.Robot) -> dict[str, float]:
    """The angles without those of followers."""
    return {name: solution.angles[name] for name in robot.joint_names}


@pytest.fixture(scope="module")
def poses(panda) -> dict[str, list]:
    """50 poses, three of which are out of reach."""
    rng = np.random.default_rng(5)
    placements = [panda.placement(TIP, panda.random(rng)) for _ in range(50)]
    for number in (7, 20, 49):
        placements[number].translation = placements[number].translation * 4.0 + (1.0, 0.0, 1.0)
    rows = [[*M.translation, *pinocchio.Quaternion(M.rotation).coeffs()] for M in placements]
    columns = dict(zip(PLACE, np.array(rows).T.tolist(), strict=True))
    return {"id": [f"pose {k}" for k in range(50)], **columns}


@pytest.mark.parametrize("form", FORMATS)
def test_each_row_is_answered_as_solve_answers_it_alone(panda, poses, tmp_path, form):
    path = write(tmp_path / f"poses.{form}", poses)
    summary = pinik.batch.run(panda, path, TIP, output=tmp_path / f"out.{form}", chunk=16, seed=3)
    answers = read(tmp_path / f"out.{form}")
    assert answers["id"] == poses["id"]
    for k in range(50):
        quat = [poses[name][k] for name in PLACE[3:]]
        alone = pinik.solve(panda, TIP, position=[poses[name][k] for name in PLACE[:3]], quat_xyzw=quat, seed=3)
        assert answers["status"][k] == alone.status.name
        assert answers["success"][k] is alone.success
        if not alone.success:
            continue
        angles = angles_of(answers, k, panda)
        assert angles == pytest.approx(own_angles(alone, panda), abs=1e-6)
        reached = panda.placement(TIP, panda.configuration(angles))
        wanted = pinocchio.SE3(pinocchio.Quaternion(np.array(quat)).matrix(), np.array([poses[n][k] for n in "xyz"]))
        off = pinocchio.log6(wanted.actInv(reached))
        assert np.linalg.norm(off.linear) < 1.1e-4
        assert np.linalg.norm(off.angular) < 1.1e-3
        assert answers["position_error_m"][k] == pytest.approx(np.linalg.norm(off.linear), abs=1e-8)
        assert answers["iterations"][k] == alone.iterations
        assert answers["restarts"][k] == alone.restarts
    assert (summary.rows, summary.solved, summary.success) == (50, 47, False)
    assert summary.by_status == {"CONVERGED": 47, "UNREACHABLE": 3}


def test_all_formats_say_the_same(panda, poses, tmp_path):
    tables = []
    for source, form in zip(FORMATS, (*FORMATS[1:], FORMATS[0]), strict=True):
        path = write(tmp_path / f"poses.{source}", poses)
        pinik.batch.run(panda, path, TIP, output=tmp_path / f"out.{form}")
        tables.append(read(tmp_path / f"out.{form}"))
    assert all(table == tables[0] for table in tables)


@pytest.mark.parametrize("method", ["dls", "ccd"])
@pytest.mark.parametrize("engine", ["native", "python"])
def test_answers_depend_on_no_other_row_nor_on_how_the_work_is_divided(panda, poses, tmp_path, method, engine):
    """Rows that need more restarts than the table has starts, too, whose starts are drawn."""
    hard = {name: [*column[:6], *column[45:]] for name, column in poses.items()}
    hard["x"] = [x * 1.25 for x in hard["x"]]  # some are barely out of reach
    options = {"method": method, "engine": engine, "restarts": 40, "max_iterations": 12, "polish": False}
    path = write(tmp_path / "hard.csv", hard)
    outputs = []
    for number, (chunk, threads) in enumerate([(100, 1), (1, 2), (3, 3), (4, 1)]):
        out = tmp_path / f"{number}.csv"
        pinik.batch.run(panda, path, TIP, output=out, chunk=chunk, threads=threads, **options)
        outputs.append(out.read_bytes())
    assert len(set(outputs)) == 1
    answers = read(tmp_path / "0.csv")
    assert max(answers["restarts"]) > 32, "some starts are drawn"
    turned = {name: column[::-1] for name, column in hard.items()}
    pinik.batch.run(panda, write(tmp_path / "t.csv", turned), TIP, output=tmp_path / "t.out.csv", chunk=4, **options)
    backwards = read(tmp_path / "t.out.csv")
    assert {name: column[::-1] for name, column in backwards.items()} == answers


def test_the_closed_form_does_not_depend_on_chunks_either(two_link, tmp_path):
    rng = np.random.default_rng(0)
    frame = two_link.frame_names[-1]
    points = np.array([two_link.placement(frame, two_link.random(rng)).translation for _ in range(300)])
    path = write(tmp_path / "p.csv", dict(zip("xyz", points.T.tolist(), strict=True)))
    outputs = []
    for chunk in (1, 7, 300):
        pinik.batch.run(two_link, path, frame, "two_bone", output=tmp_path / "o.csv", chunk=chunk)
        outputs.append((tmp_path / "o.csv").read_bytes())
    assert len(set(outputs)) == 1


def test_rows_may_ask_for_different_things(panda, tmp_path):
    """Free axes, no position, no orientation, frames, tolerances and starts of their own, one row of each."""
    start = panda.poses["default"]
    M = panda.placement(TIP, start)
    x, y, z = (M.translation + np.array([0.02, -0.03, 0.04])).tolist()
    qx, qy, qz, qw = pinocchio.Quaternion(M.rotation).coeffs().tolist()
    empty = dict.fromkeys(("frame", *PLACE, "tolerance_m", "tolerance_rad", "start.panda_joint1", "start.panda_joint4"))
    full = dict(zip(PLACE, (x, y, z, qx, qy, qz, qw), strict=True))
    cases = [
        (full, Target(TIP, [x, y, z], quat_xyzw=[qx, qy, qz, qw])),
        ({"z": z}, Target(TIP, [None, None, z])),
        ({"x": x, "y": y, "z": z}, Target(TIP, [x, y, z])),
        ({name: full[name] for name in PLACE[3:]}, Target(TIP, quat_xyzw=[qx, qy, qz, qw])),
        ({"frame": "panda_link5", "x": 0.1, "y": 0.2, "z": 0.5}, Target("panda_link5", [0.1, 0.2, 0.5])),
        ({**full, "tolerance_m": 0.05}, Target(TIP, [x, y, z], quat_xyzw=[qx, qy, qz, qw], tolerance=(0.05, 2e-3))),
        (
            {**full, "tolerance_m": 1e-3, "tolerance_rad": 0.2},
            Target(TIP, [x, y, z], quat_xyzw=[qx, qy, qz, qw], tolerance=(1e-3, 0.2)),
        ),
        ({**full, "start.panda_joint1": 1.0, "start.panda_joint4": -1.0}, Target(TIP, [x, y, z], rotation=M.rotation)),
    ]
    rows = [{**empty, **row} for row, _ in cases]
    columns = {name: [row[name] for row in rows] for name in empty}
    options = {"q0": start, "tolerance": (1e-4, 2e-3)}
    for form in ("csv", "jsonl", "parquet"):
        pinik.batch.run(panda, write(tmp_path / f"t.{form}", columns), TIP, output=tmp_path / f"o.{form}", **options)
        answers = read(tmp_path / f"o.{form}")
        assert [int(name) for name in answers["id"]] == list(range(len(cases)))
        for k, (row, target) in enumerate(cases):
            q0 = start.copy()
            for number in (1, 4):
                if f"start.panda_joint{number}" in row:
                    q0[number - 1] = row[f"start.panda_joint{number}"]
            alone = pinik.solve(panda, target, **options | {"q0": q0})
            assert alone.success
            assert angles_of(answers, k, panda) == pytest.approx(own_angles(alone, panda), abs=1e-6), row
            assert (answers["position_error_m"][k] is None) == (target.position is None)
            assert (answers["orientation_error_rad"][k] is None) == (target.rotation is None)


def test_roll_pitch_and_yaw_and_degrees(panda, tmp_path):
    rpy = (0.3, -0.2, 0.7)
    place = panda.placement(TIP, panda.poses["default"]).translation.tolist()
    alone = pinik.solve(panda, TIP, position=place, rpy=rpy, q0={"panda_joint1": 0.5})
    columns = {
        name: [value] for name, value in zip(("x", "y", "z", "roll", "pitch", "yaw"), (*place, *rpy), strict=True)
    }
    columns["start.panda_joint1"] = [0.5]
    in_degrees = {n: [math.degrees(c[0])] if n not in "xyz" else c for n, c in columns.items()}
    for form, degrees in itertools.product(("csv", "jsonl"), (False, True)):
        given = in_degrees if degrees and form == "csv" else columns
        path = write(tmp_path / f"t.{form}", given)
        pinik.batch.run(panda, path, TIP, output=tmp_path / f"o.{form}", degrees=degrees)
        answers = read(tmp_path / f"o.{form}")
        for name in panda.joint_names:
            turns = degrees and form == "csv" and panda.joint(name).kind != "prismatic"
            expected = math.degrees(alone.angles[name]) if turns else alone.angles[name]
            assert answers[f"angle.{name}"][0] == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("form", FORMATS)
def test_angles_that_look_like_degrees_are_warned_of_once_with_the_first_row(panda, tmp_path, form):
    rows = [(0.3, -0.2, 0.7), (180.0001, 0.0, 30.0), (180.0, 0.0, 30.0), (-90.0, 0.0, 0.0)]
    columns = dict(zip(("roll", "pitch", "yaw"), map(list, zip(*rows, strict=True)), strict=True))
    path, output = write(tmp_path / f"t.{form}", columns), tmp_path / f"o.{form}"
    with pytest.warns(pinik.InputWarning) as given:
        pinik.batch.run(panda, path, TIP, output=output, chunk=1)
    (warning,) = given
    place = {"csv": "line 4", "jsonl": "line 3"}.get(form, "row 2")
    assert f"t.{form}: {place}: roll, pitch and yaw go beyond a full turn in radians" in str(warning.message)
    assert warning.filename == __file__
    if form == "csv":
        pinik.batch.run(panda, path, TIP, output=output, degrees=True)  # warnings are errors in tests
    quiet = write(tmp_path / f"q.{form}", {name: column[:2] for name, column in columns.items()})
    pinik.batch.run(panda, quiet, TIP, output=output)


def test_continuous_joints_stay_at_the_turn_of_their_start(kinova, tmp_path):
    frame = kinova.frame_names[-1]
    name = next(joint.name for joint in kinova.joints if joint.nq == 2)
    place = kinova.placement(frame, kinova.configuration({name: 0.3})).translation.tolist()
    starts = [0.0, 2.0 * math.pi, -4.0 * math.pi]
    columns = {**{axis: [value] * 3 for axis, value in zip("xyz", place, strict=True)}, f"start.{name}": starts}
    pinik.batch.run(kinova, write(tmp_path / "t.csv", columns), frame, output=tmp_path / "o.csv")
    for k, angle in enumerate(starts):
        alone = pinik.solve(kinova, frame, position=place, q0={name: angle})
        assert read(tmp_path / "o.csv")[f"angle.{name}"][k] == pytest.approx(alone.angles[name], abs=1e-6)


def test_floating_joints_have_columns_of_their_own(tmp_path):
    robot = pinik.load("two_link", root="free_flyer")
    frame = robot.frame_names[-1]
    path = write(tmp_path / "t.csv", {"x": [3.0], "y": [-2.0], "z": [1.0]})
    pinik.batch.run(robot, path, frame, output=tmp_path / "o.csv")
    answers = read(tmp_path / "o.csv")
    alone = pinik.solve(robot, frame, position=[3.0, -2.0, 1.0])
    for name, M in alone.joint_placements.items():
        own = [answers[f"placement.{name}.{part}"][0] for part in PLACE]
        np.testing.assert_allclose(pinocchio.XYZQUATToSE3(np.array(own)).homogeneous, M.homogeneous, atol=1e-6)


def test_options_of_solve_reach_the_solves(panda, poses, tmp_path):
    path = write(tmp_path / "t.csv", {name: column[:12] for name, column in poses.items()})
    pinik.batch.run(
        panda, path, TIP, "pinv", output=tmp_path / "o.csv", restarts=0, max_iterations=7, locked=["panda_joint3"],
        cutoff=0.02, q0=panda.poses["default"], tool=[0.0, 0.0, 0.05], relative_to="panda_link1",
    )  # fmt: skip
    answers = read(tmp_path / "o.csv")
    assert max(answers["iterations"]) <= 7
    assert set(answers["restarts"]) == {0}
    assert set(answers["angle.panda_joint3"]) == {panda.poses["default"][2]}


def test_times_are_there_when_they_are_asked_for(panda, poses, tmp_path):
    path = write(tmp_path / "t.csv", poses)
    pinik.batch.run(panda, path, TIP, output=tmp_path / "o.csv", times=True)
    answers = read(tmp_path / "o.csv")
    assert list(answers)[-1] == "time_s"
    assert min(answers["time_s"]) > 0.0


def test_streams_are_read_and_written(panda, poses, tmp_path):
    outputs = {}
    for form in FORMATS:
        path = write(tmp_path / f"t.{form}", poses)
        for output in FORMATS:
            sink = io.BytesIO()
            pinik.batch.run(panda, io.BytesIO(path.read_bytes()), TIP, output=sink, form=output, chunk=8)
            outputs.setdefault(output, set()).add(sink.getvalue())
    for output, contents in outputs.items():
        pinik.batch.run(panda, tmp_path / "t.csv", TIP, output=tmp_path / f"o.{output}", chunk=8)
        assert contents == {(tmp_path / f"o.{output}").read_bytes()}, output
    with pytest.raises(InputError, match="resume must be False for a stream"):
        pinik.batch.run(panda, tmp_path / "t.csv", TIP, output=io.BytesIO(), resume=True)


KILLED = """
import sys, pinik
robot = pinik.load("panda")
pinik.batch.run(robot, sys.argv[1], "panda_hand_tcp", output=sys.argv[2], chunk=5, resume=True)
"""


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_a_run_that_is_killed_again_and_again_ends_with_the_same_bytes(panda, poses, tmp_path, form):
    """`benchmarks/batch.py --kills 100` does this a hundred times."""
    many = {name: column * 40 for name, column in poses.items() if name != "id"}
    path = write(tmp_path / "t.csv", many)
    pinik.batch.run(panda, path, TIP, output=tmp_path / f"whole.{form}", chunk=5)
    rng, out = random.Random(1), tmp_path / f"o.{form}"
    paths = os.pathsep.join(filter(None, sys.path))
    for _ in range(3):
        command = [sys.executable, "-c", KILLED, str(path), str(out)]
        process = subprocess.Popen(command, env=os.environ | {"PYTHONPATH": paths})
        while not any(parts_folder(out).glob("*.part")) and process.poll() is None:
            time.sleep(0.005)
        time.sleep(rng.uniform(0.0, 0.1))
        process.kill()
        process.wait()
    summary = pinik.batch.run(panda, path, TIP, output=out, chunk=5, resume=True)
    assert summary.rows == 2000
    assert summary.solved == 47 * 40
    assert out.read_bytes() == (tmp_path / f"whole.{form}").read_bytes()
    assert not parts_folder(out).exists()


def unfinished(panda, poses, tmp_path) -> dict:
    """A run that was interrupted after a few chunks, and its arguments."""
    given = {"targets": write(tmp_path / "t.csv", poses), "output": tmp_path / "o.csv", "chunk": 5, "frame": TIP}

    def stop(tally, rows):
        if tally.finished == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        pinik.batch.run(panda, **given, threads=1, on_progress=stop)
    return given


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"seed": 1}, "options.seed was 0 and is 1"),
        ({"chunk": 6}, "chunk was 5 and is 6"),
        ({"times": True}, "output.columns was"),
        ({"method": "ccd"}, 'options.method.name was "dls" and is "ccd"'),
        ({"damping": 0.3}, "options.method.parameters.damping"),
        ({"q0": {"panda_joint1": 0.1}}, "start.q was"),
        ({"tolerance": (1e-3, 1e-3)}, "options.tolerance was"),
        ({"frame": "panda_link8"}, 'targets.frame was "panda_hand_tcp" and is "panda_link8"'),
        ({"robot": "ur5"}, 'robot.name was "panda" and is "ur5"'),
        ({"targets": "other"}, "targets.sha256 was"),
    ],
)
def test_what_was_begun_otherwise_is_not_resumed(panda, ur5, poses, tmp_path, changed, words):
    given = unfinished(panda, poses, tmp_path)
    finished = {path.name: path.read_bytes() for path in parts_folder(given["output"]).glob("*.part")}
    assert len(finished) >= 3
    other = dict(changed)
    if "targets" in changed:
        (tmp_path / "t2.csv").write_bytes(given["targets"].read_bytes().replace(b"pose 30", b"pose thirty"))
        other["targets"] = tmp_path / "t2.csv"
    robot = panda
    if other.pop("robot", None):
        robot, other["frame"] = ur5, "tool0"
    with pytest.raises(InputError) as raised:
        pinik.batch.run(robot, resume=True, **given | other)
    assert words in str(raised.value)
    assert {path.name: path.read_bytes() for path in parts_folder(given["output"]).glob("*.part")} == finished
    summary = pinik.batch.run(panda, resume=True, **given)
    assert summary.resumed == 5 * len(finished)
    pinik.batch.run(panda, **given | {"output": tmp_path / "whole.csv"})
    assert given["output"].read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_another_version_does_not_resume(panda, poses, tmp_path, monkeypatch):
    given = unfinished(panda, poses, tmp_path)
    monkeypatch.setattr("pinik.batch.versions", lambda: {"pinik": "9.9"})
    with pytest.raises(InputError, match=r'versions\.pinik was "0\.1\.0" and is "9\.9"'):
        pinik.batch.run(panda, resume=True, **given)


def test_what_nobody_can_answer_is_said_before_any_work(panda, two_link, poses, tmp_path):
    path = write(tmp_path / "t.csv", poses)
    out = tmp_path / "o.csv"
    with pytest.raises(InputError, match=r"t\.csv: line 2: "):
        pinik.batch.run(two_link, path, two_link.frame_names[-1], "two_bone", output=out)
    with pytest.raises(UnknownNameError, match="did you mean 'panda_hand_tcp'"):
        pinik.batch.run(panda, path, "panda_hand_tcq", output=out)
    with pytest.raises(InputError, match=r"o\.txt must end in \.csv"):
        pinik.batch.run(panda, path, TIP, output=tmp_path / "o.txt")
    with pytest.raises(InputError, match="threads is for this process"):
        pinik.batch.run(panda, path, TIP, output=out, threads=2, workers=2)
    with pytest.raises(UnknownNameError, match="dampign"):
        pinik.batch.run(panda, path, TIP, output=out, dampign=0.1)
    assert {entry.name for entry in tmp_path.iterdir()} == {"t.csv"}


def test_without_pyarrow_parquet_is_refused_with_the_install_line(panda, poses, tmp_path, monkeypatch):
    path = write(tmp_path / "t.csv", poses)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(MissingExtraError, match=r"Parquet needs pyarrow: pip install 'pinik\[batch\]'"):
        pinik.batch.run(panda, path, TIP, output=tmp_path / "o.parquet")
    pinik.batch.run(panda, path, TIP, output=tmp_path / "o.csv")


def test_links_are_followed_and_permissions_kept(panda, poses, tmp_path):
    real, link = tmp_path / "there" / "real.csv", tmp_path / "answers.csv"
    real.parent.mkdir()
    real.write_text("old")
    real.chmod(0o640)
    link.symlink_to(real)
    pinik.batch.run(panda, write(tmp_path / "t.csv", poses), TIP, output=link)
    assert link.is_symlink()
    assert real.read_text().startswith("id,success,")
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert [entry.name for entry in tmp_path.rglob("*") if ".parts" in entry.name] == []


def test_pipes_are_written_and_not_replaced(panda, poses, tmp_path):
    targets = write(tmp_path / "t.csv", poses)
    pipe, file = tmp_path / "pipe", tmp_path / "answers.csv"
    os.mkfifo(pipe)
    with ThreadPoolExecutor(1) as pool:
        read = pool.submit(pipe.read_bytes)
        pinik.batch.run(panda, targets, TIP, output=pipe, form="csv")
        content = read.result(timeout=20)
    assert pipe.is_fifo()
    pinik.batch.run(panda, targets, TIP, output=file)
    assert content == file.read_bytes()
    with pytest.raises(InputError, match="resume must be False for a stream"):
        pinik.batch.run(panda, targets, TIP, output=pipe, form="csv", resume=True)
