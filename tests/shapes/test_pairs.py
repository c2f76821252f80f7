"""Which pairs of links count, why the others do not, and that it is found out once."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import pinocchio
import pytest

import pinik
from collision_oracle import PlainCollisions
from pinik.caches import cache_folder, digest
from pinik.shapes import pairs as pairs_module
from pinik.shapes.disabled_pairs import written_disabled_pairs
from robots import load_quietly
from urdf_texts import joint, link, robot

MASS = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
REACH = '<limit lower="-1.5" upper="1.5" effort="1" velocity="1"/>'


def ball(radius=0.1, xyz="0 0 0"):
    return f'<collision><origin xyz="{xyz}"/><geometry><sphere radius="{radius}"/></geometry></collision>'


def away(xyz):
    return f'<origin xyz="{xyz}"/>'


# Links one metre long along x, each with a ball in its middle; the third can bend back to the first, ±1.5 rad a joint.
ARM = robot(
    link("a", ball(0.3)),
    link("b", ball(0.1)),
    link("c", ball(0.1)),
    link("far", ball(0.1, "0 0 9")),
    joint("j1", "a", "b", away("0.2 0 0"), '<axis xyz="0 0 1"/>'),
    joint("j2", "b", "c", away("0.45 0 0"), '<axis xyz="0 0 1"/>'),
    joint("j3", "c", "far", away("0.2 0 0"), '<axis xyz="0 0 1"/>'),
)


@pytest.fixture
def finds(monkeypatch, tmp_path):
    """A cache of its own, and a list that grows by each search."""
    monkeypatch.setenv("PINIK_CACHE_DIR", str(tmp_path / "cache"))
    found, search = [], pairs_module._find_out
    monkeypatch.setattr(pairs_module, "_find_out", lambda *a: found.append(1) or search(*a))
    return found


def test_neighbours_do_not_count_what_never_touches_does_not_and_the_rest_does(finds):
    found = pinik.load(ARM).collision_pairs
    assert found.source == "found"
    reasons = dict(found.left_out)
    assert {pair for pair, why in reasons.items() if why == "adjacent"} == {("a", "b"), ("b", "c"), ("c", "far")}
    assert {pair for pair, why in reasons.items() if why == "never"} == {("a", "far"), ("b", "far")}
    assert found.counting == (("a", "c"),)


def test_links_fixed_to_each_other_are_one_body_and_their_neighbours_are_adjacent(finds):
    text = robot(
        link("a", ball()),
        link("plate", ball()),
        link("b", ball()),
        joint("f", "a", "plate", kind="fixed", limit=""),
        joint("j", "plate", "b", away("0.5 0 0")),
    )
    assert pinik.load(text).collision_pairs.left_out == {
        ("a", "plate"): "fixed",
        ("a", "b"): "adjacent",
        ("b", "plate"): "adjacent",
    }


@pytest.mark.parametrize(("between", "counts"), [("", False), (MASS, True)])
def test_links_without_mass_and_shape_are_part_of_the_joint(finds, between, counts):
    """Three hinges of a ball joint leave the links at its ends neighbours; a link with mass between them does not."""
    text = robot(
        link("a", ball(0.3)),
        link("m1", between),
        link("m2", between),
        link("b", ball(0.25)),
        joint("j1", "a", "m1", away("0.9 0 0"), '<axis xyz="0 0 1"/>'),
        joint("j2", "m1", "m2", away("0.3 0 0"), '<axis xyz="0 0 1"/>'),
        joint("j3", "m2", "b", away("0.4 0 0"), '<axis xyz="0 0 1"/>'),
    )
    found = pinik.load(text).collision_pairs
    assert (found.counting == (("a", "b"),)) is counts
    assert (found.left_out.get(("a", "b")) == "adjacent") is not counts
    assert found.without_shapes == ("m1", "m2")


def test_two_fingers_of_a_palm_without_mass_are_no_neighbours(finds):
    text = robot(
        link("base", ball(0.01, "0 0 -1")),
        link("palm"),
        link("left", ball(0.2)),
        link("right", ball(0.2)),
        joint("j", "base", "palm"),
        joint("l", "palm", "left", away("0 0.5 0"), '<axis xyz="0 1 0"/>', kind="prismatic", limit=REACH),
        joint("r", "palm", "right", away("0 -0.5 0"), '<axis xyz="0 1 0"/>', kind="prismatic", limit=REACH),
    )
    assert ("left", "right") in pinik.load(text).collision_pairs.counting


def test_what_touches_at_rest_and_what_always_touches_is_told_apart(finds):
    """The spinning c stays inside the wide ball of a; d passes a's ball, where it also stands at rest."""
    text = robot(
        link("a", ball(0.5)),
        link("b", ball(0.01, "0 0 5")),
        link("c", ball(0.1)),
        link("d", ball(0.1)),
        joint("j1", "a", "b", away("0.3 0 0")),
        joint("j2", "b", "c"),
        joint("j3", "b", "d", '<axis xyz="1 0 0"/>', kind="prismatic", limit=REACH),
    )
    left_out = pinik.load(text).collision_pairs.left_out
    assert left_out["a", "d"] == left_out["a", "c"] == "at rest"
    moved = text.replace('lower="-1.5" upper="1.5"', 'lower="1" upper="2"')  # rest is put inside the limits
    found = pinik.load(moved).collision_pairs
    assert found.left_out["a", "d"] == "never"


