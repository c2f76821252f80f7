"""Pictures of maps: the colours are those of the numbers, the cut faces the camera, and the frame can be seen."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from pinik.model.home import home_configuration
from pinik.picture.arguments import view_direction
from pinik.workspace.colors import ANCHORS, colors_of
from pinik.workspace.pose import shown_configuration


@pytest.fixture(scope="module")
def found(ur5):
    return pinik.reach(ur5, "tool0", cell=0.2, samples=20_000, directions=6, rolls=2)


def test_colours_are_the_anchors_and_grow_lighter():
    at = np.linspace(0, 1, 101)
    colors = colors_of(at)
    named = [[int(name[k : k + 2], 16) for k in (1, 3, 5)] for name in ANCHORS]
    np.testing.assert_allclose(255 * colors[::25], named, atol=1e-9)
    light = colors**2.2 @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(light) > 0).all()
    np.testing.assert_array_equal(colors_of(np.array([-1.0, 2.0])), colors[[0, -1]])


def test_cutting_shows_the_robot_inside(ur5, found):
    size = (160, 120)
    whole, quarter = (found.draw(cut=cut, size=size).pixels.astype(int) for cut in ("none", "quarter"))
    covered = (whole[..., :3] < 250).any(axis=2)
    assert 0.2 < covered.mean() < 0.9
    assert (np.abs(whole - quarter).sum(axis=2) > 30)[covered].mean() > 0.15
    alone = found.draw(workspace=1.0, cut="none", size=size).pixels[..., :3]
    assert (alone != whole[..., :3]).any()


def test_the_frame_is_where_the_map_is_cut_open(ur5, found):
    for azimuth in (-0.6, 1.0, 2.5, -2.2):
        direction = view_direction((azimuth, 0.3))
        q = shown_configuration(found, ur5, direction)
        middle = found.bounds().mean(axis=0)
        away = (ur5.placement("tool0", q).translation - middle)[:2]
        assert away @ direction[:2] > 0.4 * np.linalg.norm(away) * np.linalg.norm(direction[:2])
        assert (q >= ur5.lower_q).all()
        assert (q <= ur5.upper_q).all()
    above = shown_configuration(found, ur5, view_direction("top"))
    np.testing.assert_array_equal(above, home_configuration(ur5))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"cut": "eighth"}, "quarter"),
        ({"quantity": "beauty"}, "share"),
        ({"quantity": "branches"}, "not counted"),
        ({"workspace": "nowhere"}, "dexterous"),
        ({"view": "below"}, "angle"),
        ({"size": (1, 1)}, "size"),
    ],
)
def test_wrong_pictures_are_refused_in_words(found, options, words):
    with pytest.raises(pinik.PinikError, match=words):
        found.draw(**options)


def test_an_empty_workspace_is_nothing_to_draw(panda):
    small = pinik.reach(panda, "panda_hand_tcp", cell=0.2, samples=100)
    with pytest.raises(pinik.InputError, match="empty"):
        small.draw(workspace="dexterous")
