"""`avoid=`: answers at which nothing touches, against closed forms of planar arms and against coal, called directly."""

from __future__ import annotations

import math
import pickle

import coal
import numpy as np
import pinocchio
import pytest

import pinik
from bars import BALL, THICK, bar, gap, planar, world_of
from collision_oracle import PlainCollisions
from engines import needs_native
from pinik import Status, World
from pinik.solving.options import Options
from robots import load_quietly
from urdf_texts import joint

ENGINES = ["python", pytest.param("native", marks=needs_native)]
TWO, THREE = planar(1.0, 0.8), planar(1.0, 1.0, 0.5)


def elbows(x: float, y: float) -> np.ndarray:
    """Both configurations (2, 2) of TWO with its tip at (x, y), the law of cosines says; j1 > 0 first."""
    bend = math.acos((x * x + y * y - 1.0 - 0.64) / 1.6)
    return np.array(
        [[math.atan2(y, x) - math.atan2(0.8 * math.sin(b), 1.0 + 0.8 * math.cos(b)), b] for b in (bend, -bend)]
    )


def ball_on(q: np.ndarray, depth: float, along: float = 0.5) -> np.ndarray:
    """The centre of a ball that goes this deep into the upper bar of an arm at q, from its left."""
    a = q[0]
    offset = THICK / 2 + BALL - depth
    return np.array([along * math.cos(a) - offset * math.sin(a), along * math.sin(a) + offset * math.cos(a), 0.0])


def touches_ball(machine: pinik.Robot, q: np.ndarray, centre: np.ndarray) -> bool:
    """Whether a ball touches a bar of TWO or THREE, by hand."""
    return gap(machine, [1.0, 0.8] if len(q) == 2 else [1.0, 1.0, 0.5], q, centre) <= 0.0


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd"])
def test_of_two_elbows_the_free_one_is_taken(engine, method):
    machine = load_quietly(TWO)
    both = elbows(1.1, 0.6)
    for here, other in ((both[0], both[1]), (both[1], both[0])):
        world = world_of(ball_on(here, 0.02))
        plain = machine.solve("tip", method=method, position=[1.1, 0.6, 0], q0=here, engine=engine)
        assert plain.q == pytest.approx(here, abs=1e-3)
        found = machine.solve("tip", method=method, position=[1.1, 0.6, 0], q0=here, engine=engine, avoid=world)
        assert found.status is Status.CONVERGED
        assert found.q == pytest.approx(other, abs=1e-3)
        assert found.restarts >= 1
        assert found.collisions == ()


def test_two_bones_take_the_other_elbow_too():
    machine = load_quietly(TWO)
    both = elbows(1.1, 0.6)
    world = world_of(ball_on(both[0], 0.02))
    found = machine.solve("tip", method="two_bone", position=[1.1, 0.6, 0], q0=both[0], avoid=world)
    assert found.q == pytest.approx(both[1], abs=1e-9)
    stuck = machine.solve("tip", method="two_bone", position=[1.1, 0.6, 0], q0=both[0], avoid=world, elbow="down")
    up = machine.solve("tip", method="two_bone", position=[1.1, 0.6, 0], q0=both[0], avoid=world, elbow="up")
    assert {stuck.status, up.status} == {Status.CONVERGED, Status.COLLIDING}
    many = machine_many(machine, [[1.1, 0.6, 0]], both[0], world, "two_bone")
    assert many.q[0] == pytest.approx(both[1], abs=1e-9)


def machine_many(machine, places, q0, world, method="dls", **words):
    return pinik.solve_many(machine, "tip", places, method, q0=q0, avoid=world, **words)


