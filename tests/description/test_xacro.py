"""xacro files in one call: their arguments, their packages, their errors in words, and bounds on what they take."""

from __future__ import annotations

import os
import re
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import trimesh

import pinik
from pinik.description import xacro
from pinik.shapes.meshes import load_shapes
from urdf_texts import robot

pytest.importorskip("xacrodoc")

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
TWO_LINKS = """
  <xacro:arg name="length" default="1.0"/>
  <xacro:arg name="mobile" default="false"/>
  <xacro:macro name="piece" params="name">
    <link name="${name}"/>
  </xacro:macro>
  <xacro:piece name="a"/>
  <xacro:piece name="b"/>
  <joint name="j" type="revolute">
    <origin xyz="${2 * float(xacro.arg('length'))} 0 0"/><parent link="a"/><child link="b"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <xacro:if value="$(arg mobile)"><link name="w"/>
    <joint name="wheel" type="fixed"><parent link="a"/><child link="w"/></joint></xacro:if>"""

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def written(body: str, name: str = "r.urdf.xacro") -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f'<robot name="r" {SPACE}>{body}</robot>')
        return path

    return written


def length(loaded: pinik.Robot) -> float:
    return float(loaded.placement("b", loaded.neutral()).translation[0])


@pytest.mark.parametrize("name", ["r.urdf.xacro", "r.xacro", "r.urdf"])
def test_a_xacro_file_loads_with_its_arguments_whatever_its_ending(write: Write, name: str) -> None:
    path = write(TWO_LINKS, name)
    assert length(pinik.load(path)) == pytest.approx(2.0)
    assert length(pinik.load(str(path), xacro_args={"length": 0.25})) == pytest.approx(0.5)
    assert length(pinik.load(path, xacro_args={"length": "3"})) == pytest.approx(6.0)
    assert "w" not in pinik.load(path).frame_names
    assert "w" in pinik.load(path, xacro_args={"mobile": True}).frame_names


def test_an_expression_alone_makes_a_xacro_file_where_its_names_are_declared(write: Write, tmp_path: Path) -> None:
    body = '<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/>'
    body += '<origin xyz="${1 + 1} 0 0"/></joint>'
    assert length(pinik.load(write(body, "r.urdf"))) == 2.0
    (tmp_path / "undeclared.urdf").write_text(f'<robot name="r">{body}</robot>')
    with pytest.raises(pinik.RobotLoadError, match="unexpanded xacro file"):
        pinik.load(tmp_path / "undeclared.urdf")


def test_a_plain_urdf_whose_name_ends_in_xacro_is_one_too(tmp_path: Path) -> None:
    path = tmp_path / "plain.xacro"
    path.write_text(robot('<link name="a"/>'))
    assert pinik.load(path).description.links == ("a",)


def test_a_tag_of_xacro_in_a_comment_makes_no_xacro_file(tmp_path: Path) -> None:
    path = tmp_path / "plain.urdf"
    path.write_text(robot('<!-- made from <xacro:arm/> --><link name="a"/>'))
    with pytest.raises(pinik.InputError, match="xacro_args are for xacro files, and this is none"):
        pinik.load(path, xacro_args={"length": 1})
    assert pinik.load(path).warnings == ()


def test_text_is_never_expanded(write: Write) -> None:
    text = write(TWO_LINKS).read_text()
    with pytest.raises(pinik.RobotLoadError, match="an unexpanded xacro file; load it by its path"):
        pinik.load(text)


@pytest.mark.parametrize("given", [["length:=1"], {"length": [1]}, {1: "2"}, {"length": None}, "length"])
def test_arguments_that_are_none_are_refused_in_words(write: Write, given: Any) -> None:
    with pytest.raises(pinik.InputError, match="xacro_args must be a dict"):
        pinik.load(write(TWO_LINKS), xacro_args=given)


def test_a_mistyped_argument_is_refused_with_the_near_name(write: Write) -> None:
    with pytest.raises(pinik.UnknownNameError, match="no xacro argument 'lenght'; did you mean 'length'"):
        pinik.load(write(TWO_LINKS), xacro_args={"lenght": 1})


