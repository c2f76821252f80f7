"""Reading takes no longer than the length of what is read: no search begins anew at each of many equal places."""

from __future__ import annotations

import contextlib
import time
from itertools import product
from string import ascii_lowercase

import pytest

from pinik.description.document import read_document
from pinik.description.encodings import declared_as_utf_8
from pinik.description.manifests import manifest_name
from pinik.description.numbers import read_numbers
from pinik.description.xacro import is_xacro
from pinik.description.xml import DocumentError
from pinik.errors import RobotLoadError
from pinik.loading import load
from pinik.shapes.mesh_checks import MeshError, checked
from urdf_texts import link, pair, robot

COUNT = 100_000
COMMENTS = b"<!--" * COUNT
SECONDS = 5.0  # of computing; a quadratic search takes minutes


def read_package(tmp_path, manifest):
    (tmp_path / "package.xml").write_bytes(manifest)
    return manifest_name(tmp_path)


def misspelt(tag, attribute):
    """An element with half a million attributes, each the given one with other letters between its own."""
    first, second = attribute[:3], attribute[3:]
    names = (
        "".join((first, *letters[:2], second, *letters[2:], '="1"')) for letters in product(ascii_lowercase, repeat=4)
    )
    return f"<{tag} {' '.join(names)}/>"


READS = {
    "misspelt names": lambda _: load(pair(misspelt("dynamics", "friction"))),
    "comments without an end after a fault": lambda _: read_document(b"<robot name=<" + COMMENTS),
    "a comment to mend and white space": lambda _: read_document(b"<robot><!-- -- --></robot>" + b" " * COUNT),
    "declarations without an end": lambda _: declared_as_utf_8(b"<?xml " * COUNT),
    "comments in a file that may be xacro": lambda tmp_path: is_xacro(tmp_path / "robot.urdf", COMMENTS),
    "comments in a package.xml": lambda tmp_path: read_package(tmp_path, b"<package>" + COMMENTS),
    "names in a package.xml": lambda tmp_path: read_package(tmp_path, b"<name> a" * COUNT),
    "white space between loose numbers": lambda _: [
        read_numbers("1" + 9_990 * " " + ", 2, 3", (3,)) for _ in range(50)
    ],
    "white space in an origin": lambda _: load(pair(f'<origin xyz="1{" " * COUNT},{" " * COUNT}2"/>')),
    "brackets around an origin": lambda _: load(pair(f'<origin xyz="{"[" * COUNT}{"]" * COUNT}"/>')),
    "numbers of a box": lambda _: load(
        robot(link("a", f'<visual><geometry><box size="{"1," * COUNT}"/></geometry></visual>'))
    ),
    "empty lines in the header of a PLY file": lambda _: checked(b"ply\n" + b"\n" * COUNT + b"end_header\n", "ply"),
}


@pytest.mark.parametrize("read", READS.values(), ids=READS)
@pytest.mark.filterwarnings("ignore::pinik.UrdfWarning")
def test_a_long_text_is_read_or_refused_at_once(read, tmp_path):
    began = time.process_time()
    with contextlib.suppress(RobotLoadError, DocumentError, MeshError):
        read(tmp_path)
    assert time.process_time() - began < SECONDS
