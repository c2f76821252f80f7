"""Faulty tables: an error with file, line and column before any work; or, if wanted, all other rows are answered."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import pinik
from pinik import InputError

GOOD = "p{k},0.4,{y},0.5,0,1,0,0"
HEADER = "id,x,y,z,qx,qy,qz,qw"


def lines(**changed: str) -> list[str]:
    """Eight good rows, lines 2 to 9, some of which are replaced: `l4="…"` is line 4."""
    rows = [GOOD.format(k=k, y=round(-0.2 + 0.05 * k, 3)) for k in range(8)]
    for name, line in changed.items():
        rows[int(name[1:]) - 2] = line
    return [HEADER, *rows]


def run(robot, path: Path, **options):
    return pinik.batch.run(robot, path, "panda_hand_tcp", output=path.with_name("out.csv"), chunk=3, **options)


BAD = {
    "NaN": ("p2,0.4,nan,0.5,0,1,0,0", "column y: must be a finite number; got nan"),
    "infinite": ("p2,0.4,0.1,-inf,0,1,0,0", "column z: must be a finite number; got -inf"),
    "no number": ("p2,0.4,0.1,up,0,1,0,0", "column z: must be a number; got 'up'"),
    "python's own numbers": ("p2,0.4,1_0,0.5,0,1,0,0", "column y: must be a number; got '1_0'"),
    "too far": ("p2,0.4,0.1,1e10,0,1,0,0", "column z: must be within ±1e+09 m"),
    "part of a quaternion": ("p2,0.4,0.1,0.5,0,1,,0", "column qz: must be a number, as there is one of qx, qy, qw"),
    "zero quaternion": ("p2,0.4,0.1,0.5,0,0,0,0", "column qx,qy,qz,qw: a quaternion must not be zero"),
    "repeated id": ("p0,0.4,0.1,0.5,0,1,0,0", "column id: comes a second time, after line 2"),
    "empty id": (",0.4,0.1,0.5,0,1,0,0", "column id: must not be empty"),
    "short": ("p2,0.4,0.1,0.5,0,1,0", "there must be 8 cells, as in the header; got 7"),
    "long": ("p2,0.4,0.1,0.5,0,1,0,0,7", "there must be 8 cells, as in the header; got 9"),
    "open quote": (
        '"p2,0.4,0.1,0.5,0,1,0,0',
        "not CSV: a quote is not closed on the same line; a cell can hold no line break",
    ),
    "nothing asked": ("p2,,,,,,,", "nothing is asked for; give a position or an orientation"),
}


@pytest.mark.parametrize("fault", BAD)
def test_a_bad_row_is_named_before_any_work_and_left_out_if_wanted(panda, tmp_path, fault):
    line, words = BAD[fault]
    path = tmp_path / "poses.csv"
    path.write_text("\n".join(lines(l4=line)) + "\n")
    with pytest.raises(InputError) as raised:
        run(panda, path)
    assert str(raised.value) == f"{path}: line 4: {words}; --skip-bad (skip_bad=True) leaves out faulty rows"
    assert {entry.name for entry in tmp_path.iterdir()} == {"poses.csv"}
    said: list[str] = []
    summary = run(panda, path, skip_bad=True, on_bad=said.append)
    assert said == [f"{path}: line 4: {words}"]
    assert (summary.rows, summary.skipped, summary.solved, summary.success) == (8, 1, 7, False)
    kept = (tmp_path / "out.csv").read_text()
    path.write_text("\n".join([*lines()[:3], *lines()[4:]]) + "\n")
    run(panda, path)
    assert kept == (tmp_path / "out.csv").read_text(), "the others are answered as without it"


def test_wrong_encoding_is_named_by_its_line(panda, tmp_path):
    path = tmp_path / "poses.csv"
    path.write_bytes("\n".join(lines(l6="caf\xe9,0.4,0,0.5,0,1,0,0")).encode("latin-1"))
    with pytest.raises(InputError, match=r"line 6: not UTF-8: .* at byte 3 of the line"):
        run(panda, path)
    assert run(panda, path, skip_bad=True).solved == 7
    path.write_bytes("id,x,y,z,caf\xe9\n".encode("latin-1"))
    with pytest.raises(InputError, match="the header: not UTF-8"):
        run(panda, path)


def test_all_faults_are_listed_and_counted_once_for_each_row(panda, tmp_path):
    path = tmp_path / "poses.csv"
    path.write_text("\n".join(lines(l2="p1,nan,nan,0.5,0,1,0,0", l5="p1,1,2", l9="p1,0.4,0,0.5,0,1,0,0")))
    said: list[str] = []
    summary = run(panda, path, skip_bad=True, on_bad=said.append)
    places = [words.removeprefix(f"{path}: ").split(":")[0] for words in said]
    assert places == ["line 2", "line 2", "line 5", "line 9"]
    assert (summary.rows, summary.skipped) == (8, 3)
    with pytest.raises(InputError, match=r"line 2: column x: .*; 2 more rows are faulty"):
        run(panda, path)


def test_default_ids_are_numbers_of_rows_also_when_some_are_left_out(panda, tmp_path):
    path = tmp_path / "poses.csv"
    path.write_text("x,y,z\n0.4,0,0.5\n0.4,bad,0.5\n\n0.4,0.1,0.5\n")
    run(panda, path, skip_bad=True)
    rows = list(csv.DictReader((tmp_path / "out.csv").read_text().splitlines()))
    assert [row["id"] for row in rows] == ["0", "2"]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_quotes_blank_lines_and_line_ends_are_read(panda, tmp_path, end, mark):
    path = tmp_path / "poses.csv"
    rows = ['"a, ""b""",0.4,0,0.5,0,1,0,0', "", " c , 0.4 ,0,0.5,0,1,0,0", "   ", "_,0.4,0,0.5,0,1,0,0"]
    path.write_bytes((mark + end.join(["", HEADER, *rows])).encode())
    run(panda, path)
    names = [row["id"] for row in csv.DictReader((tmp_path / "out.csv").read_text().splitlines())]
    assert names == ['a, "b"', "c", "_"]


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("id,x,y", "there is no column 'z'; a table of targets has the columns x,y,z"),
        ("id", "there is no column 'x'"),
        ("x,y,z,qx,qy,qz", "there is no column 'qw'"),
        ("x,y,z,x", "the column 'x' comes twice"),
        ("x,y,z,qx,qy,qz,qw,roll,pitch,yaw", "give the orientation once"),
        ("x,y,z,qW,qx,qy,qz", "no column 'qW'; did you mean 'qw'"),
        (
            "x,y,z,start.panda_joint9",
            "the column 'start.panda_joint9': no joint 'panda_joint9'; did you mean 'panda_joint",
        ),
        ("x,y,z,start.panda_finger_joint2", "joint 'panda_finger_joint2' mimics"),
        ('x,y,"z', "line 1: not CSV: a quote is not closed on the same line"),
    ],
)
def test_columns_are_checked(panda, tmp_path, header, words):
    path = tmp_path / "poses.csv"
    path.write_text(header + "\n" + ",".join("0" * (header.count(",") + 1)) + "\n")
    with pytest.raises(InputError) as raised:
        run(panda, path)
    assert str(raised.value).startswith(f"{path}: ")
    assert words in str(raised.value)


