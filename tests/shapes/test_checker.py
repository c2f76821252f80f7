"""Both checkers against closed forms and against coal, called by Pinocchio on what it reads itself."""

from __future__ import annotations

import itertools
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pinocchio
import pytest

import pinik
from collision_oracle import PlainCollisions, all_pairs
from engines import needs_native
from pinik.shapes.checker import make_checker
from pinik.shapes.collisions import shapes_of
from pinik.shapes.pairs import solid_pairs
from pinik.shapes.solids import Solid, Surface
from pinik.shapes.touch import Pair
from robots import load_quietly
from urdf_texts import joint, link, robot

ENGINES = [pytest.param("native", marks=needs_native), "python"]
SLIDER = robot(link("a"), link("b"), joint("x", "a", "b", '<axis xyz="1 0 0"/>', kind="prismatic"))


def cube(edge: float = 1.0, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Surface:
    """A cube as a mesh of twelve triangles."""
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * edge + at
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Surface.of(corners, np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]))


def two(engine, first, second, at=None):
    """A checker of two solids, of which the second slides along x, and the slide of it."""
    machine = load_quietly(SLIDER)
    origin = pinocchio.SE3.Identity()
    solids = []
    for owner, number, (kind, size) in (("a", 0, first), ("b", 1, second)):
        surface = size if isinstance(size, Surface) else None
        place = at if number and at is not None else origin
        solids.append(Solid(owner, number, place, kind, () if surface else size, surface))
    return make_checker(machine, solids, [Pair(0, 1, 0)], engine)


BODIES = {
    "box": ("box", (1.0, 1.0, 1.0)),
    "sphere": ("sphere", (0.5,)),
    "cylinder": ("cylinder", (0.5, 1.0)),
    "capsule": ("capsule", (0.5, 1.0)),
    "mesh": ("mesh", cube()),
}


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("first", "second"), list(itertools.product(BODIES, repeat=2)))
def test_bodies_of_width_one_on_a_line_are_apart_by_their_distance_less_one(engine, first, second):
    """All are one metre wide along x, so the gap and the depth along it have a closed form."""
    checker = two(engine, BODIES[first], BODIES[second])
    for x in (-1.3, -1.001, 1.001, 2.5):
        assert checker.report(np.array([x])) == []
        gap = checker.clearance(np.array([x]))
        assert gap.distance == pytest.approx(abs(x) - 1.0, abs=2e-5)
        a, b = np.array(gap.points)
        assert np.linalg.norm(a - b) == pytest.approx(gap.distance, abs=1e-5)
        assert [a[0], b[0]] == pytest.approx([np.copysign(0.5, x), x - np.copysign(0.5, x)], abs=1e-4)
    for x in (-0.99, -0.9, 0.9, 0.999):
        [touch] = checker.report(np.array([x]))
        assert touch.group == 0
        assert touch.depth == pytest.approx(1.0 - abs(x), abs=2e-4)
        assert touch.normal == pytest.approx([np.sign(x), 0.0, 0.0], abs=0.05)
        assert checker.clearance(np.array([x])).distance == -touch.depth


@pytest.mark.parametrize("engine", ENGINES)
def test_spheres_anywhere_have_the_depth_of_the_closed_form(engine):
    rng = np.random.default_rng(5)
    for _ in range(50):
        at = rng.uniform(-1.0, 1.0, 3)
        checker = two(engine, ("sphere", (0.4,)), ("sphere", (0.7,)), pinocchio.SE3(np.eye(3), at))
        x = rng.uniform(-1.0, 1.0)
        centre = at + np.array([x, 0.0, 0.0])
        gap = np.linalg.norm(centre) - 1.1
        found = checker.report(np.array([x]))
        assert bool(found) == (gap < 0.0)
        assert checker.clearance(np.array([x])).distance == pytest.approx(gap, abs=1e-5)
        for touch in found:
            assert touch.normal == pytest.approx(centre / np.linalg.norm(centre), abs=1e-4)


@pytest.mark.parametrize("engine", ENGINES)
def test_primitives_along_the_same_axes_touch_however_deep(engine):
    """Without a request for contacts coal overlooks some of these; a box inside the other must always be found."""
    rng = np.random.default_rng(17)
    kinds = {
        "box": lambda: tuple(rng.uniform(0.02, 0.3, 3)),
        "cylinder": lambda: tuple(rng.uniform(0.02, 0.3, 2)),
        "capsule": lambda: tuple(rng.uniform(0.02, 0.3, 2)),
    }
    for _ in range(1500):
        (first, make), (second, make_other) = (list(kinds.items())[k] for k in rng.integers(0, 3, 2))
        turn = pinocchio.rpy.rpyToMatrix(*(np.pi / 2 * rng.integers(0, 4, 3))) @ pinocchio.rpy.rpyToMatrix(
            *(rng.uniform(-3.0, 3.0) * np.eye(3)[rng.integers(0, 3)])
        )
        # Both have their centres in common but for a part of the least half width along one axis.
        at = 0.009 * rng.uniform(-1.0, 1.0) * np.eye(3)[rng.integers(0, 3)]
        checker = two(engine, (first, make()), (second, make_other()), pinocchio.SE3(turn, at))
        assert len(checker.report(np.zeros(1))) == 1


