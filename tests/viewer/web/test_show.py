"""One session and the tabs that watch it: what each is sent, in which order, and how much at most."""

from __future__ import annotations

import json

import numpy as np
import pytest

import pinik
from by_hand import two_hinges
from judge import plain_placement
from pinik.viewer.simulation.session import Session
from pinik.viewer.web.show import Show
from robots import load_quietly
from stand_ins import Clock, Later, Tab, read_frame, snapshot


class Stage:
    """A show whose clock and workers the test controls."""

    def __init__(self, machine, methods=("dls", "ccd"), *, running=True, motion="random"):
        self.clock, self.later = Clock(), Later()
        session = Session(machine, methods, clock=self.clock)
        session.set_motion(motion)
        session.running = running
        self.show = Show(session, self.later, "1.2", self.clock)

    def join(self) -> Tab:
        tab = Tab()
        self.show.join(tab)
        return tab

    def tick(self, count=1):
        for _ in range(count):
            self.clock.now += 1 / 60
            self.show.tick()

    def says(self, tab, kind, **fields):
        self.show.receive(tab, json.dumps({"type": kind, **fields}))

    def draw(self, tab, count=1):
        for _ in range(count):
            self.says(tab, "drawn", step=0)

    def play(self, *tabs, ticks):
        """Let time pass with tabs that answer every frame at once."""
        for _ in range(ticks):
            self.tick()
            for tab in tabs:
                self.draw(tab, 2)


@pytest.fixture
def stage(two_link):
    return Stage(two_link)


# Joining


def test_a_robot_stands_still_until_its_shapes_are_there_or_somebody_asks_for_something(two_link):
    for first in (lambda stage: stage.later.do_all(), lambda stage: stage.says(stage.join(), "limits", on=False)):
        stage = Stage(two_link)
        stage.join()
        stage.tick(10)
        assert stage.show.session.steps == 0
        first(stage)
        stage.tick(10)
        assert stage.show.session.steps == 10


def test_a_tab_is_told_everything_in_order(stage):
    before = stage.join()
    assert before.kinds == ["hello", "robot", "state", "frame"]
    stage.later.do_all()
    shapes = before.kinds[4:]
    assert shapes[-1:] == ["shapes"]
    assert set(shapes[:-1]) == {"shape"}
    assert len(before.last("shapes")["parts"]) == len(shapes) - 1 > 0
    after = stage.join()
    assert after.kinds == ["hello", "robot", "state", *shapes, "frame"]
    assert [m for m in after.sent if m in before.sent] == after.sent  # the same, word for word


def test_what_a_tab_is_told_belongs_together(stage, two_link):
    stage.later.do_all()
    stage.tick(3)
    tab = stage.join()
    hello, told, state = (tab.last(kind) for kind in ("hello", "robot", "state"))
    frame = read_frame(tab.last("frame"))
    assert told["generation"] == state["generation"] == tab.last("shapes")["generation"] == frame.generation == 1
    assert (told["name"], told["root"]) == (state["robot"], state["root"]) == ("two_link", "fixed")
    assert len(told["joints"]) == two_link.model.njoints == frame.blocks[0].joints.shape[0]
    assert len(frame.blocks) == state["view"] == len(state["instances"]) == 2
    assert state["step"] == frame.step == 3
    assert state["robot"] in hello["robots"]
    assert state["motion"] in [motion["name"] for motion in hello["motions"]]
    assert hello["version"] == "1.2"
    q = stage.show.session.instances[0].q
    assert np.allclose(frame.blocks[0].points[0], plain_placement(two_link, "tip", q).translation, atol=1e-6)


