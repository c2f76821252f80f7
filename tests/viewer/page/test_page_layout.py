"""Where robots, captions and notices stand in the picture: robots as large as they can be, and none of them covered."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from desk import METHODS, PHONE, WIDE

SIZES = {
    "1000": {"width": 1000, "height": 700},
    "1280": WIDE,
    "1920": {"width": 1920, "height": 1080},
    "390": PHONE,
}

CHORDS = """async (points) => {
    const { Silhouette } = await import("pinik/silhouette.js");
    const { THREE } = await import("pinik/three.js");
    const [right, up] = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 0, 1)];
    const { width, height, beside, above } = new Silhouette(points.map((p) => new THREE.Vector3(...p)), { right, up });
    return [width, height, beside, above];
}"""
# All in pixels of the stage: what robots have visited, what they cover now, captions, balls, and the stage itself.
PICTURE = """() => {
    const { show } = pinik, { stage, cast } = show, { instances } = cast;
    const seen = (points) =>
        instances.map((_, i) => points(i).map((p) => stage.project(p.clone().add(cast.offset(i))))
            .map(({ x, y }) => [x, y]));
    const { left, top, width, height } = stage.element.getBoundingClientRect();
    const rectangles = (found) => [...document.querySelectorAll(found)].map((e) => e.getBoundingClientRect())
        .map((r) => [r.left - left, r.top - top, r.right - left, r.bottom - top]);
    return {
        visited: seen(() => show.visited), robots: seen((i) => instances[i].robot.corners()),
        captions: rectangles("#labels .chip"), buttons: rectangles(".views")[0], toasts: rectangles(".toast"),
        balls: show.ballsOnScreen().map(({ at, radius: r }) => [at.x - r, at.y - r, at.x + r, at.y + r]),
        size: [width, height], captioned: show.camera.captions,
    };
}"""
RESTS = "pinik.still && !pinik.viewer.needs_render"
LONG = "joint 'panda_joint1' cannot be at 9 rad: its limits are from -2.8973 to 2.8973 rad, so nothing has changed. "


def chord_by_scanning(points, along):
    """The longest chord of the convex hull of points (n, 2) along an axis, from ten thousand scan lines."""
    hull = points[ConvexHull(points).vertices]
    start, end = hull, np.roll(hull, -1, axis=0)
    across = 1 - along
    lines = np.linspace(hull[:, across].min() + 1e-9, hull[:, across].max() - 1e-9, 10_001)[:, np.newaxis]
    low, high = np.minimum(start[:, across], end[:, across]), np.maximum(start[:, across], end[:, across])
    with np.errstate(divide="ignore", invalid="ignore"):
        part = (lines - start[:, across]) / (end[:, across] - start[:, across])
    crossing = start[:, along] + part * (end[:, along] - start[:, along])
    crossing[(lines < low) | (lines > high) | (low == high)] = np.nan
    return float(np.nanmax(np.nanmax(crossing, axis=1) - np.nanmin(crossing, axis=1)))


def test_copies_stand_apart_by_the_longest_chord_of_their_outline(open_panel):
    desk, rng = open_panel("two_link", ("dls",)), np.random.default_rng(5)
    for count in (3, 4, 12, 60):
        points = rng.normal(size=(count, 3)) @ np.array([[1, 0.2, 0.8], [0, 1, 0.3], [0, 0, 1]])
        width, height, beside, above = desk.page.evaluate(CHORDS, points.tolist())
        flat = points[:, [0, 2]]
        assert [width, height] == pytest.approx(np.ptp(flat, axis=0))
        assert beside == pytest.approx(chord_by_scanning(flat, 0), rel=1e-3)
        assert above == pytest.approx(chord_by_scanning(flat, 1), rel=1e-3)
        assert beside <= width
        assert above <= height
    # A slanted shape may stand nearer than it is wide.
    slanted = [[0, 0, 0], [1, 0, 0], [3, 0, 2], [2, 0, 2]]
    assert desk.page.evaluate(CHORDS, slanted) == pytest.approx([3, 2, 1, 1])


def outline(points):
    """The convex outline of points, counterclockwise in the axes of the picture."""
    points = np.array(points)
    return points[ConvexHull(points).vertices]


def shared(some, other):
    """The area that two convex outlines share: the one cut by each side of the other."""
    for start, end in zip(other, np.roll(other, -1, axis=0), strict=True):
        edge = end - start
        side = [edge[0] * (p[1] - start[1]) - edge[1] * (p[0] - start[0]) for p in some]
        kept = []
        for k, point in enumerate(some):
            if side[k] >= 0:
                kept.append(point)
            if side[k] * side[k - 1] < 0:
                part = side[k - 1] / (side[k - 1] - side[k])
                kept.insert(len(kept) - (side[k] >= 0), some[k - 1] + part * (point - some[k - 1]))
        some = kept
        if len(some) < 3:
            return 0.0
    return area(np.array(some))


def area(outline):
    x, y = outline.T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)


def corners(rectangle):
    left, top, right, bottom = rectangle
    return np.array([[left, top], [right, top], [right, bottom], [left, bottom]])


def look(desk, view):
    """Look from a view, and return what stands where once captions and camera agree."""
    for _ in range(2):  # the height of captions depends on the picture before
        desk.page.evaluate("view => pinik.show.frameAll(false, view)", view)
        desk.shows(RESTS)
    return desk.page.evaluate(PICTURE)


def test_areas_are_shared_as_they_should():
    square, beside = corners([0, 0, 2, 2]), corners([1, 1, 4, 4])
    assert (shared(square, beside), area(square)) == (1.0, 4.0)
    assert shared(square, corners([2.5, 0, 3, 3])) == 0.0
    assert shared(square, corners([-1, -1, 5, 5])) == 4.0


@pytest.mark.parametrize("robot", ["arm", "panda"])
def test_robots_in_a_row_fill_its_width_and_are_as_near_as_their_outlines_allow(open_stage, robot):
    desk = open_stage(robot, METHODS, motion="curve")
    for view in ("iso", "front", "side"):
        picture = look(desk, view)
        outlines = [outline(points) for points in picture["visited"]]
        assert all(shared(a, b) < 0.02 * area(a) for a, b in itertools.pairwise(outlines))
        apart = outlines[1].mean(axis=0)[0] - outlines[0].mean(axis=0)[0]
        nearer = np.array([0.1 * apart, 0.0])
        assert all(shared(a + nearer, b) > 0.0 for a, b in itertools.pairwise(outlines)), "they could stand nearer"
        assert np.ptp(np.concatenate(outlines)[:, 0]) > 0.95 * picture["size"][0]
        heights = [np.ptp(points[:, 1]) for points in outlines]
        assert max(heights) / min(heights) < 1.02, "robots side by side have the same size"


def test_two_rows_show_lions_larger_where_one_row_leaves_most_of_the_stage_empty(open_stage):
    desk = open_stage("lion", METHODS, motion="curve", root="free_flyer")
    for size, before in {"1280": 0.24, "390": 0.13}.items():  # the mean height of an outline in a row [stage's height]
        desk.page.set_viewport_size(SIZES[size])
        picture = look(desk, "side")
        outlines = [np.array(points) for points in picture["visited"]]
        assert outlines[2].mean(axis=0)[1] - outlines[0].mean(axis=0)[1] > 0.2 * picture["size"][1], "in two rows"
        assert np.mean([np.ptp(points[:, 1]) for points in outlines]) > 1.4 * before * picture["size"][1]
        assert np.ptp(np.concatenate(outlines)[:, 1]) > 0.5 * picture["size"][1]


ARRANGED = """async () => {
    const { arrange } = await import("pinik/layout.js"), { PRESETS } = await import("pinik/camera.js");
    const { THREE } = await import("pinik/three.js");
    const sides = [-0.5, 0.5], points = sides.flatMap((x) => sides.map((y) => new THREE.Vector3(x, y, 0)));
    const lens = (captions) => pinik.show.camera._lens(captions);
    return Object.entries(PRESETS).map(([name, view]) => {
        const { captions, offsets } = arrange(points, 4, view, lens);
        return [name, captions, new Set(offsets.map(({ x }) => x.toFixed(3))).size];
    });
}"""


def test_flat_squares_stand_in_two_rows_where_the_view_is_from_above_with_captions_beside_them(open_stage):
    desk = open_stage("two_link", METHODS)
    arranged = {name: (captions, rows) for name, captions, rows in desk.page.evaluate(ARRANGED)}
    assert arranged["top"] == ("beside", 2)


@pytest.mark.parametrize(
    ("robot", "sizes"),
    [("arm", list(SIZES)), ("panda", ["1280"]), ("lion", ["1280", "390"])],
    ids=["arm", "panda", "lion"],
)
def test_captions_cover_neither_robots_nor_balls_nor_each_other(open_stage, robot, sizes):
    desk = open_stage(robot, METHODS, motion="curve", root="free_flyer" if robot == "lion" else "fixed")
    for size, view in itertools.product(sizes, ("iso", "side", "top")):
        desk.page.set_viewport_size(SIZES[size])
        picture = look(desk, view)
        captions = [corners(caption) for caption in picture["captions"]]
        assert len(captions) == 4
        others = [outline(points) for points in picture["robots"]] + [corners(ball) for ball in picture["balls"]]
        others.append(corners(picture["buttons"]))
        for k, caption in enumerate(captions):
            assert caption.min() >= 0.0
            assert (caption.max(axis=0) <= picture["size"]).all()
            covered = sum(shared(caption, other) for other in [*others, *captions[:k]])
            assert covered < 20.0, f"caption {k} covers something at {size} from {view}"


TELL = "async (words) => { const { Notices } = await import('pinik/notices.js'); new Notices().error(words); }"


def test_notices_cover_neither_captions_nor_robots_nor_balls(open_stage):
    desk = open_stage("panda", METHODS, motion="curve")
    several = [["The tolerance must be 0.001 to 1000 mm."], [LONG, "Too far.", LONG * 2], [(LONG * 4)[:400].strip()]]
    for size, words in itertools.product(SIZES, several):
        desk.page.set_viewport_size(SIZES[size])
        desk.runs("document.querySelector('#toasts').replaceChildren()")
        for each in words:
            desk.page.evaluate(TELL, each.strip())
        desk.shows(RESTS)
        picture, shown = desk.page.evaluate(PICTURE), SIZES[size]
        assert 1 <= len(picture["toasts"]) <= len(words)
        assert desk.toasts.last.locator("span").inner_text() == words[-1].strip()
        for left, top, right, bottom in picture["toasts"]:
            assert top >= picture["size"][1], f"a notice stands below the stage at {size}"
            assert 0.0 <= left < right <= (shown["width"] if size == "390" else picture["size"][0])
            assert bottom <= shown["height"]


def test_captions_move_aside_for_a_notice_where_the_stage_is_alone(open_stage):
    desk = open_stage("arm", METHODS, motion="curve")
    desk.click("present")
    desk.page.evaluate(TELL, LONG)
    picture = look(desk, "iso")
    (toast,) = [corners(toast) for toast in picture["toasts"]]
    assert toast.min() >= 0.0
    others = [*picture["captions"], *picture["balls"]]
    assert sum(shared(toast, corners(other)) for other in others) == 0.0
