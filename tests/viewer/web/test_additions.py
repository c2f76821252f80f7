"""What looks need is made once per robot, in another thread, and sent to every tab, also to one that comes later."""

from __future__ import annotations

import json

import pytest

from pinik.viewer.simulation.session import Session
from pinik.viewer.web.show import Show
from robots import load_quietly
from stand_ins import Clock, Later, Tab


class Bench:
    def __init__(self, robot):
        self.later = Later()
        self.show = Show(Session(robot, ["dls"], clock=Clock()), self.later, "1.2", Clock())
        self.tab = self.join()

    def join(self):
        tab = Tab()
        self.show.join(tab)
        self.later.do_all()
        return tab

    def says(self, kind, **fields):
        self.show.receive(self.tab, json.dumps({"type": kind, **fields}))
        self.later.do_all()


def told(tab, kind):
    texts = [json.loads(message) for message in tab.sent if isinstance(message, str)]
    return [message for message in texts if message["type"] == kind]


@pytest.fixture
def bench(two_link):
    return Bench(two_link)


def test_a_reach_is_sent_once_per_frame_that_has_a_ball(bench):
    assert told(bench.tab, "reach") == []
    bench.says("look", name="reach", on=True)
    bench.says("look", name="reach", on=False)
    bench.says("look", name="reach", on=True)
    assert [message["frame"] for message in told(bench.tab, "reach")] == ["tip"]
    bench.says("add_effector", frame="link2")
    assert [message["frame"] for message in told(bench.tab, "reach")] == ["tip", "link2"]


def test_a_tab_that_comes_later_gets_what_was_made(bench):
    bench.says("look", name="reach", on=True)
    assert told(bench.join(), "reach") == told(bench.tab, "reach") != []


def test_another_robot_gets_its_own(bench):
    bench.says("look", name="reach", on=True)
    bench.says("robot", name="arm", root="fixed")
    bench.later.do_all()
    first, second = told(bench.tab, "reach")
    assert (first["generation"], second["generation"]) == (1, 2)
    assert told(bench.join(), "reach") == [second]


def test_what_a_look_needed_of_the_robot_before_is_neither_made_nor_sent(bench, monkeypatch):
    for ready in (False, True):
        bench.says("robot", name="two_link", root="fixed")
        bench.show.receive(bench.tab, json.dumps({"type": "look", "name": "reach", "on": True}))
        ((work, then),) = bench.later.waiting
        bench.later.waiting.clear()
        made = work() if ready else None
        bench.says("look", name="reach", on=False)
        bench.says("robot", name="arm", root="fixed")
        bench.tab.sent.clear()
        with monkeypatch.context() as patch:
            patch.setattr("pinik.viewer.web.additions.reach_message", pytest.fail)
            then(made if ready else work())
        assert bench.tab.sent == []


def test_collision_shapes_of_the_robot_before_that_wait_for_a_slow_tab_are_taken_back(monkeypatch):
    bench = Bench(load_quietly("panda"))
    bench.tab.sent.clear()
    bench.says("look", name="collisions", on=True)
    shapes = [message for message in bench.tab.sent if isinstance(message, bytes) and not message.startswith(b"PNKF")]
    back = []
    monkeypatch.setattr(bench.tab, "withdraw", back.extend)
    bench.says("robot", name="two_link", root="fixed")
    assert shapes
    assert set(shapes) <= set(back)


def test_collision_shapes_come_as_commands_and_their_paths():
    bench = Bench(load_quietly("panda"))
    shapes = [message for message in bench.tab.sent if isinstance(message, bytes) and not message.startswith(b"PNKF")]
    bench.says("look", name="collisions", on=True)
    (message,) = told(bench.tab, "collisions")
    sent = [m for m in bench.tab.sent if isinstance(m, bytes) and not m.startswith(b"PNKF")]
    commands = sent[len(shapes) :]
    assert len(commands) == len(message["parts"]) > 5
    assert all(part["path"].startswith("/pinik/collisions/") for part in message["parts"])
    links = list(bench.show.session.robot.description.links)
    with_shapes = {tag.name for tag in bench.show.session.robot.description.link_tags if tag.collisions}
    assert {links[part["link"]] for part in message["parts"]} == with_shapes


def test_what_cannot_be_made_is_said_and_stops_nothing(bench, monkeypatch):
    def fail(*_):
        raise OSError("no such thing")

    monkeypatch.setattr("pinik.viewer.web.additions.reach_message", fail)
    bench.says("look", name="reach", on=True)
    assert "no such thing" in told(bench.tab, "error")[-1]["message"]
    bench.says("limits", on=False)
    assert bench.show.state()["limits"] is False