def test_two_tabs_get_the_same(stage):
    first, second = stage.join(), stage.join()
    stage.later.do_all()
    for step in range(40):
        stage.play(first, second, ticks=1)
        if step % 10 == 3:
            stage.says(first, "view", count=1 + step // 20)
    assert first.sent == second.sent
    assert first.kinds.count("frame") > 30


def test_a_tab_that_left_is_told_nothing_more(stage):
    tab, other = stage.join(), stage.join()
    stage.show.leave(tab)
    stage.show.leave(tab)
    told = len(tab.sent)
    stage.later.do_all()
    stage.play(other, ticks=30)
    assert len(tab.sent) == told
    stage.says(tab, "drawn", step=1)
    assert other.kinds.count("frame") == 31


def test_without_tabs_it_goes_on(stage):
    stage.later.do_all()
    stage.tick(30)
    assert stage.show.session.steps == 30


# Slow tabs


def test_no_more_than_two_frames_are_under_way_and_then_comes_the_newest(stage):
    stage.later.do_all()
    slow = stage.join()
    stage.tick(10)
    assert [read_frame(frame).step for frame in slow.of("frame")] == [0, 1]
    stage.draw(slow)
    assert read_frame(slow.last("frame")).step == 10
    stage.tick(5)
    assert len(slow.of("frame")) == 3
    stage.draw(slow, 2)
    assert [read_frame(frame).step for frame in slow.of("frame")] == [0, 1, 10, 15]
    stage.tick(5)
    assert [read_frame(frame).step for frame in slow.of("frame")][4:] == [16]
    stage.draw(slow, 50)  # more answers than questions count for nothing
    stage.tick(10)
    assert len(slow.of("frame")) <= 8


def test_nothing_queues_for_a_tab_that_never_answers(two_link):
    stage = Stage(two_link, ["dls"], motion="curve")
    mute, quick = stage.join(), stage.join()
    stage.later.do_all()
    told = len(mute.sent)
    stage.play(quick, ticks=10_000)
    assert len(mute.sent) - told == 1  # the second frame
    assert quick.kinds.count("frame") == 10_001
    assert 620 <= quick.kinds.count("state") <= 670  # about four a second in 10,000/60 s


def test_nothing_is_sent_while_nothing_moves(two_link):
    stage = Stage(two_link, ["dls"], motion="hand")
    tab = stage.join()
    stage.later.do_all()
    stage.play(tab, ticks=200)
    assert not stage.show.is_lively()
    told = len(tab.sent)
    stage.play(tab, ticks=600)
    assert len(tab.sent) == told
    stage.show.receive(tab, json.dumps({"type": "ball", "index": 0, "position": [0.9, 0.7, 0.0]}))
    assert stage.show.is_lively()
    stage.play(tab, ticks=30)
    new = [read_frame(frame) for frame in tab.of("frame")[-20:]]
    assert new[-1].step > new[0].step >= 800
    assert new[-1].balls[0, :3].tolist() == pytest.approx([0.9, 0.7, 0.0])
    assert not Stage(two_link, ["dls"], motion="hand").show.is_lively()  # nobody watches


def test_a_state_waits_for_a_late_tab_and_is_then_the_newest(stage):
    slow = stage.join()
    stage.tick(2)
    for count in (1, 2, 4):
        stage.says(slow, "view", count=count)
        stage.tick()
    assert slow.kinds.count("state") == 1
    stage.draw(slow)
    assert slow.kinds.count("state") == 2
    assert slow.last("state")["view"] == 4
    assert slow.kinds[-1] == "frame"


def test_a_slow_tab_does_not_slow_the_others(stage):
    stage.later.do_all()
    _, quick = stage.join(), stage.join()
    stage.play(quick, ticks=60)
    assert [read_frame(frame).step for frame in quick.of("frame")] == list(range(61))


# Time


def test_states_come_four_times_a_second_while_it_runs(stage):
    stage.later.do_all()
    tab = stage.join()
    stage.play(tab, ticks=1)
    tab.sent.clear()
    stage.play(tab, ticks=120)
    assert tab.kinds.count("state") in (7, 8)
    assert tab.kinds.count("frame") == 120
    stage.says(tab, "run", on=False)
    stage.play(tab, ticks=1)
    assert tab.last("state")["running"] is False
    tab.sent.clear()
    stage.play(tab, ticks=120)
    assert tab.sent == []


@pytest.mark.parametrize(
    "message",
    [
        {"type": "limits", "on": False},
        {"type": "step"},
        {"type": "reset"},
        {"type": "ball", "index": 0, "position": [0.3, 0.0, 0.2]},
        {"type": "method", "instance": 0, "method": "jt"},
        {"type": "setup", "setup": "view=1"},
    ],
)
def test_every_change_is_told_to_all_tabs_at_the_next_tick(two_link, message):
    stage = Stage(two_link, running=False)
    tab, other = stage.join(), stage.join()
    stage.play(tab, other, ticks=1)
    tab.sent.clear()
    other.sent.clear()
    stage.says(tab, **{"kind": message["type"], **{k: v for k, v in message.items() if k != "type"}})
    stage.play(tab, other, ticks=1)
    assert sorted(tab.kinds) == ["frame", "state"]
    assert tab.sent == other.sent


def test_a_ball_that_is_dragged_moves_in_every_frame(two_link):
    stage = Stage(two_link, motion="hand")
    tab = stage.join()
    stage.play(tab, ticks=1)
    tab.sent.clear()
    for k in range(12):
        place = [0.3, 0.0, 0.2 + 0.01 * k]
        stage.says(tab, "ball", index=0, position=place)
        stage.play(tab, ticks=1)
        assert np.allclose(read_frame(tab.last("frame")).balls[0][:3], place)
    assert tab.kinds.count("state") <= 1


def test_a_status_is_never_that_of_another_ball_and_tabs_see_no_flicker(two_link):
    stage = Stage(two_link, ("dls",), motion="hand")
    stage.later.do_all()
    late = stage.join()
    stage.tick(20)
    for k in range(20):
        stage.says(late, "ball", index=0, position=[0.3, 0.0, 0.2 + 0.01 * k])
        (between,) = stage.show.state()["instances"]
        assert between["status"] == "IDLE"
        stage.draw(late)
        stage.tick()
        (then,) = stage.show.state()["instances"]
        assert then["status"] != "IDLE"
    seen = [state["instances"][0]["status"] for state in late.of("state")]
    assert len(seen) > 2
    assert "IDLE" not in seen[1:]


def test_the_pace_is_that_of_the_clock(stage):
    stage.later.do_all()
    assert stage.show.state()["steps_per_second"] is None
    stage.tick(90)
    assert stage.show.state()["steps_per_second"] == pytest.approx(60.0)
    stage.show.do({"type": "run", "on": False})
    stage.clock.now += 100
    stage.tick()
    assert stage.show.state()["steps_per_second"] is None
    stage.show.do({"type": "run", "on": True})
    stage.tick(20)
    assert stage.show.state()["steps_per_second"] == pytest.approx(60.0)


# What is asked


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "a message must be a JSON object"),
        ("\x00", "a message must be a JSON object"),
        ('{"type": "dance"}', "no message 'dance'"),
        ('{"type": "drawn"}', "'drawn' takes step; got none"),
        ('{"type": "drawn", "step": "1"}', "drawn: step must be a whole number"),
        ('{"type": "drawn", "step": true}', "drawn: step must be a whole number"),
        ('{"type": "drawn", "step": 1, "more": 2}', "'drawn' takes step"),
        ('{"type": "view", "count": 3}', "1, 2 or 4"),
        ('{"type": "robot", "name": "arm"}', "'robot' takes name, root"),
        ('{"type": "robot", "name": "arm", "root": "free_flyer", "path": "/"}', "'robot' takes name, root"),
        ('{"type": "robot", "name": "armm", "root": "fixed"}', "did you mean 'arm'"),
        ('{"type": "robot", "name": "/etc/passwd", "root": "fixed"}', "no robot"),
        ('{"type": "robot", "name": "../../urdf/arm.urdf", "root": "fixed"}', "no robot"),
        ('{"type": "robot", "name": "arm", "root": "ceiling"}', "no root 'ceiling'"),
        ('{"type": "robot", "name": 5, "root": "fixed"}', "name must be a text"),
        ('{"type": "robot", "name": "arm", "root": null}', "root must be a text"),
        ('{"type": "setup"}', "'setup' takes setup"),
        ('{"type": "setup", "setup": 5}', "setup must be a text"),
        ('{"type": "setup", "setup": "robot=/etc/passwd"}', "no robot '/etc/passwd'"),
        ('{"type": "setup", "setup": "root=ceiling"}', "no root 'ceiling'"),
        ('{"type": "setup", "setup": "colour=red"}', "no part of a set-up 'colour'"),
        ('{"type": "setup", "setup": "view=3"}', "1, 2 or 4"),
    ],
)
def test_a_bad_message_is_answered_to_its_tab_alone_and_changes_nothing(stage, text, fault):
    tab, other = stage.join(), stage.join()
    stage.later.do_all()
    told, before = len(other.sent), snapshot(stage.show.session)
    stage.show.receive(tab, text)
    assert fault in tab.last("error")["message"]
    assert tab.kinds[-1] == "error"
    assert (len(other.sent), snapshot(stage.show.session), stage.later.waiting) == (told, before, [])


