"""Pictures of robots whose looks are known: boxes, balls and their shadows."""

from __future__ import annotations

import colorsys
import io
import itertools
import sys
import tracemalloc

import numpy as np
import pytest
import trimesh
from PIL import Image

import pinik
from by_hand import two_hinges
from pinik.picture.camera import Camera
from robots import load_quietly

CUBE = """
<robot name="cube">
  <link name="base">
    <visual><geometry><box size="{size}"/></geometry><material name="m"><color rgba="{color}"/></material></visual>
  </link>
</robot>"""

TWO_PLATES = """
<robot name="plates">
  <link name="base"><visual><geometry><box size="1 1 0.02"/></geometry></visual></link>
  <link name="roof"><visual><geometry><box size="0.4 0.4 0.02"/></geometry></visual></link>
  <joint name="lift" type="prismatic">
    <parent link="base"/><child link="roof"/><axis xyz="0 0 1"/><limit lower="0" upper="9" effort="1" velocity="1"/>
  </joint>
</robot>"""


def cube(size="1 1 1", color="0.5 0.5 0.5 1"):
    return pinik.load(CUBE.format(size=size, color=color))


def from_far_away(direction, distance=1000.0, seen=3.0):
    """A camera that sees `seen` metres from top to bottom about the origin, almost in parallel."""
    back = np.array(direction, dtype=float) / np.linalg.norm(direction)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    return Camera(distance * back, np.stack([right, np.cross(right, back), -back]), seen / 2 / distance)


def hue(pixel):
    return colorsys.rgb_to_hsv(*(np.asarray(pixel[:3], dtype=float) / 255.0))[0]


def reds(picture):
    """Which pixels are red, as balls are."""
    r, g, b = (picture.pixels[..., k].astype(int) for k in range(3))
    return (r > 40) & (g < 0.75 * r) & (b < 0.75 * r)


def darkness(picture):
    return 255 - picture.pixels[..., :3].mean(axis=2)


# What is seen


@pytest.mark.parametrize("direction", [(1, 0.1, 0.2), (1, -1, 0.5), (0.2, 0.9, 1.4)])
@pytest.mark.parametrize("size", ["1 1 1", "0.4 1.2 0.9"])
def test_a_box_covers_the_area_of_its_silhouette(direction, size):
    """Seen along n, it is the sum over its faces of area × |n · normal|, of each opposite pair one."""
    view = from_far_away(direction)
    picture = pinik.draw(cube(size), view=view, size=(400, 400), ground=False, background=None)
    a, b, c = map(float, size.split())
    n = np.abs(direction) / np.linalg.norm(direction)
    covered = picture.pixels[..., 3].sum() / 255.0 * (3.0 / 400) ** 2
    assert covered == pytest.approx(n @ [b * c, a * c, a * b], rel=2e-3)


def test_a_ball_is_seen_where_its_middle_is_projected_in_its_own_colour(arm):
    options = {"size": (400, 300), "ground": False, "background": None}
    for color, y in (("#d81f2f", -0.4), ("#1f6fc4", 0.0), ("#0c9a72", 0.6)):
        at = [1.2, y, 0.3]
        picture = pinik.draw(arm, balls=at, ball_color=color, ball_radius=0.06, **options)
        column, row = picture.project(at)
        wanted = [int(color[k : k + 2], 16) for k in (1, 3, 5)]
        assert abs(hue(picture.pixels[round(row), round(column)]) - hue(wanted)) < 0.03
        without = pinik.draw(arm, view=picture.camera, **options)
        rows, columns = np.nonzero((picture.pixels[..., 3] > 127) & (without.pixels[..., 3] == 0))
        assert [columns.mean(), rows.mean()] == pytest.approx([column, row], abs=0.5)


