"""Collisions, obstacles and other answers in the page's panel."""

from __future__ import annotations

import pytest

from judge import plain_placement


@pytest.fixture
def desk(open_panel):
    opened = open_panel("panda", methods=("dls", "ccd"), running=True)
    opened.page.locator("#around-block > summary").click()
    opened.page.locator("#answers-block > summary").click()
    return opened


def test_an_obstacle_is_put_down_resized_moved_and_removed(desk):
    desk.click("add-box")
    state = desk.until(lambda s: len(s["obstacles"]) == 1)
    assert state["obstacles"][0]["kind"] == "box"
    desk.until(lambda s: s["collisions"]["on"])
    desk.type("obstacle-0-x", 0.9)
    desk.until(lambda s: s["obstacles"][0]["position"][0] == 0.9)
    desk.type("obstacle-0-height", 0.4)
    desk.until(lambda s: s["obstacles"][0]["size"][2] == 0.4)
    desk.click("add-sphere")
    desk.until(lambda s: [each["kind"] for each in s["obstacles"]] == ["box", "sphere"])
    desk.click("remove-obstacle-0")
    desk.until(lambda s: [each["kind"] for each in s["obstacles"]] == ["sphere"])
    desk.expect("obstacle-0-radius").to_have_count(1)


@pytest.mark.parametrize("kind", ["box", "sphere"])
def test_an_obstacle_is_grabbed_wherever_it_is_seen(open_stage, kind):
    desk = open_stage("two_link", methods=("dls",), view=1)
    size = [0.4, 0.4, 0.4] if kind == "box" else [0.2]
    desk.view.send("add_obstacle", kind=kind, size=size, position=[1.5, 1.5, 0.5])
    desk.shows("pinik.state.obstacles.length === 1")
    desk.click("frame-all")
    desk.settle()
    at = desk.runs("pinik.show.stage.project(new pinik.show.camera.sphere.center.constructor(1.5, 1.5, 0.5))")
    box = desk.page.locator("#canvas").bounding_box()
    x, y = box["x"] + at["x"], box["y"] + at["y"]
    aside = 0.8 * 0.2 / desk.runs("pinik.show.stage.pixel")
    assert aside > 15
    desk.page.mouse.move(x + aside, y)
    desk.page.mouse.down()
    desk.page.mouse.move(x + aside, y - 40, steps=4)
    desk.page.mouse.up()
    state = desk.until(lambda s: s["obstacles"][0]["position"] != [1.5, 1.5, 0.5])
    assert state["obstacles"][0]["position"][2] > 0.5


def test_what_touches_is_named_and_then_avoided(desk):
    ball = desk.state["balls"][0]["position"]
    desk.click("add-sphere")
    desk.until(lambda s: s["collisions"]["on"] and not s["collisions"]["loading"])
    for axis, coordinate in zip("xyz", (0.35, 0.0, 0.75), strict=True):
        desk.type(f"obstacle-0-{axis}", coordinate)
    desk.until(lambda s: s["instances"][0]["touching"])
    desk.expect("collisions-words").to_contain_text("obstacle 1")
    desk.click("avoid")
    state = desk.until(lambda s: not any(each["touching"] for each in s["instances"]))
    assert state["collisions"]["avoid"]
    desk.expect("collisions-words").to_have_text("Nothing touches")
    assert desk.until(desk.is_followed)["balls"][0]["position"] == ball


def test_answers_stay_although_the_ball_moved_when_they_were_asked_for(open_panel):
    desk = open_panel("ur5", methods=("dls",), running=True, motion="curve", setup="robot=ur5&motion=curve")
    desk.page.locator("#answers-block > summary").click()
    desk.until(lambda s: s["step"] > 30)
    desk.click("find-answers")
    desk.expect("answers-words").to_contain_text("answer")
    step = desk.state["step"]
    desk.shows(f"pinik.state.step > {step + 30}")
    desk.expect("answers-words").to_contain_text("answer")
    assert desk.part("answers-list").locator("button").count() > 0


def test_a_set_of_answers_with_more_dimensions_says_what_to_ask_for(open_panel):
    desk = open_panel("panda", methods=("dls",))
    desk.page.locator("#answers-block > summary").click()
    desk.click("find-self-motion")
    desk.expect("answers-words").to_contain_text("such as an orientation")
    desk.expect("self-motion-slider").to_be_hidden()


def test_an_answer_is_taken_by_its_number(desk):
    before = desk.state["instances"][0]["angles"]
    desk.click("find-answers")
    desk.expect("answer-3").to_have_count(1)
    desk.expect("answers-words").to_contain_text("answers")
    desk.click("answer-3")
    state = desk.until(lambda s: s["instances"][0]["angles"] != before and s["instances"][0]["status"] == "CONVERGED")
    after = state["instances"][0]["angles"]
    assert max(abs(after[name] - before[name]) for name in before) > 0.01
    (q, _) = desk.view.configurations
    at = plain_placement(desk.view.robot, state["balls"][0]["frame"], q).translation
    assert at == pytest.approx(state["balls"][0]["position"], abs=2e-4)


def test_a_robot_without_collision_shapes_says_so(open_panel):
    desk = open_panel("asr_twodof", methods=("dls",), running=True)
    desk.page.locator("#around-block > summary").click()
    desk.click("collisions")
    desk.expect("collisions-words").to_contain_text("no collision shapes")


def test_a_search_that_fails_is_not_said_to_go_on(desk):
    desk.choose("ball-mode-0", "off")
    desk.until(lambda s: s["balls"][0]["mode"] == "off")
    desk.click("find-answers")
    desk.expect("toasts").to_contain_text("no ball asks for anything")
    desk.expect("answers-words").to_have_text("")
