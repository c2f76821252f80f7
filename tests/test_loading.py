"""What `load` makes of names and paths."""

from __future__ import annotations

from pathlib import Path

import pytest

import pinik
from urdf_texts import link, robot


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
