"""`pinik.Tracker(avoid=…)`: no tick ends where something touches, as coal and distances by hand see it."""

from __future__ import annotations

import coal
import numpy as np
import pinocchio
import pytest

import pinik
from bars import BALL, THICK, gap, planar, world_of
from collision_oracle import PlainCollisions
from engines import needs_native
from pinik import Target, TrackerStatus, World
from robots import load_quietly

ENGINES = ["python", pytest.param("native", marks=needs_native)]
TIP = "panda_hand_tcp"
TWO, THREE = (1.0, 0.8), (1.0, 0.8, 0.5)


def tracker_of(machine, start, engine, avoid, **words):
    return pinik.Tracker(
        machine, Target("tip", [1.0, 0.0, 0.0]), start, velocity=2.0, engine=engine, avoid=avoid, **words
    )


START = np.array([-0.6, 1.3])


def on_circle(machine, turn):
    """Where the tip of the arm that keeps its elbow is after it has turned as a whole."""
    return machine.placement("tip", np.add(START, [turn, 0.0])).translation


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd"])
def test_an_arm_without_a_joint_to_spare_stops_before_a_ball(engine, method):
    machine = load_quietly(planar(*TWO))
    centre = on_circle(machine, 0.9)
    tracker = tracker_of(machine, START, engine, world_of(centre), method=method)
    for turn in np.linspace(0.0, 0.9, 60):
        before = tracker.q
        wanted = on_circle(machine, turn)
        q = tracker(wanted)
        assert gap(machine, TWO, q, centre) > 0.0
        assert np.abs(q - before).max() <= 0.02 * (1.0 + 1e-9)
        reached = np.linalg.norm(machine.placement("tip", q).translation - wanted) <= 1e-6
        assert (tracker.status is TrackerStatus.OK) == reached
    for _ in range(60):
        q = tracker(wanted)
    assert tracker.status is TrackerStatus.BLOCKED
    assert {touch.pair for touch in tracker.collisions} == {("b1", "ball0")}
    assert tracker.message.startswith("what must not touch is in the way: b1 and the object ball0 overlap by ")
    assert tracker.position_error == pytest.approx(np.linalg.norm(machine.placement("tip", q).translation - wanted))
    assert 0.0 < gap(machine, TWO, q, centre) < 1e-3
    assert np.abs(tracker(wanted) - q).max() < 1e-4
    for turn in np.linspace(0.5, 0.2, 40):  # it is free to go back
        tracker(on_circle(machine, turn))
    assert tracker.status is TrackerStatus.OK
    assert tracker.collisions == ()
    assert tracker.message == str(TrackerStatus.OK)


@pytest.mark.parametrize("engine", ENGINES)
def test_an_arm_with_a_joint_to_spare_goes_out_of_the_way_and_stays_at_its_target(engine):
    """The tip moves on a line, and the elbow comes to a ball; without `avoid` the arm goes through it."""
    machine = load_quietly(planar(*THREE))
    start = np.array([0.9, -1.2, -0.6])
    line = machine.placement("tip", start).translation + np.outer(np.linspace(0.0, 0.1, 100), [1.0, 0.0, 0.0])
    plain = tracker_of(machine, start, engine, None)
    through = np.array([plain(place) for place in line])
    elbow = machine.placement("b1", through[70]).translation
    bar = machine.placement("b0", through[70]).rotation
    centre = elbow + bar @ np.array([-0.3, -(THICK / 2 + BALL) + 0.004, 0.0])
    assert min(gap(machine, THREE, q, centre) for q in through) < 0.0 < gap(machine, THREE, start, centre)
    tracker = tracker_of(machine, start, engine, world_of(centre))
    statuses = []
    for place in [*line, *line[-1:].repeat(20, axis=0)]:
        before = tracker.q
        q = tracker(place)
        assert gap(machine, THREE, q, centre) > 0.0
        assert np.abs(q - before).max() <= 0.02 * (1.0 + 1e-9)
        statuses.append(tracker.status)
        if tracker.status is TrackerStatus.OK:
            assert machine.placement("tip", q).translation == pytest.approx(place, abs=1e-6)
    assert statuses[-1] is TrackerStatus.OK
    assert TrackerStatus.BLOCKED not in statuses


