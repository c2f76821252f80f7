"""The handle of a live view: `pinik.live` for scripts and notebooks, without a browser."""

from __future__ import annotations

import gc
import json
import os
import re
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from dataclasses import dataclass

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import two_hinges
from glb_player import Player
from judge import is_inside, plain_placement
from pinik.export.glb import save_glb
from pinik.viewer.web import live_view as live_view_module
from robots import load_quietly
from stand_ins import PATIENCE


@pytest.fixture
def view(two_link):
    with pinik.live(two_link, ["dls", "ccd"], port=0, motion="hand") as opened:
        yield opened


def answers(view):
    with urllib.request.urlopen(f"{view.url}api/state", timeout=PATIENCE) as answer:
        return json.loads(answer.read())


def can_be_bound(port):
    with socket.socket() as listening:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(("127.0.0.1", port))
        listening.listen()
        return True


def wait_until(condition):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, "the condition never held"
        time.sleep(0.005)


def open_files():
    """The number of open files, or 0 if the system does not tell."""
    return len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else 0


def own_threads():
    return [thread for thread in threading.enumerate() if thread.name.startswith("pinik-live")]


# Opening and closing


def test_leaving_a_view_frees_its_port_and_ends_its_threads(two_link):
    before = own_threads()
    with pinik.live(two_link, port=0) as view:
        port = view.port
        assert view.url == f"http://127.0.0.1:{port}/"
        assert answers(view)["robot"] == "two_link"
        with pytest.raises(OSError, match="in use"):
            can_be_bound(port)
    assert can_be_bound(port)
    assert "pinik-live" not in [thread.name for thread in set(own_threads()) - set(before)]
    wait_until(lambda: set(own_threads()) <= set(before))
    with pinik.live(two_link, port=port) as again:
        assert answers(again)["generation"] == 1


def test_closing_twice_is_closing_once(two_link):
    view = pinik.live(two_link, port=0)
    view.close()
    view.close()
    assert can_be_bound(view.port)
    assert "closed" in repr(view)
    with pytest.raises(pinik.InputError, match="this live view is closed"):
        view.state  # noqa: B018 - the question is what raises
    with pytest.raises(pinik.InputError, match="this live view is closed"):
        view.move_ball([0, 0, 1])
    assert "iframe" not in view._repr_html_()


def test_closing_does_not_wait_for_pages_that_are_open(two_link):
    view = pinik.live(two_link, port=0)
    with socket.create_connection(("127.0.0.1", view.port)) as page:
        page.sendall(f"GET /api/state HTTP/1.1\r\nHost: localhost:{view.port}\r\n\r\n".encode())
        assert page.recv(12) == b"HTTP/1.1 200"
        view.close()  # would wait for ever, as the page closes nothing
        page.settimeout(PATIENCE)
        while page.recv(65536):
            pass


def test_a_question_while_it_is_closed_is_answered_or_refused(two_link):
    """Such a question comes after the check whether the view is closed, and before its loop ends."""
    view = pinik.live(two_link, port=0)
    view.close()
    view._closed.clear()
    with pytest.raises(pinik.InputError, match="this live view is closed"):
        view.state  # noqa: B018 - the question is what raises


def test_an_error_inside_the_with_statement_gets_out_and_closes(two_link):
    with pytest.raises(ZeroDivisionError), pinik.live(two_link, port=0) as view:
        1 / 0  # noqa: B018 - the error is wanted
    assert can_be_bound(view.port)


def test_waiting_ends_when_it_is_closed(two_link):
    with pinik.live(two_link, port=0) as view:
        waiting = threading.Thread(target=view.wait)
        waiting.start()
    waiting.join(PATIENCE)
    assert not waiting.is_alive()


def test_a_server_that_cannot_start_leaves_nothing_behind(two_link, monkeypatch):
    def missing(*_):
        raise pinik.EngineError("meshcat's viewer is missing")

    wait_until(lambda: not own_threads())
    monkeypatch.setattr(live_view_module, "make_server", missing)
    before = open_files()
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with pytest.raises(pinik.EngineError, match="meshcat's viewer is missing"):
        pinik.live(two_link, port=port)
    assert can_be_bound(port)
    wait_until(lambda: not own_threads())
    gc.collect()  # what was left open would warn here
    wait_until(lambda: open_files() == before)


