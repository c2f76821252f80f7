"""The seats of tabs: a late tab gets no frame and no state until it answers, and then the newest."""

from __future__ import annotations

from pinik.viewer.web.seats import Seats


class Tab:
    """Keeps what it is sent."""

    def __init__(self):
        self.sent = []

    def send(self, message):
        self.sent.append(message)


def seated():
    seats, tab = Seats(), Tab()
    seats.add(tab, "frame 0")
    return seats, tab


def test_a_third_frame_waits_for_an_answer_and_is_then_the_newest():
    seats, tab = seated()
    for k in (1, 2, 3):
        seats.offer_frame(f"frame {k}")
    assert tab.sent == ["frame 0", "frame 1"]
    seats.drawn(tab, "frame 3", "state")
    assert tab.sent == ["frame 0", "frame 1", "frame 3"]


def test_a_late_tab_gets_its_state_before_its_frame():
    seats, tab = seated()
    seats.offer_frame("frame 1")
    seats.offer_state("state 1")
    seats.offer_frame("frame 2")
    seats.drawn(tab, "frame 2", "state 2")
    assert tab.sent == ["frame 0", "frame 1", "state 2", "frame 2"]


def test_an_answer_sends_nothing_to_a_tab_that_missed_nothing():
    seats, tab = seated()
    seats.offer_state("state 1")
    for _ in range(5):
        seats.drawn(tab, "frame", "state")
    assert tab.sent == ["frame 0", "state 1"]
    for k in range(1, 5):
        seats.offer_frame(f"frame {k}")
    assert tab.sent[2:] == ["frame 1", "frame 2"]  # answers without a frame are no credit


def test_other_messages_reach_late_tabs_too_and_removed_ones_no_more():
    seats, tab = seated()
    seats.offer_frame("frame 1")
    seats.send("robot")
    assert tab.sent[-1] == "robot"
    seats.remove(tab)
    seats.remove(tab)
    seats.send("shapes")
    seats.drawn(tab, "frame", "state")
    assert tab.sent[-1] == "robot"
    assert len(seats) == 0
