"""What a URDF may open: its own folder, its package, packages that are found by name, and `package_dirs`."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import pinik
from addresses import resolve
from permissions import open_folder, without_root
from pinik.description.packages import Surroundings
from urdf_texts import joint, link, robot


@pytest.fixture(autouse=True)
def elsewhere(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A home folder of our own beside the tests' files, and no ROS."""
    monkeypatch.setenv("HOME", str(tmp_path / "home" / "someone"))
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


def made(path: Path, text: str = "mesh") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def package(folder: Path, name: str) -> Path:
    made(folder / "package.xml", f"<package><!-- <name>other</name> --><name>{name}</name></package>")
    return folder


def test_a_robot_s_meshes_may_lie_beside_its_urdf_folder(tmp_path: Path) -> None:
    mesh = made(tmp_path / "arm" / "meshes" / "a.stl")
    for folder in ("urdf", "robots", "urdf/variants"):
        urdf = made(tmp_path / "arm" / folder / "arm.urdf")
        up = "../" * len(Path(folder).parts)
        assert Surroundings(urdf).find(f"{up}meshes/a.stl").path.samefile(mesh)
        assert Surroundings(urdf).find(str(mesh)).path == mesh


def test_a_package_xml_makes_all_of_the_package_its_own(tmp_path: Path) -> None:
    package(tmp_path / "arm", "arm_description")
    mesh = made(tmp_path / "arm" / "common" / "a.stl")
    urdf = made(tmp_path / "arm" / "made" / "by" / "hand" / "arm.urdf")
    assert Surroundings(urdf).find("../../../common/a.stl").path.samefile(mesh)


@pytest.mark.parametrize(
    "address",
    [
        "../../secret.stl",
        "{}/secret.stl",
        "file://{}/secret.stl",
        "file:{}/secret.stl",
        "inside.stl",
        "../link/secret.stl",
    ],
)
def test_a_file_outside_is_refused_and_opened_on_request(tmp_path: Path, address: str) -> None:
    secret = made(tmp_path / "secret.stl")
    urdf = made(tmp_path / "arm" / "urdf" / "arm.urdf")
    (tmp_path / "arm" / "urdf" / "inside.stl").symlink_to(secret)
    (tmp_path / "arm" / "link").symlink_to(tmp_path)
    address = address.format(tmp_path)
    found = Surroundings(urdf).find(address)
    assert found.path is None
    assert found.refused
    assert "outside the folders that this URDF may open" in found.why
    assert Surroundings(urdf, [tmp_path]).find(address).path.samefile(secret)
    assert Surroundings(urdf, allow_outside=True).find(address).path.samefile(secret)
    assert not Surroundings(urdf).find("../../nothing.stl").refused


def test_load_names_what_it_refuses_and_opens_it_on_request(tmp_path: Path) -> None:
    made(tmp_path / "secret.stl")
    shape = '<visual><geometry><mesh filename="../secret.stl"/></geometry></visual>'
    urdf = made(tmp_path / "arm" / "arm.urdf", robot(link("a", shape)))
    with pytest.warns(pinik.UrdfWarning, match=r"mesh '\.\./secret.stl': not opened: it lies outside"):
        loaded = pinik.load(urdf)
    assert [flaw.code for flaw in loaded.warnings] == ["mesh-outside"]
    opened = pinik.load(urdf, allow_outside=True)
    assert opened.warnings == ()
    assert opened.with_root("planar").surroundings.find("../secret.stl").path is not None


def test_the_home_folder_and_the_root_are_nobody_s_package(tmp_path: Path) -> None:
    home = tmp_path / "home" / "someone"
    made(home / "private" / "a.stl")
    made(home / "a.stl")
    urdf = made(home / "urdf" / "arm.urdf")
    assert Surroundings(urdf).find("../a.stl").refused
    for address in ("package://private/a.stl", f"package://{home.parent.name}/someone/a.stl"):
        assert Surroundings(urdf).find(address).path is None
    assert resolve("package://etc/hostname", urdf_path=urdf) is None
    package(home / "private", "private")
    assert Surroundings(urdf).find("package://private/a.stl").path == home / "private" / "a.stl"


