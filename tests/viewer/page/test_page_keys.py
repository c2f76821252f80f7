"""The page used by keyboard alone: every key in the help, and every control by Tab."""

from __future__ import annotations

import numpy as np
import pytest

CONTROLS = "button, select, input, a[href], summary, [tabindex='0']"


def place(state, k=0):
    return np.array(state["balls"][k]["position"])


@pytest.fixture
def desk(open_panel):
    return open_panel(methods=("dls",), view=2)


def changes(desk, key, of):
    """The value `of` the server's state before and after a key is pressed."""
    before = of(desk.agree())
    desk.page.keyboard.press(key)
    return before, of(desk.until(lambda s: not np.array_equal(of(s), before)))


def test_space_dot_and_r_run_step_and_reset(desk):
    assert changes(desk, "Space", lambda s: s["running"]) == (False, True)
    desk.expect("start").to_have_text("Stop")
    assert changes(desk, "Space", lambda s: s["running"]) == (True, False)
    desk.expect("start").to_have_text("Start")
    step = desk.state["step"]
    assert changes(desk, ".", lambda s: s["step"]) == (step, step + 1)
    assert changes(desk, "r", lambda s: s["step"]) == (step + 1, 0)


def test_letters_and_figures_change_the_settings(desk):
    for count in (1, 4, 2):
        assert changes(desk, str(count), lambda s: s["view"])[1] == count
    assert [changes(desk, "m", lambda s: s["motion"])[1] for _ in range(3)] == ["curve", "random", "hand"]
    curves = [changes(desk, "c", lambda s: s["curve"])[1] for _ in range(5)]
    assert len(set(curves)) == 5
    assert changes(desk, "+", lambda s: s["speed"])[1] > 1
    assert changes(desk, "-", lambda s: s["speed"])[1] == pytest.approx(1)
    assert changes(desk, "l", lambda s: s["limits"]) == (True, False)
    assert changes(desk, "o", lambda s: s["balls"][0]["oriented"]) == (False, True)


def test_arrows_and_page_keys_move_the_selected_ball(desk):
    desk.click("camera-front")  # where right is y and away is −x
    desk.settle()
    desk.stop_clock()
    moves = {"ArrowRight": (0, 1, 0), "ArrowLeft": (0, -1, 0), "ArrowUp": (-1, 0, 0), "ArrowDown": (1, 0, 0)}
    moves |= {"PageUp": (0, 0, 1), "PageDown": (0, 0, -1)}
    steps = []
    for key, direction in moves.items():
        before, after = changes(desk, key, place)
        steps.append(np.linalg.norm(after - before))
        np.testing.assert_allclose((after - before) / steps[-1], direction, atol=1e-4)
    np.testing.assert_allclose(steps, steps[0], rtol=1e-3)
    before, after = changes(desk, "Shift+ArrowRight", place)
    assert 0 < np.linalg.norm(after - before) < 0.5 * steps[0]


def test_keys_held_down_lose_no_step(desk):
    desk.stop_clock()
    before, after = changes(desk, "PageUp", place)
    for _ in range(9):
        desk.page.keyboard.press("PageUp")
    desk.until(lambda s: place(s)[2] - before[2] == pytest.approx(10 * (after - before)[2], abs=1e-5))


def test_b_selects_the_next_ball_and_the_arrows_move_that(open_panel):
    desk = open_panel("lion", methods=("dls",))
    desk.view.send("effector", index=1, mode="on")
    desk.agree()
    desk.page.keyboard.press("b")
    desk.expect("ball-1").to_have_attribute("aria-pressed", "true")
    first, second = changes(desk, "PageUp", lambda s: (place(s, 0).tolist(), place(s, 1).tolist()))
    assert first[0] == second[0]
    assert second[1][2] > first[1][2]


def test_p_opens_the_parameters_of_one_method_after_the_other(desk):
    fields = ["param-0-damping", "param-1-relaxation"]
    desk.agree()
    for visible in [(True, False), (False, True), (False, False)]:
        desk.page.keyboard.press("p")
        for field, wanted in zip(fields, visible, strict=True):
            desk.expect(field).to_be_visible(visible=wanted)