def test_no_message_reads_a_file_or_imports(stage, tmp_path):
    good = tmp_path / "good.urdf"
    good.write_text(two_hinges(1, 1))
    tab = stage.join()
    stage.later.do_all()
    for name in (str(good), good.as_uri(), f"../../{good}"):
        stage.says(tab, "robot", name=name, root="fixed")
        stage.says(tab, "setup", setup=f"robot={name}")
        stage.says(tab, "add_effector", frame=name)
        stage.says(tab, "method", instance=0, method=f"{name}:Solver")
        assert tab.kinds[-4:] == ["error"] * 4
        assert stage.later.waiting == []


def test_do_raises_what_a_page_would_be_told(stage):
    with pytest.raises(pinik.UnknownNameError):
        stage.show.do({"type": "drawn", "step": 1})
    with pytest.raises(pinik.InputError):
        stage.show.do({"type": "view", "count": 3})


# Another robot


def test_another_robot_is_loaded_elsewhere_and_then_shown(stage):
    tab = stage.join()
    stage.later.do_all()
    stage.show.do({"type": "speed", "value": 3.0})
    stage.play(tab, ticks=3)
    stage.says(tab, "robot", name="arm", root="free_flyer")
    stage.play(tab, ticks=2)
    state = tab.last("state")
    assert (state["robot"], state["loading"], state["generation"]) == ("two_link", "arm", 1)
    tab.sent.clear()
    stage.later.do()
    assert tab.kinds[:2] == ["robot", "state"]
    stage.later.do_all()
    assert tab.kinds[2:] == ["shape"] * (len(tab.sent) - 3) + ["shapes"]
    stage.play(tab, ticks=2)
    state = tab.last("state")
    assert (state["robot"], state["root"], state["loading"], state["generation"]) == ("arm", "free_flyer", None, 2)
    assert (state["speed"], state["running"], state["motion"]) == (3.0, True, "random")
    assert tab.of("robot")[0]["generation"] == tab.last("shapes")["generation"] == 2
    frame = read_frame(tab.last("frame"))
    assert (frame.generation, len(frame.blocks[0].joints)) == (2, 14)
    assert stage.join().kinds[:3] == ["hello", "robot", "state"]


