"""Joints, rings, copying, undo, pictures and pausing on the page, against the server's state and plain Pinocchio."""

from __future__ import annotations

import io
import json
import math

import numpy as np
import pinocchio
import pytest

from judge import plain_placement


def angles(state, k=0):
    return state["instances"][k]["angles"]


def open_joints(desk):
    desk.part("joints").locator("summary").click()
    desk.part("joints-of").wait_for()


def test_a_joint_is_moved_by_number_and_by_keys_and_the_ball_follows(open_panel):
    desk = open_panel("panda", methods=("dls", "ccd"), running=True)
    open_joints(desk)
    desk.type("joint-number-panda_joint1", 40)
    state = desk.until(lambda s: s["led"] == [0, 1])
    assert angles(state)["panda_joint1"] == angles(state, 1)["panda_joint1"] == pytest.approx(math.radians(40))
    robot = desk.view.robot
    q = robot.configuration({n: a for n, a in angles(state).items() if n not in robot.mimics})
    place = plain_placement(robot, state["balls"][0]["frame"], q)
    np.testing.assert_allclose(state["balls"][0]["position"], place.translation, atol=1e-9)
    desk.expect("joints").to_contain_text("The joints lead")
    desk.expect("joint-panda_finger_joint2").to_be_disabled()
    slider = desk.part("joint-panda_joint2")
    slider.focus()
    before = angles(desk.state)["panda_joint2"]
    slider.press("ArrowRight")
    desk.until(lambda s: before < angles(s)["panda_joint2"] < before + math.radians(0.3))
    slider.press("End")
    desk.until(lambda s: angles(s)["panda_joint2"] == pytest.approx(1.7628, abs=1e-3))
    desk.click("balls-lead")
    desk.until(lambda s: s["led"] == [])
    desk.choose("joints-of", "1")
    desk.type("joint-number-panda_joint1", 10)
    assert desk.until(lambda s: s["led"] == [1])


def test_many_joints_can_be_searched(open_panel):
    desk = open_panel("talos", methods=("dls",))
    open_joints(desk)
    rows = desk.part("joints").locator("li:visible")
    assert rows.count() > 30
    desk.part("joint-search").press_sequentially("gripper_left")  # with letters that are shortcuts elsewhere
    assert desk.part("joint-search").input_value() == "gripper_left"
    assert 0 < rows.count() < 10
    desk.part("joint-search").fill("nothing like it")
    desk.expect("joints").to_contain_text("No joint has this in its name.")


def test_copied_text_is_shown_and_pasted_angles_are_set_or_refused_in_words(open_panel):
    desk = open_panel("arm", methods=("dls",))
    open_joints(desk)
    desk.click("copy-open")
    desk.choose("copy-what", "pose.json")
    shown = json.loads(desk.part("copy-text").input_value())["angles"]
    assert shown == pytest.approx({name: angles(desk.state)[name] for name in desk.view.robot.joint_names})
    desk.click("copy-button")
    desk.expect("copy-done").to_have_text("Copied.")
    desk.part("paste-text").fill("bone1_x: 0.25\nbone2_x: -0.5")
    desk.click("paste-button")
    state = desk.until(lambda s: s["led"] == [0])
    assert (angles(state)["bone1_x"], angles(state)["bone2_x"]) == pytest.approx((0.25, -0.5))
    desk.click("copy-open")
    desk.part("paste-text").fill("bone1_x = 0.25")
    desk.click("paste-button")
    desk.expect(desk.toasts).to_contain_text("line 1 of the pasted text must be joint: value")


def test_undo_and_redo_bring_back_settings_balls_poses_and_robots(open_panel):
    desk = open_panel("arm", methods=("dls",), running=True)
    open_joints(desk)
    first = angles(desk.state)["bone1_x"]
    ball = desk.state["balls"][0]["position"]
    desk.type("joint-number-bone1_x", 25)
    desk.until(lambda s: angles(s)["bone1_x"] == pytest.approx(math.radians(25)))
    desk.agree()  # else the tab may not have seen what was between the two changes, which are then undone as one
    desk.part("limits").click()
    desk.until(lambda s: not s["limits"])
    desk.agree()
    desk.page.keyboard.press("Control+z")
    desk.until(lambda s: s["limits"] and s["led"] == [0])
    desk.agree()
    desk.click("undo")
    state = desk.until(lambda s: s["led"] == [])
    assert angles(state)["bone1_x"] == pytest.approx(first, abs=1e-3)
    np.testing.assert_allclose(state["balls"][0]["position"], ball, atol=1e-4)
    desk.expect("undo").to_be_disabled()
    desk.agree()
    desk.page.keyboard.press("Control+Shift+z")
    desk.until(lambda s: angles(s)["bone1_x"] == pytest.approx(math.radians(25), abs=1e-4))
    desk.agree()
    desk.choose("robot", "two_link")
    desk.until(lambda s: s["robot"] == "two_link")
    desk.agree()
    desk.click("undo")
    assert desk.until(lambda s: s["robot"] == "arm")


def test_changes_that_follow_each_other_before_an_answer_are_undone_as_one(open_panel):
    desk = open_panel("arm", methods=("dls",))
    desk.runs("{ for (const id of ['limits', 'polish']) document.getElementById(id).click(); }")
    desk.until(lambda s: not s["limits"] and s["polish"])
    desk.agree()
    desk.click("undo")
    desk.until(lambda s: s["limits"] and not s["polish"])
    desk.expect("undo").to_be_disabled()
    desk.agree()
    desk.click("redo")
    desk.until(lambda s: not s["limits"] and s["polish"])


