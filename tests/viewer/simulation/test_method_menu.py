"""The closed form beside the other methods: where it is offered, refused in words, waits, and makes room."""

from __future__ import annotations

import math

import numpy as np
import pytest

import pinik
from judge import plain_placement
from pinik.viewer.protocol.messages import apply
from pinik.viewer.protocol.setup import apply_setup, read_setup, write_setup
from pinik.viewer.protocol.state import session_state
from pinik.viewer.simulation.another_robot import with_robot
from pinik.viewer.simulation.session import Session
from robots import load_quietly
from stand_ins import Clock, snapshot

EVERY_ROBOTS = ["ccd", "jt", "pinv", "dls"]
ALONE = "is not moved by two parallel hinges alone"


def session(robot, methods=("dls", "two_bone"), **options):
    return Session(robot, methods, clock=Clock(), **options)


def steps(of, count):
    for _ in range(count):
        of.step()


def missed(of, instance, ball=0):
    at = plain_placement(of.robot, of.balls[ball].frame, instance.q).translation
    return float(np.linalg.norm(at - of.balls[ball].position))


# The first ball's frame lies away from the second of two parallel hinges, or in that hinge itself: see their URDFs.
OFFERED = ("two_link", "asr_twodof", "double_pendulum_simple")
NOT_OFFERED = ("double_pendulum", "double_pendulum_continuous", "arm", "lion", "panda")


@pytest.mark.parametrize("name", [*OFFERED, *NOT_OFFERED])
def test_it_is_offered_where_two_parallel_hinges_carry_a_ball(name):
    offers = session_state(Session(load_quietly(name)))["methods"]
    assert offers == ([*EVERY_ROBOTS, "two_bone"] if name in OFFERED else EVERY_ROBOTS)


@pytest.mark.parametrize("name", ["arm", "lion", "panda"])
def test_elsewhere_it_is_refused_with_the_reason_and_nothing_is_lost(name):
    robot = load_quietly(name)
    with pytest.raises(pinik.InputError, match=f"two_bone cannot chase a ball here: .* {ALONE}: .* joints move it"):
        session(robot)
    shown = session(robot, ["ccd"])
    assert session_state(shown)["methods"] == EVERY_ROBOTS
    shown.set_motion("curve")
    steps(shown, 3)
    before = snapshot(shown)
    for ask in (
        lambda: shown.set_method(0, "two_bone"),
        lambda: apply(shown, {"type": "method", "instance": 0, "method": "two_bone"}),
        lambda: apply_setup(shown, read_setup(write_setup(shown).replace("methods=ccd", "methods=two_bone"))),
    ):
        with pytest.raises(pinik.InputError, match=ALONE):
            ask()
        assert snapshot(shown) == before


def test_it_is_never_taken_unasked(two_link):
    assert [one.solver.name for one in Session(two_link).instances] == EVERY_ROBOTS
    assert [one.solver.name for one in Session(two_link, ["two_bone"]).instances] == ["two_bone", "ccd", "jt", "pinv"]


def test_one_iteration_a_step_reaches_every_place_in_reach(two_link):
    shown = session(two_link)
    rng = np.random.default_rng(2)
    for _ in range(50):
        place = plain_placement(two_link, "tip", two_link.random(rng)).translation
        shown.move_ball(0, place)
        shown.step()
        assert missed(shown, shown.instances[1]) < 1e-12
    summary = shown.summaries[1]
    assert (summary.steps, summary.mean_iterations, summary.efficiency) == (50, 1.0, 1.0)
    assert summary.mean_error < 1e-12
    assert (summary.mean_joint_updates, shown.instances[1].last.iterations) == (0.0, 1)


def test_a_ball_off_the_plane_is_unreachable_and_the_plane_is_named(two_link):
    shown = session(two_link)
    shown.move_ball(0, [0.5, 0.3, 0.12])
    steps(shown, 2)
    verdict = shown.instances[1].verdict()
    assert verdict.status == "UNREACHABLE"
    assert verdict.position_error == pytest.approx(0.12, abs=1e-12)
    assert "lies 12 cm off the plane in which tip moves, whose normal is the z axis of the world" in verdict.message


def test_a_ball_that_only_limits_keep_away_is_unreachable_as_well():
    shown = session(load_quietly("double_pendulum_simple"))
    wanted = plain_placement(shown.robot, shown.balls[0].frame, np.array([0.4, 1.0])).translation
    shown.move_ball(0, wanted)
    shown.step()
    verdict = shown.instances[1].verdict()
    assert (verdict.status, len(verdict.active_limits)) == ("UNREACHABLE", 2)
    assert "at their only values" in verdict.message
    shown.change_settings(limits=False)
    shown.step()
    assert shown.instances[1].verdict().status == "CONVERGED"
    assert missed(shown, shown.instances[1]) < 1e-12