def test_always_means_in_every_sample_though_not_at_rest(finds):
    """The slider touches from 1e-9 m on, and rests at 0: no sample lies between."""
    text = robot(
        link("a", ball(0.5)),
        link("b", MASS),
        link("c", ball(0.5)),
        joint("j1", "a", "b", away("-1.000001 0 0")),
        joint(
            "j2",
            "b",
            "c",
            '<axis xyz="1 0 0"/>',
            kind="prismatic",
            limit='<limit lower="0" upper="1" effort="1" velocity="1"/>',
        ),
    )
    assert pinik.load(text).collision_pairs.left_out == {("a", "c"): "always"}


def test_the_srdf_says_which_pairs_count():
    """Every pair but those that Pinocchio finds disabled in the file."""
    machine = load_quietly("panda")
    plain = PlainCollisions(machine)
    pinocchio.removeCollisionPairs(machine.model, plain.geometry, str(machine.srdf))
    plain.pairs = [(pair.first, pair.second) for pair in plain.geometry.collisionPairs]
    found = machine.collision_pairs
    assert found.source == "srdf"
    assert set(found.counting) == {plain.names(k) for k in range(len(plain.pairs))}
    assert Counter(found.left_out.values()).keys() == {"fixed", "srdf"}


def test_a_faulty_srdf_is_an_error_that_names_it(tmp_path):
    (tmp_path / "r.urdf").write_text(ARM)
    (tmp_path / "r.srdf").write_text("<robot")
    machine = pinik.load(tmp_path / "r.urdf")
    with pytest.raises(pinik.RobotLoadError, match=r"r\.srdf: the SRDF cannot be read"):
        machine.collisions(machine.neutral())


def test_an_srdf_that_disables_nothing_leaves_it_to_pinik(tmp_path, finds):
    (tmp_path / "r.urdf").write_text(ARM)
    (tmp_path / "r.srdf").write_text('<robot name="r"><disable_collisions link1="a" link2="other" reason="x"/></robot>')
    assert pinik.load(tmp_path / "r.urdf").collision_pairs.source == "found"


def test_what_is_written_as_an_srdf_is_read_back_and_pinocchio_reads_it_too(tmp_path, finds):
    found = pinik.load(ARM).collision_pairs
    (tmp_path / "r.urdf").write_text(ARM)
    (tmp_path / "r.srdf").write_text(written_disabled_pairs("r", dict.fromkeys(found.left_out, "Never")))
    again = pinik.load(tmp_path / "r.urdf").collision_pairs
    assert again.source == "srdf"
    assert again.counting == found.counting
    assert set(again.left_out) == set(found.left_out)
    model = pinocchio.buildModelFromUrdf(str(tmp_path / "r.urdf"))
    geometry = pinocchio.buildGeomFromUrdf(model, str(tmp_path / "r.urdf"), pinocchio.COLLISION)
    geometry.addAllCollisionPairs()
    pinocchio.removeCollisionPairs(model, geometry, str(tmp_path / "r.srdf"))
    assert len(geometry.collisionPairs) == len(found.counting)
    quoted = written_disabled_pairs('<&"', {('a"', "<b>"): "'"})
    assert ElementTree.fromstring(quoted)[0].attrib == {"link1": 'a"', "link2": "<b>", "reason": "'"}


