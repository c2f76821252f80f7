"""The page's figures agree with the server's; messages say why a target is missed; results can be saved."""

from __future__ import annotations

import csv
import io
import json
import re
import urllib.request

import numpy as np
import pytest
from PIL import Image

from desk import METHODS
from glb_player import Player
from urdf_texts import chain

COLUMNS = ["mean-time", "mean-iterations", "efficiency", "mean-error", "largest-jump"]
UNITS = {"ms": 1e-3, "µs": 1e-6, "%": 0.01, "m": 1.0, "cm": 0.01, "mm": 0.001, "°": np.pi / 180, "": 1.0}


def figures(desk, i):
    """The figures in a row of the table, in SI units: name → (value, half of its last digit)."""
    said = {}
    for column in COLUMNS:
        text = desk.text(f"{column}-{i}").split("/")[0].strip()
        found = re.fullmatch(r"([\d.]+)\s*(\D*)", text)
        assert found, f"{column}: {text!r}"
        decimals = len(found[1].partition(".")[2])
        unit = UNITS[found[2].strip()]
        said[column] = float(found[1]) * unit, 0.51 * 10.0**-decimals * unit
    return said


def fetch(desk, path):
    with urllib.request.urlopen(desk.view.url + path) as answer:
        return answer.read().decode("utf-8")


def test_statistics_fill_and_change_while_it_runs(open_panel):
    desk = open_panel(methods=METHODS, motion="curve")
    for column in COLUMNS:
        assert [desk.text(f"{column}-{i}") for i in range(4)] == ["–"] * 4
    desk.click("start")
    for i in range(4):
        desk.expect(f"mean-time-{i}").to_contain_text(re.compile("ms|µs"))
        desk.expect(f"efficiency-{i}").to_contain_text("%")
    before = [desk.text(f"mean-time-{i}") for i in range(4)]
    desk.wait(lambda: all(desk.text(f"mean-time-{i}") != before[i] for i in range(4)))


def test_table_state_and_csv_agree(open_panel):
    desk = open_panel(methods=METHODS, motion="curve", running=True)
    desk.until(lambda s: all(i["statistics"]["steps"] > 30 for i in s["instances"]))
    desk.click("start")
    stopped = desk.until(lambda s: not s["running"])["step"]
    desk.shows("!pinik.state.running")
    desk.click("step")
    desk.shows(f"pinik.state.step === {stopped + 1}")
    state = json.loads(fetch(desk, "api/state"))
    with desk.page.expect_download() as download:
        desk.click("csv")
    rows = list(csv.DictReader(io.StringIO(download.value.path().read_text("utf-8"))))
    assert download.value.suggested_filename.endswith(".csv")
    assert [row["method"] for row in rows] == list(METHODS)
    names = ["mean_time", "mean_iterations", "efficiency", "mean_error", "largest_jump"]
    for i, (instance, row) in enumerate(zip(state["instances"], rows, strict=True)):
        statistics = instance["statistics"]
        in_csv = [row["mean_time_s"], row["mean_iterations"], row["efficiency"], row["mean_error_m"]]
        in_csv.append(row["largest_jump_rad_or_m"])
        assert [float(value) for value in in_csv] == [statistics[name] for name in names]
        assert int(row["steps"]) == statistics["steps"]
        for column, name in zip(COLUMNS, names, strict=True):
            value, half_digit = figures(desk, i)[column]
            assert value == pytest.approx(statistics[name], abs=half_digit), column


def test_reset_empties_the_statistics(open_panel):
    desk = open_panel(methods=("dls",), motion="curve", running=True)
    desk.expect("efficiency-0").to_contain_text("%")
    desk.click("start")
    desk.until(lambda s: not s["running"])
    desk.click("reset")
    for column in COLUMNS:
        desk.expect(f"{column}-0").to_have_text("–")