def test_v_f_and_t_change_what_is_seen(desk):
    desk.settle()
    desk.page.keyboard.press("v")
    desk.expect("camera-front").to_have_attribute("aria-pressed", "true")
    desk.page.keyboard.press("v")
    desk.expect("camera-side").to_have_attribute("aria-pressed", "true")
    desk.settle()
    looked = desk.runs("pinik.viewer.camera.position.toArray()")
    desk.page.locator("#canvas").hover(position={"x": 300, "y": 40})
    desk.page.mouse.wheel(0, 600)
    desk.shows(f"pinik.viewer.camera.position.distanceTo({{x: {looked[0]}, y: {looked[1]}, z: {looked[2]}}}) > 0.1")
    desk.page.keyboard.press("f")
    desk.shows(f"pinik.viewer.camera.position.distanceTo({{x: {looked[0]}, y: {looked[1]}, z: {looked[2]}}}) < 0.01")
    themes = []
    for _ in range(3):
        desk.page.keyboard.press("t")
        themes.append(desk.runs("document.documentElement.dataset.theme"))
    assert themes == ["light", "dark", "light"]


def test_the_help_lists_every_key_and_opens_and_closes_by_keys(desk):
    desk.expect("help-dialog").to_be_hidden()
    desk.page.keyboard.press("?")
    desk.expect("help-dialog").to_be_visible()
    tested = ["Space", ".", "e", ",", "r", "1", "2", "4", "m", "c", "+", "−", "l", "p", "b", "←", "→", "↑", "↓"]
    tested += ["Page ↑", "Page ↓", "o", "v", "0", "h", "w", "f", "t", "?"]
    assert desk.part("help-dialog").locator("dt kbd").all_inner_texts() == tested
    assert all(desk.part("help-dialog").locator("dd").all_inner_texts())
    desk.page.keyboard.press("l")
    desk.page.keyboard.press("Escape")
    desk.expect("help-dialog").to_be_hidden()
    desk.click("help")
    desk.expect("help-dialog").to_be_visible()
    desk.part("help-dialog").get_by_role("button").click()
    desk.expect("help-dialog").to_be_hidden()
    assert desk.state["limits"] is True, "a key behind the open help did something"


def test_no_key_does_anything_behind_an_open_dialog(desk):
    desk.view.send("step")
    step = desk.until(lambda s: s["step"] > 0)["step"]
    desk.click("picture")
    desk.expect("picture-dialog").to_be_visible()
    desk.part("picture-dialog").get_by_role("button").first.focus()
    for key in ("r", "l"):
        desk.page.keyboard.press(key)
    desk.page.keyboard.press("Escape")
    desk.expect("picture-dialog").to_be_hidden()
    assert changes(desk, "1", lambda s: s["view"]) == (2, 1)
    assert (desk.state["step"], desk.state["limits"]) == (step, True)


def test_what_is_typed_into_an_input_is_no_command(desk):
    before = desk.agree()
    desk.part("target-x").focus()
    for key in ["2", "4", ".", "r", "l", "m", "c", "o", "b", "p", "-", "+", " ", "t", "?"]:
        desk.page.keyboard.press(key)
    desk.expect("help-dialog").to_be_hidden()
    desk.part("limits").focus()
    assert changes(desk, " ", lambda s: s["limits"]) == (True, False), "space switches the box, and nothing else"
    assert {**desk.state, "limits": True, "setup": ""} == {**before, "setup": ""}
    desk.part("step").focus()
    assert changes(desk, " ", lambda s: s["step"]) == (0, 1)
    assert desk.state["running"] is False


def test_tab_reaches_every_control_and_its_focus_is_seen(open_panel):
    desk = open_panel("two_link", methods=("dls", "ccd"))
    desk.page.keyboard.press("p")
    desk.page.evaluate(
        """selector => {
            const isOffered = (e) => !e.disabled && e.checkVisibility({ visibilityProperty: true });
            window.wanted = [...document.querySelectorAll(selector)].filter(isOffered);
            document.activeElement.blur();
        }""",
        CONTROLS,
    )
    count = desk.runs("wanted.length")
    assert count > 40
    seen = {}
    for _ in range(count + 5):
        desk.page.keyboard.press("Tab")
        at = desk.runs(
            """{
                const e = document.activeElement, box = e.getBoundingClientRect(), style = getComputedStyle(e);
                const ringed = style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1;
                const inside = box.top < innerHeight && box.bottom > 0 && box.left < innerWidth && box.right > 0;
                return { index: wanted.indexOf(e), ringed, inside, what: e.outerHTML.slice(0, 120) };
            }"""
        )
        if at["index"] >= 0:
            assert at["ringed"], f"no ring around {at['what']}"
            assert at["inside"], f"out of sight: {at['what']}"
            seen[at["index"]] = at["what"]
    missed = [i for i in range(count) if i not in seen]
    assert not missed, desk.page.evaluate("missed => missed.map(i => wanted[i].outerHTML)", missed)
