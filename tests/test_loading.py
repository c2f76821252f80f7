"""What `load` makes of names and paths."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import pytest

import pinik
from urdf_texts import joint, link, pair, robot


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


def test_the_home_folder_is_expanded(home: Path) -> None:
    shape = '<visual><geometry><mesh filename="package://parts/m.stl"/></geometry></visual>'
    (home / "mine.urdf").write_text(robot(link("a", shape)))
    (home / "folder" / "parts").mkdir(parents=True)
    (home / "folder" / "parts" / "m.stl").write_text("")
    loaded = pinik.load("~/mine.urdf", package_dirs=["~/folder"])
    assert loaded.description.path == home / "mine.urdf"
    assert loaded.warnings == ()


@pytest.mark.parametrize("path", ["panda.urdf", "no/such/panda.urdf", Path("panda")])
def test_a_mistyped_path_suggests_the_robot_of_that_name(path: str | Path) -> None:
    with pytest.raises(pinik.RobotLoadError, match="no such file, but the catalogue has a robot 'panda'"):
        pinik.load(path)


@pytest.mark.parametrize("path", ["/no/such/robot_of_mine.urdf", "~nobody_of_this_name/r.urdf", "/"])
def test_other_paths_are_refused_in_words(path: str) -> None:
    with pytest.raises(pinik.RobotLoadError):
        pinik.load(path)


CASES = {
    "commas": (pair('<origin xyz="0.1, 0, 0.3" rpy="1.57, 0 0"/>'), "commas between the numbers"),
    "null bytes": (pair().encode() + b"\n\0\0\n", "null bytes at its end"),
    "a second axis": (pair('<axis xyz="0 1 0"/><axis xyz="0 0 1"/>'), "2 <axis> elements that differ"),
    "a shape of size zero": (
        robot(link("a", '<visual><geometry><box size="0 0 0"/></geometry></visual>')),
        "the shape is left out",
    ),
    "a bad colour": (robot('<material name="m"><color rgba="red"/></material>', link("a")), "its colour is left out"),
    "a missing mesh": (
        robot(link("a", '<visual><geometry><mesh filename="m.stl"/></geometry></visual>')),
        "mesh 'm.stl': not found: there is no such file",
    ),
    "a warning of the model": (
        robot(
            *map(link, "abc"),
            joint("j", "a", "b", '<mimic joint="k"/>', limit='<limit lower="1" upper="2"/>'),
            joint("k", "a", "c", limit='<limit lower="-1" upper="0"/>'),
        ),
        "its limits 1…2 are ignored",
    ),
}


@pytest.mark.parametrize(("source", "words"), CASES.values(), ids=CASES)
def test_what_is_a_warning_is_an_error_with_strict(source: str | bytes, words: str) -> None:
    with pytest.warns(pinik.UrdfWarning, match=re.escape(words)):
        pinik.load(source)
    with pytest.raises(pinik.RobotLoadError, match=re.escape(words)) as caught:
        pinik.load(source, strict=True)
    assert caught.value.cause.startswith("with strict=True, ")


def test_a_good_file_is_loaded_in_strict_silence(recwarn: pytest.WarningsRecorder) -> None:
    for name in ("arm", "lion", "panda", "two_link"):
        assert pinik.load(name, strict=True).warnings == ()
    assert not recwarn.list


def test_the_error_of_a_file_with_thousands_of_flaws_is_short() -> None:
    shape = '<visual><geometry><box size="0 0 0"/></geometry></visual>'
    text = robot(link("a", *[shape] * 3000, *(f'<inertial name="{k}"/>' for k in range(3))), '<material name="m"/>')
    with pytest.raises(pinik.RobotLoadError) as caught:
        pinik.load(text, strict=True)
    assert "each of 3002 warnings is an error" in str(caught.value)
    assert len(str(caught.value)) < 2000


@pytest.mark.parametrize("name", ["é", "e\u0301", "日本 腕", "مفصل", "a'b&quot;", "😀", "­x", "a&lt;b&amp;c"])
def test_a_name_in_any_letters_works_from_the_file_to_the_solution(name: str) -> None:
    text = robot(link("a"), link(name), joint(name, "a", name, '<axis xyz="0 0 1"/>')).replace('"r"', f'"{name}"')
    loaded = pinik.load(text, strict=True)
    plain = html.unescape(name)
    assert (loaded.name, loaded.joint_names) == (plain, (plain,))
    found = loaded.solve(plain, rpy=[0, 0, 0.5])
    assert found.success
    assert found.angles[plain] == pytest.approx(0.5, abs=1e-3)
    assert json.loads(json.dumps(found.to_dict()))["angles"][plain] == found.angles[plain]
    assert pinik.load(loaded.urdf, strict=True).joint_names == (plain,)


def test_names_that_look_alike_but_are_other_letters_are_two_names() -> None:
    composed, decomposed = "é", "e\u0301"
    text = robot(
        *map(link, "abc"), joint(composed, "a", "b", '<axis xyz="0 0 1"/>'), joint(decomposed, "b", "c")
    )  # fmt: skip
    loaded = pinik.load(text)
    assert set(loaded.joint_names) == {composed, decomposed}
    assert loaded.angles(loaded.configuration({decomposed: 0.25})) == {composed: 0.0, decomposed: 0.25}