@pytest.mark.parametrize("engine", ENGINES)
def test_where_both_elbows_touch_the_shallower_is_told_with_names_and_depth(engine):
    machine = load_quietly(TWO)
    both = elbows(1.1, 0.6)
    deep, shallow = ball_on(both[0], 0.03), ball_on(both[1], 0.012)
    world = world_of(deep, shallow)
    found = machine.solve("tip", position=[1.1, 0.6, 0], q0=both[0], engine=engine, avoid=world, restarts=10)
    assert found.status is Status.COLLIDING
    assert not found.success
    assert found.q == pytest.approx(both[1], abs=1e-6)
    assert found.position_error < 1e-6
    (touch,) = found.collisions
    assert set(touch.pair) == {"b0", "ball1"}
    assert touch.depth == pytest.approx(0.012, abs=1e-6)
    assert (
        found.message == "reaches the target, but b0 and the object ball1 overlap by 1.2 cm; both answers found collide"
    )
    assert found.chosen_from == 2
    with pytest.raises(pinik.SolveError, match=r"b0 and the object ball1 overlap by 1\.2 cm"):
        found.raise_for_status()
    document = found.to_dict()
    assert document["status"] == "COLLIDING"
    assert document["collisions"] == [{"pair": ["b0", "ball1"], "with_world": True, "depth_m": touch.depth}]
    again = pickle.loads(pickle.dumps(found))
    assert [one.pair for one in again.collisions] == [("b0", "ball1")]
    assert again.message == found.message
    alone = machine.solve("tip", position=[1.1, 0.6, 0], q0=both[0], engine=engine, avoid=world, restarts=0)
    assert alone.status is Status.COLLIDING
    assert alone.q == pytest.approx(both[0], abs=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_where_the_same_answers_collide_again_and_again_the_attempts_end_early(engine):
    """An arm of two bars has two answers; the 56th attempt is the last one."""
    machine = load_quietly(TWO)
    both = elbows(1.1, 0.6)
    world = world_of(ball_on(both[0], 0.03), ball_on(both[1], 0.012))
    found = machine.solve("tip", position=[1.1, 0.6, 0], q0=both[0], engine=engine, avoid=world)
    assert found.status is Status.COLLIDING
    assert (found.restarts, found.chosen_from) == (55, 2)
    assert found.message.endswith("; both answers found collide")


@pytest.mark.parametrize("engine", ENGINES)
def test_answers_that_differ_by_whole_turns_are_one(engine):
    """Hinges with a range of two turns and more reach each elbow in many ways, at which the same touches."""
    machine = load_quietly(
        planar(1.0, 0.8, limits=(-9.0, 9.0)).replace('lower="-3.0" upper="3.0"', 'lower="-9" upper="9"')
    )
    both = elbows(1.1, 0.6)
    world = world_of(ball_on(both[0], 0.03), ball_on(both[1], 0.012))
    for q0 in (both[0], both[0] + [2 * math.pi, -2 * math.pi], [math.pi + both[0][0], both[0][1] - math.pi]):
        found = machine.solve("tip", position=[1.1, 0.6, 0], q0=q0, engine=engine, avoid=world)
        assert (found.status, found.chosen_from) == (Status.COLLIDING, 2)
        assert found.restarts == 55


@pytest.mark.parametrize("engine", ENGINES)
def test_where_answers_are_not_isolated_all_attempts_are_made(engine):
    """Three bars reach a point in infinitely many ways; a ball around all holds every one."""
    machine = load_quietly(planar(1.0, 1.0, 0.5))
    world = World()
    world.add_sphere("room", 1.5, [0.0, 0.0, 0.0])
    found = machine.solve("tip", position=[0.9, 0.6, 0], engine=engine, avoid=world, restarts=70)
    assert (found.status, found.restarts) == (Status.COLLIDING, 70)
    assert found.chosen_from > 10
    assert found.message.endswith(f"; all {found.chosen_from} answers found collide")


@needs_native
def test_the_answers_that_all_collide_are_those_that_solve_all_finds_and_collide_as_pinocchio_sees_it():
    machine = load_quietly("ur5")
    plain, counting = PlainCollisions(machine), set(machine.collision_pairs.counting)
    rng = np.random.default_rng(8)
    ended_early = equal = poses_without = 0
    for _ in range(250):
        aim = machine.placement("tool0", machine.random(rng))
        found = machine.solve("tool0", placement=aim, avoid="self")
        if found.success:
            continue
        poses_without += 1
        others = machine.solve_all("tool0", placement=aim)
        assert all(plain.touching(q) & counting for q in others)
        distinct: list[np.ndarray] = []
        for q in others:
            if all(np.abs(np.sin(0.5 * (q - other))).max() > 0.005 for other in distinct):
                distinct.append(q)
        equal += found.chosen_from == len(distinct)
        ended_early += found.restarts < 100
    assert poses_without > 8
    assert equal >= 0.8 * poses_without
    assert ended_early >= 0.8 * poses_without


@pytest.mark.parametrize("engine", ENGINES)
def test_a_redundant_arm_goes_out_of_a_slight_touch(engine):
    """The limits of the first hinge leave it hardly more than the way out, so that every attempt ends in the touch."""
    q0 = np.array([0.3, 0.8, 0.5])
    machine = load_quietly(planar(1.0, 1.0, 0.5, limits=(0.29, 0.34)))
    position = machine.placement("tip", q0).translation
    # The ball lies to the right of the first bar, and touches it below j0 = 0.335.
    right = np.array([0.9 * math.cos(0.335), 0.9 * math.sin(0.335), 0.0])
    ball = right + (THICK / 2 + BALL) * np.array([math.sin(0.335), -math.cos(0.335), 0.0])
    assert touches_ball(machine, q0, ball)
    found = machine.solve("tip", position=position, q0=q0, engine=engine, avoid=world_of(ball), restarts=2, seed=3)
    assert found.status is Status.CONVERGED
    assert found.restarts == 2
    assert found.q[0] > 0.3349
    assert machine.placement("tip", found.q).translation == pytest.approx(position, abs=1e-4)
    assert not touches_ball(machine, found.q, ball)


@pytest.fixture(scope="module")
def panda():
    return load_quietly("panda")


def poses(machine: pinik.Robot, count: int, seed: int) -> list[pinocchio.SE3]:
    rng = np.random.default_rng(seed)
    return [machine.placement("panda_hand_tcp", machine.random(rng)) for _ in range(count)]


@needs_native
def test_no_answer_of_the_panda_touches_as_pinocchio_sees_it(panda):
    """Each pose is that of a configuration where links touch, from which the solve begins."""
    plain, counting = PlainCollisions(panda), set(panda.collision_pairs.counting)
    rng = np.random.default_rng(1)
    solved, asked = 0, 0
    while asked < 25:
        q = panda.random(rng)
        if not panda.collisions(q):
            continue
        assert plain.touching(q) & counting
        asked += 1
        found = panda.solve("panda_hand_tcp", placement=panda.placement("panda_hand_tcp", q), q0=q, avoid="self")
        touching = plain.touching(found.q) & counting
        assert found.success == (not touching)
        assert {tuple(sorted(touch.pair)) for touch in found.collisions} == touching
        assert found.success or found.status is Status.COLLIDING
        assert found.position_error < 1e-4
        solved += found.success
    assert solved > 5


@needs_native
def test_both_engines_come_to_the_same_verdict(panda):
    for place in poses(panda, 10, 2):
        words = {"placement": place, "avoid": "self", "restarts": 2}
        ours, theirs = (panda.solve("panda_hand_tcp", engine=engine, **words) for engine in ("native", "python"))
        assert ours.status is theirs.status
        assert [touch.pair for touch in ours.collisions] == [touch.pair for touch in theirs.collisions]
        if ours.restarts == theirs.restarts and ours.success:
            assert ours.q == pytest.approx(theirs.q, abs=1e-5)


@needs_native
def test_an_arm_above_a_table_goes_not_into_it():
    """Every link of the ur5 is compared with the table by coal alone, where Pinocchio puts it."""
    machine = load_quietly("ur5")
    plain = PlainCollisions(machine)
    size, at = [0.8, 1.2, 0.06], np.array([0.6, 0.0, -0.05])
    world = World()
    world.add_box("table", size, at)
    table, place = coal.Box(*size), coal.Transform3s(np.eye(3), at)
    data, shapes = machine.model.createData(), plain.geometry.createData()

    def hits(q):
        pinocchio.updateGeometryPlacements(machine.model, data, plain.geometry, shapes, q)
        for shape, M in zip(plain.geometry.geometryObjects, shapes.oMg, strict=True):
            result = coal.CollisionResult()
            there = coal.Transform3s(M.rotation, M.translation)
            if shape.parentJoint and coal.collide(shape.geometry, there, table, place, coal.CollisionRequest(), result):
                return True
        return False

    rng = np.random.default_rng(4)
    kept, turned = 0, 0
    for _ in range(40):
        aim = machine.placement("tool0", machine.random(rng))
        without = machine.solve("tool0", placement=aim)
        found = machine.solve("tool0", placement=aim, avoid=world)
        assert found.success != hits(found.q)
        kept += found.success
        turned += found.success and hits(without.q)
    assert kept > 20
    assert turned > 2


@pytest.mark.parametrize("engine", ENGINES)
def test_what_the_target_does_not_move_counts_with_its_start(engine):
    """A second arm lies in the way, at rest or put aside by q0; locked joints stay where they are as well."""
    other = joint("k", "base", "o", '<origin xyz="0 0.5 0"/><axis xyz="0 0 1"/>')
    parts = TWO.replace("</robot>", f"{bar('o', 0.6)}{other}</robot>")
    machine = load_quietly(parts)
    down = elbows(1.1, 0.6)[1]
    q0 = machine.configuration({"j0": down[0], "j1": down[1], "k": 0.0})
    through = machine.solve("tip", position=[1.1, 0.6, 0], q0=q0, engine=engine)
    assert {pair for one in machine.collisions(through.q) for pair in one.pair} >= {"o"}
    found = machine.solve("tip", position=[1.1, 0.6, 0], q0=q0, engine=engine, avoid="self")
    assert found.success
    assert found.angles["k"] == 0.0
    assert found.angles["j1"] > 0.0
    aside = machine.configuration({"j0": down[0], "j1": down[1], "k": 2.5})
    kept = machine.solve("tip", position=[1.1, 0.6, 0], q0=aside, engine=engine, avoid="self")
    assert kept.angles["j1"] < 0.0
    locked = machine.solve("tip", position=[1.1, 0.6, 0], q0=q0, engine=engine, avoid="self", locked=["j0"], restarts=5)
    assert locked.status is Status.COLLIDING
    nothing = machine.solve("tip", position=[1.1, 0.6, 0], q0=q0, engine=engine, avoid="self", locked=["j0", "j1"])
    assert nothing.status is Status.COLLIDING


@pytest.mark.parametrize("engine", ENGINES)
def test_solve_all_leaves_out_and_counts_what_collides(engine):
    machine = load_quietly(TWO)
    both = elbows(1.1, 0.6)
    words = {"position": [1.1, 0.6, 0], "engine": engine, "restarts": 8}
    free = machine.solve_all("tip", avoid=world_of(np.array([5.0, 0, 0])), **words)
    assert (len(free), free.colliding) == (2, 0)
    found = machine.solve_all("tip", avoid=world_of(ball_on(both[0], 0.02)), **words)
    assert found.q == pytest.approx(both[1:], abs=1e-6)
    assert found.colliding == 1
    assert "1 answer and 1 that collides" in found.message
    assert found.to_dict()["colliding"] == 1
    world = world_of(ball_on(both[0], 0.02), ball_on(both[1], 0.011))
    none = machine.solve_all("tip", avoid=world, **words)
    assert (len(none), none.colliding, none.status) == (0, 2, Status.COLLIDING)
    assert "overlap by 1.1 cm" in none.message


def test_the_closed_form_leaves_out_what_collides():
    both = elbows(1.1, 0.6)
    world = world_of(ball_on(both[0], 0.02))
    found = pinik.solve_all(load_quietly(TWO), "tip", "two_bone", position=[1.1, 0.6, 0], avoid=world)
    assert found.q == pytest.approx(both[1:], abs=1e-9)
    assert (found.colliding, found.is_complete) == (1, True)


@pytest.mark.parametrize("engine", ENGINES)
def test_solve_many_has_a_status_for_each(engine):
    machine = load_quietly(TWO)
    both, other = elbows(1.1, 0.6), elbows(-0.9, 0.9)
    world = world_of(ball_on(both[0], 0.03), ball_on(both[1], 0.02))
    places = np.array([[1.1, 0.6, 0], [-0.9, 0.9, 0], [3.0, 0, 0]] * 3)
    many = machine_many(machine, places, other[0], world, engine=engine, threads=2, restarts=8)
    assert list(many.status) == [Status.COLLIDING, Status.CONVERGED, Status.UNREACHABLE] * 3
    assert many.success.tolist() == [False, True, False] * 3
    assert many.q[0] == pytest.approx(both[1], abs=1e-6)
    assert many[3].collisions[0].depth == pytest.approx(0.02, abs=1e-6)
    assert "ball1" in many[0].message


@pytest.mark.parametrize("engine", ENGINES)
def test_a_point_of_a_path_that_touches_is_a_miss(engine):
    """On the circle about its base, an arm of two bars that keeps its elbow turns as a whole: through the ball."""
    machine = load_quietly(TWO)
    start = elbows(1.2, 0.0)[0]
    turns = np.linspace(0.0, 1.2, 25)
    path = np.column_stack([1.2 * np.cos(turns), 1.2 * np.sin(turns), np.zeros(len(turns))])
    centre = ball_on(np.add(start, [0.6, 0.0]), 0.0, along=0.3)
    free = [not touches_ball(machine, np.add(start, [turn, 0.0]), centre) for turn in turns]
    assert 5 < sum(free) < 24
    followed = pinik.track(machine, "tip", path, start, engine=engine, avoid=world_of(centre), restarts=0)
    assert followed.reached.tolist() == free
    assert {status for status in followed.status if status is not Status.CONVERGED} == {Status.COLLIDING}
    for k in np.flatnonzero(~followed.reached):  # held at the last point that was reached
        assert not touches_ball(machine, followed.q[k], centre)
    jumps = pinik.track(machine, "tip", path, start, engine=engine, avoid=world_of(centre), restarts=10)
    assert all(not touches_ball(machine, q, centre) for q in jumps.q)
    assert jumps.reached.all()
    assert jumps.jumps


@pytest.mark.parametrize("engine", ENGINES)
def test_a_redundant_arm_goes_round_on_its_path(engine):
    """The tip stands still for an arm of three bars; as the ball allows no other place, the elbow moves aside."""
    machine = load_quietly(THREE)
    q0 = np.array([0.3, 0.8, 0.5])
    position = machine.placement("tip", q0).translation
    ball = ball_on(q0, 0.005, along=0.9)
    followed = pinik.track(machine, "tip", [position] * 3, q0, engine=engine, avoid=world_of(ball))
    assert followed.success
    assert all(not touches_ball(machine, q, ball) for q in followed.q)
    assert np.abs(followed.q - q0).max() < 0.2


def test_options_hold_the_world_as_it_was():
    world = World()
    world.add_sphere("ball", 0.1, [1.0, 0.0, 0.0])
    before = Options(avoid=world)
    assert hash(before) == hash(Options(avoid=world))
    assert before == Options(avoid=[world])
    assert before != Options(avoid=["self", world])
    assert Options(avoid="self") == Options(avoid=["self"])
    assert Options() == Options(avoid=[]) == Options(avoid=None) == Options(avoid=World())
    world.add_sphere("other", 0.1, [2.0, 0.0, 0.0])
    assert before != Options(avoid=world)
    assert [solid.owner for solid in before.avoid.around] == ["ball"]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_solve_sees_the_world_as_it_is_now(engine):
    """The compiled problem of the last call is not taken for another version of the world."""
    machine = load_quietly(TWO)
    both = elbows(1.1, 0.6)
    world = world_of(np.array([5.0, 0.0, 0.0]))
    words = {"position": [1.1, 0.6, 0.0], "q0": both[0], "engine": engine, "avoid": world}
    for _ in range(3):
        assert machine.solve("tip", **words).q == pytest.approx(both[0], abs=1e-6)
    prepared = pinik.prepare(machine, "tip", position=[1.1, 0.6, 0.0], engine=engine, avoid=world)
    world.add_sphere("new", BALL, ball_on(both[0], 0.02))
    assert machine.solve("tip", **words).q == pytest.approx(both[1], abs=1e-6)
    assert prepared(q0=both[0]).q == pytest.approx(both[0], abs=1e-6)
    world.remove("new")
    assert machine.solve("tip", **words).q == pytest.approx(both[0], abs=1e-6)
    copy = pickle.loads(pickle.dumps(pinik.prepare(machine, "tip", position=[1, 1, 0], engine=engine, avoid=world)))
    assert [solid.owner for solid in copy.options.avoid.around] == ["ball0"]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_start_may_touch(engine):
    machine = load_quietly(TWO)
    both, other = elbows(1.1, 0.6), elbows(-0.9, 0.9)
    found = machine.solve(
        "tip", position=[-0.9, 0.9, 0], q0=both[0], engine=engine, avoid=world_of(ball_on(both[0], 0.03))
    )
    assert found.success
    assert min(np.abs(found.q - one).max() for one in other) < 1e-4


@pytest.mark.parametrize("value", [3, "others", ["self", 1], [None]])
def test_anything_else_is_refused_in_words(value):
    words = r'avoid must be "self", a pinik\.World, or a list of these; got'
    with pytest.raises(pinik.InputError, match=words) as error:
        pinik.solve(load_quietly(TWO), "tip", position=[1, 0, 0], avoid=value)
    assert error.value.argument == "avoid"


def test_a_robot_without_collision_shapes_says_so():
    with pytest.raises(pinik.InputError, match="has no collision shapes"):
        pinik.solve(load_quietly("asr_twodof"), "Tip", position=[0.2, 0.2, 0.9], avoid="self")