def test_for_text_the_working_directory_is_the_robot_s_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made(tmp_path / "secret.stl")
    mesh = made(tmp_path / "here" / "meshes" / "a.stl")
    monkeypatch.chdir(tmp_path / "here")
    assert Surroundings().find("meshes/a.stl").path.samefile(mesh)
    assert Surroundings().find("../secret.stl").refused


def test_a_package_beside_the_robot_is_known_by_its_package_xml(tmp_path: Path) -> None:
    mesh = made(package(tmp_path / "checkout-2", "hand_description") / "meshes" / "hand.stl")
    urdf = made(package(tmp_path / "arm", "arm_description") / "urdf" / "arm.urdf")
    for address in (
        "package://hand_description/meshes/hand.stl",
        "package://hand_description//meshes/hand.stl",
        "$(find hand_description)/meshes/hand.stl",
        "../../checkout-2/meshes/hand.stl",
        f"file://{mesh}",
    ):
        assert Surroundings(urdf).find(address).path.samefile(mesh), address
    assert Surroundings(urdf).find("package://hand/meshes/hand.stl").path is None


def test_a_workspace_of_links_is_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """colcon build --symlink-install: the installed package holds links to the files of its source."""
    source = made(package(tmp_path / "src" / "arm", "arm_description") / "meshes" / "a.stl")
    installed = tmp_path / "install" / "share" / "arm_description"
    package(installed, "arm_description")
    (installed / "meshes").mkdir()
    (installed / "meshes" / "a.stl").symlink_to(source)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "install"))
    urdf = made(tmp_path / "elsewhere" / "arm.urdf")
    assert Surroundings(urdf).find("package://arm_description/meshes/a.stl").path is not None
    assert Surroundings(urdf).find(f"file://{source}").refused


@pytest.mark.parametrize(
    ("address", "why"),
    [
        ("package://arm/meshes/base.stl", "there is 'Base.STL'"),
        ("package://arm/Meshes/Base.STL", "meshes/Base.STL'"),
        ("../meshes/base.stl", "there is 'Base.STL'"),
        ("../meshes/bass.stl", "there is no such file"),
        ("../Meshes", "there is no such file"),
        ("package://arm/meshes/bass.stl", "there is no such file"),
        ("package://legs/meshes/base.stl", "no package 'legs' was found"),
        ("package://ARM/meshes/Base.STL", "no package 'ARM' was found, but there is 'arm'"),
        ("package://Hand_Description/palm.stl", "no package 'Hand_Description' was found, but there is 'hand_descr"),
        ("package://PANDA_description/meshes/x.stl", "no package 'PANDA_description' was found, but there is 'panda"),
    ],
)
def test_a_missing_file_is_told_from_one_that_is_spelled_otherwise(tmp_path: Path, address: str, why: str) -> None:
    made(tmp_path / "arm" / "meshes" / "Base.STL")
    package(tmp_path / "the_hand", "hand_description")
    urdf = made(tmp_path / "arm" / "urdf" / "arm.urdf")
    found = Surroundings(urdf).find(address)
    assert found.path is None
    assert why in found.why


@pytest.mark.parametrize("kind", ["pipe", "zeros", "folder", "unreadable"])
def test_a_package_xml_that_is_no_file_is_no_package(tmp_path: Path, kind: str) -> None:
    manifest = tmp_path / "arm" / "package.xml"
    manifest.parent.mkdir()
    if kind == "pipe":
        os.mkfifo(manifest)
    elif kind == "zeros":
        manifest.symlink_to("/dev/zero")
    elif kind == "folder":
        manifest.mkdir()
    else:
        made(manifest, "<name>" + "x" * 5_000_000 + "</name>")
    mesh = made(tmp_path / "arm" / "meshes" / "a.stl")
    urdf = made(tmp_path / "arm" / "urdf" / "arm.urdf")
    started = time.monotonic()
    assert Surroundings(urdf).find("../meshes/a.stl").path.samefile(mesh)
    assert Surroundings(urdf).find("package://legs/a.stl").path is None
    assert time.monotonic() - started < 20