def test_all_methods_are_counted_over_the_same_steps_which_begin_anew_or_cover_all(open_panel):
    desk = open_panel(methods=METHODS, motion="curve", running=True)
    desk.until(lambda s: all(i["statistics"]["steps"] > 20 for i in s["instances"]))
    desk.click("start")
    desk.until(lambda s: not s["running"])
    state = desk.agree()
    steps = {i["statistics"]["steps"] for i in state["instances"]}
    assert len(steps) == 1
    desk.expect("counted").to_have_text(f"{steps.pop()} steps")
    assert [desk.text(f"engine-{i}") for i in range(4)] == [i["engine"] for i in state["instances"]]
    desk.choose("window", "all")
    desk.until(lambda s: s["window"] == "all")
    assert "statistics=all" in desk.address()
    angles = [i["angles"] for i in state["instances"]]
    desk.click("begin-anew")
    state = desk.until(lambda s: {i["statistics"]["steps"] for i in s["instances"]} == {0})
    assert [i["angles"] for i in state["instances"]] == angles
    desk.expect("counted").to_have_text("0 steps")
    desk.expect("efficiency-0").to_have_text("–")


def test_steps_that_the_clock_ended_are_said_apart(open_panel):
    desk = open_panel("two_link", methods=("dls", "ccd"))
    desk.expect("cut-off").to_be_hidden()
    told = desk.runs("""{
        const state = structuredClone(pinik.state);
        const figures = { steps: 50, busy: 50, mean_time: 0.0000871, mean_iterations: 1, mean_joint_updates: 0,
                          efficiency: 0.5, mean_error: 0.1, largest_jump: 0.1 };
        state.instances[0].statistics = { ...figures, cut_off: 12 };
        state.instances[1].statistics = { ...figures, cut_off: 0 };
        pinik.table.setState(state);
        return [...document.querySelectorAll("[data-cut=true]")].map(({ dataset }) => dataset.testid);
    }""")
    assert told == ["efficiency-0"]
    desk.expect("cut-off").to_contain_text("cut off dls in 12 of 50 steps")
    desk.expect("mean-time-0").to_have_text("87.1 µs")


def test_caption_card_and_table_say_one_number_at_any_moment(open_panel):
    """They are read in one go while the ball moves away from robots that cannot follow."""
    desk = open_panel("two_link", methods=("dls",), running=True)
    read = """[...document.querySelectorAll("[data-testid^=status-], [data-testid^=label-] .words, .message")]
        .map(({ textContent }) => /([\\d.]+ \\S*m) short/.exec(textContent)?.[1])"""
    seen = set()
    for k in range(40):
        desk.view.move_ball([2.0 + 0.05 * k, 0.3, 0.0])
        desk.page.wait_for_timeout(60)
        words = desk.runs(read)
        assert len(words) == 3
        assert len(set(words)) == 1, words
        seen.add(words[0])
    assert len(seen - {None}) > 3


def test_a_robot_that_swings_is_said_to_swing_on_its_card(open_panel):
    desk = open_panel(methods=("pinv",), running=True)
    desk.view.send("parameter", instance=0, name="max_residual", value=0.05)
    desk.view.move_ball([0.0, 1.5, 0.2])
    message = desk.part("message-0")
    desk.expect(message).to_contain_text("does not come to rest")
    box, text = message.bounding_box(), message.evaluate("e => e.scrollHeight - e.clientHeight")
    assert (text, box["height"] > 60) == (0, True)


def chart(desk, testid):
    return np.asarray(Image.open(io.BytesIO(desk.part(testid).screenshot())).convert("RGB")).astype(int)


def test_the_charts_are_drawn_and_go_on(open_panel):
    desk = open_panel("two_link", methods=("dls", "ccd"), motion="curve", running=True)
    colours = np.array([[31, 111, 196], [217, 122, 0]])  # of the first two instances
    for testid in ("error-chart", "time-chart"):

        def lines(testid=testid):
            drawn = chart(desk, testid)
            return [(np.abs(drawn - colour).max(axis=2) < 60).sum() for colour in colours]

        desk.wait(lambda lines=lines: min(lines()) > 20)
        before = chart(desk, testid)
        desk.wait(lambda testid=testid, before=before: (chart(desk, testid) != before).any())


