"""What single tabs ask for when somebody teaches: explanations, races, lessons and comparisons, without a browser."""

from __future__ import annotations

import json

import numpy as np
import pytest

from judge import plain_placement
from pinik.viewer.protocol.lessons import LESSONS
from pinik.viewer.protocol.setup import read_setup, write_setup
from pinik.viewer.simulation.session import Session
from pinik.viewer.web.show import Show
from stand_ins import Clock, Later, Tab


class Hall:
    """A show with a stopped session of an arm, and its tabs."""

    def __init__(self, robot, methods="dls,ccd"):
        self.clock, self.later = Clock(), Later()
        self.show = Show(Session(robot, methods, clock=self.clock), self.later, "1.2", self.clock)
        self.later.do_all()

    @property
    def session(self):
        return self.show.session

    def join(self):
        tab = Tab()
        self.show.join(tab)
        return tab

    def says(self, tab, kind, **fields):
        self.show.receive(tab, json.dumps({"type": kind, **fields}))

    def tick(self, count=1, *tabs):
        """Let time pass with tabs that answer every frame."""
        for _ in range(count):
            self.clock.now += 1 / 60
            self.show.tick()
            for tab in (*tabs, *tabs):
                self.says(tab, "drawn", step=0)


def told(tab, kind):
    """The messages of a kind that a tab was sent."""
    texts = [json.loads(message) for message in tab.sent if isinstance(message, str)]
    return [message for message in texts if message["type"] == kind]


@pytest.fixture
def hall(arm):
    return Hall(arm)


def test_only_tabs_with_an_open_explanation_get_one(hall):
    reader, other = hall.join(), hall.join()
    hall.says(reader, "explain", instance=1)
    hall.tick(1, reader, other)
    (explained,) = told(reader, "explanation")
    assert (explained["instance"], explained["method"], explained["reason"]) == (1, "ccd", None)
    assert told(other, "explanation") == []
    hall.says(reader, "explain", instance=None)
    hall.tick(60, reader, other)
    assert len(told(reader, "explanation")) == 1


def test_the_explanation_follows_every_iteration(hall):
    tab = hall.join()
    hall.says(tab, "ball", index=0, position=[0.45, 0.25, 0.75])
    hall.says(tab, "explain", instance=0)
    hall.tick(1, tab)
    step = hall.session.steps
    for _ in range(2):
        hall.says(tab, "step_iteration", instance=0)
        hall.tick(1, tab)
    first, second, third = told(tab, "explanation")[-3:]
    assert first["after"] == pytest.approx(second["residual"], rel=1e-4)
    assert second["after"] == pytest.approx(third["residual"], rel=1e-4)
    assert hall.session.steps == step
    off = plain_placement(hall.session.robot, "tip", hall.session.instances[0].q).translation - [0.45, 0.25, 0.75]
    assert third["residual"] == pytest.approx(np.linalg.norm(off), rel=1e-4)
    assert hall.session.instances[1].q is hall.session.home


def test_a_running_session_explains_four_times_a_second(hall):
    tab = hall.join()
    hall.says(tab, "motion", motion="curve")
    hall.says(tab, "run", on=True)
    hall.says(tab, "explain", instance=0)
    before = len(told(tab, "explanation"))
    hall.tick(120, tab)
    assert 7 <= len(told(tab, "explanation")) - before <= 11


def test_a_late_tab_gets_the_newest_explanation_once_it_answers(hall):
    tab = hall.join()
    hall.says(tab, "explain", instance=0)
    hall.says(tab, "run", on=True)
    hall.says(tab, "motion", motion="curve")
    hall.tick(60)
    late = len(told(tab, "explanation"))
    hall.tick(60)
    assert len(told(tab, "explanation")) == late
    hall.says(tab, "drawn", step=0)
    assert len(told(tab, "explanation")) == late + 1


def test_an_instance_that_is_not_visible_is_not_explained(hall):
    tab = hall.join()
    hall.says(tab, "explain", instance=3)
    hall.tick(2, tab)
    assert told(tab, "explanation") == []


def test_without_targets_the_reason_is_told(hall):
    tab = hall.join()
    hall.says(tab, "effector", index=0, mode="off")
    hall.says(tab, "explain", instance=0)
    hall.tick(1, tab)
    assert told(tab, "explanation")[-1]["reason"] == "there are no targets"