def test_packages_and_meshes_are_found_from_the_xacro_file(write: Write, tmp_path: Path) -> None:
    """$(find …) takes pinik's own search: here the package beside the robot's, whose folder has another name."""
    (tmp_path / "hand-main").mkdir()
    (tmp_path / "hand-main" / "package.xml").write_text("<package><name>hand_description</name></package>")
    write(TWO_LINKS, "hand-main/hand.xacro")
    (tmp_path / "hand-main" / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "meshes" / "b.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    addresses = ("file://$(find hand_description)/a.obj", "package://hand_description/a.obj", "../meshes/b.obj")
    shapes = "".join(f'<visual><geometry><mesh filename="{one}"/></geometry></visual>' for one in addresses)
    include = '<xacro:include filename="$(find hand_description)/hand.xacro"/>'
    path = write(f'{include}<link name="c">{shapes}</link><joint name="k" type="fixed"><parent link="b"/>'
                 '<child link="c"/></joint>', "arm/urdf/arm.xacro")  # fmt: skip
    loaded = pinik.load(path)
    assert loaded.warnings == ()
    assert loaded.description.path == path
    drawn, flaws = load_shapes(loaded)
    assert (len(drawn), flaws) == (3, [])


def test_dirname_is_the_folder_of_the_file_in_which_it_stands(write: Write, tmp_path: Path) -> None:
    box = '<link name="{}"><visual><geometry><mesh filename="$(dirname)/{}.stl"/></geometry></visual></link>'
    write(box.format("b", "near"), "parts/part.xacro")
    fixed = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    path = write(f'{box.format("a", "far")}<xacro:include filename="$(dirname)/parts/part.xacro"/>{fixed}')
    for file in ("far.stl", "parts/near.stl"):
        trimesh.creation.box((1, 1, 1)).export(tmp_path / file)
    loaded = pinik.load(path, strict=True)
    assert loaded.description.meshes == (str(tmp_path / "far.stl"), str(tmp_path / "parts" / "near.stl"))
    assert len(load_shapes(loaded)[0]) == 2


def test_a_package_of_package_dirs_comes_first(write: Write, tmp_path: Path) -> None:
    write(TWO_LINKS, "near/parts/two.xacro")
    write(TWO_LINKS.replace("2 * float", "5 * float"), "given/parts/two.xacro")
    path = write('<xacro:include filename="$(find parts)/two.xacro"/>', "near/r.xacro")
    assert length(pinik.load(path)) == pytest.approx(2.0)
    assert length(pinik.load(path, package_dirs=[tmp_path / "given"])) == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ('\n\n<link name="${no_name}"/>', r"name 'no_name' is not defined .*\(line 3\)"),
        ('\n<xacro:nothing/>', r"unknown macro name: xacro:nothing \(line 2\)"),
        ('<xacro:macro name="m" params="n">\n<link name="${n + q}"/></xacro:macro>\n\n<xacro:m n="a"/>', r"\(line 2\)"),
        ('\n<link name="$(arg which)"/>', r"'which' has no value; .*--xacro-arg which:=VALUE\) \(line 2\)"),
        ('<xacro:include filename="$(find nowhere)/x.xacro"/>', r"no package 'nowhere' was found; .*package_dirs"),
        ('<xacro:include filename="$(find Hand)/x.xacro"/>', r"no package 'Hand' was found, but there is 'hand'; name"),
        ('\n\n\n<xacro:include filename="none.xacro"/>', r"none.xacro cannot be read: No such file .*\(line 4\)"),
        ('\n<link name="a">', r"not XML: mismatched tag \(line 2\)"),
        ('<xacro:include filename="r.urdf.xacro"/>', "files include each other, .* without end"),
        ('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>', "call each other, without end"),
        ('<xacro:include filename="broken.xacro"/>', r"not XML: .*broken.xacro, line 2\)"),
        ('<xacro:property name="x" value="${y}"/><xacro:property name="y" value="${x}"/><l n="${x}"/>', "circular"),
        ("<link name=\"${xacro.fatal('too bad')}\"/>", "too bad"),
        ("<link name=\"${().__class__}\"/>", "xacro: .*__class__"),
        ("<link name=\"${open('/etc/passwd')}\"/>", "name 'open' is not defined"),
        ('<link name="${[0] * 10**10}"/>', "takes more than 2048 MB of memory"),
        ("<link name=\"${'a' * 20_000_000}\"/>", "larger than 16 MB"),
        ("<joint/>", "no <link> elements"),
        ('\n<xacro:arg name="n"/><l n="$(arg n)"/>', r"xacro: xacro:arg: missing attribute 'default' \(line 2\)"),
        ('<link name="$(env NO_SUCH)"/>', r"xacro: environment variable 'NO_SUCH' is not set \(line 1\)"),
        ('<link name="$(eval 1/0)"/>', r"xacro: division by zero \(line 1\)"),
        ("<link name=\"${dict(a=1)['b']}\"/>", "xacro: there is no key 'b' when evaluating expression"),
        ('<xacro:include filename="${[]}" ns="a b"/>', "xacro: it cannot be expanded: expected str"),
    ],
)  # fmt: skip
def test_an_error_is_said_in_words_with_file_and_line(write: Write, tmp_path: Path, body: str, words: str) -> None:
    (tmp_path / "broken.xacro").write_text("<robot>\n<link name=></robot>")
    (tmp_path / "hand").mkdir()
    with pytest.raises(pinik.RobotLoadError, match=words) as caught:
        pinik.load(write(body))
    assert str(caught.value).startswith(str(tmp_path / "r.urdf.xacro"))
    assert not re.search(r"Traceback|\w+(Error|Exception): |<class '", str(caught.value))
    assert len(str(caught.value)) < 1500


