from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

from addresses import resolve
from pinik.description import catalog as robot_catalog
from pinik.description import reader as urdf
from pinik.description.catalog import catalog, find
from pinik.description.shares import example_robot_data
from pinik.errors import RobotLoadError, UnknownNameError
from pinik.model.build import build_model

OWN = ["arm", "lion", "two_link"]
BROKEN = "ur3_empty"
# The files that address meshes which no installation has.
MESHES_ELSEWHERE = {"romeo_laas_small"}


@pytest.fixture(autouse=True)
def read_anew() -> Iterator[None]:
    """The catalogue remembers what it read; no test takes over what another one found."""
    robot_catalog._urdf_files.cache_clear()
    yield
    robot_catalog._urdf_files.cache_clear()


def test_the_catalogue_has_every_file_of_example_robot_data_once_and_pinik_s_own() -> None:
    robots = example_robot_data()
    assert robots is not None
    files = set(robots.rglob("*.urdf"))
    assert len(files) >= 69
    listed = [find(name).urdf for name in catalog() if name not in OWN]
    assert set(listed) == files
    assert len(listed) == len(files)
    assert set(OWN) <= set(catalog())


def test_the_names_are_sorted_and_can_be_typed() -> None:
    names = catalog()
    assert names == sorted(names)
    assert all(name == name.lower() and name.isidentifier() for name in names)


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("panda", "panda_description/urdf/panda.urdf"),
        ("ur3", "ur_description/urdf/ur3_robot.urdf"),
        ("ur5", "ur_description/urdf/ur5_robot.urdf"),
        ("ur10", "ur_description/urdf/ur10_robot.urdf"),
        ("z1", "z1_description/urdf/z1.urdf"),
        ("xarm7", "xarm_description/urdf/xarm7.urdf"),
        ("kinova", "kinova_description/robots/kinova.urdf"),
        ("so101", "so_arm_description/urdf/so101.urdf"),
        ("talos", "talos_data/robots/talos_reduced.urdf"),
        ("romeo", "romeo_description/urdf/romeo.urdf"),
        ("baxter", "baxter_description/urdf/baxter.urdf"),
        ("pr2", "pr2_description/urdf/pr2.urdf"),
        ("tiago", "tiago_description/robots/tiago.urdf"),
        ("solo", "solo_description/robots/solo.urdf"),
        ("g1", "g1_description/urdf/g1_29dof_rev_1_0.urdf"),
        ("hector", "hector_description/robots/quadrotor_base.urdf"),
        ("anymal_b", "anymal_b_simple_description/robots/anymal.urdf"),
        ("anymal_c", "anymal_c_simple_description/urdf/anymal.urdf"),
    ],
)
def test_a_robot_has_the_name_that_people_expect(name: str, file: str) -> None:
    robots = example_robot_data()
    assert robots is not None
    assert find(name).urdf == robots / file


def test_an_unknown_name_brings_near_ones() -> None:
    with pytest.raises(UnknownNameError, match=r"no robot 'anymal'; did you mean .*'anymal_b'") as caught:
        find("anymal")
    assert caught.value.valid == tuple(catalog())


@pytest.mark.parametrize(
    ("name", "srdf"),
    [
        ("arm", "arm.srdf"),
        ("panda", "panda.srdf"),
        ("panda_collision", "panda.srdf"),
        ("hyq", "hyq.srdf"),
        ("solo12", "solo.srdf"),
        ("talos_full", "talos.srdf"),
        ("icub_reduced", "icub.srdf"),
        ("ur5", "ur5.srdf"),
        ("anymal_c", "anymal.srdf"),
        # Poses of joints that these robots do not have.
        ("talos_left_arm", None),
        ("romeo_laas_small", None),
        ("baxter", None),
        # No SRDF, though the folder has some of others.
        ("ur10", None),
        ("so101", None),
        (BROKEN, None),
    ],
)
def test_a_robot_comes_with_its_own_poses_or_none(name: str, srdf: str | None) -> None:
    found = find(name).srdf
    assert (found and found.name) == srdf


@pytest.mark.parametrize("name", sorted(set(catalog()) - {BROKEN}))
def test_every_robot_loads_and_its_meshes_are_found(name: str) -> None:
    description = urdf.read(find(name).urdf)
    model, _ = build_model(description)
    moving = {tag.name for tag in description.joints if tag.kind != "fixed"}
    assert set(model.names) == {"universe"} | moving
    missing = [mesh for mesh in description.meshes if resolve(mesh, urdf_path=description.path) is None]
    assert bool(missing) == (name in MESHES_ELSEWHERE)


@pytest.mark.parametrize("name", sorted(name for name in catalog() if find(name).srdf))
def test_the_poses_that_come_with_a_robot_are_its_own(name: str) -> None:
    """A pose sets joints of this robot alone or, being a larger sibling's, nearly all of this one's."""
    entry = find(name)
    assert entry.srdf is not None
    joints = ElementTree.parse(entry.urdf).getroot().findall("joint")
    moving = {joint.get("name") for joint in joints if joint.get("type") != "fixed"}
    own = {joint.get("name") for joint in joints} | {"root_joint"}
    for state in ElementTree.parse(entry.srdf).iter("group_state"):
        posed = {joint.get("name") for joint in state.iter("joint")}
        assert posed <= own or len(posed & moving) > 0.9 * len(moving)


def test_the_file_that_holds_no_robot_says_so() -> None:
    with pytest.raises(RobotLoadError, match=r"ur3\.urdf: <robot>: there are no <link> elements"):
        urdf.read(find(BROKEN).urdf)


def test_the_installed_folder_comes_before_the_checkout_s(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "src" / "pinik"
    (tmp_path / "urdf").mkdir()
    (tmp_path / "urdf" / "checkout.urdf").touch()
    package.mkdir(parents=True)
    monkeypatch.setattr(robot_catalog, "__file__", str(package / "description" / "catalog.py"))
    assert "checkout" in catalog()
    (package / "urdf").mkdir()
    (package / "urdf" / "installed.urdf").touch()
    robot_catalog._urdf_files.cache_clear()
    assert "installed" in catalog()
    assert "checkout" not in catalog()


def test_without_example_robot_data_pinik_s_own_robots_remain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_catalog, "example_robot_data", lambda: None)
    assert catalog() == OWN