def test_two_views_at_once_know_nothing_of_each_other(two_link, arm):
    with pinik.live(two_link, port=0) as one, pinik.live(arm, port=0) as other:
        assert one.port != other.port
        one.send("view", count=1)
        assert (one.state["view"], other.state["view"]) == (1, 4)
        assert (one.robot.name, other.robot.name) == ("two_link", "arm")


def test_without_a_port_the_first_free_one_is_taken(two_link):
    with pinik.live(two_link) as one, pinik.live(two_link) as other:
        assert one.port != other.port
        assert all(view.port >= 7007 for view in (one, other))


# What cannot be


def test_a_busy_port_is_said_in_words(two_link):
    with pinik.live(two_link, port=0) as view, pytest.raises(pinik.InputError, match="leave the port out") as raised:
        pinik.live(two_link, port=view.port)
    assert f"cannot listen on 127.0.0.1, port {view.port}: Address already in use" in str(raised.value)
    assert own_threads() == [] or not any(thread.name == "pinik-live" for thread in own_threads())


@pytest.mark.parametrize(
    ("options", "fault"),
    [
        ({"port": -1}, "port must be a whole number from 0 to 65535; got -1"),
        ({"port": 65536}, "port must be a whole number from 0 to 65535; got 65536"),
        ({"port": "80"}, "port must be a whole number from 0 to 65535; got '80'"),
        ({"port": 7.5}, "port must be a whole number from 0 to 65535; got 7.5"),
        ({"port": True}, "port must be a whole number from 0 to 65535; got True"),
        ({"host": "192.0.2.1"}, "cannot listen on 192.0.2.1, port 0"),
        ({"host": "127.0.0.1:80"}, "cannot listen on 127.0.0.1:80"),
        ({"host": "x" * 300}, "cannot listen on xxx"),
        ({"host": ""}, "host must be an address of this machine"),
        ({"host": None}, "host must be an address of this machine"),
        ({"host": 5}, "host must be an address of this machine"),
        ({"methods": ["ccdd"]}, "no method 'ccdd'; did you mean 'ccd'"),
        ({"methods": []}, "one to four methods; got 0"),
        ({"methods": ["ccd"] * 5}, "one to four methods; got 5"),
        ({"methods": [pinik.CCD(stiffness={"nope": 0.5})]}, "no joint 'nope'"),
        ({"methods": [pinik.Robot]}, "a Solver class"),
        ({"view": 3}, "1, 2 or 4"),
        ({"view": "2"}, "1, 2 or 4"),
        ({"motion": "dance"}, "no motion 'dance'"),
    ],
)
def test_what_cannot_be_is_said_in_words(two_link, options, fault):
    with pytest.raises(pinik.PinikError) as raised:
        pinik.live(two_link, **{"port": 0, **options})
    assert fault in str(raised.value)


def test_a_robot_that_is_none_is_said_in_words():
    with pytest.raises(pinik.UnknownNameError, match="no robot 'armm'"):
        pinik.live("armm", port=0)
    with pytest.raises(pinik.InputError, match="root"):
        pinik.live("two_link", root="ceiling", port=0)


def test_a_robot_is_a_name_a_file_or_one_that_was_loaded(tmp_path):
    file = tmp_path / "own.urdf"
    file.write_text(two_hinges(1.0, 0.5))
    for robot in ("arm", file, str(file), load_quietly("two_link", root="planar")):
        root = "planar" if isinstance(robot, pinik.Robot) else "fixed"
        with pinik.live(robot, port=0, running=False) as view:
            assert (view.robot.root, view.state["running"]) == (root, False)


# What it can do


def test_it_says_what_it_shows_and_where(view):
    assert repr(view) == f"<LiveView of 'two_link': {view.url}>"


def test_a_ball_is_put_and_the_robots_go_there(view):
    place = plain_placement(view.robot, "tip", view.robot.configuration({"joint1": 0.5, "joint2": 0.6})).translation
    for form in (place, tuple(place), place.tolist(), [np.float32(x) for x in place]):
        view.move_ball([0.0, 0.0, 1.0])
        view.move_ball(form)
        wait_until(lambda: all(one["status"] == "CONVERGED" for one in view.state["instances"]))
        assert view.state["balls"][0]["position"] == pytest.approx(place.tolist())
        for q in view.configurations:
            assert np.linalg.norm(plain_placement(view.robot, "tip", q).translation - place) <= 2e-4
            assert is_inside(view.robot, q)


