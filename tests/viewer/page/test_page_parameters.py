"""The page's parameters: each kind of widget changes its solver while it runs, and shows the server's value."""

from __future__ import annotations

import pytest

from desk import METHODS


def open_parameters(open_panel, method, **options):
    """A running view of one instance with its parameters open."""
    desk = open_panel("two_link", methods=(method,), running=True, motion="curve", **options)
    open_all(desk, 0)
    return desk


def open_all(desk, instance):
    """Open an instance's card and show all of its parameters, if it offers a choice."""
    desk.part(f"parameters-{instance}").locator("summary").click()
    if desk.part(f"level-{instance}-all").is_visible():
        desk.click(f"level-{instance}-all")


def value(state, name, instance=0):
    return next(p for p in state["instances"][instance]["parameters"] if p["name"] == name)["value"]


def or_infinite(number):
    return float("inf") if number is None else number


def row(desk, testid):
    """A parameter's whole row: label, input, slider, help."""
    return desk.page.locator(".parameter").filter(has=desk.part(testid))


def test_every_parameter_has_a_widget_with_its_value_range_unit_and_help(open_panel):
    desk = open_panel("two_link", METHODS)
    state = desk.state
    described = [(i, p) for i, instance in enumerate(state["instances"]) for p in instance["parameters"]]
    for i in range(len(METHODS)):
        open_all(desk, i)
    for i, parameter in described:
        testid = f"param-{i}-{parameter['name']}"
        field = desk.part(testid)
        desk.expect(field).to_be_visible()
        said = row(desk, testid).inner_text()
        assert parameter["help"] in said
        assert parameter["unit"] in said
        assert parameter["symbol"] in said
        match parameter["kind"]:
            case "number":
                shown = field.input_value()
                assert float(shown or "inf") == pytest.approx(or_infinite(parameter["value"]), rel=1e-5)
                for bound, attribute in [("low", "min"), ("high", "max")]:
                    said = field.get_attribute(attribute)
                    assert (float(said) if said else None) == parameter[bound]
            case "truth":
                assert field.is_checked() is parameter["value"]
            case "choice":
                assert field.input_value() == parameter["value"]
                options = field.locator("option").evaluate_all("all => all.map(({ value }) => value)")
                assert options == parameter["choices"]
            case "joints":
                offered = field.locator("option").evaluate_all("all => all.map(({ value }) => value).filter(Boolean)")
                assert offered == state["joint_names"]


def test_a_card_shows_the_parameter_that_matters_then_more_then_all(open_panel):
    desk = open_panel("two_link", ("dls",))
    desk.part("parameters-0").locator("summary").click()
    rows = desk.part("parameters-0").locator(".parameter:visible .name")
    counts = []
    for level, name in enumerate(("main", "more", "all"), start=1):
        desk.click(f"level-0-{name}")
        own = [p["name"].replace("_", " ") for p in desk.state["instances"][0]["parameters"] if p["level"] <= level]
        desk.expect(rows).to_have_count(len(own))
        assert set(rows.evaluate_all("all => all.map((e) => e.firstChild.data)")) == set(own)
        counts.append(len(own))
    assert counts[0] == 1 < counts[1] < counts[2]
    assert rows.first.inner_text().split() == ["damping", "λ"]
    desk.choose("param-0-factorization", "svd")
    desk.click("level-0-main")
    desk.expect(rows).to_have_count(2)  # what was changed stays in view


def test_a_number_is_typed_or_slid(open_panel):
    desk = open_parameters(open_panel, "dls")
    desk.type("param-0-damping", 0.3)
    desk.until(lambda s: value(s, "damping") == 0.3)
    slider = row(desk, "param-0-damping").locator("input[type=range]")
    middle = float(slider.input_value())
    slider.fill("0")
    low = value(desk.until(lambda s: value(s, "damping") != 0.3), "damping")
    assert low == pytest.approx(0.001)
    slider.fill("1000")
    assert value(desk.until(lambda s: value(s, "damping") > 1), "damping") == pytest.approx(10.0)
    desk.expect("param-0-damping").to_have_value("10")
    assert 0 < middle < 1000
    assert desk.state["running"]


def test_a_choice_a_truth_and_their_way_back_to_the_defaults(open_panel):
    desk = open_parameters(open_panel, "dls")
    defaults = desk.part("defaults-0")
    desk.expect(defaults).to_be_disabled()
    desk.choose("param-0-rule", "manipulability")
    desk.until(lambda s: value(s, "rule") == "manipulability")
    desk.part("param-0-target_jacobian").check()
    desk.until(lambda s: value(s, "target_jacobian") is True)
    desk.part("param-0-target_jacobian").uncheck()
    desk.until(lambda s: value(s, "target_jacobian") is False)
    desk.type("param-0-damping", 0.2)
    desk.until(lambda s: value(s, "damping") == 0.2)
    desk.agree()
    defaults.click()
    desk.until(lambda s: all(p["value"] == p["default"] for p in s["instances"][0]["parameters"]))
    desk.expect("param-0-rule").to_have_value("residual")
    desk.expect(defaults).to_be_disabled()


