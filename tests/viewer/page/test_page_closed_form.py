"""The closed form on the page: the menu offers it if it fits the robot; otherwise a message says why not."""

from __future__ import annotations

from desk import METHODS

FITTING = [*METHODS, "two_bone"]


def offered(desk, i=0):
    return desk.part(f"method-{i}").locator("option").all_inner_texts()


def test_it_is_chosen_like_the_others_and_takes_one_iteration(open_panel):
    desk = open_panel("two_link", ("dls", "jt"))
    assert offered(desk) == FITTING
    desk.choose("method-0", "two_bone")
    desk.until(lambda s: s["instances"][0]["method"] == "two_bone")
    for name, place in (("x", 0.5), ("y", 0.3), ("z", 0.0)):
        desk.type(f"target-{name}", place)
    desk.until(lambda s: s["balls"][0]["position"] == [0.5, 0.3, 0.0])
    desk.click("step")
    desk.expect("status-0").to_have_text("reached")
    desk.expect("mean-iterations-0").to_have_text("1.0")
    desk.expect("efficiency-0").to_have_text("100 %")
    # On a slow machine the transpose beside it needs more steps than one.
    desk.wait(lambda: desk.is_followed(desk.state) or desk.click("step"))
    assert desk.is_followed(desk.state)
    desk.part("parameters-0").locator("summary").click()
    desk.choose("param-0-elbow", "up")
    desk.until(lambda s: s["instances"][0]["parameters"][-1]["value"] == "up")
    desk.click("step")
    desk.wait(lambda: desk.state["instances"][0]["angles"]["joint2"] < 0.0)
    desk.type("target-z", 0.1)
    desk.click("step")
    desk.expect("message-0").to_contain_text(
        "10 cm off the plane in which tip moves, whose normal is the z axis of the"
    )
    assert "methods=two_bone,jt" in desk.address()


def test_with_a_second_ball_it_waits_and_says_why(open_panel):
    desk = open_panel("two_link", ("dls", "two_bone"))
    desk.choose("add-effector", "link2")
    desk.until(lambda s: len(s["balls"]) == 2)
    desk.click("step")
    desk.expect("status-1").to_have_text("cannot do this")
    desk.expect("label-1").to_contain_text("cannot do this")
    desk.expect("message-1").to_have_text("waiting: two_bone takes only one target; got 2")
    assert offered(desk, 1) == FITTING
    desk.choose("ball-mode-1", "off")
    desk.click("step")
    desk.expect("status-1").to_have_text("reached")


def test_with_another_robot_it_makes_room_and_leaves_the_menu(open_panel):
    desk = open_panel("two_link", ("ccd", "two_bone"))
    desk.choose("robot", "arm")
    desk.until(lambda s: s["robot"] == "arm")
    desk.expect(desk.toasts).to_contain_text("instance 2 now uses dls: two_bone cannot chase a ball here")
    desk.expect("method-1").to_have_value("dls")
    assert offered(desk, 0) == offered(desk, 1) == list(METHODS)
    desk.choose("robot", "two_link")
    desk.until(lambda s: s["robot"] == "two_link")
    desk.wait(lambda: offered(desk) == FITTING)


def test_a_link_that_asks_for_it_elsewhere_is_answered_in_words(open_panel):
    desk = open_panel("arm", ("ccd", "jt"), setup="robot=arm&methods=ccd,two_bone")
    desk.expect(desk.toasts).to_contain_text("two_bone cannot chase a ball here: frame 'tip' is not moved by two")
    assert [one["method"] for one in desk.state["instances"]] == ["ccd", "jt"]
    desk.expect("method-1").to_have_value("jt")