def changed(of):
    return of.instances[1].q.tobytes(), of.instances[1].solver


def test_while_it_cannot_do_what_is_asked_it_waits_and_says_why(two_link):
    shown = session(two_link)
    shown.set_motion("curve")
    steps(shown, 5)
    before = changed(shown)
    shown.add_ball("link2")
    steps(shown, 5)
    one, other = shown.instances[1], shown.instances[0]
    assert one.verdict() == ("REFUSED", "waiting: two_bone takes only one target; got 2", None, None, ())
    assert (one.status, one.counted, one.last) == ("REFUSED", False, None)
    assert changed(shown) == before
    assert other.status != "REFUSED"
    assert [summary.steps for summary in shown.summaries] == [5, 0]
    shown.set_mode(1, "off")
    shown.move_ball(0, [0.5, 0.3, 0.0])
    shown.step()
    assert (one.status, shown.summaries[1].steps) == ("CONVERGED", 1)
    assert missed(shown, one) < 1e-12

    shown.balls[0].orient(True, [0.0, 0.0, 0.5])
    before = changed(shown)
    steps(shown, 5)
    assert "only a position; target 'tip' has an orientation" in one.verdict().message
    assert changed(shown) == before
    shown.balls[0].orient(False, [0.0, 0.0, 0.0])
    shown.step()
    assert one.status == "CONVERGED"

    shown.balls[0].release("y")
    shown.step()
    assert "only a whole position; target 'tip' leaves an axis free" in one.verdict().message
    shown.balls[0].release("")
    shown.step()
    assert one.status == "CONVERGED"

    shown.set_mode(0, "off")
    shown.set_mode(1, "on")
    shown.step()
    assert one.verdict().message.startswith(f"waiting: frame 'link2' {ALONE}: it lies on the axis of joint 'joint2'")
    shown.set_method(1, "ccd")
    shown.step()
    assert shown.instances[1].status != "REFUSED"


def test_what_is_offered_follows_the_balls(two_link):
    shown = session(two_link, ["dls"])
    shown.add_ball("link1")
    assert "two_bone" in shown.offered
    link = write_setup(shown).replace("methods=dls", "methods=two_bone")
    shown.balls.remove(0)
    assert shown.offered == EVERY_ROBOTS
    with pytest.raises(pinik.InputError, match=f"frame 'link1' {ALONE}: only one joint moves it"):
        shown.set_method(0, "two_bone")
    apply_setup(shown, read_setup(link))  # whose balls come first
    assert shown.instances[0].solver.name == "two_bone"
    assert write_setup(shown) == link


def test_its_parameters_go_through_a_set_up(two_link):
    shown = session(two_link)
    shown.set_parameter(1, "elbow", "up")
    link = write_setup(shown)
    other = Session(two_link, ["ccd", "ccd"], clock=Clock())
    apply_setup(other, read_setup(link))
    assert (other.instances[1].solver, write_setup(other)) == (pinik.TwoBoneSolver(elbow="up"), link)
    for elbow, sign in (("up", -1.0), ("down", 1.0)):
        other.set_parameter(1, "elbow", elbow)
        other.step()
        assert math.copysign(1.0, other.instances[1].q[1]) == sign


def test_with_a_robot_that_it_cannot_move_it_makes_room_and_says_so(two_link, arm):
    shown = session(two_link, ["ccd", "jt", "dls", pinik.TwoBoneSolver(elbow="up")])
    shown.running = True
    there = with_robot(shown, arm)
    assert [one.solver.name for one in there.instances] == ["ccd", "jt", "dls", "pinv"]
    (note,) = there.notes
    assert note.startswith(f"instance 4 now uses pinv: two_bone cannot chase a ball here: frame 'tip' {ALONE}: 12")
    steps(there, 2)
    assert all(one.status == "CONVERGED" for one in there.instances)
    back = with_robot(there, two_link)
    assert (back.notes, "two_bone" in back.offered) == ([], True)
    kept = with_robot(shown, load_quietly("asr_twodof"))
    assert (kept.notes, kept.instances[3].solver) == ([], pinik.TwoBoneSolver(elbow="up"))


def test_instances_that_make_room_take_different_methods(two_link, arm):
    there = with_robot(session(two_link, ["two_bone", "two_bone"]), arm)
    assert sorted(one.solver.name for one in there.instances) == sorted(EVERY_ROBOTS)
    assert [note[:10] for note in there.notes] == ["instance 1", "instance 2"]