def test_a_word_stands_for_no_number(open_panel):
    desk = open_parameters(open_panel, "jt")
    word = row(desk, "param-0-alpha").get_by_label("automatic")
    desk.expect(word).to_be_checked()
    word.uncheck()
    assert value(desk.until(lambda s: value(s, "alpha") is not None), "alpha") > 0
    desk.expect("param-0-alpha").not_to_have_value("")
    word.check()
    desk.until(lambda s: value(s, "alpha") is None)
    desk.type("param-0-alpha", 0.25)
    desk.until(lambda s: value(s, "alpha") == 0.25)
    desk.expect(word).not_to_be_checked()
    desk.type("param-0-alpha", "")
    desk.until(lambda s: value(s, "alpha") is None)
    limit = row(desk, "param-0-max_step").get_by_label("no limit")
    desk.expect(limit).not_to_be_checked()
    limit.check()
    desk.until(lambda s: value(s, "max_step") is None)


def test_joints_get_numbers_one_by_one_and_lose_them(open_panel):
    desk = open_parameters(open_panel, "ccd")
    first, second = desk.state["joint_names"]
    for joint in (first, second):
        desk.choose("param-0-stiffness", joint)
        desk.until(lambda s, joint=joint: joint in value(s, "stiffness"))
    desk.type(f"param-0-stiffness-{second}", 0.75)
    desk.until(lambda s: value(s, "stiffness")[second] == 0.75)
    desk.page.get_by_role("button", name=f"Remove {first}").click()
    assert value(desk.until(lambda s: first not in value(s, "stiffness")), "stiffness") == {second: 0.75}
    desk.expect(f"param-0-stiffness-{first}").to_have_count(0)


def test_a_joint_added_before_the_last_one_is_confirmed_keeps_both(open_panel):
    desk = open_panel("two_link", methods=("ccd",))
    tab = desk.page.context.new_page()
    wires, states = [], []

    def carry(wire):
        wires.append(wire)
        wire.connect_to_server().on_message(take)

    def take(message):
        if isinstance(message, str) and message.startswith('{"type": "state"'):
            states.append(message)
        if len(states) <= 1:
            wires[0].send(message)

    tab.route_web_socket("**/ws", carry)
    tab.goto(desk.view.url)
    tab.wait_for_function("() => pinik.state")
    tab.get_by_test_id("parameters-0").locator("summary").click()
    first, second = desk.state["joint_names"]
    tab.evaluate("() => { const now = performance.now(); performance.now = () => now; }")  # no time passes between them
    tab.get_by_test_id("level-0-all").click()
    adder = tab.get_by_test_id("param-0-stiffness")
    adder.select_option(first)
    desk.until(lambda s: first in value(s, "stiffness"))
    wires[0].send(states[0])  # told before the server heard of the first joint
    adder.select_option(second)
    assert set(value(desk.until(lambda s: second in value(s, "stiffness")), "stiffness")) == {first, second}


def test_another_method_or_instance_keeps_to_its_own_parameters(open_panel):
    desk = open_panel("two_link", methods=("dls", "pinv"), running=True)
    for i in (0, 1):
        open_all(desk, i)
    desk.type("param-1-cutoff", 0.05)
    state = desk.until(lambda s: value(s, "cutoff", 1) == 0.05)
    assert all(p["value"] == p["default"] for p in state["instances"][0]["parameters"])
    desk.choose("method-1", "ccd")
    desk.expect("param-1-cutoff").to_have_count(0)
    desk.expect("param-1-relaxation").to_be_visible()


def test_a_number_out_of_range_is_refused_in_words_and_shown_as_it_was(open_panel):
    desk = open_panel("two_link", ("dls", "ccd"))
    joint = desk.state["joint_names"][0]
    for i in (0, 1):
        open_all(desk, i)
    desk.choose("param-1-stiffness", joint)
    desk.until(lambda s: value(s, "stiffness", 1))
    chosen = [i["parameters"] for i in desk.agree()["instances"]]
    bad = {"param-0-damping": -1, "param-0-step_size": 7, "param-1-relaxation": 5, f"param-1-stiffness-{joint}": 2}
    for testid, number in bad.items():
        shown = desk.part(testid).input_value()
        desk.type(testid, number)
        desk.expect(desk.toasts).to_have_count(1)
        assert testid.split("-")[2] in desk.toasts.inner_text()
        assert str(number) in desk.toasts.inner_text()
        desk.toasts.get_by_role("button").click()
        assert [i["parameters"] for i in desk.state["instances"]] == chosen
        desk.expect(testid).to_have_value(shown)