@pytest.mark.parametrize(("content", "words"), [("", "there is no header"), ("x,y,z\n", "there are no rows")])
def test_empty_tables_are_refused(panda, tmp_path, content, words):
    (tmp_path / "poses.csv").write_text(content)
    with pytest.raises(InputError, match=words):
        run(panda, tmp_path / "poses.csv")


def test_frames_and_tolerances_are_checked_row_by_row(panda, tmp_path):
    path = tmp_path / "poses.csv"
    path.write_text("frame,x,y,z,tolerance_m\n,0.4,0,0.5,\npanda_hand_tpc,0.4,0,0.5,1e-3\n,0.4,0,0.5,0\n")
    said: list[str] = []
    assert run(panda, path, skip_bad=True, on_bad=said.append).solved == 1
    assert said[0].startswith(f"{path}: line 3: column frame: no frame 'panda_hand_tpc'; did you mean 'panda_hand_tcp'")
    assert said[1:] == [f"{path}: line 4: column tolerance_m: must be positive"]
    with pytest.raises(InputError, match="line 2: column frame: there is no frame to move"):
        pinik.batch.run(panda, path, output=tmp_path / "out.csv")


JSON = {
    "no JSON": ('{"x": 0.4,', "not JSON: "),
    "no object": ("[0.4, 0, 0.5]", "must be an object such as"),
    "key twice": ('{"x": 0.4, "x": 0.5, "y": 0, "z": 0.5}', "not JSON: a key comes twice"),
    "text": ('{"x": "0.4", "y": 0, "z": 0.5}', "column x: must be a number; got '0.4'"),
    "truth": ('{"x": true, "y": 0, "z": 0.5}', "column x: must be a number; got True"),
    "NaN": ('{"x": NaN, "y": 0, "z": 0.5}', "column x: must be a finite number; got nan"),
    "huge": ('{"x": 1' + "0" * 400 + ', "y": 0, "z": 0.5}', "column x: must be a number; got 1000"),
    "id": ('{"id": 1.5, "x": 0.4, "y": 0, "z": 0.5}', "column id: must be a text or a whole number; got 1.5"),
}