def test_a_race_is_answered_to_its_tab_only_and_one_at_a_time(hall):
    tab, other = hall.join(), hall.join()
    hall.says(tab, "race", places=3, seed=5)
    hall.says(other, "race", places=3, seed=5)
    assert "already being run" in told(other, "error")[-1]["message"]
    hall.later.do_all()
    (race,) = told(tab, "race")
    assert [runner["method"] for runner in race["runners"]] == ["dls", "ccd"]
    assert [len(runner["finishes"]) for runner in race["runners"]] == [3, 3]
    assert (race["seed"], len(race["places"])) == (5, 3)
    assert race["card"].startswith("pinik race: arm, tip, 3 random places")
    assert told(other, "race") == []
    hall.says(other, "race", places=0, seed=0)
    hall.later.do_all()
    assert told(other, "race")[0]["random"] is False


def test_a_tab_that_has_left_gets_no_result(hall):
    tab = hall.join()
    hall.says(tab, "race", places=1, seed=1)
    hall.show.leave(tab)
    hall.later.do_all()
    assert told(tab, "race") == []


def test_a_line_up_puts_all_where_they_begin_before_the_same_ball(hall):
    tab = hall.join()
    hall.says(tab, "motion", motion="curve")
    hall.says(tab, "run", on=True)
    hall.tick(30)
    hall.says(tab, "line_up", position=[0.4, 0.2, 0.7])
    assert not hall.session.running
    assert all(instance.q is hall.session.home for instance in hall.session.seen)
    np.testing.assert_array_equal(hall.session.balls[0].position, [0.4, 0.2, 0.7])
    hall.says(tab, "step_iteration", instance=None)
    assert all(instance.q is not hall.session.home for instance in hall.session.seen)


def test_a_lesson_begins_anew_even_if_its_scene_is_on_show(hall):
    tab = hall.join()
    for _ in range(2):
        hall.says(tab, "lesson", name="curl")
        assert all(instance.q is hall.session.home for instance in hall.session.seen)
        hall.tick(30)
        assert all(instance.q is not hall.session.home for instance in hall.session.seen)
    asked = read_setup(LESSONS["curl"].setup)
    now = read_setup(write_setup(hall.session))
    assert {name: now[name] for name in ("robot", "methods", "motion", "run")} == {
        name: asked[name] for name in ("robot", "methods", "motion", "run")
    }


def test_a_lesson_of_another_robot_leaves_the_one_on_show_as_it_is_until_that_is_there(hall):
    tab = hall.join()
    hall.says(tab, "motion", motion="curve")
    hall.says(tab, "run", on=True)
    hall.tick(20, tab)
    before = write_setup(hall.session), [one.q.tolist() for one in hall.session.instances], hall.session.steps
    hall.says(tab, "lesson", name="two-bones")
    after = write_setup(hall.session), [one.q.tolist() for one in hall.session.instances], hall.session.steps
    assert after == before
    on = hall.session.balls[0].position
    hall.session.step()
    assert np.linalg.norm(hall.session.balls[0].position - on) < 0.05  # the lap goes on
    hall.later.do_all()
    assert (hall.session.robot.name, hall.session.steps, hall.session.running) == ("two_link", 0, True)


def test_a_comparison_begins_where_the_curve_crosses_itself(hall):
    tab = hall.join()
    hall.says(tab, "comparison", number="1", preset="thesis")
    hall.says(tab, "bones", number="1", preset="thesis")
    assert told(tab, "bones") == [{"type": "bones", "number": "1", "preset": "thesis", "joints_per_bone": 2.0}]
    hall.tick()
    tip = plain_placement(hall.session.robot, "tip", hall.session.home).translation
    assert np.linalg.norm(hall.session.balls[0].position - tip) < 0.01
    assert [instance.status for instance in hall.session.seen] == ["CONVERGED"] * 4


@pytest.mark.parametrize(
    ("kind", "fields"),
    [
        ("explain", {"instance": -1}),
        ("explain", {"instance": "0"}),
        ("explain", {}),
        ("race", {"places": 11, "seed": 0}),
        ("race", {"places": -1, "seed": 0}),
        ("race", {"places": 1.0, "seed": 0}),
        ("race", {"places": 1, "seed": -1}),
        ("race", {"places": 1, "seed": 2**40}),
        ("race", {"places": 1}),
        ("bones", {"number": "9", "preset": "thesis"}),
        ("comparison", {"number": "1", "preset": "best"}),
        ("comparison", {"number": 1, "preset": "thesis"}),
        ("lesson", {"name": "nope"}),
        ("lesson", {"name": "curl", "file": "/etc/passwd"}),
    ],
)
def test_malformed_requests_change_nothing(hall, kind, fields):
    tab = hall.join()
    before = write_setup(hall.session)
    hall.says(tab, kind, **fields)
    (error,) = told(tab, "error")
    assert len(error["message"]) > 20
    hall.tick()
    assert told(tab, "explanation") == told(tab, "race") == []
    assert write_setup(hall.session) == before
