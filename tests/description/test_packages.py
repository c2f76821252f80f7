from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from addresses import resolve
from pinik.description import shares
from pinik.description.shares import example_robot_data


@pytest.fixture(autouse=True)
def no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


def made(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("mesh")
    return path


@pytest.mark.parametrize("given", ["", "robot_description"], ids=["what holds the package", "the package itself"])
def test_a_package_is_found_in_a_given_directory(tmp_path: Path, given: str) -> None:
    mesh = made(tmp_path / "robot_description" / "meshes" / "arm.stl")
    for directory in (tmp_path / given, str(tmp_path / given)):
        assert resolve("package://robot_description/meshes/arm.stl", package_dirs=[directory]) == mesh
        assert resolve("model://robot_description/meshes/arm.stl", package_dirs=[directory]) == mesh


def test_a_package_whose_folder_is_called_otherwise_is_known_by_its_manifest(tmp_path: Path) -> None:
    mesh = made(tmp_path / "checkout-2" / "arm.stl")
    (tmp_path / "checkout-2" / "package.xml").write_text("<package><name> robot_description </name></package>")
    assert resolve("package://robot_description/arm.stl", package_dirs=[tmp_path / "checkout-2"]) == mesh
    assert resolve("package://other/arm.stl", package_dirs=[tmp_path / "checkout-2"]) is None


@pytest.mark.parametrize("place", ["robot_description/urdf", "other_package/urdf", "robot_description"])
def test_a_package_is_found_above_the_urdf_file(tmp_path: Path, place: str) -> None:
    mesh = made(tmp_path / "robot_description" / "meshes" / "arm.stl")
    urdf_path = tmp_path / place / "robot.urdf"
    assert resolve("package://robot_description/meshes/arm.stl", urdf_path=urdf_path) == mesh


def test_a_given_directory_comes_before_the_files_own_package(tmp_path: Path) -> None:
    made(tmp_path / "own" / "p" / "arm.stl")
    mine = made(tmp_path / "given" / "p" / "arm.stl")
    urdf_path = tmp_path / "own" / "p" / "robot.urdf"
    assert resolve("package://p/arm.stl", urdf_path=urdf_path, package_dirs=[tmp_path / "given"]) == mine


@pytest.mark.parametrize("nesting", ["", "repository", "repository/group"])
def test_a_package_is_found_through_ros_package_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, nesting: str
) -> None:
    mesh = made(tmp_path / "src" / nesting / "p" / "arm.stl")
    monkeypatch.setenv("ROS_PACKAGE_PATH", os.pathsep.join(["/nowhere", "", str(tmp_path / "src")]))
    assert resolve("package://p/arm.stl") == mesh


def test_ros_package_path_may_name_the_package_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = made(tmp_path / "p" / "arm.stl")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "p"))
    assert resolve("package://p/arm.stl") == mesh


def test_a_package_is_found_through_ament_prefix_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = made(tmp_path / "install" / "share" / "p" / "arm.stl")
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join(["/opt/ros/none", str(tmp_path / "install")]))
    assert resolve("package://p/arm.stl") == mesh


@pytest.mark.parametrize(
    "address",
    [
        "package://example-robot-data/robots/panda_description/urdf/panda.urdf",
        "package:///example-robot-data/robots/panda_description/urdf/panda.urdf",
        "package://panda_description/urdf/panda.urdf",
    ],
)
def test_example_robot_data_is_a_package_and_holds_packages(address: str) -> None:
    robots = example_robot_data()
    assert robots is not None
    assert resolve(address) == robots / "panda_description" / "urdf" / "panda.urdf"


def test_the_robots_folder_is_found_without_importing_anything_heavy() -> None:
    """The module alone, without pinik's front, in a fresh interpreter."""
    code = (
        "import runpy, sys; "
        f"robots = runpy.run_path({shares.__file__!r})['example_robot_data'](); "
        "assert robots.is_dir() and not {'numpy', 'pinocchio'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_file_address_is_taken_from_the_root_and_decoded(tmp_path: Path) -> None:
    mesh = made(tmp_path / "two words.stl")
    for start in ("file://", "file:", "file://localhost"):
        assert resolve(f"{start}{tmp_path}/two%20words.stl", package_dirs=[tmp_path]) == mesh


def test_a_plain_path_is_absolute_or_relative_to_the_urdf_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = made(tmp_path / "meshes" / "arm.stl")
    urdf_path = made(tmp_path / "urdf" / "robot.urdf")
    assert resolve(str(mesh), package_dirs=[tmp_path]) == mesh
    found = resolve("../meshes/arm.stl", urdf_path=urdf_path)
    assert found is not None
    assert found.samefile(mesh)
    assert resolve("..\\meshes\\arm.stl", urdf_path=urdf_path) == found
    assert resolve("meshes/arm.stl", urdf_path=urdf_path, package_dirs=[tmp_path]) == mesh
    monkeypatch.chdir(tmp_path)
    assert resolve("meshes/arm.stl") == Path("meshes/arm.stl")


@pytest.mark.parametrize(
    "address",
    [
        "package://p/../secret.stl",
        "package://p/meshes/../../secret.stl",
        "package://../p/arm.stl",
        "package://./arm.stl",
        "package://",
        "package://p",
        "package://p/",
        "package://p/no.stl",
        "package://q/arm.stl",
        "package://p/a\0b",
        "package://p/" + "a" * 5000,
        "file:///no/such/file",
        "https://example.org/arm.stl",
        "no.stl",
        "",
    ],
)
def test_what_is_not_there_or_leaves_its_package_is_none(tmp_path: Path, address: str) -> None:
    made(tmp_path / "p" / "arm.stl")
    made(tmp_path / "secret.stl")
    assert resolve(address, urdf_path=tmp_path / "p" / "robot.urdf", package_dirs=[tmp_path]) is None


def test_dots_that_stay_inside_the_package_are_welcome(tmp_path: Path) -> None:
    mesh = made(tmp_path / "p" / "arm.stl")
    (tmp_path / "p" / "meshes").mkdir()
    found = resolve("package://p/meshes/../arm.stl", package_dirs=[tmp_path])
    assert found is not None
    assert found.samefile(mesh)