def test_a_ball_hides_what_is_behind_it_and_is_hidden_by_what_is_before_it():
    box = cube()
    view = from_far_away((1, 0, 0))
    before = pinik.draw(box, balls=[[2.0, 0.0, 0.0]], ball_radius=0.2, view=view, size=(200, 200), ground=False)
    behind = pinik.draw(box, balls=[[-2.0, 0.0, 0.0]], ball_radius=0.2, view=view, size=(200, 200), ground=False)
    half = pinik.draw(box, balls=[[-2.0, 0.5, 0.0]], ball_radius=0.2, view=view, size=(200, 200), ground=False)
    disc = np.pi * 0.2**2 / (3.0 / 200) ** 2
    assert reds(before).sum() == pytest.approx(disc, rel=0.06)
    assert reds(behind).sum() == 0
    assert reds(half).sum() == pytest.approx(disc / 2, rel=0.1)


def test_a_robot_is_seen_at_the_configuration_asked_for(two_link):
    rng = np.random.default_rng(1)
    for _ in range(3):
        q = two_link.random(rng)
        tip = two_link.placement("tip", q).translation
        picture = pinik.draw(two_link, q, view="top", size=(300, 300), ground=False, background=None)
        x, y = picture.project(tip)
        assert picture.pixels[round(y), round(x), 3] == 255
        other = pinik.draw(two_link, -q, view=picture.camera, size=(300, 300), ground=False, background=None)
        assert other.pixels[round(y), round(x), 3] == 0


def test_everything_is_in_the_picture_and_fills_it():
    for name in ("lion", "panda", "two_link"):
        for view in ("angle", "front", "side", "top", (2.0, 0.5)):
            picture = pinik.draw(load_quietly(name), view=view, size=(160, 100), ground=False, background=None)
            rows, columns = np.nonzero(picture.pixels[..., 3])
            left, right, top, bottom = columns.min(), 159 - columns.max(), rows.min(), 99 - rows.max()
            assert min(left, right, top, bottom) >= 3
            assert min(left + right, top + bottom * 1.6) <= 45


def test_several_configurations_stand_beside_each_other():
    box = cube("0.4 0.4 0.4")
    q = np.zeros((3, 0))
    view = from_far_away((1, 0, 0))
    alone = pinik.draw(box, view=view, size=(300, 300), ground=False, background=None)
    three = pinik.draw(box, q, offset=(0, 0.8, 0), view=view, size=(300, 300), ground=False, background=None)
    each = pinik.draw(
        box, q, offset=[[0, -0.8, 0], [0, 0, 0], [0, 0.8, 0]], view=view, size=(300, 300), ground=False, background=None
    )
    assert three.pixels[150, :, 3].nonzero()[0].min() == pytest.approx(150 - 20, abs=1)
    starts = np.flatnonzero(np.diff((each.pixels[150, :, 3] > 0).astype(int)) == 1) + 1
    assert starts == pytest.approx([50, 130, 210], abs=1)
    for picture, count in ((each, 3), (alone, 1)):
        assert (picture.pixels[..., 3] > 127).sum() == pytest.approx(count * 40**2, rel=0.03)


def test_a_ghost_lets_through_what_is_behind_it():
    black = cube(color="0 0 0 1")
    view = from_far_away((1, 0, 0))
    options = {"view": view, "size": (100, 100), "ground": False}
    solid, ghost = (pinik.draw(black, opacity=share, **options).pixels[50, 50].astype(int) for share in (1.0, 0.25))
    assert ghost[:3] == pytest.approx(0.25 * solid[:3] + 0.75 * 255, abs=2)
    clear = pinik.draw(black, opacity=0.25, background=None, **options).pixels[50, 50]
    assert clear[3] == pytest.approx(64, abs=1)
    behind = pinik.draw(black, opacity=0.25, balls=[[-2, 0, 0]], ball_radius=0.2, **options).pixels[50, 50].astype(int)
    before = pinik.draw(black, opacity=0.25, balls=[[2, 0, 0]], ball_radius=0.2, **options).pixels[50, 50].astype(int)
    assert behind[:3] == pytest.approx(0.75 * before[:3] + 0.25 * solid[:3], abs=6)


