"""Worlds: what is added is where it was put, changes make new versions, and wrong arguments are named."""

from __future__ import annotations

import threading

import numpy as np
import pinocchio
import pytest

import pinik
from pinik import World
from urdf_texts import joint, link, robot

AT = pinocchio.SE3(pinocchio.rpy.rpyToMatrix(0.3, -0.2, 0.9), np.array([0.4, -0.1, 0.2]))
TIP = robot(
    link("base"),
    link("tip", '<collision><geometry><sphere radius="0.1"/></geometry></collision>'),
    joint("x", "base", "tip", '<axis xyz="1 0 0"/>', kind="prismatic"),
)
CELL = robot(
    link("floor", '<collision><geometry><box size="9 9 1"/></geometry></collision>'),
    link("post", '<collision><geometry><cylinder radius="0.2" length="3"/></geometry></collision>'),
    joint("j", "floor", "post", '<origin xyz="2 0 0"/>', kind="fixed", limit=""),
)


@pytest.fixture(scope="module")
def tip():
    """A ball of 0.1 m that slides along x."""
    return pinik.load(TIP)


def gap(machine, x, world):
    return machine.clearance(np.array([x]), world).distance


def test_each_object_is_where_it_was_put(tip):
    world = World()
    world.add_box("box", [0.2, 4.0, 6.0], [2.0, 0.0, 0.0])
    assert gap(tip, 0.5, world) == pytest.approx(2.0 - 0.1 - 0.6, abs=1e-6)
    world.add_sphere("ball", 0.3, [-2.0, 0.0, 0.0])
    assert tip.clearance(np.array([-1.0]), world).pair == ("tip", "ball")
    assert gap(tip, -1.0, world) == pytest.approx(2.0 - 0.3 - 1.1, abs=1e-6)
    lying = pinocchio.SE3(pinocchio.rpy.rpyToMatrix(0.0, np.pi / 2, 0.0), np.array([0.0, 1.0, 0.0]))
    alone = World()
    alone.add_cylinder("rod", 0.25, 8.0, lying.homogeneous)
    assert gap(tip, 2.9, alone) == pytest.approx(1.0 - 0.25 - 0.1, abs=1e-6)
    alone.add_mesh("wall", ([[2, -5, -5], [2, 5, -5], [2, 0, 9]], [[0, 1, 2]]), scale=[0.5, 1, 1])
    assert gap(tip, 0.5, alone) == pytest.approx(1.0 - 0.6, abs=1e-6)


def test_what_touches_is_named_with_its_depth(tip):
    world = World()
    world.add_box("box", [1.0, 1.0, 1.0], [1.0, 0.0, 0.0])
    [found] = tip.collisions(np.array([0.45]), world)
    assert found.pair == ("tip", "box")
    assert found.depth == pytest.approx(0.05, abs=1e-5)
    assert found.normal == pytest.approx([1.0, 0.0, 0.0], abs=1e-3)
    assert found.points[0] == pytest.approx([0.55, 0.0, 0.0], abs=1e-3)
    assert tip.collisions(np.array([0.3]), world) == []


def test_the_deepest_comes_first(tip):
    world = World()
    world.add_sphere("shallow", 0.5, [0.0, 0.58, 0.0])
    world.add_sphere("deep", 0.5, [0.0, -0.3, 0.0])
    assert [one.pair[1] for one in tip.collisions(np.array([0.0]), world)] == ["deep", "shallow"]


def test_a_change_is_seen_by_the_next_call_and_makes_a_version(tip):
    world = World()
    assert (world.version, len(world), list(world)) == (0, 0, [])
    q = np.array([0.0])
    assert tip.collisions(q, world) == []
    world.add_sphere("ball", 1.0)
    before = world.solids
    assert tip.collisions(q, world)[0].pair == ("tip", "ball")
    world.remove("ball")
    assert tip.collisions(q, world) == []
    assert [solid.owner for solid in before] == ["ball"]  # what was handed out stays as it was
    assert world.version == 2
    world.add_sphere("ball", 1.0)
    assert "ball" in world
    assert tip.collisions(q, world)[0].pair == ("tip", "ball")


def test_the_placement_is_copied(tip):
    at = np.eye(4)
    world = World()
    world.add_sphere("ball", 0.2, at)
    at[0, 3] = 5.0
    assert tip.collisions(np.array([0.0]), world)


def test_a_mesh_file_is_scaled_and_placed(tip, tmp_path):
    facets = "".join(
        "facet normal 1 0 0\nouter loop\n"
        + "".join(f"vertex 1000 {y} {z}\n" for y, z in corners)
        + "endloop\nendfacet\n"
        for corners in [((-500, -500), (500, -500), (0, 500))]
    )
    (tmp_path / "wall.stl").write_text(f"solid w\n{facets}endsolid w\n")
    world = World()
    world.add_mesh("wall", tmp_path / "wall.stl", [0.5, 0.0, 0.0], scale=0.001)
    assert gap(tip, 1.0, world) == pytest.approx(0.4, abs=1e-6)


