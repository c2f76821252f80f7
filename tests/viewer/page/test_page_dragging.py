"""Dragging in the 3-D view: the ball follows the pointer, the robots follow the ball, and the camera rests."""

from __future__ import annotations

import numpy as np
import pytest

from desk import HALF, METHODS, PHONE

RED = np.array([216, 31, 47])  # about what a ball looks like


def place(state, k=0):
    return np.array(state["balls"][k]["position"])


def camera(desk):
    return np.array(desk.runs("pinik.viewer.camera.matrixWorld.toArray()"))


def looks_along(desk):
    """The camera's direction in the robot's world, where z is up."""
    x, y, z = -camera(desk)[8:11]
    return np.array([x, -z, y])


def drag(desk, start, way, *, steps=6, release=True):
    """Press at a point [px], move by a way [px] in steps, and release."""
    mouse = desk.page.mouse
    mouse.move(*start)
    mouse.down()
    for k in range(1, steps + 1):
        mouse.move(start[0] + way[0] * k / steps, start[1] + way[1] * k / steps)
    if release:
        mouse.up()


def at_rest(desk):
    """Wait until the camera has looked twice whether everything is in the picture, and stayed; return where it is."""
    seen: list = []

    def stays() -> bool:
        seen.append(camera(desk))
        desk.page.wait_for_timeout(700)
        return (camera(desk) == seen[-1]).all()

    desk.wait(stays)
    return seen[-1]


def red_spots(picture):
    """The centres (x, y) of the red spots in a picture, from left to right."""
    is_red = (np.abs(picture - RED) < 60).all(axis=2) & (picture[..., 0] > 2 * picture[..., 1] + 20)
    columns = np.flatnonzero(is_red.sum(axis=0) > 2)
    groups = np.split(columns, np.flatnonzero(np.diff(columns) > 6) + 1)
    return [(group.mean(), np.flatnonzero(is_red[:, group].any(axis=1)).mean()) for group in groups if len(group) > 4]


def test_all_four_instances_follow_the_ball_that_is_dragged(open_stage):
    desk = open_stage(methods=METHODS, running=True)
    desk.until(desk.is_followed)
    desk.settle()
    begin, seen_from = place(desk.state), at_rest(desk)
    start = desk.ball_on_screen()
    drag(desk, start, (-25, 40), release=False)
    state = desk.until(lambda s: np.linalg.norm(place(s) - begin) > 0.03)
    np.testing.assert_allclose(camera(desk), seen_from, atol=1e-9, err_msg="the camera turned")
    desk.page.mouse.up()
    desk.wait(lambda: np.allclose(np.subtract(desk.ball_on_screen(), start), (-25, 40), atol=3))
    desk.agree()
    state = desk.until(desk.is_followed)
    assert len(state["instances"]) == 4
    assert abs((place(state) - begin) @ looks_along(desk)) < 1e-3, "not in the plane that is seen"
    for axis, coordinate in zip("xyz", place(state), strict=True):
        desk.wait(lambda axis=axis, coordinate=coordinate: abs(desk.value(f"target-{axis}") - coordinate) < 6e-4)


def test_a_ball_is_where_the_page_says_and_every_instances_copy_can_be_dragged(open_desk):
    desk = open_desk(methods=METHODS, viewport=HALF)
    box = desk.page.locator("#canvas").bounding_box()
    spots = red_spots(desk.picture())
    assert len(spots) == 4
    x, y = desk.ball_on_screen()
    np.testing.assert_allclose(spots[0], (x - box["x"], y - box["y"]), atol=4)
    for spot in spots[1:]:
        before = place(desk.agree())
        drag(desk, (spot[0] + box["x"], spot[1] + box["y"]), (0, -12))
        after = place(desk.until(lambda s, before=before: np.linalg.norm(place(s) - before) > 0.01))
        assert after[2] > before[2]
        desk.settle()


def test_a_camera_on_its_way_waits_until_the_ball_is_released(open_stage):
    desk = open_stage(methods=("dls",))
    at_rest(desk)
    desk.runs("{ pinik.show.frameAll(true, 'top'); pinik.show.hold(); }")
    at_rest(desk)
    assert looks_along(desk)[2] > -0.5, "it went on"
    desk.runs("pinik.show.letGoOfBall(0)")
    desk.wait(lambda: looks_along(desk)[2] < -0.99)


