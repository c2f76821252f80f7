"""Every message that numbers something refuses numbers that do not exist, in words."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from pinik.viewer.simulation.session import Session
from pinik.viewer.web.show import Show
from robots import load_quietly
from stand_ins import GOOD, Clock, Later, Tab, snapshot

PROTOCOL = (Path(__file__).parents[3] / "docs" / "live-protocol.md").read_text("utf-8")
ROWS = re.findall(r"^\| `(\w+)` \|([^|]*)\|", PROTOCOL, re.MULTILINE)
NUMBERED = [(kind, name) for kind, fields in ROWS for name in ("instance", "index") if f"`{name}`" in fields]
OTHERS = {
    "explain": {"instance": 0},
    "find_self_motion": {"instance": 0},
    "take_answer": {"index": 0, "instance": 0},
    "move_along": {"index": 0},
}


class Stage:
    """A show of two visible robots with a ball, an obstacle, and answers that were found."""

    def __init__(self):
        self.later, self.tab = Later(), Tab()
        session = Session(load_quietly("two_link"), ("dls", "ccd"), clock=Clock())
        session.obstacles.add("sphere", [0.1], [2.0, 0.0, 0.0])
        self.show = Show(session, self.later, "1.2", Clock())
        self.show.join(self.tab)
        self.ask("find_answers", {})
        self.later.do_all()

    def ask(self, kind, fields):
        """Send a message; return the errors that it was answered with."""
        self.tab.sent.clear()
        self.show.receive(self.tab, json.dumps({"type": kind, **fields}))
        texts = [json.loads(message) for message in self.tab.sent if isinstance(message, str)]
        return [text["message"] for text in texts if text["type"] == "error"]


@pytest.fixture(scope="module")
def stage():
    return Stage()


def test_the_protocol_has_messages_that_number_something():
    assert {"method", "explain", "ball", "obstacle", "take_answer", "paste"} <= {kind for kind, _ in NUMBERED}


@pytest.mark.parametrize("number", [-1, 77, 10**30])
@pytest.mark.parametrize(("kind", "name"), NUMBERED)
def test_a_number_that_does_not_exist_is_refused_in_words(stage, kind, name, number):
    good = OTHERS[kind] if kind in OTHERS else GOOD[kind][0]
    before = snapshot(stage.show.session)
    (words,) = stage.ask(kind, good | {name: number})
    assert str(number) in words
    assert "numbered from 0" in words or "must not be negative" in words
    assert snapshot(stage.show.session) == before


@pytest.mark.parametrize("kind", ["explain", "step_iteration", "angles", "paste", "find_self_motion", "take_answer"])
def test_a_robot_that_is_not_shown_is_refused_too(stage, kind):
    good = OTHERS[kind] if kind in OTHERS else GOOD[kind][0]
    before = snapshot(stage.show.session)
    assert stage.ask(kind, good | {"instance": 2}) == ["the visible instances are numbered from 0 to 1; got 2"]
    assert snapshot(stage.show.session) == before


@pytest.mark.parametrize("number", ["7", "-1", "x"])
def test_parameters_in_a_link_belong_to_one_of_its_methods(stage, number):
    setup = f'robot=two_link&methods=dls,ccd&parameters={{"{number}":{{"damping":1}}}}'
    (words,) = stage.ask("setup", {"setup": setup})
    assert "parameters must belong to one of the methods 0 to 1" in words
    assert number in words
