"""`--avoid-self` and `--world` of `pinik solve` and `pinik track`."""

from __future__ import annotations

import json
import math

import pytest

from urdf_texts import joint, link, robot


def bar(name: str, length: float) -> str:
    shape = f'<collision><origin xyz="{length / 2} 0 0"/><geometry><box size="{length} 0.04 0.04"/></geometry>'
    return link(name, f"{shape}</collision>")


TURN = '<axis xyz="0 0 1"/>'
ARM = robot(
    link("base"),
    bar("upper", 1.0),
    bar("fore", 1.0),
    link("tip"),
    joint("shoulder", "base", "upper", TURN),
    joint("elbow", "upper", "fore", '<origin xyz="1 0 0"/>', TURN),
    joint("t", "fore", "tip", '<origin xyz="1 0 0"/>', kind="fixed", limit=""),
)
# With its tip at (√2, 0), the elbow is at (√½, ±√½).
TIP = ("--frame", "tip", "--position", math.sqrt(2.0), 0, 0)
UP = ("--start", "shoulder=0.8", "--start", "elbow=-1.6")


def cell(*balls: tuple[str, float, float]) -> str:
    shape = '<collision><origin xyz="{} {} 0"/><geometry><sphere radius="0.1"/></geometry></collision>'
    links = [link(name, shape.format(x, y)) for name, x, y in balls]
    fixed = [joint(f"f{name}", "room", name, kind="fixed", limit="") for name, _, _ in balls]
    return robot(link("room"), *links, *fixed)


@pytest.fixture
def files(tmp_path):
    (tmp_path / "arm.urdf").write_text(ARM)
    half = math.sqrt(0.5)
    (tmp_path / "one.urdf").write_text(cell(("ball", half, half)))
    (tmp_path / "two.urdf").write_text(cell(("ball", half, half), ("stone", half, -half - 0.1)))
    return tmp_path


def test_the_other_elbow_is_taken(run, files):
    plain = run("solve", files / "arm.urdf", *TIP, *UP, "--json").json
    assert plain["angles"]["elbow"] == pytest.approx(-math.pi / 2, abs=1e-4)
    assert plain["collisions"] == []
    answer = run("solve", files / "arm.urdf", *TIP, *UP, "--world", files / "one.urdf", "--json").json
    assert answer["status"] == "CONVERGED"
    assert answer["angles"]["elbow"] == pytest.approx(math.pi / 2, abs=1e-4)


def test_a_collision_is_exit_status_1_with_names_and_depths(run, files):
    words = ("solve", files / "arm.urdf", *TIP, *UP, "--world", files / "two.urdf", "--avoid-self", "--restarts", 5)
    answer = run(*words, "--json")
    assert answer.status == 1
    assert (answer.json["status"], answer.json["success"]) == ("COLLIDING", False)
    assert answer.json["collisions"]
    assert {"ball", "stone"} & {name for one in answer.json["collisions"] for name in one["pair"]}
    assert all(one["depth_m"] > 0.0 for one in answer.json["collisions"])
    text = run(*words)
    assert text.status == 1
    assert "reaches the target, but " in text.out + text.err
    assert "overlap by" in text.out + text.err


def test_a_path_counts_points_that_touch_as_missed(run, files):
    points = "\n".join(json.dumps({"position": [x, 0, 0]}) for x in (1.2, math.sqrt(2.0), 1.6))
    words = ("track", files / "arm.urdf", "-", "--frame", "tip", *UP, "--restarts", 0, "--json")
    assert run(*words, stdin=points).json["status"] == ["CONVERGED"] * 3
    answer = run(*words, "--world", files / "one.urdf", stdin=points)
    assert answer.status == 1
    assert "COLLIDING" in answer.json["status"]


def test_what_cannot_be_avoided_is_said_in_words(run, files):
    missing = run("solve", files / "arm.urdf", *TIP, "--world", files / "none.urdf")
    assert missing.status == 3
    assert "--world" in missing.err
    bare = run("solve", "asr_twodof", "--frame", "Tip", "--position", 0.3, 0.1, 0.8, "--avoid-self")
    assert bare.status == 2
    assert "has no collision shapes" in bare.err