def test_lines_are_those_of_the_expanded_file_and_the_words_say_so(write: Write) -> None:
    """The lines are those that `xacro FILE` writes below its own heading of XML."""
    path = write(TWO_LINKS.replace('xyz="0 0 1"', 'xyz="0, 0, 1"'))
    with pytest.warns(pinik.UrdfWarning, match=r"commas .* \(line 8 of the expanded file\)"):
        lines = pinik.load(path).description.document.splitlines()
    assert b'<axis xyz="0, 0, 1"/>' in lines[7]
    with pytest.raises(pinik.RobotLoadError, match=r"joint 'j': .* \(line [4-8] of the expanded file\)$"):
        pinik.load(write(TWO_LINKS.replace('xyz="0 0 1"', 'xyz="0 0 z"')))
    path = write('<link name="a">\n<visual><geometry><box size="1 1 z"/></geometry></visual></link>')
    with pytest.warns(pinik.UrdfWarning, match=r"'z' is not a number; .* \(line 5 of the expanded file\)"):
        pinik.load(path)


@pytest.mark.parametrize("body", ['<link name="${10**10**10}"/>', '<xacro:include filename="pipe.xacro"/>'])
def test_what_takes_too_long_is_stopped(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, body: str
) -> None:
    os.mkfifo(tmp_path / "pipe.xacro")
    monkeypatch.setattr(xacro, "SECONDS", 1.5)
    with pytest.raises(pinik.RobotLoadError, match=r"takes longer than 1.5 s to expand"):
        pinik.load(write(body))


@pytest.mark.parametrize("place", ["zero.xacro", "$(find hand)/zero.xacro"])
def test_an_included_file_without_an_end_is_named(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str
) -> None:
    (tmp_path / "fine.xacro").write_text("<robot/>")
    (tmp_path / "hand").mkdir()
    endless = tmp_path / place.replace("$(find hand)", "hand")
    endless.symlink_to("/dev/zero")
    monkeypatch.setattr(xacro, "_MOST_MEMORY", 500 * 1024**2)
    includes = '<xacro:include filename="fine.xacro"/>', f'<xacro:include filename="{place}"/>'
    with pytest.raises(
        pinik.RobotLoadError, match=r"takes more than 500 MB of memory .*; the last file that"
    ) as caught:
        pinik.load(write("".join(includes)))
    assert str(caught.value).endswith(f"included is {endless}")


def test_a_warning_of_xacro_is_kept_and_nothing_is_printed(write: Write, capfd: pytest.CaptureFixture[str]) -> None:
    path = write(TWO_LINKS + '<xacro:property name="pi" value="3"/>')
    with pytest.warns(pinik.UrdfWarning, match="redefining global symbol: pi"):
        pinik.load(path)
    assert capfd.readouterr() == ("", "")


def test_threads_expand_files_side_by_side(write: Write) -> None:
    paths = [write(TWO_LINKS.replace("2 *", f"{i} *"), f"r{i}.xacro") for i in range(1, 5)]
    told: dict[int, float] = {}

    def work(i: int) -> None:
        told[i] = length(pinik.load(paths[i]))

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert told == {i: pytest.approx(i + 1.0) for i in range(4)}


def test_a_page_loads_no_file(write: Write, arm: pinik.Robot) -> None:
    from pinik.viewer.protocol.robots import RobotMenu

    menu = RobotMenu(arm)
    for name in (str(write(TWO_LINKS)), "ur10e_description"):
        with pytest.raises(pinik.UnknownNameError):
            menu.check(name, "fixed")


def test_a_missing_package_names_the_line_that_installs_it(write: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xacro.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(pinik.MissingExtraError, match=r"a xacro file needs xacrodoc: pip install 'pinik\[xacro\]'"):
        pinik.load(write(TWO_LINKS))