def test_of_ghosts_one_behind_the_other_each_lets_through_its_share():
    """Seen one by one, and put over each other by hand; whatever their order."""
    box = cube("0.1 1 1")
    options = {"view": from_far_away((1, 0.2, 0.3)), "size": (100, 100), "ground": False, "background": None}
    places = np.array([[-0.9, 0.1, 0.0], [0.9, -0.2, 0.1], [0.3, 0.0, -0.1], [-0.3, 0.2, 0.2]])
    shares, colors = np.array([0.5, 0.4, 0.7, 0.3]), np.array(["#d97a00", "#0c9a72", "#1f6fc4", "#d81f2f"])
    row, column = 50, 50
    total, left = np.zeros(3), 1.0
    for k in np.argsort(-places[:, 0]):
        alone = pinik.draw(box, offset=places[k : k + 1], color=str(colors[k]), **options).pixels[row, column]
        assert alone[3] == 255
        total, left = total + left * shares[k] * alone[:3], left * (1.0 - shares[k])
    for order in ([0, 1, 2, 3], [3, 1, 0, 2]):
        picture = pinik.draw(
            box,
            np.zeros((4, 0)),
            offset=places[order],
            opacity=shares[order],
            color=[str(color) for color in colors[order]],
            **options,
        )
        pixel = picture.pixels[row, column].astype(float)
        assert pixel[3] == pytest.approx(255 * (1.0 - left), abs=1)
        assert pixel[:3] * pixel[3] / 255 == pytest.approx(total, abs=2)


def test_a_ghost_costs_what_it_covers_and_not_what_the_picture_has(two_link):
    def peak(count):
        q = np.linspace([0.0, 0.1], [1.5, 1.0], count)
        tracemalloc.start()
        pinik.draw(two_link, q, opacity=0.3, size=(400, 250))
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return most

    peak(1)
    assert (peak(22) - peak(2)) / 20 < 6e6  # the colours of all samples would take 10 MB, and their depths 3


@pytest.mark.parametrize("background", ["#ffffff", None])
@pytest.mark.parametrize(("name", "most"), [("_AT_ONCE", 1000), ("_MOST", 500)])
def test_it_does_not_matter_how_many_rows_are_drawn_at_once(arm, monkeypatch, background, name, most):
    options = {"q": [np.zeros(12), np.full(12, 0.3)], "opacity": [1.0, 0.4], "balls": [0.3, 0.3, 0.3]}
    options |= {"size": (160, 101), "background": background}
    at_once = pinik.draw(arm, **options).pixels.astype(int)
    monkeypatch.setattr(sys.modules["pinik.picture.render"], name, most)
    assert np.abs(pinik.draw(arm, **options).pixels - at_once).max() <= 1


def test_a_material_that_is_half_transparent_is_a_ghost_too():
    options = {"view": from_far_away((1, 0, 0)), "size": (100, 100), "ground": False, "background": None}
    assert pinik.draw(cube(color="0 0 0 0.5"), **options).pixels[50, 50, 3] == pytest.approx(128, abs=1)
    assert pinik.draw(cube(color="0 0 0 0.5"), opacity=0.5, **options).pixels[50, 50, 3] == pytest.approx(64, abs=1)


def test_a_tint_takes_the_hue_of_its_colour(arm):
    for color in ("#d97a00", "#0c9a72"):
        picture = pinik.draw(arm, color=color, size=(200, 200), ground=False, background=None)
        pixels = picture.pixels[picture.pixels[..., 3] == 255].astype(int)
        wanted = hue([int(color[k : k + 2], 16) for k in (1, 3, 5)])
        assert abs(np.median([hue(pixel) for pixel in pixels]) - wanted) < 0.04


def test_a_robot_without_shapes_is_drawn_as_its_skeleton():
    bare = pinik.load(two_hinges(1.0, 0.5))
    q = bare.configuration(dict.fromkeys(bare.joint_names[:2], 0.5))
    picture = pinik.draw(bare, q, view="top", size=(300, 300), ground=False, background=None)
    origins = [bare.placement(name, q).translation for name in bare.description.links]
    for a, b in itertools.pairwise(origins):
        for share in (0.25, 0.5, 0.75):
            x, y = picture.project(a + share * (b - a))
            assert picture.pixels[round(y), round(x), 3] == 255
    assert 0.005 < (picture.pixels[..., 3] > 0).mean() < 0.2


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e6])
def test_a_picture_is_the_same_whatever_the_size_of_the_robot(scale):
    pictures = [pinik.draw(pinik.load(two_hinges(1.0 * k, 0.5 * k)), size=(100, 60)) for k in (1.0, scale)]
    assert np.abs(pictures[0].pixels.astype(int) - pictures[1].pixels).max() <= 1