def test_a_target_out_of_reach_is_said_so_in_words(open_panel):
    desk = open_panel(methods=METHODS, running=True)
    desk.type("target-x", 5)
    desk.until(lambda s: {i["status"] for i in s["instances"]} == {"UNREACHABLE"})
    desk.click("start")
    desk.until(lambda s: not s["running"])
    state = desk.agree()
    for i in range(len(state["instances"])):
        desk.expect(f"message-{i}").to_contain_text("reach")
        desk.expect(f"status-{i}").to_contain_text("m short")
        desk.expect(f"label-{i}").to_contain_text("m short")
        tip = desk.effectors(state)[i].translation
        short = float(re.search(r"([\d.]+) m short", desk.text(f"status-{i}"))[1])
        assert short == pytest.approx(np.linalg.norm(tip - state["balls"][0]["position"]), abs=0.006)


def test_a_missed_target_names_the_joints_that_sit_at_their_limits(open_panel, arm):
    desk = open_panel(methods=("jt", "dls"), running=True)
    desk.view.move_ball([0.0, 0.0, 0.2])
    desk.until(lambda s: all(i["status"] not in ("IDLE", "CONVERGED") and i["active_limits"] for i in s["instances"]))
    desk.click("start")
    desk.until(lambda s: not s["running"])
    desk.agree()
    for i, instance in enumerate(desk.state["instances"]):
        q = np.array([instance["angles"][name] for name in arm.joint_names])
        at_limit = set(np.array(arm.joint_names)[(q == arm.lower) | (q == arm.upper)])
        assert at_limit >= set(instance["active_limits"]) != set()
        message = desk.part(f"message-{i}")
        desk.expect(message).to_have_text(instance["message"])
        assert set(re.findall(r"bone\d_[xz]", message.inner_text())) == set(instance["active_limits"])
        assert "limit" in message.inner_text()
        desk.expect(f"status-{i}").to_contain_text("short")


def test_the_saved_animation_plays_without_a_server(open_desk, tmp_path):
    desk = open_desk(methods=("dls", "ccd"), motion="curve", running=True)
    desk.until(lambda s: s["step"] > 90)
    with desk.page.expect_download() as download:
        desk.click("save-animation")
    path = tmp_path / "saved.html"
    download.value.save_as(path)
    desk.view.close()
    desk.faults.excuse("ERR_CONNECTION_REFUSED|WebSocket")
    desk.page.goto(path.as_uri())
    desk.shows("window.pinik?.player")
    desk.expect(desk.page.locator("#labels .chip")).to_have_count(2)
    clock = desk.page.locator("#clock")
    desk.expect(clock).to_contain_text(re.compile(r"\d s of [1-9][\d.]* s|\d s of 0\.[5-9] s"))
    first, before = clock.inner_text(), desk.picture()
    desk.expect(clock).not_to_have_text(first)
    desk.wait(lambda: (np.abs(desk.picture() - before).max(axis=2) > 60).sum() > 50)
    desk.page.locator("#play").click()
    stopped = clock.inner_text()
    desk.page.locator("#time").fill("0")
    desk.expect(clock).to_contain_text("0.0 s of")
    assert stopped.split(" of ")[1] == clock.inner_text().split(" of ")[1]


def test_the_last_seconds_can_be_saved_as_gltf(open_panel, tmp_path):
    desk = open_panel(methods=("dls", "ccd"), motion="curve", running=True)
    desk.until(lambda s: s["step"] > 90)
    with desk.page.expect_download() as download:
        desk.click("save-glb")
    download.value.save_as(tmp_path / "saved.glb")
    played = Player(tmp_path / "saved.glb")
    assert played.duration > 1.0
    assert {"dls tip", "ccd tip", "dls ball tip"} <= set(played.names)


def test_a_robot_without_shapes_offers_no_gltf(open_panel, tmp_path):
    bare = tmp_path / "bare.urdf"
    bare.write_text(chain(3, "revolute"))
    desk = open_panel(bare, methods=("dls",))
    desk.expect("save-glb").to_be_hidden()
    desk.page.get_by_test_id("robot").select_option("two_link", force=True)
    desk.expect("save-glb").to_be_visible()


def test_a_page_saved_before_the_first_step_opens_as_well(open_panel, tmp_path):
    desk = open_panel("two_link", methods=("dls",))
    path = tmp_path / "saved.html"
    desk.view.save_animation(path)
    desk.page.goto(path.as_uri())
    desk.shows("window.pinik?.player")
    desk.expect("label-0").to_be_visible()
