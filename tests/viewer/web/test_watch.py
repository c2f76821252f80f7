"""A watched file: the robot is loaded again when it changes, and the last good one stays while it is faulty."""

from __future__ import annotations

import json
import os

import numpy as np
import pytest

import pinik
from by_hand import two_hinges
from pinik.loading import load_in_silence
from pinik.viewer.simulation.by_hand import set_angles
from pinik.viewer.simulation.session import Session
from pinik.viewer.web.show import Show
from pinik.viewer.web.watch import Watch, files_of
from stand_ins import Clock, Later, Tab
from urdf_texts import joint, link, robot

AGE = iter(range(1, 10**6))


def arm(length, *, name="own"):
    first = joint("turn", "base", "one")
    second = joint("bend", "one", "two", f'<origin xyz="{length} 0 0"/>')
    end = joint("end", "two", "tip", f'<origin xyz="{length} 0 0"/>', kind="fixed", limit="")
    return named(name, link("base"), link("one"), link("two"), link("tip"), first, second, end)


def named(name, *parts):
    return robot(*parts).replace('name="r"', f'name="{name}"', 1)


def write(path, text):
    """Write a file whose time differs from that of every other write, however coarse the file system's clock is."""
    path.write_text(text)
    os.utime(path, (next(AGE), next(AGE)))


class Stage:
    def __init__(self, path):
        self.path, self.later = path, Later()
        machine = load_in_silence(path)
        session = Session(machine, ["dls", "ccd"], clock=Clock())
        self.show = Show(session, self.later, "1", Clock(), reload=lambda: load_in_silence(path))
        self.tab = Tab()
        self.show.join(self.tab)
        self.later.do_all()

    def look(self):
        self.show.look_at_files()
        self.later.do_all()
        self.later.do_all()


@pytest.fixture
def stage(tmp_path):
    path = tmp_path / "own.urdf"
    write(path, arm(0.4))
    return Stage(path)


def test_a_changed_file_brings_the_new_robot_with_the_old_angles_and_settings(stage):
    before = stage.show.session
    set_angles(before, 1, {"turn": 0.7, "bend": -0.3})
    before.change_settings(limits=False)
    stage.look()
    assert stage.show.session is before, "nothing has changed"
    write(stage.path, arm(0.6))
    stage.look()
    now = stage.show.session
    assert now is not before
    assert now.robot.placement("tip", [0.0, 0.0]).translation[0] == pytest.approx(1.2)
    np.testing.assert_allclose(now.instances[1].q, [0.7, -0.3])
    np.testing.assert_allclose(now.instances[0].q, before.instances[0].q)
    assert [one.solver.name for one in now.seen] == ["dls", "ccd"]
    assert not now.settings.limits
    assert sorted(now.leading.among(now.balls.targets)) == [1]
    told = [json.loads(m) for m in stage.tab.sent if isinstance(m, str) and '"robot"' in m[:20]]
    assert [message["keeps_view"] for message in told if message["type"] == "robot"] == [False, True]
    assert stage.show.state()["watched"] == {"file": "own.urdf", "fault": None, "shown": True}


@pytest.mark.parametrize("motion", ["curve", "random"])
def test_balls_that_move_go_on_from_where_they_are(tmp_path, motion):
    path = tmp_path / "own.urdf"
    write(path, two_hinges(0.5, 0.4))
    stage = Stage(path)
    before = stage.show.session
    before.set_motion(motion)
    for _ in range(200):
        before.step()
    here = before.balls[0].position
    write(path, two_hinges(0.5, 0.4) + "<!-- changed -->")
    stage.look()
    now = stage.show.session
    assert now is not before
    np.testing.assert_array_equal(now.balls[0].position, here)
    for _ in range(200):
        before.step()
        now.step()
        np.testing.assert_allclose(now.balls[0].position, before.balls[0].position)