def test_a_shape_that_cannot_be_read_is_named_and_left_out():
    text = CUBE.format(size="1 1 1", color="0.5 0.5 0.5 1")
    lost = '<visual><geometry><mesh filename="nowhere.stl"/></geometry></visual></link>'
    with pytest.warns(pinik.UrdfWarning, match="mesh 'nowhere.stl': not found"):
        robot = pinik.load(text.replace("</link>", lost))
    with pytest.warns(pinik.UrdfWarning, match=r"cube: link 'base': a shape is left out: there is no mesh 'nowhere"):
        picture = pinik.draw(robot, size=(100, 100), ground=False, background=None)
    assert (picture.pixels[..., 3] > 0).any()


# Light and ground


def test_a_roof_darkens_what_it_keeps_the_sun_from():
    plates = pinik.load(TWO_PLATES)
    view = (0.0, 0.9)
    low = pinik.draw(plates, [0.02], view=view, size=(200, 200), ground=False)
    high = pinik.draw(plates, [0.5], view=low.camera, size=(200, 200), ground=False)
    on_the_plate = np.array([[0.4 * np.cos(a), 0.4 * np.sin(a), 0.01] for a in np.linspace(0, 6, 40)])
    eye = low.camera.position
    past_the_roof = eye + (on_the_plate - eye) * ((0.5 - eye[2]) / (0.01 - eye[2]))  # where looks at them are so high
    seen = np.abs(past_the_roof[:, :2]).max(axis=1) > 0.22
    assert seen.sum() > 20
    at = low.project(on_the_plate[seen]).round().astype(int)
    lit, cast = darkness(low)[at[:, 1], at[:, 0]], darkness(high)[at[:, 1], at[:, 0]]
    assert np.ptp(lit) < 12
    assert (cast - lit).max() > 25


def test_a_ball_keeps_its_colour_in_the_shade():
    plates = pinik.load(TWO_PLATES)
    ball = {"balls": [0, 0, 0.1], "ball_radius": 0.06}
    picture = pinik.draw(plates, [0.3], **ball, view=(0.0, 0.2), size=(200, 200), ground=False)
    x, y = picture.project(ball["balls"])
    r, g, b = picture.pixels[round(y), round(x), :3].astype(int)
    assert r > 150
    assert max(g, b) < 0.4 * r


def test_what_stands_on_the_ground_has_its_shadow_there_to_the_right_of_it():
    options = {"view": (0.0, 0.4), "size": (300, 200)}
    bare, ground = (pinik.draw(cube("0.2 0.2 1"), ground=on, background=None, **options) for on in (False, True))
    shadow = ground.pixels[..., 3].astype(int) - bare.pixels[..., 3]
    _, columns = np.nonzero(shadow > 20)
    middle = ground.project([0.0, 0.0, -0.5])[0]
    assert len(columns) > 200
    assert columns.mean() > middle + 5
    assert (bare.pixels[bare.pixels[..., 3] == 255] == ground.pixels[bare.pixels[..., 3] == 255]).all()


def test_a_shadow_falls_where_the_light_is_cut_off():
    """The shadow of a ball in the air lies on the line from the sun through it."""
    box = cube("2 2 0.01")
    plate = pinik.draw(box, view=(0.3, 1.2), size=(300, 300), ground=False)
    spots = []
    for height in (0.2, 0.4):
        ball = {"balls": [[0, 0, height]], "ball_radius": 0.05}
        picture = pinik.draw(box, **ball, view=plate.camera, size=(300, 300), ground=False)
        rows, columns = np.nonzero((darkness(picture) - darkness(plate) > 15) & ~reds(picture))
        # A point of the plate from its pixel: the plate's corners say how.
        corners = np.array([[0, 0, 0.005], [1, 0, 0.005], [0, 1, 0.005]])
        origin, x, y = plate.project(corners)
        middle = np.array([columns.mean(), rows.mean()]) - origin
        spots.append(np.linalg.solve(np.stack([x - origin, y - origin], axis=1), middle))
    assert spots[1] == pytest.approx(2 * spots[0], rel=0.15)
    assert np.linalg.norm(spots[0]) > 0.05