def test_configurations_are_the_callers_own(view):
    view.send("run", on=False)
    view.send("reset")
    before = [q.tolist() for q in view.configurations]
    for q in view.configurations:
        q += 1.0
    assert [q.tolist() for q in view.configurations] == before
    view.send("reset")
    assert [q.tolist() for q in view.configurations] == before
    assert len(view.configurations) == 2


def test_a_state_is_that_of_the_api(view):
    view.send("run", on=False)
    assert view.state == answers(view)


def test_a_message_changes_what_a_page_would(view):
    view.send("motion", motion="curve")
    view.send("curve", curve="square")
    view.send("parameter", instance=0, name="damping", value=np.float64(0.25))
    view.send("method", instance=1, method="jt")
    view.send("robot", name="arm", root="planar")
    wait_until(lambda: view.state["robot"] == "arm")
    state = view.state
    assert (state["motion"], state["curve"], state["root"], view.robot.root) == ("curve", "square", "planar", "planar")
    assert [one["method"] for one in state["instances"]] == ["dls", "jt"]
    assert {p["name"]: p["value"] for p in state["instances"][0]["parameters"]}["damping"] == 0.25


@pytest.mark.parametrize(
    ("call", "fault"),
    [
        (lambda view: view.send("dance"), "no message 'dance'"),
        (lambda view: view.send("view", count=3), "1, 2 or 4"),
        (lambda view: view.send("view"), "takes count; got none"),
        (lambda view: view.send("method", instance=0, method="os:system"), "no method 'os:system'"),
        (lambda view: view.send("robot", name="/etc/passwd", root="fixed"), "no robot"),
        (lambda view: view.send("ball", index=0, position=object()), "a message must consist of numbers, texts"),
        (lambda view: view.send("ball", index=0, position=[0, 0, float("nan")]), "3 finite numbers"),
        (lambda view: view.send("setup", setup="colour=red"), "no part of a set-up 'colour'"),
        (lambda view: view.move_ball([1, 2]), "3 finite numbers"),
        (lambda view: view.move_ball("abc"), "3 finite numbers"),
        (lambda view: view.move_ball(None), "3 finite numbers"),
        (lambda view: view.move_ball([1, 2, "3"]), "3 finite numbers"),
        (lambda view: view.move_ball([0, 0, 1e3]), "from -100 to 100 m"),
        (lambda view: view.move_ball([0, 0, 1], index=9), "from 0 to 0; got 9"),
    ],
)
def test_errors_cross_the_thread(view, call, fault):
    view.send("run", on=False)
    before = view.state
    with pytest.raises(pinik.PinikError) as raised:
        call(view)
    assert fault in str(raised.value)
    assert view.state == before