@pytest.mark.parametrize("engine", ENGINES)
def test_a_start_that_touches_never_gets_deeper_and_is_no_success(engine):
    machine = load_quietly(planar(*TWO))
    side = machine.placement("b1", START)
    centre = side.act(np.array([0.4, THICK / 2 + BALL - 0.03, 0.0]))
    tracker = tracker_of(machine, START, engine, world_of(centre))
    depths = [-gap(machine, TWO, START, centre)]
    assert depths[0] == pytest.approx(0.03)
    tracker(on_circle(machine, 0.0))  # where it is
    assert tracker.status is TrackerStatus.BLOCKED
    assert tracker.collisions[0].depth == pytest.approx(0.03, abs=1e-6)
    for turn in np.linspace(0.0, 0.3, 20):  # deeper
        depths.append(-gap(machine, TWO, tracker(on_circle(machine, turn)), centre))
        assert tracker.status is TrackerStatus.BLOCKED
        assert tracker.collisions[0].pair == ("b1", "ball0")
    for turn in np.linspace(0.0, -0.3, 30):  # out of it
        q = tracker(on_circle(machine, turn))
        depths.append(-gap(machine, TWO, q, centre))
        if depths[-1] >= 0.0:
            assert tracker.status is TrackerStatus.BLOCKED
            assert tracker.collisions[0].depth == pytest.approx(depths[-1], abs=1e-5)
    assert (np.diff(depths) <= 1e-9).all()
    assert depths[-1] < 0.0
    assert tracker.status is TrackerStatus.OK


@pytest.mark.parametrize("engine", ENGINES)
def test_a_ball_right_behind_the_start_at_which_both_touch_leaves_it_where_it_is(engine):
    """Nothing lies before the ball: the first tick stays, and says what it would touch, with `q` free."""
    machine = load_quietly(planar(*TWO))
    side = machine.placement("b1", START)
    centre = side.act(np.array([0.4, THICK / 2 + BALL + 1e-5, 0.0]))
    tracker = tracker_of(machine, START, engine, world_of(centre))
    q = tracker(on_circle(machine, 0.2))
    assert tracker.status is TrackerStatus.BLOCKED
    assert gap(machine, TWO, q, centre) > 0.0
    assert machine.collisions(q, world_of(centre)) == []
    assert [touch.pair for touch in tracker.collisions] == [("b1", "ball0")]


@needs_native
def test_no_tick_of_the_panda_ends_in_a_box_or_in_itself_as_coal_sees_it():
    """A hand is led through a box and into the arm itself; every link is compared by coal, where Pinocchio puts it."""
    machine = load_quietly("panda")
    plain, counting = PlainCollisions(machine), set(machine.collision_pairs.counting)
    size, at = [0.1, 0.5, 0.5], np.array([0.55, 0.35, 0.4])
    world = World()
    world.add_box("box", size, at)
    box, there = coal.Box(*size), coal.Transform3s(np.eye(3), at)
    data, shapes = machine.model.createData(), plain.geometry.createData()

    def hits(q):
        pinocchio.updateGeometryPlacements(machine.model, data, plain.geometry, shapes, q)
        found = set()
        for shape, M, name in zip(plain.geometry.geometryObjects, shapes.oMg, plain.links, strict=True):
            result = coal.CollisionResult()
            own = coal.Transform3s(M.rotation, M.translation)
            if shape.parentJoint and coal.collide(shape.geometry, own, box, there, coal.CollisionRequest(), result):
                found.add(tuple(sorted((name, "box"))))
        return found | (plain.touching(q) & counting)

    start = machine.poses["default"]
    place = machine.placement(TIP, start).homogeneous
    assert not hits(start)
    avoiding = pinik.Tracker(machine, TIP, start, avoid=["self", world])
    heedless = pinik.Tracker(machine, TIP, start)
    statuses, through = set(), 0
    for way in ([0.25, 0.35, -0.1], [0.0, 0.0, 0.0], [-0.45, 0.0, -0.3], [-0.1, 0.2, 0.3]):
        target = place.copy()
        target[:3, 3] += way
        for _ in range(80):
            before = avoiding.q
            q = avoiding(target)
            through += bool(hits(heedless(target)))
            assert not hits(q)
            assert (np.abs(q - before) <= machine.velocity_limits / 100.0 * (1.0 + 1e-9)).all()
            statuses.add(avoiding.status)
            if avoiding.status is TrackerStatus.BLOCKED:
                named = {tuple(sorted(touch.pair)) for touch in avoiding.collisions}
                assert named
                assert named <= counting | {tuple(sorted((name, "box"))) for name in plain.links}
    assert through > 20
    assert {TrackerStatus.OK, TrackerStatus.BLOCKED} <= statuses