def test_shapes_of_a_robot_that_has_gone_are_dropped(stage):
    tab = stage.join()
    old_shapes = stage.later.waiting.pop()
    stage.says(tab, "robot", name="arm", root="fixed")
    stage.later.do()
    stage.later.waiting.append(old_shapes)
    stage.later.do(1)
    assert "shapes" not in tab.kinds
    stage.later.do()
    assert [m["generation"] for m in tab.of("shapes")] == [2]


@pytest.mark.parametrize("order", [(0, 0), (1, 0)], ids=["the older is ready first", "the newer is ready first"])
@pytest.mark.parametrize(
    ("first", "second"),
    [(("panda", "fixed"), ("arm", "fixed")), (("arm", "fixed"), ("arm", "free_flyer"))],
    ids=["two robots", "one robot, two roots"],
)
def test_the_newest_of_two_requests_wins(stage, first, second, order):
    tab = stage.join()
    stage.later.do_all()
    for name, root in (first, second):
        stage.says(tab, "robot", name=name, root=root)
    for index in order:
        stage.later.do(index)
    stage.later.do_all()
    stage.play(tab, ticks=1)
    assert [(m["name"], m["root"]) for m in tab.of("robot")] == [("two_link", "fixed"), second]
    assert tab.last("state")["loading"] is None
    assert stage.show.session.robot.root == second[1]


@pytest.mark.parametrize(
    ("newer", "shown"), [("robot=two_link&root=fixed&view=1", "two_link"), ("view=1", "arm")], ids=["whole", "a part"]
)
def test_a_newer_set_up_of_the_robot_on_show_keeps_it(stage, newer, shown):
    tab = stage.join()
    stage.later.do_all()
    stage.says(tab, "robot", name="arm", root="fixed")
    stage.says(tab, "setup", setup=newer)
    assert stage.show.state()["loading"] == (None if shown == "two_link" else "arm")
    stage.later.do_all()
    assert (stage.show.session.robot.name, stage.show.session.view) == (shown, 1)


def test_a_robot_that_cannot_be_loaded_leaves_the_old_one_and_says_why(stage):
    tab, other = stage.join(), stage.join()
    stage.later.do_all()
    stage.says(tab, "robot", name="ur3_empty", root="fixed")
    stage.later.do_all()
    stage.play(tab, ticks=1)
    for one in (tab, other):
        assert one.last("error")["message"].startswith("ur3_empty cannot be loaded: ")
    state = tab.last("state")
    assert (state["robot"], state["loading"], state["generation"], state["step"]) == ("two_link", None, 1, 1)


def test_shapes_that_cannot_be_had_are_a_warning(stage):
    tab = stage.join()
    _, then = stage.later.waiting.pop()
    then(RuntimeError("no meshes here"))
    told = tab.last("shapes")
    assert told["parts"] == []
    assert "no meshes here" in told["warnings"][0]