def test_a_ground_lies_under_the_robot_or_where_it_is_told():
    under, told, deeper = (
        pinik.draw(cube(), ground=height, view=(0.0, 0.4), size=(200, 150)) for height in (True, -0.5, -1.5)
    )
    assert (under.pixels == told.pixels).all()
    assert (under.pixels != deeper.pixels).any()


def test_light_differs_from_face_to_face_of_a_box():
    picture = pinik.draw(cube(), view=(-0.6, 0.5), size=(200, 200), ground=False)
    middles = [[0.5, 0, 0], [0, -0.5, 0], [0, 0, 0.5]]
    shades = [darkness(picture)[round(y), round(x)] for x, y in picture.project(middles)]
    assert np.ptp(shades) > 20
    assert np.diff(sorted(shades)).min() > 5


@pytest.mark.parametrize("on", [True, False])
def test_a_truth_value_of_numpy_is_one(on):
    told = [pinik.draw(cube(), ground=ground, size=(64, 40)) for ground in (on, np.bool_(on))]
    assert (told[0].pixels == told[1].pixels).all()


def test_a_mesh_that_is_inside_out_looks_as_if_it_were_not(tmp_path):
    pictures = []
    for name in ("out", "in"):
        mesh = trimesh.creation.icosphere(2, 0.5)
        if name == "in":
            mesh.invert()
        mesh.export(tmp_path / f"{name}.stl")
        text = f'<robot name="r"><link name="l"><visual><geometry><mesh filename="{tmp_path}/{name}.stl"/>'
        robot = pinik.load(text + "</geometry></visual></link></robot>", package_dirs=[tmp_path])
        pictures.append(pinik.draw(robot, size=(120, 90), ground=False).pixels.astype(int))
    outwards, inwards = pictures
    assert np.ptp(outwards[45, 40:80]) > 10
    assert np.abs(outwards - inwards).max() <= 2


def test_paper_is_white_a_colour_or_none():
    options = {"size": (120, 80), "ground": False}
    white, green, clear = (pinik.draw(cube(), background=b, **options) for b in ("#ffffff", "#00ff00", None))
    assert white.pixels[0, 0].tolist() == [255, 255, 255, 255]
    assert green.pixels[0, 0].tolist() == [0, 255, 0, 255]
    assert clear.pixels[0, 0].tolist() == [0, 0, 0, 0]
    assert (white.pixels[40, 60] == clear.pixels[40, 60]).all()


# What is done with one


def test_the_same_camera_sees_the_same(arm):
    first = pinik.draw(arm, size=(160, 100))
    again = pinik.draw(arm, view=first.camera, size=(160, 100))
    assert (first.pixels == again.pixels).all()
    rng = np.random.default_rng(0)
    points = rng.normal(size=(5, 3))
    moved = pinik.draw(arm, arm.random(rng), view=first.camera, size=(160, 100))
    assert (moved.project(points) == first.project(points)).all()


def test_pixels_are_counted_from_the_middle_of_the_first_as_matplotlib_does():
    picture = pinik.draw(cube(), view=from_far_away((1, -1, 0.5)), size=(201, 200), ground=False, background=None)
    rows, columns = np.indices(picture.pixels.shape[:2])
    opacity = picture.pixels[..., 3].astype(float)
    middle = [(opacity * columns).sum() / opacity.sum(), (opacity * rows).sum() / opacity.sum()]
    assert picture.project([0.0, 0.0, 0.0]) == pytest.approx([100.0, 99.5], abs=1e-9)
    assert middle == pytest.approx([100.0, 99.5], abs=0.05)


def test_a_point_behind_the_camera_is_nowhere(arm):
    picture = pinik.draw(arm, size=(160, 100))
    back = picture.camera.position - 0.1 * picture.camera.axes[2]
    assert np.isnan(picture.project(back)).all()
    assert picture.project(np.zeros((0, 3))).shape == (0, 2)


