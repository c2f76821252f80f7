"""Answers as notebooks show them, and as data frames."""

from __future__ import annotations

import math
import re
from html.parser import HTMLParser

import numpy as np
import pandas
import pytest

import pinik
from pinik.solving.joint_bars import joint_bars
from urdf_texts import joint, link, robot


def limit(lower: float, upper: float) -> str:
    return f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'


ARM = robot(
    link("a"), link("b"), link("c"), link("tip"),
    joint("turn", "a", "b", kind="continuous", limit=""),
    joint("lift&lt;1&gt;", "b", "c", kind="prismatic", limit=limit(-0.5, 1.5)),
    joint("bend", "c", "tip", limit=limit(-1.0, 2.0)),
)  # fmt: skip


class Piece(HTMLParser):
    """What a piece of HTML holds: its words, its open elements, and the places of its marks."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.words: list[str] = []
        self.open: list[str] = []
        self.rects: list[dict[str, str]] = []
        self.rows = 0
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)
        self.rows += tag == "tr"

    def handle_startendtag(self, tag, attributes):
        if tag == "rect":
            self.rects.append(dict(attributes))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(self.words)


@pytest.fixture(scope="module")
def arm():
    return pinik.load(ARM)


@pytest.fixture(scope="module")
def panda():
    return pinik.load("panda")


def bars_of(arm, rows, success=True):
    return Piece(joint_bars(arm, "it's <b>done</b>", success, np.array(rows, dtype=float)))


def middles(piece):
    return [float(r["x"]) + float(r["width"]) / 2 for r in piece.rects]


def test_each_joint_has_a_bar_whose_mark_is_where_the_angle_is_between_the_limits(arm):
    piece = bars_of(arm, [[0.0, 0.5, 2.0]])
    assert piece.open == []
    assert piece.rows == 3
    # The bars are 200 px wide, with 3 px at each end: in the middle, in the middle, and at the right end.
    assert middles(piece) == pytest.approx([100.0, 100.0, 197.0], abs=0.1)
    assert len({rect["fill"] for rect in piece.rects}) == 2  # only the last joint is at a limit
    assert piece.rects[0]["fill"] == piece.rects[1]["fill"]


def test_names_and_messages_are_text_and_no_elements(arm):
    piece = bars_of(arm, [[0.0, 0.5, 1.0]])
    assert "lift<1>" in piece.text
    assert "<b>done</b>" in piece.text
    assert "0.500" in piece.text
    assert piece.text.lstrip().startswith("✓")
    assert bars_of(arm, [[0.0, 0.5, 1.0]], success=False).text.lstrip().startswith("✗")


def test_an_angle_beyond_half_a_turn_stays_inside_its_bar(arm):
    (turn, *_) = middles(bars_of(arm, [[4.0 * math.pi, 0.5, 1.0]]))
    assert turn == pytest.approx(197.0, abs=0.1)


def test_many_configurations_are_a_band_and_few_marks(arm):
    rows = np.column_stack([np.linspace(-1.0, 1.0, 5000), np.zeros(5000), np.zeros(5000)])
    piece = bars_of(arm, rows)
    assert len(piece.rects) < 100
    low, high = (3.0 + (value + math.pi) / (2.0 * math.pi) * 194.0 for value in (-1.0, 1.0))
    band = piece.rects[0]
    assert float(band["x"]) == pytest.approx(low, abs=0.1)
    assert float(band["width"]) == pytest.approx(high - low, abs=0.2)
    assert "−1.000 … 1.000" in piece.text


def test_no_configuration_is_only_a_message(arm):
    assert bars_of(arm, np.zeros((0, 3))).rows == 0


def answers(panda):
    frame, q = "panda_hand_tcp", panda.configuration({"panda_joint4": -1.5, "panda_joint6": 1.5})
    here = panda.placement(frame, q)
    places = here.translation + np.array([[0.0, 0.0, 0.004 * k] for k in range(6)])
    yield panda.solve(frame, placement=here, q0=q), 1
    yield pinik.solve_many(panda, frame, places, q0=q), 6
    yield pinik.track(panda, frame, places, q0=q, times=0.5 * np.arange(6.0)), 6
    yield pinik.self_motion(panda, frame, q, points=20), 20


def test_every_answer_shows_every_joint_and_its_message(panda):
    for answer, _ in answers(panda):
        shown = Piece(answer._repr_html_())
        assert shown.open == []
        assert str(answer) in shown.text
        assert all(name in shown.words for name in panda.joint_names)
        assert isinstance(answer, pinik.Solution) is ("panda_finger_joint2" in shown.words)
        assert not re.search(r"nan|inf\b", shown.text.replace(str(answer), ""))


def test_a_data_frame_has_a_row_for_each_configuration_and_its_angles_reach_the_places(panda):
    for answer, count in answers(panda):
        if isinstance(answer, pinik.Solution):
            continue
        frame = answer.to_frame()
        assert isinstance(frame, pandas.DataFrame)
        assert len(frame) == count
        assert (frame["position_error_m"] < 1e-4).all()
        for row, q in zip(frame[list(panda.joint_names)].to_numpy(), answer.q, strict=True):
            again = panda.configuration(dict(zip(panda.joint_names, row, strict=True)))
            there = panda.placement("panda_hand_tcp", again).translation
            np.testing.assert_allclose(there, panda.placement("panda_hand_tcp", q).translation, atol=1e-12)


def test_the_times_of_a_track_are_its_index(panda):
    (track,) = (answer for answer, _ in answers(panda) if isinstance(answer, pinik.Track))
    frame = track.to_frame()
    assert frame.index.name == "time_s"
    assert list(frame.index) == [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]


def test_branches_are_rows_in_their_order():
    ur5 = pinik.load("ur5")
    place = ur5.placement("tool0", ur5.random(3))
    branches = pinik.solve_all(ur5, "tool0", placement=place)
    frame = branches.to_frame()
    assert len(frame) == len(branches) > 1
    assert frame["distance"].is_monotonic_increasing
    assert frame["elbow_joint"].tolist() == [angles["elbow_joint"] for angles in branches.angles]
    assert Piece(branches._repr_html_()).rows == 6


def test_a_joint_with_the_name_of_a_column_keeps_its_own():
    one = pinik.load(robot(link("a"), link("b"), joint("status", "a", "b")))
    frame = pinik.solve_many(one, [pinik.Target("b", axis="z", direction=[0.0, 0.0, 1.0])] * 2).to_frame()
    assert list(frame.columns).count("status") == 2


def test_no_questions_are_an_empty_data_frame(panda):
    assert len(pinik.solve_many(panda, []).to_frame()) == 0