def test_a_set_up_with_another_robot_waits_for_it(stage):
    tab = stage.join()
    stage.later.do_all()
    stage.says(tab, "setup", setup="robot=arm&root=planar&view=1&methods=jt&motion=curve&curve=knot&limits=off")
    assert stage.show.session.robot.name == "two_link"
    stage.later.do_all()
    state = stage.join().last("state")
    assert (state["robot"], state["root"], state["view"], state["motion"], state["curve"], state["limits"]) == (
        "arm",
        "planar",
        1,
        "curve",
        "knot",
        False,
    )
    assert [one["method"] for one in state["instances"]] == ["jt"]
    stage.play(tab, ticks=1)
    assert "error" not in tab.kinds


def test_tabs_are_told_why_a_method_makes_room_for_another(two_link):
    stage = Stage(two_link, ["ccd", "two_bone"])
    tab, other = stage.join(), stage.join()
    stage.later.do_all()
    stage.says(tab, "robot", name="arm", root="fixed")
    stage.later.do_all()
    stage.play(tab, ticks=1)
    for each in (tab, other):
        (error,) = each.of("error")
        assert error["message"].startswith("instance 2 now uses dls: two_bone cannot chase a ball here: frame 'tip'")
    state = tab.last("state")
    assert ([one["method"] for one in state["instances"]], "two_bone" in state["methods"]) == (["ccd", "dls"], False)


def test_a_set_up_that_names_other_methods_is_no_news(two_link):
    stage = Stage(two_link, ["ccd", "two_bone"])
    tab = stage.join()
    stage.says(tab, "setup", setup="robot=arm&methods=ccd,jt")
    stage.later.do_all()
    assert "error" not in tab.kinds
    stage.says(tab, "setup", setup="robot=two_link&methods=two_bone,dls")
    stage.later.do_all()
    assert [one.solver.name for one in stage.show.session.seen] == ["two_bone", "dls"]
    stage.says(tab, "setup", setup="robot=lion&methods=two_bone,dls")
    stage.later.do_all()
    stage.play(tab, ticks=1)
    assert "two_bone cannot chase a ball here: frame 'left_fore_paw'" in tab.last("error")["message"]
    assert tab.last("state")["robot"] == "lion"


def test_a_faulty_set_up_of_another_robot_shows_the_robot_and_says_what_was_wrong(stage):
    tab = stage.join()
    stage.says(tab, "setup", setup="robot=arm&view=3")
    stage.later.do_all()
    stage.play(tab, ticks=1)
    assert "1, 2 or 4" in tab.last("error")["message"]
    assert (tab.last("state")["robot"], tab.last("state")["loading"]) == ("arm", None)


def test_a_part_of_a_set_up_keeps_the_robot_and_its_root():
    stage = Stage(load_quietly("arm", root="free_flyer"))
    tab = stage.join()
    stage.later.do_all()
    stage.says(tab, "setup", setup="view=1")
    assert stage.later.waiting == []
    assert (stage.show.session.view, stage.show.session.robot.root) == (1, "free_flyer")
    stage.says(tab, "setup", setup="robot=arm")  # fixed, as it is nowhere said otherwise
    stage.later.do_all()
    assert stage.show.session.robot.root == "fixed"


def test_the_set_up_in_the_state_makes_the_same_state(stage):
    stage.show.do({"type": "method", "instance": 1, "method": "pinv"})
    stage.show.do({"type": "parameter", "instance": 0, "name": "damping", "value": 0.25})
    stage.show.do({"type": "curve", "curve": "square"})
    stage.show.do({"type": "motion", "motion": "curve"})
    text = stage.show.state()["setup"]
    other = Stage(load_quietly("arm"), running=False)
    other.show.do({"type": "setup", "setup": text})
    other.later.do_all()
    assert other.show.state()["setup"] == text


# Recording


def test_the_recording_begins_anew_where_frames_change_their_kind(stage):
    stage.later.do_all()
    show = stage.show
    stage.tick(10)
    assert len(show.recording) == 6  # the beginning, and every second step
    for message in (
        {"type": "view", "count": 1},
        {"type": "add_effector", "frame": "link1"},
        {"type": "remove_effector", "index": 1},
        {"type": "setup", "setup": "view=2"},
        {"type": "method", "instance": 1, "method": "jt"},  # else its name would stand on what another one did
    ):
        show.do(message)
        assert len(show.recording) == 1
        stage.tick(10)
        assert len(show.recording) == 6
    show.do({"type": "limits", "on": False})
    assert len(show.recording) == 6
    show.do({"type": "robot", "name": "arm", "root": "fixed"})
    stage.later.do_all()
    assert len(show.recording) == 1
    stage.tick(2)
    assert read_frame(show.recording.frames[: show.recording.frame_bytes]).generation == 2
