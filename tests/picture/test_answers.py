"""Pictures of answers: branches as ghosts, self-motions as fans, and what touches in red."""

from __future__ import annotations

import colorsys
import dataclasses
import itertools

import numpy as np
import pinocchio
import pytest
from scipy.spatial import ConvexHull

import pinik
from pinik.picture.poses import GHOSTS, TINTS, poses_of
from urdf_texts import joint, link, robot

NAMES = ("upper", "lower", "hand")
LENGTHS = (0.5, 0.4, 0.3)  # [m]
WIDE = (0.08, 0.06, 0.04)  # also how thick
BARE = {"size": (300, 300), "ground": False, "background": None}


def planar_arm():
    """Three grey bars in a plane, on hinges about z."""

    def bar(name, length, wide):
        box = f'<geometry><box size="{length} {wide} {wide}"/></geometry><origin xyz="{length / 2} 0 0"/>'
        look = '<material name="m"><color rgba="0.6 0.6 0.6 1"/></material>'
        return link(name, f"<visual>{box}{look}</visual><collision>{box}</collision>")

    axis = '<axis xyz="0 0 1"/>'
    return pinik.load(
        robot(
            link("base"),
            *(bar(*one) for one in zip(NAMES, LENGTHS, WIDE, strict=True)),
            link("tip"),
            *(
                joint(f"to_{child}", parent, child, f'<origin xyz="{end} 0 0"/>', axis)
                for parent, child, end in zip(["base", *NAMES[:2]], NAMES, [0.0, *LENGTHS[:2]], strict=True)
            ),
            joint("to_tip", "hand", "tip", f'<origin xyz="{LENGTHS[2]} 0 0"/>', kind="fixed", limit=""),
        )
    )


@pytest.fixture(scope="module")
def bars():
    return planar_arm()


def middle(bars, name, q):
    """The middle of a bar by plain Pinocchio."""
    data = bars.model.createData()
    pinocchio.framesForwardKinematics(bars.model, data, q)
    length = dict(zip(NAMES, LENGTHS, strict=True))[name]
    return data.oMf[bars.model.getFrameId(name)].act(np.array([length / 2, 0.0, 0.0]))


def at(picture, point):
    """The pixel that shows a point of the world."""
    x, y = picture.project(point)
    return picture.pixels[round(y), round(x)].astype(int)


def red(pixels):
    r, g, b = (np.asarray(pixels)[..., k].astype(int) for k in range(3))
    return (np.asarray(pixels)[..., 3] > 0) & (r > 90) & (g < 0.5 * r) & (b < 0.5 * r)


def hue(pixel):
    return colorsys.rgb_to_hsv(*(np.asarray(pixel[:3], dtype=float) / 255.0))[0]


# Branches


def elbows(bars, start):
    """Both answers for the tip at 0.3, 0.4 with the hand along y."""
    pose = pinocchio.SE3(pinocchio.utils.rotate("z", np.pi / 2), np.array([0.3, 0.6, 0.0]))
    return pinik.solve_all(bars, "tip", placement=pose, q0=start)


def test_the_first_branch_is_solid_and_the_other_a_ghost(bars):
    """The elbows are where the law of cosines has them, 0.5 m from the base and 0.4 m from the hand's joint."""
    wrist = np.array([0.3, 0.3, 0.0])
    d = np.linalg.norm(wrist)
    inward = (d**2 + 0.5**2 - 0.4**2) / (2 * d)
    along, across = wrist / d, np.array([-wrist[1], wrist[0], 0.0]) / d
    left, right = (inward * along + side * np.sqrt(0.5**2 - inward**2) * across for side in (1.0, -1.0))
    for start, solid, ghost in (([2.0, -2.0, 0.5], left, right), ([-0.5, 2.0, 0.5], right, left)):
        branches = elbows(bars, start)
        assert len(branches) == 2
        picture = pinik.draw(bars, branches, view="top", **BARE)
        assert at(picture, 0.6 * solid)[3] == 255
        assert 60 < at(picture, 0.6 * ghost)[3] < 160
        assert at(picture, 0.6 * solid)[:3] == pytest.approx(at(picture, 0.6 * solid)[0], abs=3)  # grey
        assert abs(hue(at(picture, 0.6 * ghost)) - hue((0x1F, 0x6F, 0xC4))) < 0.04