@pytest.mark.parametrize("engine", ENGINES)
def test_a_mesh_is_its_surface(engine):
    checker = two(engine, ("mesh", cube(2.0)), ("mesh", cube(0.5)))
    assert checker.report(np.array([0.0])) == []
    assert checker.clearance(np.array([0.0])).distance == pytest.approx(0.75)
    assert len(checker.report(np.array([0.9]))) == 1


@pytest.mark.parametrize("engine", ENGINES)
def test_a_mesh_that_is_not_convex_touches_with_its_triangles_and_is_as_deep_as_its_hull(engine):
    """An L of three cubes: its hull reaches the small cube above its corner, which it touches only further down."""
    low, high = cube(1.0), cube(1.0, (0.0, 0.0, 1.0))
    wing = cube(1.0, (1.0, 0.0, 0.0))
    parts = (low, high, wing)
    faces = np.vstack([part.faces + 8 * k for k, part in enumerate(parts)])
    corner = ("mesh", Surface.of(np.vstack([part.vertices for part in parts]), faces.astype(np.int64)))
    checker = two(engine, corner, ("mesh", cube(0.2)), pinocchio.SE3(np.eye(3), np.array([0.0, 0.0, 1.0])))
    assert checker.report(np.array([0.65])) == []
    [touch] = checker.report(np.array([0.55]))
    # The hull's slope goes from (0.5, 1.5) to (1.5, 0.5) in x and z; the cube's low corner lies at (0.45, 0.9).
    assert touch.depth == pytest.approx((2.0 - 0.45 - 0.9) / np.sqrt(2.0), abs=1e-4)
    assert touch.normal == pytest.approx([np.sqrt(0.5), 0.0, np.sqrt(0.5)], abs=1e-3)


@needs_native
@pytest.mark.parametrize("name", ["panda", "ur5", "kinova"])
def test_moved_by_the_depth_against_the_normal_the_first_is_free(name):
    """Pinocchio's own shapes, moved and compared by coal."""
    machine = load_quietly(name)
    plain = PlainCollisions(machine)
    counting = machine.collision_pairs.counting
    rng = np.random.default_rng(14)
    moved = 0
    while moved < 20:
        q = machine.random(rng)
        for touch in machine.collisions(q):
            assert touch.pair in counting
            assert plain.touching_when_moved(q, touch.pair, np.zeros(3))
            assert not plain.touching_when_moved(q, touch.pair, -(touch.depth + 1e-4) * touch.normal)
            moved += 1


@pytest.mark.parametrize("engine", ENGINES)
def test_many_configurations_give_what_single_ones_give(engine):
    checker = two(engine, BODIES["box"], BODIES["mesh"])
    Q = np.linspace(-2.0, 2.0, 41)[:, None]
    single = [bool(checker.report(q)) for q in Q]
    assert 0 < sum(single) < len(Q)
    assert checker.touches(Q).tolist() == single
    assert checker.counts(Q).tolist() == [sum(single)]


@pytest.mark.parametrize(
    ("name", "count"),
    [("panda", 200), ("ur5", 200), ("z1", 20), ("kinova", 20), ("tiago", 20), ("talos", 10), ("a1", 100)],
)
def test_every_pair_touches_where_pinocchio_says_so(name, count):
    """Pinocchio reads the file and its meshes by itself; the pairs are all that can move, disabled ones too."""
    machine = load_quietly(name)
    plain, shapes = PlainCollisions(machine), shapes_of(machine)
    pairs = list(all_pairs(machine, [solid.owner for solid in shapes.solids]))
    assert set(pairs) == {plain.names(k) for k in range(len(plain.pairs))}
    checker = make_checker(machine, shapes.solids, solid_pairs(shapes.solids, pairs))
    rng = np.random.default_rng(11)
    touched = 0
    for _ in range(count):
        q = machine.random(rng)
        ours = {pairs[touch.group] for touch in checker.report(q)}
        assert ours == plain.touching(q)
        touched += len(ours)
    assert touched > 0