def test_a_faulty_file_is_said_in_words_over_the_last_good_robot_until_it_is_good_again(stage):
    before = stage.show.session
    write(stage.path, arm(0.4).replace('<child link="two"/>', '<child link="three"/>'))
    stage.look()
    assert stage.show.session is before
    assert "three" in stage.show.state()["watched"]["fault"]
    stage.path.unlink()
    stage.look()
    assert stage.show.state()["watched"]["fault"] == f"{stage.path}: there is no such file"
    write(stage.path, arm(0.5))
    stage.look()
    assert stage.show.state()["watched"]["fault"] is None
    assert stage.show.session.robot.placement("tip", [0.0, 0.0]).translation[0] == pytest.approx(1.0)


def test_what_the_robot_no_longer_has_is_dropped_and_its_new_name_is_on_the_menu(stage):
    before = stage.show.session
    before.add_ball("two")
    before.set_parameter(1, "stiffness", {"bend": 0.5})
    before.change_settings(polish=True)
    before.scores.cover("all")
    before.misses.pause = True
    write(stage.path, arm(0.4, name="other").replace('"bend"', '"fold"').replace('"two"', '"second"'))
    stage.look()
    now = stage.show.session
    assert (now.robot.name, now.robot.joint_names) == ("other", ("turn", "fold"))
    assert "second" in now.robot.frame_names
    assert "two" not in now.balls.frames
    assert (now.settings.polish, now.scores.window, now.misses.pause) == (True, "all", True), "later parts are kept"
    said = " ".join(m for m in stage.tab.sent if isinstance(m, str) and '"error"' in m[:20])
    assert "the ball of 'two' is gone" in said
    assert "bend" in said
    assert stage.show.state()["robot"] == "other"
    stage.show.receive(stage.tab, json.dumps({"type": "robot", "name": "other", "root": "planar"}))
    stage.later.do_all()
    assert stage.show.session.robot.root == "planar"


def test_nobody_who_watches_costs_no_look(stage):
    stage.show.leave(stage.tab)
    write(stage.path, arm(0.6))
    stage.look()
    assert stage.show.session.robot.placement("tip", [0.0, 0.0]).translation[0] == pytest.approx(0.8)


def test_srdf_meshes_and_included_files_are_watched_too(tmp_path):
    (tmp_path / "parts").mkdir()
    mesh, macro, path = tmp_path / "m.obj", tmp_path / "parts" / "macro.xacro", tmp_path / "own.xacro"
    mesh.write_bytes(b"x")
    colours = tmp_path / "parts" / "paint.mtl"
    write(colours, "newmtl red")
    write(macro, "<robot/>")
    shape = '<visual><geometry><mesh filename="m.obj"/></geometry></visual>'
    write(path, named("own", link("base", shape)))
    found = files_of(load_in_silence(path))
    assert {path, path.with_suffix(".srdf"), mesh, colours, macro} <= set(found)
    loads = []

    def again():
        loads.append(path)
        return load_in_silence(path)

    watch = Watch(load_in_silence(path), again, lambda work, then: then(work()))
    for file in (mesh, colours, macro, path.with_suffix(".srdf")):
        write(file, "<robot name='own'/>")
        watch.look(lambda robot: None)
    assert len(loads) == 4
    watch.look(lambda robot: None)
    assert len(loads) == 4


def test_only_a_robot_from_a_file_can_be_watched(two_link):
    with pytest.raises(pinik.InputError, match="path of a file"):
        pinik.live(two_link, watch=True, port=0)


def test_the_state_says_whether_the_watched_robot_is_the_one_on_show(stage):
    write(stage.path, "<robot/>")
    stage.look()
    assert stage.show.state()["watched"]["shown"]
    stage.show.do({"type": "robot", "name": "two_link", "root": "fixed"})
    stage.look()
    state = stage.show.state()
    assert state["robot"] == "two_link"
    assert not state["watched"]["shown"]
    assert state["watched"]["fault"]


def test_the_command_has_the_path_of_the_file_which_no_saved_page_has(stage):
    assert stage.show.state()["command"] == f"pinik live {stage.path} --watch"
    assert str(stage.path).encode() not in stage.show.animation()
    stage.show.do({"type": "robot", "name": "two_link", "root": "fixed"})
    stage.look()
    assert stage.show.state()["command"] == "pinik live two_link"