@pytest.mark.parametrize("start", [[2.0, -2.0, 0.5], [-0.5, 2.0, 0.5]])
def test_no_ghost_covers_the_solid_one_even_in_front_of_it(bars, start):
    """Seen along the plane, one of the elbows is in front of the other."""
    view = (-np.pi / 2 + 0.2, 0.1)
    branches = elbows(bars, start)
    both = pinik.draw(bars, branches, view=view, **BARE)
    alone = pinik.draw(bars, branches[0], view=both.camera, **BARE)
    solid = alone.pixels[..., 3] == 255
    ghost = pinik.draw(bars, branches[1], view=both.camera, **BARE).pixels[..., 3] == 255
    assert (solid & ghost).sum() > 500
    assert np.abs(both.pixels[solid].astype(int) - alone.pixels[solid]).mean() < 3
    assert np.abs(both.pixels[solid].astype(int) - alone.pixels[solid]).max() < 40  # shadows are sampled anew


def test_an_opacity_that_is_given_makes_of_branches_what_it_makes_of_configurations(bars):
    branches = elbows(bars, [2.0, -2.0, 0.5])
    looks = {"opacity": [1.0, 0.6], "color": ["#999999", "#00ff00"], "view": (-1.4, 0.1)}
    drawn, same = (pinik.draw(bars, q, **looks, **BARE).pixels for q in (branches, branches.q))
    assert (drawn == same).all()


def test_every_branch_has_a_colour_of_its_own(ur5):
    branches = pinik.solve_all(ur5, "tool0", position=[0.4, 0.25, 0.35], rpy=[np.pi, 0, 0.4])
    assert len(branches) == 8
    picture = pinik.draw(
        ur5, branches, offset=(0, 3, 0), view=(0.0, 0.1), size=(800, 100), ground=False, background=None
    )
    hues = []
    for k in range(1, 8):
        column = round(picture.project([0.0, 3.0 * k, 0.2])[0])
        part = picture.pixels[:, column - 30 : column + 30].reshape(-1, 4)
        seen = np.median(part[(part[:, 3] > 60) & (np.ptp(part[:, :3].astype(int), axis=1) > 25)], axis=0)
        hues.append(hue(seen))
        assert seen[3] < 200
    apart = np.abs(np.subtract.outer(hues, hues))
    apart = np.minimum(apart, 1 - apart) + np.eye(7)
    assert apart.min() > 0.02


def cielab(pixel):
    """L*, a*, b* of an sRGB pixel under D65, by the formulas of CIE 15 and IEC 61966-2-1."""
    c = np.asarray(pixel[:3], dtype=float) / 255.0
    linear = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    x, y, z = np.cbrt(to_xyz @ linear / to_xyz.sum(axis=1))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("paper", ["#ffffff", "#14181d"])
def test_the_colours_of_sixteen_branches_are_told_apart_on_white_and_on_black(bars, paper):
    branches = elbows(bars, [2.0, -2.0, 0.5])
    found = dataclasses.replace(branches._found, q=np.repeat(branches.q[:1], 16, axis=0))
    row = dataclasses.replace(branches, _found=found)
    where = np.zeros((16, 3))
    where[:, 0] = 1.5 * np.arange(16)
    size = (1200, 120)
    picture = pinik.draw(bars, row, offset=where, view="top", size=size, ground=False, background=paper)
    seen = [cielab(at(picture, middle(bars, "upper", branches[0]) + offset)) for offset in where[1:]]
    paper_seen = cielab(picture.pixels[0, 0])
    gaps = [np.linalg.norm(a - b) for a, b in itertools.combinations([*seen, paper_seen], 2)]
    assert min(gaps) > 5.0
    assert len(set(TINTS)) == 15


def test_answers_that_are_none_are_said_in_words(bars):
    none = pinik.solve_all(bars, "tip", position=[2.0, 0.0, 0.0])
    with pytest.raises(pinik.InputError, match=r"^q has no configuration to draw: unreachable"):
        pinik.draw(bars, none)


def test_answers_of_another_robot_are_refused(bars, ur5):
    with pytest.raises(pinik.InputError):
        pinik.draw(ur5, elbows(bars, [2.0, -2.0, 0.5]))
    with pytest.raises(pinik.InputError):
        pinik.draw(ur5, bars.self_motion(pinik.Target("tip", [0.6, 0.3, 0.0]), bars.solve("tip", [0.6, 0.3, 0.0])))