@pytest.mark.parametrize("address", ["a.stl", "package://arm/a.stl"])
@pytest.mark.parametrize(
    ("kind", "why"),
    [
        ("pipe", "this is a pipe or a device, not a mesh"),
        ("device", "this is a pipe or a device, not a mesh"),
        ("folder", "this is a directory, not a mesh"),
        ("lost", "this is a symbolic link that leads nowhere"),
    ],
)
def test_what_stands_in_place_of_a_mesh_is_named_and_not_opened(
    tmp_path: Path, kind: str, why: str, address: str
) -> None:
    urdf = made(tmp_path / "arm" / "arm.urdf")
    mesh = tmp_path / "arm" / "a.stl"
    match kind:
        case "pipe":
            os.mkfifo(mesh)
        case "device":
            mesh.symlink_to("/dev/zero")
        case "folder":
            mesh.mkdir()
        case "lost":
            mesh.symlink_to("no such file")
    found = Surroundings(urdf).find(address)
    assert (found.path, found.why) == (None, why)


@pytest.mark.parametrize("address", ["meshes/a.stl", "package://arm/meshes/a.stl"])
def test_a_mesh_in_a_folder_that_cannot_be_read_is_not_called_missing(address: str) -> None:
    with open_folder() as folder:
        urdf, mesh = made(folder / "arm" / "arm.urdf"), made(folder / "arm" / "meshes" / "a.stl")
        mesh.parent.chmod(0)
        try:
            with without_root():
                found = Surroundings(urdf).find(address)
        finally:
            mesh.parent.chmod(0o755)
        assert (found.path, found.why) == (None, "a folder on the way to it cannot be read: permission denied")
        assert Surroundings(urdf).find(address).path.samefile(mesh)


def test_load_gives_the_reason_of_every_mesh_that_is_not_found(tmp_path: Path) -> None:
    made(tmp_path / "arm" / "M.stl")
    addresses = {
        "m.stl": "there is 'M.stl'",
        "package://legs/a.stl": "no package 'legs' was found",
        "package://ARM/M.stl": "no package 'ARM' was found, but there is 'arm'",
        "C:/robots/a.stl": "it is a path of a Windows machine",
        "solid://a.stl": "pinik does not know addresses that begin with 'solid://'",
        "/no/such.stl": "there is no such file",
    }
    shapes = (f'<visual><geometry><mesh filename="{address}"/></geometry></visual>' for address in addresses)
    urdf = made(tmp_path / "arm" / "arm.urdf", robot(link("a", "".join(shapes))))
    with pytest.warns(pinik.UrdfWarning) as caught:
        pinik.load(urdf)
    lines = [str(warning.message) for warning in caught]
    for address, why in addresses.items():
        assert [line for line in lines if repr(address) in line and why in line], address


def test_a_mesh_that_is_not_found_has_the_line_of_its_first_shape(tmp_path: Path) -> None:
    shape = '<visual><geometry>\n<mesh filename="{}"/></geometry></visual>\n'
    text = robot("\n", link("a", *map(shape.format, ("m.stl", "n.stl", "m.stl"))), link("b"))
    urdf = made(tmp_path / "arm" / "arm.urdf", f"{text[: -len('</robot>')]}{joint('j', 'a', 'b')}</robot>")
    with pytest.warns(pinik.UrdfWarning, match=r"mesh 'm.stl' \(line 2\), mesh 'n.stl' \(line 4\): not found"):
        found = pinik.load(urdf)
    assert [(flaw.element, flaw.line) for flaw in found.warnings] == [("mesh 'm.stl'", 2), ("mesh 'n.stl'", 4)]