def test_many_threads_may_ask_at_once(view):
    faults = []

    def ask(number):
        try:
            for k in range(20):
                view.move_ball([0.1, 0.0, 0.1 * number + 0.01 * k])
                assert len(view.configurations) == view.state["view"]
        except BaseException as fault:
            faults.append(fault)

    threads = [threading.Thread(target=ask, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    assert faults == []


def test_a_solver_of_ones_own_that_raises_ends_nothing(two_link):
    @dataclass(frozen=True, kw_only=True)
    class Broken(pinik.JacobianSolver):
        name = "broken"

        def direction(self, J, e):
            raise RuntimeError("broken")

    with pinik.live(two_link, ["dls", Broken], port=0, motion="random") as view:
        wait_until(lambda: view.state["step"] > 3)
        assert view.state["instances"][1]["status"] == "FAILED"
        assert "RuntimeError: broken" in view.state["instances"][1]["message"]
        assert view.state["instances"][0]["status"] != "FAILED"


def test_it_steps_by_itself_while_it_runs(two_link):
    with pinik.live(two_link, ["dls"], port=0, motion="curve", running=False) as view:
        assert view.state["step"] == 0
        view.send("step")
        assert view.state["step"] == 1
        view.send("run", on=True)
        wait_until(lambda: view.state["step"] > 10)
        assert view.state["steps_per_second"] > 0


def test_the_animation_is_written_to_a_file(view, tmp_path):
    wait_until(lambda: len(view._show.recording) > 2)
    file = tmp_path / "animation.html"
    view.save_animation(file)
    view.save_animation(str(file))
    assert '<script type="application/json" id="recording"' in file.read_text("utf-8")


def test_an_animation_saved_at_once_has_the_robots_shapes(arm, tmp_path):
    with pinik.live(arm, ["dls"], port=0, running=False) as view:
        view.save_animation(tmp_path / "arm.html")
    page = (tmp_path / "arm.html").read_text("utf-8")
    (recording,) = re.findall(r'<script type="application/json" id="recording">(.*?)</script>', page, re.DOTALL)
    with_shapes = {link.name for link in arm.description.link_tags if link.visuals}
    document = json.loads(recording)
    assert {document["robot"]["links"][part["link"]]["name"] for part in document["shapes"]["parts"]} == with_shapes


def test_a_recording_holds_where_everything_was(arm, tmp_path):
    with pinik.live(arm, ["ccd", "dls"], port=0, motion="curve", running=False) as view:
        seen, balls = [view.configurations], [view.state["balls"][0]["position"]]
        for _ in range(60):
            view.send("step")
            seen.append(view.configurations)
            balls.append(view.state["balls"][0]["position"])
        recording = view.recording()
    np.testing.assert_allclose(recording.times, np.arange(31) / 30)
    np.testing.assert_array_equal(recording.q, np.array(seen[::2]).swapaxes(0, 1))
    assert (recording.names, recording.robot) == (["ccd", "dls"], arm)
    (ball,) = recording.balls
    assert (ball.frame, ball.pinned, ball.oriented) == ("tip", False, False)
    np.testing.assert_allclose(ball.positions, balls[::2], atol=1e-6)
    assert np.ptp(ball.positions, axis=0).max() > 0.05
    save_glb(recording, tmp_path / "view.glb")
    played = Player(tmp_path / "view.glb")
    data = arm.model.createData()
    for step in (0, 40, 60):
        for name, q in zip(recording.names, seen[step], strict=True):
            pinocchio.framesForwardKinematics(arm.model, data, q)
            there = data.oMf[arm.model.getFrameId("tip")].homogeneous
            np.testing.assert_allclose(played.place(f"{name} tip", step / 60, above=name), there, atol=1e-6)
            at = played.place(f"{name} ball tip", step / 60, above=name)[:3, 3]
            np.testing.assert_allclose(at, balls[step], atol=1e-6)


def test_twenty_seconds_last_twenty_seconds(arm):
    with pinik.live(arm, ["dls"], port=0, motion="curve", running=False) as view:
        for _ in range(1300):
            view.send("step")
        recording = view.recording()
    assert len(recording.times) == 600
    np.testing.assert_allclose(np.diff(recording.times), 1 / 30)
    assert recording.q.shape == (1, 600, arm.model.nq)


def test_a_view_that_took_no_step_has_recorded_where_it_begins(arm):
    with pinik.live(arm, ["dls"], port=0, running=False) as view:
        recording = view.recording()
        np.testing.assert_array_equal(recording.q, [[view.configurations[0]]])
    assert recording.times.tolist() == [0.0]


def test_balls_that_are_off_are_not_recorded_and_pinned_ones_are_told(arm):
    with pinik.live(arm, ["dls"], port=0, running=False) as view:
        for frame in ("bone1", "bone2"):
            view.send("add_effector", frame=frame)
        view.send("effector", index=1, mode="pinned")
        view.send("effector", index=2, mode="off")
        recording = view.recording()
    assert [(ball.frame, ball.pinned) for ball in recording.balls] == [("tip", False), ("bone1", True)]


def test_no_browser_is_no_error(view, monkeypatch):
    asked = []
    monkeypatch.setattr(live_view_module.webbrowser, "open", lambda url: bool(asked.append(url)))
    assert view.open() is False
    assert asked == [view.url]


def test_a_host_of_its_own_is_listened_on(two_link):
    with pinik.live(two_link, port=0, host="localhost") as view:
        assert view.url == f"http://localhost:{view.port}/"
        assert answers(view)["robot"] == "two_link"
    with pinik.live(two_link, port=0, host="0.0.0.0") as view:
        assert view.url == f"http://127.0.0.1:{view.port}/"
        request = urllib.request.Request(f"{view.url}api/state", headers={"Host": "evil.example"})
        with pytest.raises(urllib.error.HTTPError) as raised:
            urllib.request.urlopen(request, timeout=PATIENCE)
        with raised.value:
            assert raised.value.code == 403


@pytest.mark.parametrize("end", ["", "view.send('robot', name='lion', root='fixed')", "raise SystemExit(0)"])
def test_a_process_with_an_open_view_ends_cleanly(end):
    script = f"import pinik\nview = pinik.live('two_link', port=0)\nprint(view.state['robot'])\n{end}"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", script], capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "two_link\n", "")
