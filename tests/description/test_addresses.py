"""The addresses of meshes, as people write them."""

from __future__ import annotations

import pytest

import pinik
from pinik.description.addresses import UnusableAddressError, read_address
from urdf_texts import link, robot


@pytest.mark.parametrize(
    ("text", "package", "path"),
    [
        ("package://p/meshes/a.stl", "p", "meshes/a.stl"),
        ("package://p//meshes/a.stl", "p", "meshes/a.stl"),
        ("package:///p/meshes/a.stl", "p", "meshes/a.stl"),
        ("PACKAGE://p/a.stl", "p", "a.stl"),
        ("model://p/a.stl", "p", "a.stl"),
        ("package:p/a.stl", "p", "a.stl"),
        (" package://p\\meshes\\a.stl\n", "p", "meshes/a.stl"),
        ("package://p/a/../b.stl", "p", "a/../b.stl"),
        ("$(find p)/meshes/a.stl", "p", "meshes/a.stl"),
        ("file://$(find p)/a.stl", "p", "a.stl"),
        ("package://$(find p)/a.stl", "p", "a.stl"),
        ("$(find-pkg-share p)/a.stl", "p", "a.stl"),
        ("file:///opt/a.stl", None, "/opt/a.stl"),
        ("file://localhost/opt/a.stl", None, "/opt/a.stl"),
        ("file:/opt/a.stl", None, "/opt/a.stl"),
        ("file:////opt/a.stl", None, "/opt/a.stl"),
        ("file:///X/a.stl", None, "/X/a.stl"),
        ("file:meshes/a.stl", None, "meshes/a.stl"),
        ("file://meshes/a.stl", None, "meshes/a.stl"),
        ("file://[", None, "["),
        ("file://[::1]/a.stl", None, "[::1]/a.stl"),
        ("../meshes/a.stl", None, "../meshes/a.stl"),
        ("..\\meshes\\a.stl", None, "../meshes/a.stl"),
        ("a:b.stl", None, "a:b.stl"),
        ("Füße.stl", None, "Füße.stl"),
    ],
)
def test_an_address_names_a_package_or_a_path(text: str, package: str | None, path: str) -> None:
    address = read_address(text)
    assert (address.package, address.spellings[0]) == (package, path)


def test_an_encoded_address_is_tried_as_it_stands_and_decoded() -> None:
    assert read_address("package://p/two%20words.stl").spellings == ("two%20words.stl", "two words.stl")
    assert read_address("two words.stl").spellings == ("two words.stl",)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "empty"),
        ("  ", "empty"),
        ("a\0b.stl", "no file has such a name"),
        ("a" * 5000, "no file has such a name"),
        ("C:\\robots\\a.stl", "a path of a Windows machine, on its drive C:"),
        ("c:/robots/a.stl", "a path of a Windows machine, on its drive C:"),
        ("file:///C:/robots/a.stl", "a path of a Windows machine, on its drive C:"),
        ("file://D:\\a.stl", "a path of a Windows machine, on its drive D:"),
        ("\\\\server\\share\\a.stl", "a path of a Windows network"),
        ("https://example.org/a.stl", "an address in a network"),
        ("gopher://a/b.stl", "'gopher://'"),
        ("$(arg mesh)", "a xacro expression"),
        ("${mesh}.stl", "a xacro expression"),
        ("package://p/../a.stl", "it leaves its package"),
        ("package://p/meshes/../../a.stl", "it leaves its package"),
        ("package://p/%2e%2e/a.stl", "it leaves its package"),
        ("$(find p)/../a.stl", "it leaves its package"),
        ("package://../a.stl", "names no package"),
        ("package://", "names no package"),
        ("package://p", "names a package, but no file in it"),
        ("package://p//", "names a package, but no file in it"),
    ],
)
def test_an_address_that_no_file_can_have_is_refused_in_words(text: str, why: str) -> None:
    with pytest.raises(UnusableAddressError, match=why.replace("$", "\\$")):
        read_address(text)


@pytest.mark.parametrize(
    "address", ["file://[", "file://[::1", "file:///%", "package://[/a", "C:\\a.stl", "a" * 9000, "//", "file:"]
)
def test_no_address_stops_kinematics(address: str) -> None:
    shape = f'<visual><geometry><mesh filename="{address}"/></geometry></visual>'
    with pytest.warns(pinik.UrdfWarning, match=r"mesh .*: not found: .*; kinematics works without it"):
        loaded = pinik.load(robot(link("a", shape)))
    assert loaded.placement("a", loaded.neutral()).isIdentity()