@pytest.mark.parametrize("fault", JSON)
def test_faulty_lines_of_json(panda, tmp_path, fault):
    line, words = JSON[fault]
    path = tmp_path / "poses.jsonl"
    good = '{"id": "%s", "x": 0.4, "y": 0, "z": 0.5}'
    path.write_text("\n".join([good % "a", "", line, good % "b"]))
    with pytest.raises(InputError) as raised:
        run(panda, path)
    assert f"{path}: line 3: {words}" in str(raised.value)
    assert run(panda, path, skip_bad=True).solved == 2


def test_faulty_arrays_and_columns(panda, tmp_path):
    path = tmp_path / "poses.npz"
    np.savez(path, x=np.array([0.4, np.nan]), y=np.zeros(2), z=np.full(2, 0.5))
    with pytest.raises(InputError, match=r"poses\.npz: row 1: column x: must be a finite number; got nan"):
        run(panda, path)
    np.savez(path, x=np.zeros(2), y=np.zeros(3), z=np.zeros(2))
    with pytest.raises(InputError, match="all arrays must have as many entries; got x: 2, y: 3"):
        run(panda, path)
    np.savez(path, x=np.zeros((2, 2)), y=np.zeros(2), z=np.zeros(2))
    with pytest.raises(InputError, match=r"x\.npy: must be an array \(N,\) of numbers or texts"):
        run(panda, path)
    path.write_bytes(b"PK no archive")
    with pytest.raises(InputError, match="not an NPZ file"):
        run(panda, path)
    path = tmp_path / "poses.parquet"
    pq.write_table(pa.table({"x": [0.4, float("nan")], "y": [0.0, 0.0], "z": [0.5, 0.5]}), path)
    with pytest.raises(InputError, match=r"poses\.parquet: row 1: column x: must be a finite number; got nan"):
        run(panda, path)
    pq.write_table(pa.table({"x": [0.4, 0.4], "y": ["a", None], "z": [0.5, 0.5]}), path)
    with pytest.raises(InputError, match=r"row 0: column y: must be a number; got 'a'"):
        run(panda, path)
    path.write_bytes(b"PAR1 no table")
    with pytest.raises(InputError, match="not a Parquet file"):
        run(panda, path)


def test_bad_rows_of_a_stream_are_named_too(panda):
    stream = io.BytesIO("\n".join(lines(l4="p2,0.4,nan,0.5,0,1,0,0")).encode())
    with pytest.raises(InputError, match=r"the stream: line 4: column y"):
        pinik.batch.run(panda, stream, "panda_hand_tcp", output=io.BytesIO())


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"id;x;y;z\na;0,4;0,1;0,5\n", "line 1: the cells are divided by semicolons; there must be commas"),
        (b"x\ty\tz\n0.4\t0.1\t0.5\n", "line 1: the cells are divided by tabs; there must be commas"),
        (b"x,y,z\r0.4,0.1,0.5\r", "line 1: lines must end in"),
        ("x,y,z\n0.4,0.1,0.5\n".encode("utf-16"), "the header: not UTF-8"),
    ],
)
def test_what_spreadsheets_write_instead_of_csv_is_named(panda, tmp_path, content, words):
    path = tmp_path / "poses.csv"
    path.write_bytes(content)
    with pytest.raises(InputError, match=words):
        run(panda, path)


