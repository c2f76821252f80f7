"""Robots in the cache of robot_descriptions: a cache of our own, and no network."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

import pinik
from pinik.description import downloads
from urdf_texts import link, robot


def test_without_the_package_the_install_line_is_a_hint(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(downloads.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(
        pinik.UnknownNameError, match=r"no robot 'ur10e_description'.*pip install 'pinik\[descriptions\]'"
    ):
        pinik.load("ur10e_description")
    assert downloads.downloadable() == []


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    pytest.importorskip("robot_descriptions")
    monkeypatch.setenv("ROBOT_DESCRIPTIONS_CACHE", str(tmp_path / "cache"))
    monkeypatch.delenv("ROBOT_DESCRIPTION_COMMIT", raising=False)

    def no_network(*_: object) -> None:
        raise AssertionError("a connection was opened")

    monkeypatch.setattr(socket.socket, "connect", no_network)
    return tmp_path / "cache"


def test_a_robot_that_is_not_cached_is_named_with_the_command_that_downloads_it(cache: Path) -> None:
    with pytest.raises(pinik.RobotLoadError, match="robot_descriptions pull panda_description") as caught:
        pinik.load("panda_description")
    assert str(cache) in str(caught.value)
    assert "pinik downloads nothing" in str(caught.value)
    assert not cache.exists()


def test_a_cached_urdf_is_loaded_with_its_meshes_and_its_poses(cache: Path) -> None:
    folder = cache / "example-robot-data" / "robots" / "panda_description"
    (folder / "urdf").mkdir(parents=True)
    shape = '<visual><geometry><mesh filename="package://example-robot-data/robots/panda_description/a.stl"/>'
    (folder / "urdf" / "panda.urdf").write_text(robot(link("a", shape + "</geometry></visual>")))
    (folder / "a.stl").write_text("mesh")
    loaded = pinik.load("panda_description")
    assert loaded.name == "panda_description"
    assert loaded.warnings == ()
    assert (
        loaded.surroundings.find("package://example-robot-data/robots/panda_description/a.stl").path == folder / "a.stl"
    )
    assert not (cache / "example-robot-data" / ".git").exists()


def test_a_cached_xacro_file_takes_the_arguments_of_its_robot_and_the_caller_s(cache: Path) -> None:
    pytest.importorskip("xacrodoc")
    folder = cache / "ur_description" / "urdf"
    folder.mkdir(parents=True)
    arguments = '<xacro:arg name="name" default="x"/><xacro:arg name="ur_type" default="y"/>'
    (folder / "ur.urdf.xacro").write_text(
        f'<robot name="ur" xmlns:xacro="http://www.ros.org/wiki/xacro">{arguments}'
        '<link name="$(arg name)_$(arg ur_type)"/></robot>'
    )
    assert pinik.load("ur10e_description").description.links == ("ur10e_ur10e",)
    other = pinik.load("ur10e_description", xacro_args={"ur_type": "ur3"})
    assert other.description.links == ("ur10e_ur3",)


def test_near_names_come_from_its_list_too(cache: Path) -> None:
    with pytest.raises(pinik.UnknownNameError, match="did you mean 'ur10e_description'"):
        pinik.load("ur10ee_description")


def test_every_robot_of_its_list_is_found_or_named_as_missing(cache: Path) -> None:
    from robot_descriptions._repositories import REPOSITORIES

    for repository in REPOSITORIES.values():
        (cache / repository.cache_path).mkdir(parents=True, exist_ok=True)
    names = downloads.downloadable()
    assert len(names) > 100
    for name in names:
        if name == "eve_r3_description":  # its module reads the URDF itself
            with pytest.raises(pinik.RobotLoadError, match="robot_descriptions cannot find its files"):
                downloads.find_download(name)
            continue
        found = downloads.find_download(name)
        assert cache in found.file.parents
        assert all(cache == folder or cache in folder.parents for folder in found.package_dirs)