def test_a_urdf_is_a_world_with_its_links_as_objects(tip, tmp_path):
    (tmp_path / "cell.urdf").write_text(CELL)
    for source in (CELL, tmp_path / "cell.urdf"):
        world = World.from_urdf(source, placement=[0.0, 0.0, -1.0])
        assert world.names == ("floor", "post")
        found = tip.clearance(np.array([0.0]), world)
        assert (found.pair, found.distance) == (("tip", "floor"), pytest.approx(0.4, abs=1e-6))
        assert tip.collisions(np.array([1.9]), world)[0].pair == ("tip", "post")
        world.remove("post")
        assert tip.collisions(np.array([1.9]), world) == []


def test_what_is_fixed_to_the_world_is_not_compared_with_it():
    text = robot(
        link("base", '<collision><geometry><box size="1 1 1"/></geometry></collision>'),
        link("b", '<collision><geometry><sphere radius="0.1"/></geometry></collision>'),
        joint("j", "base", "b", '<origin xyz="2 0 0"/>'),
    )
    world = World()
    world.add_box("floor", [9, 9, 1])
    fixed, free = pinik.load(text), pinik.load(text, root="free_flyer")
    assert {one.pair[0] for one in fixed.collisions(fixed.neutral(), world)} == {"b"}
    assert {one.pair[0] for one in free.collisions(free.neutral(), world)} == {"base", "b"}


def test_a_world_may_change_while_others_use_it(tip):
    world, stop, faults = World(), threading.Event(), []

    def change():
        while not stop.is_set():
            world.add_sphere("ball", 1.0)
            world.remove("ball")

    changer = threading.Thread(target=change)
    changer.start()
    try:
        for _ in range(300):
            found = tip.collisions(np.array([0.0]), world)
            if [one.pair for one in found] not in ([], [("tip", "ball")]):
                faults.append(found)
    finally:
        stop.set()
        changer.join()
    assert not faults


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda w: w.add_sphere("taken", 1.0), "'taken' is in the world already"),
        (lambda w: w.add_sphere("", 1.0), "name must be a text that is not empty"),
        (lambda w: w.add_sphere(3, 1.0), "name must be a text that is not empty"),
        (lambda w: w.add_sphere("s", 0.0), "radius must be a positive number"),
        (lambda w: w.add_sphere("s", float("nan")), "radius"),
        (lambda w: w.add_cylinder("s", 1.0, -1.0), "length must be a positive number"),
        (lambda w: w.add_box("s", [1.0, 2.0]), "size must be 3 finite numbers"),
        (lambda w: w.add_box("s", [1.0, 2.0, 0.0]), "size must be a positive number"),
        (lambda w: w.add_box("s", [1, 1, 1], np.ones((4, 4))), "placement"),
        (lambda w: w.add_box("s", [1, 1, 1], [np.inf, 0, 0]), "placement"),
        (lambda w: w.add_mesh("s", "nowhere.stl"), "'nowhere.stl' cannot be used: there is no such file"),
        (lambda w: w.add_mesh("s", "nowhere.stl", scale=0), "scale must not be zero"),
        (lambda w: w.add_mesh("s", ([[0, 0, 0]], [[0, 0, 1]])), "corners are not 0 to 0"),
        (lambda w: w.add_mesh("s", ([[0, 0, 0]], [[0, 0, 0.5]])), "corners are not 0 to 0"),
        (lambda w: w.add_mesh("s", ([[0, 0]], [[0, 0, 0]])), "vertices must be N times 3"),
        (lambda w: w.add_mesh("s", 3), "mesh must be a file, or vertices"),
        (lambda w: World.from_urdf(3), "source must be a path"),
        (lambda w: World.from_urdf(CELL, "folder"), "package_dirs must be a list of folders"),
    ],
)
def test_wrong_arguments_are_named_and_change_nothing(call, words):
    world = World()
    world.add_sphere("taken", 1.0)
    with pytest.raises(pinik.InputError, match=words):
        call(world)
    assert (world.names, world.version) == (("taken",), 1)


def test_an_unknown_object_is_an_error_with_near_names():
    world = World()
    world.add_sphere("table", 1.0)
    with pytest.raises(pinik.UnknownNameError, match=r"no object 'tabel'.*'table'"):
        world.remove("tabel")


def test_an_obstacle_that_cannot_be_read_is_an_error():
    """It must be avoided, so leaving it out would be dangerous."""
    broken = '<collision><geometry><mesh filename="no.stl"/></geometry></collision>'
    with pytest.raises(pinik.InputError, match=r"cannot be read.*no\.stl"):
        World.from_urdf(robot(link("a", broken)))
    with pytest.raises(pinik.InputError, match="cannot be read"):
        World.from_urdf(robot(link("a", "<collision><geometry><cone/></geometry></collision>")))


def test_only_a_world_is_taken_for_one(tip):
    with pytest.raises(pinik.InputError, match=r"world must be a pinik\.World"):
        tip.collisions(np.array([0.0]), "cell.urdf")
