"""The page of a map in a browser: it shows the numbers of the map, and cells go as its controls say."""

from __future__ import annotations

import re

import numpy as np
import pytest

import pinik
from page_fixtures import need_browser, new_context

pytestmark = pytest.mark.timeout(300)


@pytest.fixture(scope="module")
def found(panda):
    return pinik.reach(panda, "panda_hand_tcp", cell=0.2, samples=20_000, directions=12, rolls=4)


@pytest.fixture(scope="module")
def tab(browser, found, tmp_path_factory):
    """The page, opened from its file; `faults` are errors, and requests to a server."""
    file = tmp_path_factory.mktemp("page") / "map.html"
    found.save_page(file)
    context = new_context(browser)
    opened = context.new_page()
    opened.faults = []
    opened.on("pageerror", lambda error: opened.faults.append(str(error)))
    opened.on("request", lambda request: opened.faults.append(request.url) if request.url.startswith("http") else None)
    opened.goto(file.as_uri())
    opened.wait_for_function("window.pinik?.reach")
    yield opened
    assert opened.faults == []
    context.close()


def count(tab):
    return int(re.match(r"[\d,]+", tab.get_by_test_id("count").inner_text())[0].replace(",", ""))


def drawn(tab):
    """(the number of cells, and the largest of their x, by what three.js draws)."""
    return tab.evaluate(
        """() => {
            const { _cells } = window.pinik.reach;
            const xs = _cells._drawn.map((row) => _cells.center(row).x);
            return [xs.length, Math.max(...xs)];
        }"""
    )


def test_it_counts_the_cells_of_the_map(tab, found):
    assert count(tab) == found.workspace().sum()
    expect = need_browser().expect
    expect(tab.locator("#summary")).to_have_text(str(found))
    expect(tab.locator("#largest")).to_have_text(f"{found.share.max():.3g}")


def test_the_least_share_and_the_tool_down_leave_fewer_cells(tab, found):
    assert float(tab.get_by_test_id("least").get_attribute("max")) == found.share.max()
    tab.get_by_test_id("least").fill("0.5")
    assert count(tab) == (found.share >= 0.5).sum() < found.workspace().sum()
    tab.get_by_test_id("least").fill("0")
    tab.get_by_test_id("down").check()
    assert count(tab) == found.workspace("down").sum() < found.workspace().sum()
    tab.get_by_test_id("down").uncheck()


def test_cuts_remove_what_is_nearer_to_the_camera(tab, found):
    for axis in "xy":
        tab.get_by_test_id(f"cut-{axis}").uncheck()
    whole = drawn(tab)
    assert whole[1] == pytest.approx(found.bounds()[1, 0] - 0.1)
    tab.get_by_test_id("at-x").fill("5")
    assert tab.get_by_test_id("cut-x").is_checked()
    cut = drawn(tab)
    assert cut[1] == pytest.approx(found.grid.axes[0][5], abs=1e-6)
    tab.get_by_test_id("layers").check()
    x = np.nonzero(found.workspace())[0]
    assert drawn(tab)[0] == (x == 5).sum(), "all cells of a single layer can be seen"
    tab.get_by_test_id("layers").uncheck()


def test_the_quantity_changes_the_scale(tab, found):
    expect = need_browser().expect
    tab.get_by_test_id("quantity").select_option("manipulability")
    expect(tab.locator("#largest")).to_have_text(f"{np.nanmax(found.manipulability):.3g}")
    tab.get_by_test_id("quantity").select_option("share")


def test_the_robot_stands_where_it_belongs(tab):
    low, high = tab.evaluate(
        """() => {
            const { _robot } = window.pinik.reach;
            const box = { min: [9, 9, 9], max: [-9, -9, -9] };
            for (const { geometry } of _robot.children) {
                geometry.computeBoundingBox();
                geometry.boundingBox.min.toArray().forEach((v, k) => (box.min[k] = Math.min(box.min[k], v)));
                geometry.boundingBox.max.toArray().forEach((v, k) => (box.max[k] = Math.max(box.max[k], v)));
            }
            return [box.min, box.max];
        }"""
    )
    assert low[2] == pytest.approx(0.0, abs=0.01)
    assert 0.6 < high[2] < 1.2
