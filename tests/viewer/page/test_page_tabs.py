"""One session in several tabs: reloads, a second tab, a server that restarts, and links."""

from __future__ import annotations

import numpy as np

import pinik
from desk import DRAWN, METHODS, SMALL, need_browser, settings


def changed(desk):
    """Change several settings from their defaults."""
    desk.choose("motion", "random")
    desk.type("speed", 2)
    desk.choose("method-0", "pinv")
    desk.part("limits").uncheck()
    return desk.until(lambda s: s["speed"] == 2 and s["instances"][0]["method"] == "pinv" and not s["limits"])


def second_tab(desk):
    page = desk.page.context.new_page()
    page.set_viewport_size(SMALL)
    page.goto(desk.view.url)
    page.wait_for_function("() => window.pinik?.ready")
    return page


def test_a_reload_comes_back_to_the_same_session(open_panel):
    desk = open_panel("two_link", methods=("dls",), running=True)
    before = settings(changed(desk))
    assert before == settings(desk.agree())
    step = desk.state["step"]
    desk.page.reload()
    desk.settle()
    assert settings(desk.agree()) == before
    assert desk.state["step"] > step, "the session began anew"
    desk.expect("speed").to_have_value("2")
    desk.expect("method-0").to_have_value("pinv")
    desk.expect("limits").not_to_be_checked()


def test_a_reload_asks_for_nothing_that_its_address_said_before(open_panel):
    desk = open_panel(methods=("dls",))
    desk.agree()
    desk.page.route("**/*", lambda route: (desk.view.send("view", count=2), route.continue_()))
    desk.page.reload()
    desk.page.unroute_all()
    desk.settle()
    assert desk.agree()["view"] == 2


def test_a_second_tab_agrees_and_each_sees_what_the_other_does(open_panel):
    desk = open_panel(methods=METHODS)
    desk.type("target-z", 0.7)
    desk.until(lambda s: s["balls"][0]["position"][2] == 0.7)
    second = second_tab(desk)
    expect = need_browser().expect
    expect(second.get_by_test_id("target-z")).to_have_value("0.7")
    second.get_by_test_id("method-2").select_option("ccd")
    desk.expect("method-2").to_have_value("ccd")
    desk.click("view-1")
    expect(second.locator("[data-testid^='instance-']")).to_have_count(1)
    assert second.evaluate("() => pinik.state.setup") == desk.agree()["setup"]
    desk.click("start")
    expect(second.get_by_test_id("start")).to_have_text("Stop")
    second.get_by_test_id("start").click()
    desk.expect("start").to_have_text("Start")


def test_a_bad_message_is_told_to_its_own_tab_alone(open_panel):
    desk = open_panel("two_link", methods=("dls",))
    second = second_tab(desk)
    desk.type("speed", 1e6)
    desk.expect(desk.toasts).to_have_count(1)
    second.get_by_test_id("step").click()
    second.wait_for_function("() => pinik.state.step === 1")
    assert second.get_by_test_id("toasts").inner_text() == ""


def test_the_page_comes_back_by_itself_when_the_server_does(open_panel, two_link):
    desk = open_panel(methods=("dls",), running=True, motion="curve")
    desk.faults.excuse("WebSocket")
    port = desk.view.port
    desk.expect("banner").to_be_hidden()
    desk.view.close()
    desk.expect("banner").to_be_visible()
    desk.view = pinik.live(two_link, ["ccd"], port=port, running=False)
    desk.expect("banner").to_be_hidden()
    desk.expect("robot").to_have_value("two_link")
    desk.settle()
    desk.expect("label-0").to_contain_text("yclic")
    desk.click("step")
    desk.until(lambda s: s["step"] == 1)
    assert desk.address().startswith("robot=two_link")


def test_a_server_that_is_started_again_with_the_same_robot_gets_the_set_up_back(open_panel):
    desk = open_panel("two_link", methods=("dls",), running=True)
    desk.faults.excuse("WebSocket")
    before, address, port = settings(changed(desk)), desk.address(), desk.view.port
    desk.view.close()
    desk.expect("banner").to_be_visible()
    desk.view = pinik.live(desk.view.robot, ["ccd"], port=port)
    desk.expect("banner").to_be_hidden()
    after = desk.until(lambda s: s["speed"] == 2 and not s["limits"])
    assert {**settings(after), "generation": 0} == {**before, "generation": 0}
    assert desk.address() == address


