"""Instances among obstacles: what touches is found, and what must not touch does not."""

from __future__ import annotations

import coal
import numpy as np
import pinocchio
import pytest

import pinik
from collision_oracle import PlainCollisions
from pinik.viewer.simulation.another_robot import with_robot
from pinik.viewer.simulation.obstacles import MOST_OBSTACLES, Obstacles
from pinik.viewer.simulation.session import Session
from robots import load_quietly
from stand_ins import Clock

PANDA = load_quietly("panda")
BALL = 0.11


def session(*methods, avoid=True):
    shown = Session(PANDA, methods, clock=Clock())
    shown.set_motion("hand")
    shown.set_contacts(True, avoid)
    shown.contacts.take(shown.contacts.load())
    return shown


def put(shown, kind, size, position):
    shown.obstacles.add(kind, size, position)
    shown.set_obstacles(shown.obstacles)


def coal_touches(q, shape, position):
    """Whether coal itself finds a link in touch with a shape that stands at a place in the world."""
    plain = PlainCollisions(PANDA)
    data, placed = PANDA.model.createData(), plain.geometry.createData()
    pinocchio.updateGeometryPlacements(PANDA.model, data, plain.geometry, placed, q)
    still = coal.Transform3s(np.eye(3), np.asarray(position, dtype=float))
    for own, at, link in zip(plain.geometry.geometryObjects, placed.oMg, plain.links, strict=True):
        moved = coal.Transform3s(at.rotation, at.translation)
        request, result = coal.CollisionRequest(), coal.CollisionResult()
        if link != "panda_link0" and coal.collide(own.geometry, moved, shape, still, request, result):
            return True
    return False


@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
def test_an_instance_that_avoids_touches_nothing_while_the_ball_circles_round_a_sphere(method):
    shown = session(method)
    place = [0.36, 0.06, 0.84]
    put(shown, "sphere", [BALL], place)
    shown.set_motion("curve")
    touched = 0
    for _ in range(120):
        shown.step()
        touched += coal_touches(shown.instances[0].q, coal.Sphere(BALL), place)
    assert touched == 0


def test_without_avoiding_the_same_circle_touches_the_sphere():
    shown = session("dls", avoid=False)
    place = [0.36, 0.06, 0.84]
    put(shown, "sphere", [BALL], place)
    shown.set_motion("curve")
    touched = False
    for _ in range(120):
        shown.step()
        touched = touched or coal_touches(shown.instances[0].q, coal.Sphere(BALL), place)
    assert touched


def test_what_touches_is_what_coal_finds():
    shown = session("dls", avoid=False)
    place = [0.45, 0.0, 0.5]
    put(shown, "box", [0.2, 0.1, 0.3], place)
    rng = np.random.default_rng(0)
    seen = set()
    for _ in range(60):
        q = PANDA.random(rng)
        ours = any("obstacle 1" in pair for pair in shown.contacts.touching(q))
        assert ours == coal_touches(q, coal.Box(0.2, 0.1, 0.3), place)
        seen.add(ours)
    assert seen == {True, False}


def test_a_ball_inside_an_obstacle_is_not_reached_and_says_why():
    shown = session("dls")
    shown.step()
    ball = shown.balls[0].position + np.array([0.0, 0.2, 0.0])
    shown.step()
    before = shown.instances[0].q
    put(shown, "sphere", [0.1], ball)
    shown.move_ball(0, ball)
    for _ in range(5):
        shown.step()
    one = shown.instances[0]
    assert one.status == "COLLIDING"
    assert (one.q == before).all()
    verdict = one.verdict()
    assert "obstacle 1" in verdict.message
    assert verdict.position_error == pytest.approx(0.2, abs=1e-3)
    assert not one.last.reached
    shown.move_ball(0, ball + np.array([0.0, 0.2, 0.1]))
    shown.step()
    assert one.status == "CONVERGED"


def test_an_obstacle_that_is_put_onto_a_robot_drives_it_away():
    shown = session("dls")
    for _ in range(3):
        shown.step()
    elbow = PANDA.placement("panda_link4", shown.instances[0].q).translation
    put(shown, "sphere", [0.05], elbow)
    assert coal_touches(shown.instances[0].q, coal.Sphere(0.05), elbow)
    shown.step()
    assert not coal_touches(shown.instances[0].q, coal.Sphere(0.05), elbow)
    assert shown.instances[0].status == "CONVERGED"


def test_a_robot_without_collision_shapes_says_so():
    shown = Session(load_quietly("asr_twodof"), ["dls"], clock=Clock())
    shown.set_contacts(True, True)
    assert shown.contacts.waits
    with pytest.raises(pinik.InputError) as refusal:
        shown.contacts.load()
    shown.contacts.take(refusal.value)
    assert not shown.contacts.waits
    assert "no collision shapes" in shown.contacts.why_not
    shown.step()  # and goes on without


def test_another_robot_keeps_obstacles_and_switches():
    shown = session("dls")
    put(shown, "box", [0.1, 0.1, 0.1], [1.0, 0.0, 0.0])
    other = with_robot(shown, load_quietly("ur5"))
    assert [obstacle.kind for obstacle in other.obstacles] == ["box"]
    assert other.contacts.on
    assert other.contacts.avoids
    assert other.contacts.waits


@pytest.mark.parametrize(
    ("kind", "size", "position", "words"),
    [
        ("cone", [1.0], [0, 0, 0], "cone"),
        ("box", [1.0], [0, 0, 0], "3 numbers"),
        ("sphere", [0.1, 0.2], [0, 0, 0], "1 number"),
        ("sphere", [0.0], [0, 0, 0], "positive"),
        ("sphere", [11.0], [0, 0, 0], "at most 10 m"),
        ("sphere", [1.0], [0, float("nan"), 0], "position"),
    ],
)
def test_what_is_no_obstacle_is_refused_in_words(kind, size, position, words):
    obstacles = Obstacles()
    with pytest.raises((pinik.InputError, pinik.UnknownNameError), match=words):
        obstacles.add(kind, size, position)
    assert len(obstacles) == 0


def test_obstacles_are_counted_moved_resized_and_removed():
    obstacles = Obstacles()
    for k in range(MOST_OBSTACLES):
        obstacles.add("sphere", [0.1], [k, 0.0, 0.0])
    with pytest.raises(pinik.InputError, match="at most"):
        obstacles.add("sphere", [0.1], [0.0, 0.0, 0.0])
    obstacles.put(3, [0.0, 5.0, 0.0])
    obstacles.resize(3, [0.2])
    obstacles.remove(0)
    assert (obstacles[2].position, obstacles[2].size) == ((0.0, 5.0, 0.0), (0.2,))
    assert [solid.owner for solid in obstacles.solids] == [f"obstacle {k + 1}" for k in range(MOST_OBSTACLES - 1)]
    with pytest.raises(pinik.InputError, match="no obstacle 7"):
        obstacles.put(7, [0.0, 0.0, 0.0])