def test_a_notebook_shows_the_pixels(arm):
    for background in ("#ffffff", None):
        picture = pinik.draw(arm, size=(160, 100), background=background)
        shown = np.asarray(Image.open(io.BytesIO(picture._repr_png_())).convert("RGBA"))
        assert (shown == picture.pixels).all()
    assert repr(picture) == "<Picture of 160×100 pixels>"
    assert picture.size == (160, 100)


@pytest.mark.parametrize("end", [".png", ".jpg", ".webp"])
def test_it_is_saved_as_its_name_says(arm, tmp_path, end):
    picture = pinik.draw(arm, size=(160, 100), background=None)
    for path in (tmp_path / f"a{end}", str(tmp_path / f"b{end}")):
        picture.save(path)
        with Image.open(path) as saved:
            assert saved.size == (160, 100)
            if end == ".jpg":
                assert min(saved.convert("RGB").getpixel((1, 1))) > 245  # white, where it was transparent


@pytest.mark.parametrize("end", [".bmp", ".gif", ".jpe", ".jfif", ".mpo", ".eps", ".pcx", ".ppm", ".pdf"])
def test_where_a_format_knows_no_opacity_it_stands_on_white(arm, tmp_path, end):
    picture = pinik.draw(arm, size=(64, 40), ground=False, background=None)
    picture.save(tmp_path / f"a{end}")
    assert (tmp_path / f"a{end}").stat().st_size > 0
    if end not in (".eps", ".pdf"):  # which Pillow alone does not read
        with Image.open(tmp_path / f"a{end}") as saved:
            assert min(saved.convert("RGB").getpixel((1, 1))) > 245


@pytest.mark.parametrize("end", [".png", ".tif", ".webp", ".tga"])
def test_where_a_format_knows_opacity_it_is_kept(arm, tmp_path, end):
    picture = pinik.draw(arm, size=(64, 40), ground=False, background=None)
    picture.save(tmp_path / f"a{end}")
    with Image.open(tmp_path / f"a{end}") as saved:
        assert (np.asarray(saved.convert("RGBA"))[..., 3] == picture.pixels[..., 3]).all()


@pytest.mark.filterwarnings("ignore:.*image format is deprecated")
def test_every_name_that_pillow_knows_is_written_or_refused_in_words(two_link, tmp_path):
    picture = pinik.draw(two_link, size=(32, 32), background=None)
    ends = Image.registered_extensions()
    refused = set()
    for end in ends:
        try:
            picture.save(tmp_path / f"a{end}")
        except pinik.InputError:
            refused.add(end)
        assert (tmp_path / f"a{end}").exists() == (end not in refused)
    assert {".psd", ".fits", ".h5", ".xbm"} <= refused
    assert len(refused) < len(ends) / 2


@pytest.mark.parametrize("name", ["a", "a.urdf", "a.", "a.psd", "a.fits", "a.h5", "a.xbm"])
def test_a_file_of_no_format_is_refused(arm, tmp_path, name):
    picture = pinik.draw(arm, size=(32, 32))
    with pytest.raises(pinik.InputError, match=r"path must end in \.png, \.jpg"):
        picture.save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("path", [None, 5, b"a.png", ["a.png"]])
def test_what_is_no_name_of_a_file_is_refused(two_link, path):
    with pytest.raises(pinik.InputError, match="path must be the name of a file"):
        pinik.draw(two_link, size=(32, 32)).save(path)


def test_a_folder_that_is_not_there_is_the_system_s_to_tell(two_link, tmp_path):
    with pytest.raises(FileNotFoundError):
        pinik.draw(two_link, size=(32, 32)).save(tmp_path / "none" / "a.png")