def test_the_address_carries_everything_to_another_server(open_panel, two_link):
    desk = open_panel("lion", METHODS, root="free_flyer", view=2)
    desk.choose("method-0", "dls")
    desk.part("parameters-0").locator("summary").click()
    desk.type("param-0-damping", 0.125)
    desk.choose("method-1", "ccd")
    desk.part("parameters-1").locator("summary").click()
    desk.click("level-1-all")
    desk.choose("param-1-stiffness", "neck_yaw")
    desk.choose("ball-mode-1", "off")
    desk.choose("ball-mode-4", "on")
    desk.type("tolerance", 0.5)
    desk.type("speed", 3)
    desk.part("limits").uncheck()
    desk.click("ball-4")
    desk.type("target-z", 0.35)
    desk.part("orientation").check()
    desk.until(lambda s: s["balls"][4]["oriented"] and s["balls"][4]["position"][2] == 0.35 and not s["limits"])
    told = desk.agree()
    address = desk.address()
    values = {p["name"]: p["value"] for p in told["instances"][1]["parameters"]}
    assert values["stiffness"], "no stiffness was set"

    desk.view.close()
    desk.faults.excuse("WebSocket")
    desk.visit(pinik.live(two_link, ["jt"], port=0), address, until="window.pinik?.ready")
    desk.until(lambda s: s["robot"] == "lion" and s["loading"] is None)
    found = desk.agree()
    assert settings(found) | {"generation": 0, "balls": 0} == settings(told) | {"generation": 0, "balls": 0}
    for before, after in zip(told["balls"], found["balls"], strict=True):
        assert [after[k] for k in ("frame", "mode", "oriented")] == [before[k] for k in ("frame", "mode", "oriented")]
        if before["mode"] != "off":
            np.testing.assert_allclose(after["position"], before["position"], atol=1e-4)
        if before["oriented"]:
            np.testing.assert_allclose(after["rpy"], before["rpy"], atol=1e-4)
    for before, after in zip(told["instances"], found["instances"], strict=True):
        assert [after[k] for k in ("method", "parameters")] == [before[k] for k in ("method", "parameters")]


def test_a_frame_of_the_robot_before_is_not_drawn_as_the_next_one(open_panel):
    desk = open_panel("two_link", ("dls",))
    tab = desk.page.context.new_page()
    wires, late, holds = [], [], False

    def carry(wire):
        wires.append(wire)
        wire.connect_to_server().on_message(lambda message: late.append(message) if holds else wire.send(message))

    def tells_of_lion(message):
        return isinstance(message, str) and message.startswith('{"type": "state"') and '"robot": "lion"' in message

    tab.route_web_socket("**/ws", carry)
    tab.set_viewport_size(SMALL)
    tab.goto(desk.view.url)
    tab.wait_for_function(f"() => {DRAWN}")
    holds = True
    desk.view.send("step")
    desk.wait(lambda: any(message[:4] == b"PNKF" for message in late))
    desk.view.send("robot", name="lion", root="fixed")
    desk.wait(lambda: any(map(tells_of_lion, late)))
    together = next(k for k, message in enumerate(late) if tells_of_lion(message)) + 1
    for message in late[:together]:  # the old robot's frame, the new robot, its state: all before the next drawing
        wires[0].send(message)
    tab.wait_for_function("() => pinik.state.robot === 'lion'")
    tab.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    holds = False
    for message in late[together:]:
        wires[0].send(message)
    tab.wait_for_function(f"() => {DRAWN}")


def test_a_bad_link_is_refused_in_words_and_the_page_lives_on(open_panel):
    desk = open_panel("two_link", ("dls",), setup="robot=no_such_robot&view=2")
    desk.expect(desk.toasts).to_contain_text("no_such_robot")
    assert (desk.state["robot"], desk.state["view"]) == ("two_link", 1)
    desk.click("view-2")
    desk.until(lambda s: s["view"] == 2)


def test_a_pasted_address_changes_the_open_page(open_panel):
    desk = open_panel("two_link", ("dls",))
    desk.address()
    desk.page.evaluate(
        """pasted => {
            const before = location.hash;
            location.hash = pasted;
            history.replaceState(null, "", before);  // as the page may do itself in this very moment
        }""",
        "robot=two_link&view=2&methods=ccd,dls&motion=random",
    )
    state = desk.until(lambda s: s["view"] == 2 and s["motion"] == "random")
    assert [i["method"] for i in state["instances"]] == ["ccd", "dls"]
    desk.expect("motion").to_have_value("random")