def test_a_drag_takes_the_ball_from_its_curve(open_stage):
    desk = open_stage(methods=("dls",), running=True, motion="curve", viewport=HALF)
    desk.until(lambda s: s["step"] > 20)
    desk.view.send("run", on=False)  # the ball waits for the hand, on its curve
    desk.agree()
    desk.settle()
    seen_from = camera(desk)
    drag(desk, desk.ball_on_screen(), (30, 0), release=False)
    desk.until(lambda s: s["motion"] == "hand")
    np.testing.assert_allclose(camera(desk), seen_from, atol=1e-9, err_msg="the camera turned")
    desk.page.mouse.up()
    desk.view.send("run", on=True)
    desk.until(desk.is_followed)


def test_with_shift_the_ball_keeps_its_height(open_stage):
    desk = open_stage(methods=("dls",), viewport=HALF)
    begin = place(desk.state)
    desk.page.keyboard.down("Shift")
    drag(desk, desk.ball_on_screen(), (-50, 25))
    desk.page.keyboard.up("Shift")
    after = place(desk.until(lambda s: np.linalg.norm(place(s) - begin) > 0.05))
    assert after[2] == pytest.approx(begin[2], abs=1e-5)


def test_dragging_beside_the_ball_turns_the_camera_and_moves_nothing(open_stage):
    desk = open_stage(methods=("dls",), viewport=HALF)
    begin, seen_from = desk.state["balls"], camera(desk)
    box = desk.page.locator("#canvas").bounding_box()
    drag(desk, (box["x"] + 60, box["y"] + box["height"] - 60), (120, -30))
    desk.wait(lambda: np.abs(camera(desk) - seen_from).max() > 0.05)
    assert desk.state["balls"] == begin
    desk.expect("camera-iso").to_have_attribute("aria-pressed", "false")
    desk.click("camera-iso")
    desk.settle()
    desk.wait(lambda: np.abs(camera(desk) - seen_from).max() < 1e-2)


def test_the_ball_that_is_taken_is_the_one_that_is_dragged_and_selected(open_stage):
    desk = open_stage("lion", methods=("dls",), viewport=HALF)
    desk.view.send("effector", index=4, mode="on")
    desk.agree()
    desk.settle()
    begin = [place(desk.state, k) for k in range(6)]
    drag(desk, desk.ball_on_screen(4), (0, -40))
    state = desk.until(lambda s: np.linalg.norm(place(s, 4) - begin[4]) > 0.02)
    assert all((place(state, k) == begin[k]).all() for k in (0, 1, 2, 3, 5))
    desk.expect("ball-4").to_have_attribute("aria-pressed", "true")


def test_a_finger_drags_the_ball_and_turns_the_camera_elsewhere(open_stage):
    desk = open_stage("arm", methods=("dls",), viewport=PHONE, has_touch=True, is_mobile=True)
    begin, seen_from = place(desk.state), camera(desk)
    fingers = desk.page.context.new_cdp_session(desk.page)

    def swipe(start, way):
        for kind, part in [("touchStart", 0.0), *[("touchMove", k / 5) for k in range(1, 6)]]:
            point = {"x": start[0] + way[0] * part, "y": start[1] + way[1] * part, "id": 1}
            fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [point]})
        fingers.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    swipe(desk.ball_on_screen(), (-30, 30))
    after = place(desk.until(lambda s: np.linalg.norm(place(s) - begin) > 0.03))
    assert after[2] < begin[2]
    np.testing.assert_allclose(camera(desk), seen_from, atol=1e-9, err_msg="the camera turned")
    assert desk.runs("scrollY + document.querySelector('.app').scrollTop") == 0
    box = desk.page.locator("#canvas").bounding_box()
    held = desk.state["balls"]
    swipe((box["x"] + 30, box["y"] + box["height"] - 30), (100, 0))
    desk.wait(lambda: np.abs(camera(desk) - seen_from).max() > 0.05)
    assert desk.state["balls"] == held