def test_what_changes_nothing_is_not_undone(open_panel):
    desk = open_panel("arm", methods=("dls",))
    desk.part("limits").click()
    desk.until(lambda s: not s["limits"])
    desk.agree()
    desk.click("undo")
    desk.until(lambda s: s["limits"])
    desk.click("teach")
    desk.click("tab-race")
    desk.expect("redo").to_be_enabled()
    desk.click("redo")
    desk.until(lambda s: not s["limits"])
    desk.agree()
    desk.page.locator("#answers-block > summary").click()
    desk.click("find-answers")  # the balls are moved by hand already, so there is nothing to undo in it
    desk.expect("answers-words").to_contain_text("answers")
    desk.click("undo")
    desk.until(lambda s: s["limits"])


def test_undo_brings_back_where_a_free_root_was(open_panel):
    desk = open_panel("two_link", methods=("dls",), running=True, root="free_flyer")
    state = desk.until(lambda s: s["instances"][0]["status"] == "CONVERGED")
    before = state["instances"][0]["placements"]["root_joint"]
    desk.agree()
    desk.type("target-x", 3.0)
    desk.until(lambda s: s["instances"][0]["placements"]["root_joint"][0] > before[0] + 1)
    desk.agree()
    desk.click("undo")
    back = desk.until(lambda s: s["balls"][0]["position"][0] < 2 and s["instances"][0]["status"] == "CONVERGED")
    np.testing.assert_allclose(back["instances"][0]["placements"]["root_joint"], before, atol=1e-3)


def test_a_session_that_paused_on_a_miss_says_which_robot_missed(open_panel):
    desk = open_panel("arm", methods=("dls",), running=True)
    desk.part("pause-on-miss").click()
    desk.until(lambda s: s["pause_on_miss"])
    desk.type("target-x", 5)
    state = desk.until(lambda s: not s["running"])
    assert state["missed"].startswith("robot 1 (dls) missed: ")
    desk.expect("missed").to_contain_text("Paused: robot 1 (dls) missed")
    desk.click("start")
    desk.expect("missed").to_be_hidden()


@pytest.mark.parametrize("axes", ["ring-local", "ring-world"])
def test_a_ring_turns_the_orientation_about_its_axis_and_snaps_with_a_key(open_stage, axes):
    desk = open_stage("panda", methods=("dls",), running=True, view=1)
    before = np.array([0.3, 0.4, 0.5])
    desk.view.send("orientation", index=0, on=True, rpy=before.tolist())
    desk.until(lambda s: s["balls"][0]["oriented"])
    desk.agree()
    desk.settle()
    desk.click(axes)
    desk.shows("pinik.settled")
    at, to = (desk.page.evaluate("a => pinik.ringOnScreen(2, a)", angle) for angle in (1.0, 1.55))
    desk.page.mouse.move(at["x"], at["y"])
    desk.page.mouse.down()
    desk.page.keyboard.down("Control")
    desk.page.mouse.move(to["x"], to["y"], steps=4)
    desk.page.mouse.up()
    desk.page.keyboard.up("Control")
    desk.until(lambda s: not np.allclose(s["balls"][0]["rpy"], before))
    desk.page.wait_for_timeout(300)
    old, new = (pinocchio.rpy.rpyToMatrix(np.array(rpy)) for rpy in (before, desk.state["balls"][0]["rpy"]))
    turn = pinocchio.log3(old.T @ new if axes == "ring-local" else new @ old.T)
    assert np.abs(turn[:2]).max() < 1e-6, "the blue ring turns about z alone"
    assert turn[2] == pytest.approx(math.radians(30), abs=1e-6), "half a radian is 30° in steps of 15°"


def test_a_ball_snaps_to_centimetres_while_the_key_is_held(open_stage):
    desk = open_stage("arm", methods=("dls",), running=True, view=1)
    x, y = desk.ball_on_screen()
    desk.page.mouse.move(x, y)
    desk.page.mouse.down()
    desk.page.keyboard.down("Control")
    desk.page.mouse.move(x + 41, y - 33, steps=3)
    desk.page.mouse.up()
    desk.page.keyboard.up("Control")
    place = np.array(desk.until(lambda s: s["balls"][0]["position"][0] != 0)["balls"][0]["position"])
    desk.page.wait_for_timeout(300)
    place = np.array(desk.state["balls"][0]["position"])
    np.testing.assert_allclose(place, np.round(place, 2), atol=1e-9)


def test_a_picture_is_saved_as_large_as_wanted_and_transparent(open_desk):
    from PIL import Image

    desk = open_desk("arm", methods=("dls",), view=1)
    size = desk.page.locator("#canvas").bounding_box()
    desk.click("picture")
    for transparent in (False, True):
        if transparent:
            desk.click("picture")
            desk.part("picture-transparent").check()
        desk.part("picture-width").fill("2500")  # wider than one piece
        with desk.page.expect_download() as saved:
            desk.click("picture-save")
        with open(saved.value.path(), "rb") as file:
            picture = np.asarray(Image.open(io.BytesIO(file.read())))
        assert picture.shape[1] == 2500
        assert picture.shape[0] == pytest.approx(2500 * size["height"] / size["width"], abs=1)
        assert (picture[0, 0, 3], picture[..., 3].max()) == (0 if transparent else 255, 255)
        assert picture[..., 3].min() == (0 if transparent else 255)