def test_a_solution_is_drawn_where_it_is(bars):
    solution = bars.solve("tip", [0.6, 0.3, 0.0])
    drawn, same = (pinik.draw(bars, q, view="top", **BARE).pixels for q in (solution, solution.q))
    assert (drawn == same).all()


def test_an_answer_alone_is_drawn_with_its_own_robot(bars):
    branches, solution = elbows(bars, [2.0, -2.0, 0.5]), bars.solve("tip", [0.6, 0.3, 0.0])
    motion = bars.self_motion("tip", solution, position=[0.6, 0.3, 0.0])
    for answer in (branches, solution, motion, [motion]):
        assert (pinik.draw(answer, **BARE).pixels == pinik.draw(bars, answer, **BARE).pixels).all()
    with pytest.raises(pinik.InputError, match=r"^q must be left out"):
        pinik.draw(branches, solution)
    for nothing in ([0.1, 0.2, 0.3], "bars", [1, motion], np.zeros((900, 3))):
        with pytest.raises(pinik.InputError, match=r"^robot must be one that pinik\.load returned") as caught:
            pinik.draw(nothing)
        assert len(str(caught.value)) < 120


# Self-motion


@pytest.fixture(scope="module")
def swing(bars):
    """The arm's self-motion with its tip at a point."""
    return bars.self_motion("tip", [1.0, -1.5, 0.8], position=bars.placement("tip", [1.0, -1.5, 0.8]).translation)


def test_a_fan_keeps_the_tip_at_even_distances(bars, swing):
    start, *ghosts = poses_of(bars, swing)
    assert (start.opacity, start.ghost, len(ghosts)) == (1.0, False, GHOSTS)
    assert start.q == pytest.approx([1.0, -1.5, 0.8], abs=1e-9)
    data = bars.model.createData()
    for pose in ghosts:
        pinocchio.framesForwardKinematics(bars.model, data, pose.q)
        there = data.oMf[bars.model.getFrameId("tip")].translation
        assert there == pytest.approx(bars.placement("tip", start.q).translation, abs=1e-7)
    fine = np.vstack([swing.q, swing.q[:1]]) if swing.closed else swing.q
    gone = np.concatenate([[0.0], np.linalg.norm(np.diff(fine, axis=0), axis=1).cumsum()])
    places = np.sort([gone[np.linalg.norm(fine - pose.q, axis=1).argmin()] for pose in ghosts])
    assert np.diff(places) == pytest.approx(np.full(GHOSTS - 1, np.diff(places).mean()), rel=0.15)


def test_a_fan_fades_with_the_way_from_its_start(bars, swing):
    start, *ghosts = poses_of(bars, swing)
    away = [np.linalg.norm(pose.q - [1.0, -1.5, 0.8]) for pose in ghosts]
    near, far = ghosts[int(np.argmin(away))], ghosts[int(np.argmax(away))]
    assert near.opacity > far.opacity + 0.2
    assert all(0.1 < pose.opacity < 0.6 for pose in ghosts)
    picture = pinik.draw(bars, swing, view="top", **BARE)
    one = pinik.draw(bars, far.q, view=picture.camera, **BARE).pixels[..., 3] == 255
    covered = [pinik.draw(bars, pose.q, view=picture.camera, **BARE).pixels[..., 3] > 0 for pose in (start, *ghosts)]
    own = one & (sum(covered) == 1)
    assert own.any()
    assert np.median(picture.pixels[own][:, 3]) == pytest.approx(255 * far.opacity, abs=2)


def test_of_a_path_the_end_is_solid_and_ghosts_at_equal_distances_lead_there(bars):
    begin = np.array([0.3, 0.8, 0.6])
    first, last = bars.placement("tip", begin).translation, bars.placement("tip", [1.2, 0.9, 0.2]).translation
    line = first + np.linspace(0.0, 1.0, 100)[:, None] ** 2 * (last - first)  # slow at first
    track = pinik.track(bars, "tip", line, begin)
    assert track.success
    end, *ghosts = poses_of(bars, track)
    assert (end.opacity, end.ghost, len(ghosts)) == (1.0, False, GHOSTS)
    assert end.q == pytest.approx(track.q[-1])
    assert ghosts[0].q == pytest.approx(track.q[0])
    way = np.append([0.0], np.linalg.norm(np.diff(track.q, axis=0), axis=1).cumsum())
    places = [way[np.linalg.norm(track.q - pose.q, axis=1).argmin()] for pose in (*ghosts, end)]
    assert np.diff(places) == pytest.approx(np.full(GHOSTS, way[-1] / GHOSTS), rel=0.3)
    assert (np.diff([pose.opacity for pose in ghosts]) > 0.0).all()
    alone = pinik.draw(track, view="top", **BARE)
    assert (alone.pixels == pinik.draw(bars, track, view="top", **BARE).pixels).all()