def test_the_targets_are_not_overwritten_by_the_answers(panda, tmp_path):
    path = tmp_path / "out.csv"
    path.write_text("\n".join(lines()) + "\n")
    (tmp_path / "poses.csv").symlink_to(path)
    with pytest.raises(InputError, match="output is the file of the targets, which would be lost"):
        run(panda, tmp_path / "poses.csv")
    assert path.read_text() == "\n".join(lines()) + "\n"


X = {"x": np.array([0.4, 0.4]), "y": np.array([0.1, 0.2]), "z": np.array([0.5, 0.5])}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"x": np.array(["0.4", "b"])}, "row 0: column x: must be a number; got '0.4'; 1 more row"),
        ({"id": np.array([1.0, 2.0])}, "row 0: column id: must be a text or a whole number; got 1.0; 1 more row"),
        ({"id": np.array(["a", ""])}, "row 1: column id: must not be empty"),
    ],
)
def test_faulty_cells_of_arrays(panda, tmp_path, changed, words):
    np.savez(tmp_path / "poses.npz", **(X | changed))
    with pytest.raises(InputError, match=words):
        run(panda, tmp_path / "poses.npz")


def test_empty_frames_of_arrays_take_the_frame_of_all_rows(panda, tmp_path):
    np.savez(tmp_path / "poses.npz", **X, frame=np.array(["", "panda_link8"]))
    assert run(panda, tmp_path / "poses.npz").solved == 2


def test_a_file_damaged_in_its_middle_is_said_in_words(panda, tmp_path):
    np.savez(tmp_path / "poses.npz", **X)
    pq.write_table(pa.table(X), tmp_path / "poses.parquet")
    for name, at in (("poses.npz", slice(150, 151)), ("poses.parquet", slice(8, 60))):
        content = bytearray((tmp_path / name).read_bytes())
        content[at] = bytes(byte ^ 0x55 for byte in content[at])
        (tmp_path / name).write_bytes(content)
        with pytest.raises(InputError, match=f"{name}: the file is damaged: "):
            run(panda, tmp_path / name)


@pytest.mark.parametrize("form", ["csv", "jsonl", "npz", "parquet"])
def test_ids_too_large_for_a_column_of_whole_numbers_are_texts(panda, tmp_path, form):
    np.savez(tmp_path / "poses.npz", **X, id=np.array([2**63, 2], dtype=np.uint64))
    pq.write_table(pa.table(X | {"id": pa.array([2**63, 2], pa.uint64())}), tmp_path / "poses.parquet")
    rows = [{"id": name, "x": 0.4, "y": 0.1, "z": 0.5} for name in (10**30, 2)]
    (tmp_path / "poses.jsonl").write_text("\n".join(map(json.dumps, rows)))
    for name, first in (("poses.npz", 2**63), ("poses.parquet", 2**63), ("poses.jsonl", 10**30)):
        output = tmp_path / f"out.{form}"
        pinik.batch.run(panda, tmp_path / name, "panda_hand_tcp", output=output)
        if form == "npz":
            ids = np.load(output)["id"].tolist()
        elif form == "parquet":
            ids = pq.read_table(output)["id"].to_pylist()
        elif form == "jsonl":
            ids = [json.loads(line)["id"] for line in output.read_text().splitlines()]
        else:
            ids = [row["id"] for row in csv.DictReader(io.StringIO(output.read_text()))]
        assert ids == [str(first), "2"]


def test_half_a_character_in_an_id_is_a_fault(panda, tmp_path):
    path = tmp_path / "poses.jsonl"
    path.write_text('{"id": "\\ud800", "x": 0.4, "y": 0.1, "z": 0.5}\n')
    with pytest.raises(InputError, match="line 1: column id: must be a text or a whole number"):
        run(panda, path)


def test_a_file_without_one_object_of_json_is_named_by_its_first_line(panda, tmp_path):
    path = tmp_path / "poses.jsonl"
    path.write_text("x,y,z\n0.4,0.1,0.5\n")
    with pytest.raises(InputError, match="line 1: not JSON"):
        run(panda, path)


def test_views_of_texts_are_ids(panda, tmp_path):
    pq.write_table(pa.table(X | {"id": pa.array(["a", "b"], pa.string_view())}), tmp_path / "poses.parquet")
    assert run(panda, tmp_path / "poses.parquet").solved == 2