def test_packages_that_are_spelled_otherwise_are_one_line(tmp_path: Path) -> None:
    made(tmp_path / "arm" / "M.stl")
    package(tmp_path / "the_hand", "hand")
    shapes = (
        f'<visual><geometry><mesh filename="package://{name}/M.stl"/></geometry></visual>' for name in ("ARM", "Hand")
    )
    urdf = made(tmp_path / "arm" / "arm.urdf", robot(link("a", "".join(shapes))))
    with pytest.warns(pinik.UrdfWarning) as caught:
        pinik.load(urdf)
    (line,) = [str(warning.message) for warning in caught]
    assert "'package://ARM/M.stl'" in line
    assert "'package://Hand/M.stl'" in line
    assert "there is a package whose name differs only in upper and lower case" in line


def test_meshes_that_are_spelled_otherwise_are_one_line(tmp_path: Path) -> None:
    made(tmp_path / "arm" / "M.stl")
    made(tmp_path / "arm" / "N.stl")
    shapes = (f'<visual><geometry><mesh filename="{name}"/></geometry></visual>' for name in ("m.stl", "n.stl"))
    urdf = made(tmp_path / "arm" / "arm.urdf", robot(link("a", "".join(shapes))))
    with pytest.warns(pinik.UrdfWarning) as caught:
        pinik.load(urdf)
    (line,) = [str(warning.message) for warning in caught]
    assert (
        "'m.stl' (line 1), mesh 'n.stl' (line 1): not found: there is a file whose name differs only in upper" in line
    )


def test_thousands_of_packages_that_are_not_found_are_one_line(tmp_path: Path) -> None:
    shapes = (f'<visual><geometry><mesh filename="package://p{i}/m.stl"/></geometry></visual>' for i in range(500))
    urdf = made(tmp_path / "arm" / "arm.urdf", robot(link("a", "".join(shapes))))
    with pytest.warns(pinik.UrdfWarning) as caught:
        pinik.load(urdf)
    assert len(caught) == 1
    assert "no package of this name was found" in str(caught[0].message)


def test_thousands_of_missing_meshes_take_no_minutes_and_one_line(tmp_path: Path) -> None:
    shapes = "".join(
        f'<visual><geometry><mesh filename="package://p{i % 7}/m{i}.stl"/></geometry></visual>' for i in range(20_000)
    )
    urdf = made(tmp_path / "arm" / "urdf" / "arm.urdf", robot(link("a", shapes)))
    started = time.monotonic()
    with pytest.warns(pinik.UrdfWarning) as caught:
        pinik.load(urdf)
    assert time.monotonic() - started < 60
    assert len(caught) == 1
    assert "and 19994 more, 20000 times: not found" in str(caught[0].message)
    assert len(str(caught[0].message)) < 1000


OPENED = """
import sys, pinik
opened = []
sys.addaudithook(lambda event, arguments: opened.append(arguments[0]) if event == "open" else None)
robot = pinik.load(sys.argv[1])
from pinik.shapes.meshes import load_shapes
load_shapes(robot)
print([path for path in opened if isinstance(path, str) and path.endswith("secret.stl")])
"""


def test_a_refused_file_is_never_opened(tmp_path: Path) -> None:
    secret = made(tmp_path / "secret.stl")
    addresses = ("../secret.stl", str(secret), f"file://{secret}", "link.stl", "package://..//secret.stl")
    shapes = "".join(f'<visual><geometry><mesh filename="{one}"/></geometry></visual>' for one in addresses)
    urdf = made(tmp_path / "arm" / "arm.urdf", robot(link("a", shapes)))
    (tmp_path / "arm" / "link.stl").symlink_to(secret)
    told = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", OPENED, urdf], capture_output=True, text=True, check=True
    )
    assert told.stdout.strip() == "[]"