@pytest.mark.parametrize(
    ("options", "fault"),
    [
        ({"robot": "arm"}, "robot must be one that pinik.load returned, or an answer with its own; got … 'str'"),
        ({"q": [1.0, 2.0, 3.0]}, "q … 2 finite numbers"),
        ({"q": [[0.0, 0.0], [1.0]]}, "q[1] … 2 finite numbers"),
        ({"q": [[0.0, 0.0], 1.0]}, "q … 2 finite numbers"),
        ({"q": np.zeros((2, 3))}, "q … N times 2 finite numbers"),
        ({"q": []}, "q … 2 finite numbers"),
        ({"q": "home"}, "q … 2 finite numbers"),
        ({"balls": [1.0, 2.0]}, "balls … N times 3 finite numbers"),
        ({"balls": [[1.0, 2.0, np.nan]]}, "balls[0] … 3 finite numbers"),
        ({"balls": 5}, "balls … N times 3 finite numbers"),
        ({"balls": "here"}, "balls … an array of numbers"),
        ({"ball_color": "red"}, "ball_color must be a colour such as '#1f6fc4'; got 'red'"),
        (
            {"balls": np.zeros((2, 3)), "ball_color": ["#000000"]},
            "ball_color must be one colour, or one for each of the 2 balls",
        ),
        ({"ball_radius": 0.0}, "ball_radius must be greater than 0 m; got 0.0"),
        ({"ball_radius": "big"}, "ball_radius … a finite number"),
        ({"ball_radius": 1e300}, "ball_radius … must be within ±1e+09 m; got 1e+300"),
        ({"opacity": 1.5}, "opacity must be between 0 and 1; got 1.5"),
        ({"opacity": [0.5, 0.5]}, "opacity … 1 finite numbers (one for each q)"),
        ({"opacity": "half"}, "opacity … a finite number"),
        ({"opacity": 0.0}, "there is nothing to draw"),
        ({"color": "blue"}, "color must be a colour such as"),
        ({"color": 5}, "color must be one colour, or one for each of the 1 configurations; got 5"),
        ({"color": ["#000000", "#000000"]}, "color must be one colour, or one for each of the 1 configurations"),
        ({"offset": [1.0, 2.0]}, "offset … 3 finite numbers"),
        ({"offset": [1e300, 0.0, 0.0]}, "offset … must be a point within 1e+09 m of the origin"),
        ({"offset": np.zeros((2, 3))}, "offset … 1×3 finite numbers (one for each q)"),
        ({"view": "back"}, "no view 'back'; available: 'angle', 'front', 'side', 'top'"),
        ({"view": 1.0}, "view … 2 finite numbers (the camera's azimuth and elevation in radians)"),
        ({"view": None}, "view … 2 finite numbers"),
        ({"view": (0.0, 2.0)}, "view: the camera's elevation must be between -π/2 and π/2 rad; got 2"),
        ({"view": (0.0, -90.0)}, "view: the camera's elevation must be between -π/2 and π/2 rad; got -90"),
        ({"size": (800,)}, "size must be a width and a height of 16 to 4000 pixels; got (800,)"),
        ({"size": (800, 5000)}, "size must be a width and a height"),
        ({"size": (800.0, 500)}, "size must be a width and a height"),
        ({"size": 800}, "size must be a width and a height"),
        ({"size": (4000, 2501)}, "size must be at most 10 million pixels, width times height; got (4000, 2501)"),
        ({"ground": "low"}, "ground … a finite number; got 'low'"),
        ({"ground": None}, "ground … a finite number; got None"),
        ({"ground": -1e300}, "ground … must be within ±1e+09 m; got -1e+300"),
        ({"background": "white"}, "background must be a colour such as '#1f6fc4'; got 'white'"),
        ({"background": 5}, "background must be a colour such as"),
    ],
)
def test_what_cannot_be_drawn_is_said_in_words(two_link, options, fault):
    options = {"robot": two_link, "size": (32, 32), **options}
    with pytest.raises(pinik.PinikError) as raised:
        pinik.draw(**options)
    assert all(part in str(raised.value) for part in fault.split(" … "))


@pytest.mark.parametrize("points", [[1.0, 2.0], "here", [[1.0, np.nan, 0.0]], 3.0])
def test_what_cannot_be_projected_is_said_in_words(two_link, points):
    with pytest.raises(pinik.InputError, match="points"):
        pinik.draw(two_link, size=(32, 32)).project(points)
