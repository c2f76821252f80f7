"""A robot can be read from a path, from text or bytes, and from an open file."""

from __future__ import annotations

import io
import itertools
import os
import pathlib
import subprocess
import sys
import threading

import numpy as np
import pytest

import pinik
from pinik.description import reader as urdf
from urdf_texts import link, pair, robot

MESH = '<visual><geometry><mesh filename="part.stl"/></geometry></visual>'


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(robot(link("é", MESH)), encoding="utf-8")
    (tmp_path / "part.stl").write_text("")
    return file


OPENED = {
    "a binary file": lambda path: path.open("rb"),
    "an unbuffered one": lambda path: path.open("rb", buffering=0),
    "a text file": lambda path: path.open(encoding="utf-8"),
}


def loads_as_a_file_does(loaded, path):
    assert loaded.frame_names[-1] == "é"
    assert loaded.description.path == path
    assert loaded.description.source == str(path)
    return loaded.warnings == ()  # the mesh beside it is found


@pytest.mark.parametrize("opened", OPENED.values(), ids=OPENED)
def test_an_open_file_is_read_like_its_path(path, opened):
    with opened(path) as file:
        assert loads_as_a_file_does(pinik.load(file), path)


@pytest.mark.parametrize("make", [pathlib.Path, str])
def test_a_path_is_one_in_any_form(path, make):
    assert loads_as_a_file_does(pinik.load(make(path)), path)


def test_bytes_that_are_released_are_refused_in_words():
    view = memoryview(b"<robot/>")
    view.release()
    with pytest.raises(pinik.InputError, match="in a memoryview that is released"):
        pinik.load(view)


@pytest.mark.parametrize("make", [str, str.encode, bytearray, memoryview, io.StringIO, io.BytesIO])
def test_text_and_bytes_are_read_without_a_file(make):
    text = robot(link("é"))
    given = make(text.encode()) if make in (bytearray, memoryview, io.BytesIO) else make(text)
    loaded = pinik.load(given)
    assert loaded.frame_names[-1] == "é"
    assert (loaded.description.path, loaded.description.source) == (None, "<text>")


def test_an_open_file_is_read_from_where_it_stands():
    file = io.BytesIO(b"header\n" + pair().encode())
    file.readline()
    assert pinik.load(file).joint_names == ("j",)
    with pytest.raises(pinik.RobotLoadError, match="empty: it contains no XML"):
        pinik.load(file)


def test_the_poses_beside_an_open_file_are_found(arm_path):
    with arm_path.open("rb") as file:
        assert "reach" in pinik.load(file).poses


@pytest.fixture
def arm_path():
    return pinik.load("arm").description.path


def test_the_standard_input_is_read():
    code = "import sys, pinik; robot = pinik.load(sys.stdin); print(robot.joint_names, robot.description.source)"
    run = subprocess.run([sys.executable, "-c", code], input=pair().encode(), capture_output=True, check=True)
    assert run.stdout.decode().strip() == "('j',) <stdin>"


def test_a_pipe_that_hands_out_small_pieces_is_read_to_its_end():
    ours, theirs = os.pipe()

    def feed():
        with open(theirs, "wb", buffering=0) as pipe:
            for byte in pair().encode():
                pipe.write(bytes([byte]))

    thread = threading.Thread(target=feed)
    thread.start()
    with open(ours, "rb", buffering=0) as pipe:
        assert pinik.load(pipe).joint_names == ("j",)
    thread.join()


class Endless(io.RawIOBase):
    def readable(self):
        return True

    def readinto(self, buffer):
        buffer[:] = b" " * len(buffer)
        return len(buffer)


class NotAFile:
    def __init__(self, *gives):
        self.gives = itertools.cycle(gives)

    def read(self, _size):
        return next(self.gives)


class WithoutSize:
    def read(self):
        return "<robot/>"


def closed():
    file = io.BytesIO()
    file.close()
    return file


@pytest.mark.parametrize(
    ("source", "words"),
    [
        (io.BufferedReader(Endless()), "too large for a robot description"),
        (closed(), "the file cannot be read: I/O operation on closed file"),
        (io.TextIOWrapper(io.BytesIO(b"<robot name='\xe9'/>"), encoding="ascii"), "open it in binary mode"),
        (NotAFile([1, 2]), r"the file must give text or bytes; it gave \[1, 2\]"),
        (NotAFile(5), "the file must give text or bytes; it gave 5"),
        (NotAFile(None), "the file must give text or bytes; it gave None"),
        (NotAFile(0), "the file must give text or bytes; it gave 0"),
        (NotAFile(np.zeros(3)), "the file must give text or bytes; it gave array"),
        (NotAFile("<robot/>", b"<robot/>"), "the file must give either text or bytes; it gave both"),
        (WithoutSize(), r"the file's read\(\) must take a size: .*positional argument"),
        (NotAFile("\ud800<robot/>", ""), "cannot be encoded"),
        ("there/is/none.urdf", "no such file$"),
        ("xml <robot/>", r"no such file \(URDF text would begin with '<'\)$"),
        (b"", "empty"),
        (b"\x7fELF\x02\x01", "not XML"),
    ],
)
def test_what_cannot_be_read_is_refused_in_words(source, words):
    with pytest.raises(pinik.RobotLoadError, match=words):
        pinik.load(source)


@pytest.mark.parametrize("source", [None, 5, ["arm"], object(), {"a": 1}])
def test_what_is_no_source_is_refused_with_what_is(source):
    with pytest.raises(
        pinik.InputError, match="a catalogue name, a path or URDF text, its bytes, or an open file; got"
    ):
        pinik.load(source)


def test_robot_urdf_is_what_pinocchio_read_and_loads_again_without_a_word():
    text = pair('<origin xyz="0.1, 0, 0.3"/>', '<axis xyz="0 3 4"/>')
    with pytest.warns(pinik.UrdfWarning):
        loaded = pinik.load(text)
    again = pinik.load(loaded.urdf, strict=True)
    assert again.urdf == loaded.urdf == urdf.read(text).xml
    assert again.model == loaded.model
