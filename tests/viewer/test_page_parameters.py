"""The page's parameters: each kind of widget changes its solver while it runs, and shows what the server holds."""

from __future__ import annotations

import pytest


def open_parameters(open_desk, method, **options):
    """A running view of one instance with its parameters open."""
    desk = open_desk("two_link", methods=(method,), running=True, motion="curve", **options)
    desk.part("parameters-0").locator("summary").click()
    return desk


def value(state, name, instance=0):
    return next(p for p in state["instances"][instance]["parameters"] if p["name"] == name)["value"]


def or_infinite(number):
    return float("inf") if number is None else number


def row(desk, testid):
    """A parameter's whole row: label, input, slider, help."""
    return desk.page.locator(".parameter").filter(has=desk.part(testid))


@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
def test_every_parameter_has_a_widget_with_its_value_range_unit_and_help(open_desk, method):
    desk = open_desk("two_link", methods=(method,))
    desk.part("parameters-0").locator("summary").click()
    for parameter in desk.state["instances"][0]["parameters"]:
        field = desk.part(f"param-0-{parameter['name']}")
        desk.expect(field).to_be_visible()
        desk.expect(row(desk, f"param-0-{parameter['name']}")).to_contain_text(parameter["help"])
        desk.expect(row(desk, f"param-0-{parameter['name']}")).to_contain_text(parameter["unit"])
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
                assert offered == desk.state["joint_names"]


def test_a_number_is_typed_or_slid(open_desk):
    desk = open_parameters(open_desk, "dls")
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


def test_a_choice_a_truth_and_their_way_back_to_the_defaults(open_desk):
    desk = open_parameters(open_desk, "dls")
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
    defaults.click()
    desk.until(lambda s: all(p["value"] == p["default"] for p in s["instances"][0]["parameters"]))
    desk.expect("param-0-rule").to_have_value("residual")
    desk.expect(defaults).to_be_disabled()


def test_a_word_stands_for_no_number(open_desk):
    desk = open_parameters(open_desk, "jt")
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


def test_joints_get_numbers_one_by_one_and_lose_them(open_desk):
    desk = open_parameters(open_desk, "ccd")
    first, second = desk.state["joint_names"]
    for joint in (first, second):
        desk.choose("param-0-stiffness", joint)
        desk.until(lambda s, joint=joint: joint in value(s, "stiffness"))
    desk.type(f"param-0-stiffness-{second}", 0.75)
    desk.until(lambda s: value(s, "stiffness")[second] == 0.75)
    desk.page.get_by_role("button", name=f"Remove {first}").click()
    assert value(desk.until(lambda s: first not in value(s, "stiffness")), "stiffness") == {second: 0.75}
    desk.expect(f"param-0-stiffness-{first}").to_have_count(0)


def test_another_method_or_instance_keeps_to_its_own_parameters(open_desk):
    desk = open_desk("two_link", methods=("dls", "pinv"), running=True)
    for i in (0, 1):
        desk.part(f"parameters-{i}").locator("summary").click()
    desk.type("param-1-cutoff", 0.05)
    state = desk.until(lambda s: value(s, "cutoff", 1) == 0.05)
    assert all(p["value"] == p["default"] for p in state["instances"][0]["parameters"])
    desk.choose("method-1", "ccd")
    desk.expect("param-1-cutoff").to_have_count(0)
    desk.expect("param-1-relaxation").to_be_visible()


@pytest.mark.parametrize(
    ("method", "name", "bad", "good"),
    [("dls", "damping", -1, "0.707107"), ("dls", "step_size", 7, "1"), ("ccd", "relaxation", 5, "")],
)
def test_a_parameter_out_of_range_is_refused_in_words_and_shown_as_it_was(open_desk, method, name, bad, good):
    desk = open_parameters(open_desk, method)
    before = value(desk.state, name)
    desk.type(f"param-0-{name}", bad)
    desk.expect(desk.toasts).to_have_count(1)
    assert name in desk.toasts.inner_text()
    assert str(bad) in desk.toasts.inner_text()
    assert value(desk.state, name) == before
    desk.expect(f"param-0-{name}").to_have_value(good)


def test_a_joints_number_out_of_range_is_refused_in_words(open_desk):
    desk = open_parameters(open_desk, "ccd")
    joint = desk.state["joint_names"][0]
    desk.choose("param-0-stiffness", joint)
    before = value(desk.until(lambda s: value(s, "stiffness")), "stiffness")
    desk.type(f"param-0-stiffness-{joint}", 2)
    desk.expect(desk.toasts).to_have_count(1)
    assert joint in desk.toasts.inner_text()
    assert value(desk.state, "stiffness") == before
    desk.expect(f"param-0-stiffness-{joint}").to_have_value(f"{before[joint]:g}")