def test_pairs_are_found_out_once_and_again_when_the_robot_changes(finds):
    first = pinik.load(ARM).collision_pairs
    assert pinik.load(ARM).collision_pairs == first
    assert len(finds) == 1
    changed = pinik.load(ARM.replace('radius="0.3"', 'radius="0.31"')).collision_pairs
    assert len(finds) == 2
    assert changed.counting == first.counting


def test_a_changed_mesh_is_another_robot(tmp_path, finds):
    mesh = "solid m\n{}endsolid m\n"
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {} 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    (tmp_path / "m.stl").write_text(mesh.format(facet.format(1)))
    shape = '<collision><geometry><mesh filename="m.stl"/></geometry></collision>'
    (tmp_path / "r.urdf").write_text(ARM.replace(ball(0.3), shape))
    pinik.load(tmp_path / "r.urdf").collision_pairs  # noqa: B018
    (tmp_path / "m.stl").write_text(mesh.format(facet.format(2)))
    pinik.load(tmp_path / "r.urdf").collision_pairs  # noqa: B018
    assert len(finds) == 2


def kept() -> Path:
    [file] = cache_folder("pairs").iterdir()
    return file


@pytest.mark.parametrize(
    "garbled",
    [
        b"",
        b"{",
        b"[]",
        b'{"digest": "", "left_out": []}',
        b'{"digest": 3, "left_out": [[1]]}',
        b"[" * 100_000,
        b"\xff\xfe",
        "cut",
        "changed",
    ],
)
def test_a_garbled_cache_is_ignored_and_written_anew(finds, garbled):
    first = pinik.load(ARM).collision_pairs
    whole = kept().read_bytes()
    if garbled == "cut":
        garbled = whole[:-1]
    elif garbled == "changed":
        garbled = whole.replace(b"never", b"always")
    kept().write_bytes(garbled)
    assert pinik.load(ARM).collision_pairs == first
    assert len(finds) == 2
    assert kept().read_bytes() == whole


def test_a_cache_with_a_right_digest_and_wrong_words_is_ignored(finds):
    first = pinik.load(ARM).collision_pairs
    for words in ([["a", "c", "because"]], [["a", "nobody", "never"]], [["a"]]):
        kept().write_text(json.dumps({"digest": digest(json.dumps(words).encode()), "left_out": words}))
        assert pinik.load(ARM).collision_pairs == first
    assert len(finds) == 4


def test_where_nothing_can_be_written_nothing_is_kept(finds, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("PINIK_CACHE_DIR", str(tmp_path / "file"))
    assert pinik.load(ARM).collision_pairs == pinik.load(ARM).collision_pairs
    assert len(finds) == 2


def test_robots_without_collision_shapes_are_told_so():
    bare = load_quietly("asr_twodof")
    with pytest.raises(pinik.InputError, match="'asr_twodof' has no collision shapes"):
        bare.collisions(bare.neutral())
    with pytest.raises(pinik.InputError, match="no collision shapes"):
        bare.collision_pairs  # noqa: B018


def test_a_shape_that_cannot_be_read_is_said_and_the_others_still_collide(tmp_path):
    shape = '<collision><geometry><mesh filename="m.stl"/></geometry></collision>'
    (tmp_path / "m.stl").write_bytes(b"PK\x03\x04 no mesh")
    (tmp_path / "r.urdf").write_text(ARM.replace(ball(0.1, "0 0 9"), shape))
    machine = pinik.load(tmp_path / "r.urdf")
    with pytest.warns(pinik.UrdfWarning, match=r"collisions are not complete: .*'far'.*archive"):
        found = machine.collision_pairs
    assert found.without_shapes == ("far",)
    assert found.counting == (("a", "c"),)