def test_a_path_that_stays_where_it_is_has_no_ghosts(bars):
    here = [0.3, 0.8, 0.6]
    place = bars.placement("tip", here).translation
    assert len(poses_of(bars, pinik.track(bars, "tip", [place, place, place], here))) == 1


def test_families_have_a_colour_each_and_share_the_ghosts_by_their_lengths(panda):
    default = panda.poses["default"]
    branches = panda.solve_all("panda_hand_tcp", placement=panda.placement("panda_hand_tcp", default), q0=default)
    families = branches.families
    assert len(families) == 2
    for shown in (branches, families):
        first, *ghosts = poses_of(panda, shown)
        assert first.q == pytest.approx(default, abs=1e-6)
        by_tint = [sum(tuple(pose.tint) == tint for pose in ghosts) for tint in {tuple(pose.tint) for pose in ghosts}]
        lengths = np.array([family.length for family in families])
        assert sorted(by_tint) == pytest.approx(sorted(GHOSTS * lengths / lengths.sum()), abs=0.5)


def test_of_many_dimensions_some_ghosts_are_drawn(panda):
    default = panda.poses["default"]
    place = panda.placement("panda_hand_tcp", default).translation
    motion = panda.self_motion("panda_hand_tcp", default, position=place, points=30)
    assert motion.dimension == 4
    first, *ghosts = poses_of(panda, motion)
    assert first.q == pytest.approx(default, abs=1e-6)
    assert len(ghosts) == GHOSTS
    branches = panda.solve_all("panda_hand_tcp", position=place, q0=default)
    assert branches.redundancy == 4
    assert len(poses_of(panda, branches)) == min(len(branches), GHOSTS + 1)


def test_an_isolated_configuration_is_drawn_alone(bars):
    pose = bars.placement("tip", [1.0, -1.5, 0.8])
    motion = bars.self_motion("tip", [1.0, -1.5, 0.8], placement=pose)
    assert motion.dimension == 0
    assert [one.opacity for one in poses_of(bars, motion)] == [1.0]


# Collisions

FOLDED, FREE = np.array([0.2, 2.9, 2.9]), np.array([0.2, 0.9, 0.9])


def test_the_links_that_touch_are_red_where_they_are_and_no_others(bars):
    """The hand lies on the upper arm; the bars' corners by plain Pinocchio bound what may be red."""
    q = np.array([0.2, 2.55, 1.6])
    pairs = [collision.pair for collision in bars.collisions(q)]
    assert [set(pair) for pair in pairs] == [{"upper", "hand"}]
    picture = pinik.draw(bars, q, collisions=True, view="top", **BARE)
    assert not red(at(picture, middle(bars, "lower", q)))
    data = bars.model.createData()
    pinocchio.framesForwardKinematics(bars.model, data, q)
    rows, columns = np.nonzero(red(picture.pixels))
    found = np.stack([columns, rows], axis=1)
    inside = np.zeros(len(found), dtype=bool)
    for name, length, wide in (("upper", LENGTHS[0], WIDE[0]), ("hand", LENGTHS[2], WIDE[2])):
        corners = np.array(
            [[x, y, z] for x in (0, length) for y in (-wide / 2, wide / 2) for z in (-wide / 2, wide / 2)]
        )
        place = data.oMf[bars.model.getFrameId(name)]
        hull = ConvexHull(picture.project(corners @ place.rotation.T + place.translation))
        here = (found @ hull.equations[:, :2].T + hull.equations[:, 2] < 1.0).all(axis=1)
        assert here.sum() > 0.5 * hull.volume  # of a polygon, its area
        inside |= here
    assert inside.all()


def test_nothing_is_red_where_nothing_touches_or_nobody_asked(bars):
    assert bars.collisions(FREE) == []
    for q, asked in ((FREE, True), (FOLDED, False)):
        assert not red(pinik.draw(bars, q, collisions=asked, view="top", **BARE).pixels).any()