@needs_native
@pytest.mark.parametrize("name", ["panda", "ur5"])
def test_both_engines_find_the_same(name):
    machine = load_quietly(name)
    shapes = shapes_of(machine)
    pairs = list(all_pairs(machine, [solid.owner for solid in shapes.solids]))
    native, python = (
        make_checker(machine, shapes.solids, solid_pairs(shapes.solids, pairs), engine)
        for engine in ("native", "python")
    )
    rng = np.random.default_rng(12)
    for _ in range(20):
        q = machine.random(rng)
        ours, theirs = native.report(q), python.report(q)
        assert [touch.group for touch in ours] == [touch.group for touch in theirs]
        assert [t.depth for t in ours] == pytest.approx([t.depth for t in theirs], abs=1e-6)


@pytest.mark.parametrize("name", ["panda", "ur5"])
def test_the_clearance_is_pinocchios_least_distance(name):
    machine = load_quietly(name)
    plain = PlainCollisions(machine)
    counting = set(machine.collision_pairs.counting)
    rng = np.random.default_rng(13)
    free = 0
    for _ in range(40):
        q = machine.random(rng)
        if machine.collisions(q):
            assert machine.clearance(q).distance <= 0.0
            continue
        free += 1
        least = min(d for pair, d in plain.distances(q).items() if pair in counting)
        found = machine.clearance(q)
        assert found.distance == pytest.approx(least, abs=1e-5)
        assert tuple(sorted(found.pair)) in counting
        assert np.linalg.norm(found.points[0] - found.points[1]) == pytest.approx(found.distance, abs=1e-5)
    assert free > 20


@pytest.mark.parametrize("engine", ENGINES)
def test_threads_share_a_checker(engine):
    machine = load_quietly("ur5")
    checker = shapes_of(machine).guard(machine, engine=engine).checker
    rng = np.random.default_rng(15)
    Q = [machine.random(rng) for _ in range(40)]
    alone = [checker.report(q) for q in Q]
    assert any(alone)
    with ThreadPoolExecutor(4) as threads:
        assert list(threads.map(checker.report, Q)) == alone


@needs_native
def test_the_engine_refuses_shapes_and_pairs_that_do_not_exist():
    from pinik import _native
    from pinik.model.compiled import native_robot

    shapes = _native.Shapes(native_robot(load_quietly(SLIDER)))
    ball = _native.Geometry(_native.SolidKind.sphere, [0.5])
    with pytest.raises(ValueError, match="no joint 2"):
        shapes.add_shape(ball, 2, np.eye(3), np.zeros(3))
    assert shapes.add_shape(ball, 1, np.eye(3), np.zeros(3)) == 0
    with pytest.raises(ValueError, match="no shape 1"):
        shapes.add_pair(0, 1, 0)
    with pytest.raises(ValueError, match="another number of sizes"):
        _native.Geometry(_native.SolidKind.box, [1.0])
    with pytest.raises(ValueError, match="does not exist"):
        _native.Geometry.mesh(np.zeros((3, 3)), [[0, 1, 3]])
    with pytest.raises(ValueError, match="no triangles"):
        _native.Geometry.mesh(np.zeros((3, 3)), [])
    with pytest.raises(ValueError, match=r"\(nq,\)"):
        shapes.report(np.zeros(2))


def test_nothing_to_compare_is_an_infinite_clearance():
    machine = pinik.load(robot(link("a", '<collision><geometry><sphere radius="1"/></geometry></collision>')))
    found = machine.clearance(machine.neutral())
    assert (found.distance, found.pair, found.points) == (np.inf, None, None)
    assert machine.collisions(machine.neutral()) == []


def test_a_solution_and_angles_stand_for_their_configuration():
    """A ball on a slide beside another at 1 m: both have a radius of 0.1 m."""
    ball = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
    machine = load_quietly(
        robot(link("a"), link("b", ball), joint("x", "a", "b", '<axis xyz="1 0 0"/>', kind="prismatic"))
    )
    world = pinik.World()
    world.add_sphere("other", 0.1, [1.0, 0.0, 0.0])
    solution = machine.solve("b", position=[0.85, 0.0, 0.0])
    for given in (solution, solution.angles, solution.q):
        assert machine.clearance(given, world).distance == pytest.approx(-0.05, abs=1e-4)
        [touch] = machine.collisions(given, world)
        assert touch.depth == pytest.approx(0.05, abs=1e-4)
    assert machine.clearance({"x": 0.5}, world).distance == pytest.approx(0.3)
    for ask in (machine.collisions, machine.clearance):
        with pytest.raises(pinik.UnknownNameError, match="joint 'nose'"):
            ask({"nose": 1.0})
        with pytest.raises(pinik.InputError, match=r"^q must be"):
            ask(None)