@needs_native
@pytest.mark.parametrize("method", ["dls", "pinv"])
def test_both_engines_keep_free_alike(method):
    machine = load_quietly(planar(*THREE))
    start = np.array([0.9, -1.2, -0.6])
    goal = machine.placement("tip", start).translation + np.array([0.3, -0.5, 0.0])
    centre = machine.placement("tip", start).translation + np.array([0.12, -0.25, 0.0])
    ways = []
    for engine in ("python", "native"):
        tracker = tracker_of(machine, start, engine, world_of(centre), method=method)
        ways.append([(tracker(goal), tracker.status, tracker.message) for _ in range(60)])
    for ours, theirs in zip(*ways, strict=True):
        assert ours[0] == pytest.approx(theirs[0], abs=1e-6)
        assert ours[1] is theirs[1]
    assert ways[0][-1][1] is TrackerStatus.BLOCKED


@pytest.mark.parametrize("engine", ENGINES)
def test_what_is_far_away_changes_nothing(engine):
    machine = load_quietly(planar(*THREE))
    start = np.array([0.9, -1.2, -0.6])
    goal = machine.placement("tip", start).translation + np.array([0.2, -0.2, 0.0])
    plain, guarded = (tracker_of(machine, start, engine, avoid) for avoid in (None, world_of(np.full(3, 9.0))))
    for _ in range(40):
        assert np.array_equal(plain(goal), guarded(goal))
        assert plain.status is guarded.status


@pytest.mark.parametrize("engine", ENGINES)
def test_it_keeps_the_version_of_the_world_that_it_was_made_with(engine):
    machine = load_quietly(planar(*TWO))
    centre = on_circle(machine, 0.4)
    world = world_of(centre)
    tracker, other = (tracker_of(machine, START, engine, world) for _ in range(2))
    world.remove("ball0")
    for turn in np.linspace(0.0, 0.4, 80):
        q = tracker(on_circle(machine, turn))
    assert tracker.status is TrackerStatus.BLOCKED
    assert [touch.pair for touch in tracker.collisions] == [("b1", "ball0")]
    assert gap(machine, TWO, q, centre) > 0.0
    late = tracker_of(machine, START, engine, world)
    for turn in np.linspace(0.0, 0.4, 80):
        late(on_circle(machine, turn))
    assert late.status is TrackerStatus.OK
    assert np.array_equal(other.q, START)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_reset_forgets_what_was_in_the_way(engine):
    machine = load_quietly(planar(*TWO))
    tracker = tracker_of(machine, START, engine, world_of(on_circle(machine, 0.4)))
    for turn in np.linspace(0.0, 0.4, 80):
        tracker(on_circle(machine, turn))
    assert tracker.collisions
    tracker.reset(START)
    assert (tracker.status, tracker.collisions) == (TrackerStatus.OK, ())


def test_what_cannot_be_avoided_is_refused_in_words():
    machine = load_quietly(planar(*TWO))
    with pytest.raises(pinik.InputError, match=r'avoid must be "self", a pinik\.World, or a list of these; got'):
        tracker_of(machine, START, "auto", "others")
    with pytest.raises(pinik.InputError, match="has no collision shapes"):
        pinik.Tracker(load_quietly("asr_twodof"), "Tip", avoid="self")