def test_each_configuration_has_its_own_red(bars):
    q = np.array([FREE, [0.2, 2.55, 1.6]])
    picture = pinik.draw(bars, q, collisions=True, offset=(0, 3, 0), view="top", **BARE)
    columns = np.nonzero(red(picture.pixels).any(axis=1))[0]
    split = picture.project([0.0, 1.5, 0.0])[1]
    assert len(columns)
    assert (columns < split).all()  # y is up


def test_what_stands_around_is_drawn_and_what_touches_it_is_red(bars):
    world = pinik.World()
    post = middle(bars, "lower", FREE)
    world.add_cylinder("post", 0.03, 0.6, post)
    world.add_box("shelf", [0.2, 0.2, 0.2], [-0.6, 0.0, 0.0])
    world.add_sphere("ball", 0.1, [-0.6, 0.6, 0.0])
    corners = np.array([[-0.7, -0.6, 0.0], [-0.5, -0.6, 0.0], [-0.6, -0.4, 0.0]])
    world.add_mesh("sheet", (corners, [[0, 1, 2]]))
    picture = pinik.draw(bars, FREE, world=world, collisions=True, view="top", **BARE)
    for place in ([-0.6, 0.0, 0.1], [-0.6, 0.6, 0.1], corners.mean(axis=0)):
        assert at(picture, place)[3] == 255
    assert at(picture, [-0.6, 0.3, 0.0])[3] == 0
    assert not any(red(at(picture, middle(bars, name, FREE))) for name in ("upper", "hand"))
    away = 0.4 * (bars.placement("hand", FREE).translation - post)
    assert red(at(picture, post + away))
    only = pinik.draw(bars, FREE, world=world, view="top", **BARE)
    assert not red(only.pixels).any()


def test_an_object_with_the_name_of_a_link_makes_no_link_of_its_name_red(bars):
    """The box "hand" goes into the bar "lower"; the hand itself is free of everything."""
    world = pinik.World()
    post = middle(bars, "lower", FREE)
    world.add_box("hand", [0.03, 0.03, 0.6], post)
    (touch,) = bars.collisions(FREE, world)
    assert (touch.pair, touch.with_world, touch.links) == (("lower", "hand"), True, ("lower",))
    (own,) = bars.collisions(np.array([0.2, 2.55, 1.6]))
    assert (set(own.links), own.with_world) == ({"upper", "hand"}, False)
    picture = pinik.draw(bars, FREE, world=world, collisions=True, view="top", **BARE)
    assert red(at(picture, post + 0.4 * (bars.placement("hand", FREE).translation - post)))
    assert not red(at(picture, middle(bars, "hand", FREE)))
    assert not red(at(picture, post + np.array([0.0, 0.0, 0.3])))
    tip = bars.placement("tip", FREE).translation
    solution = bars.solve("tip", tip, q0=FREE, avoid=world, restarts=0)
    assert solution.status is pinik.Status.COLLIDING
    drawn = pinik.draw(bars, solution, view="top", **BARE)
    assert not red(at(drawn, middle(bars, "hand", solution.q)))


def test_a_ghost_is_seen_in_front_of_what_stands_around_and_not_behind(bars):
    branches = elbows(bars, [2.0, -2.0, 0.5])
    point = 0.5 * bars.placement("lower", branches[1]).translation
    for height, seen in ((-0.5, True), (0.5, False)):
        world = pinik.World()
        world.add_box("plate", [3.0, 3.0, 0.1], [0.3, 0.3, height])
        picture = pinik.draw(bars, branches, world=world, view="top", **BARE)
        color = at(picture, point)
        assert color[3] == 255
        assert (color[2] - color[0] > 25) == seen  # the first ghost is blue, and the plate is not


def test_a_solution_that_touches_is_red_by_itself(bars):
    """The tip is to be where the post is."""
    world = pinik.World()
    world.add_sphere("ball", 0.15, [0.6, 0.3, 0.0])
    solution = bars.solve("tip", [0.6, 0.3, 0.0], avoid=world)
    assert solution.status is pinik.Status.COLLIDING
    names = {name for collision in solution.collisions for name in collision.pair}
    assert names == {"hand", "ball"}
    picture = pinik.draw(bars, solution, view="top", **BARE)
    assert red(at(picture, middle(bars, "hand", solution.q)))
    assert not red(pinik.draw(bars, solution.q, view="top", **BARE).pixels).any()


def test_what_is_no_world_is_said_in_words(bars):
    with pytest.raises(pinik.InputError, match=r"world must be a pinik\.World; got 'table'"):
        pinik.draw(bars, world="table")
