"""What `solve_many` refuses, and in which words: the number of the first question at fault among them."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from pinik import Target
from pinik.solving import places as reading
from robots import load_quietly

TIP = "panda_hand_tcp"


def spoilt(poses, k, row, column, value):
    poses = poses.copy()
    poses[k, row, column] = value
    return poses


EYES = np.array([np.eye(4)] * 4)
POINT = Target(TIP, [0.4, 0.0, 0.5])
BAD = {
    "NaN in a matrix": ((TIP, spoilt(EYES, 2, 0, 3, math.nan)), r"places\[2\] must be"),
    "infinite rotation": ((TIP, spoilt(EYES, 1, 0, 0, math.inf)), r"places\[1\] must be"),
    "no rotation": ((TIP, spoilt(EYES, 3, 0, 0, 2.0)), r"places\[3\] must be a rotation matrix"),
    "a reflection": ((TIP, spoilt(EYES, 2, 0, 0, -1.0)), r"places\[2\] must be a rotation matrix"),
    "far away": ((TIP, spoilt(EYES, 2, 0, 3, 1e10)), r"places\[2\] must be a point within"),
    "last row": ((TIP, spoilt(EYES, 2, 3, 0, 0.5)), r"last row"),
    "NaN in the last row": ((TIP, spoilt(EYES, 2, 3, 0, math.nan)), r"places"),
    "3×4": ((TIP, EYES[:, :3]), "places must be N times 4×4"),
    "NaN in a position": ((TIP, [[0, 0, 1], [0, math.nan, 1]]), r"places\[1\] must be 3 finite numbers"),
    "two numbers": ((TIP, [[0, 0], [0, 1]]), "places must be N times 3"),
    "one position": ((TIP, [0, 0, 1]), "places must be N times 3"),
    "ragged": ((TIP, [[0, 0, 1], [0, 1]]), "places must be"),
    "text": ((TIP, "somewhere"), "places must be"),
    "texts": ((TIP, [["a", "b", "c"]]), "places must be"),
    "matrices of text": ((TIP, np.full((2, 4, 4), "a")), "places must be"),
    "SE3 and something other than": ((TIP, [pinocchio.SE3.Identity(), 3]), r"places\[1\] must be"),
    "no places": ((TIP,), "places must say where"),
    "no matrices of that size": ((TIP, np.zeros((0, 4, 3))), "places must be N times 4×4"),
    "no targets, but places": (([], EYES), "a frame's name or one Target"),
    "an unknown frame nowhere": (("nowhere", []), "no frame 'nowhere'"),
    "a number": ((3,), "targets"),
    "None": ((None,), "targets"),
    "no sequence of targets": (([POINT, 3],), "targets must be Target objects"),
    "mixed kinds": (([POINT, POINT, Target(TIP, placement=np.eye(4))],), r"targets\[2\] must be of the same kind as"),
    "mixed frames": (([POINT, Target("panda_link5", [0, 0, 1])],), r"targets\[1\] must be of the same kind as"),
    "mixed numbers": (([[POINT], [POINT, POINT]],), r"targets\[1\] must be of the same kind as"),
    "several patterns": (([POINT], EYES), "a frame's name or one Target"),
    "an axis": ((Target(TIP, axis="x", direction=[0, 0, 1]), EYES), "do not specify all that"),
    "a pose by points": ((Target(TIP, placement=np.eye(4)), [[0, 0, 1]]), "do not specify all that"),
    "an unknown frame": (("nowhere", EYES), "no frame 'nowhere'"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_no_question_is_refused_in_words(name, panda):
    arguments, words = BAD[name]
    with pytest.raises(pinik.PinikError, match=words):
        pinik.solve_many(panda, *arguments)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"q0": np.zeros((3, 8))}, "q0 must be one start, or one for each of the 4 targets; got 3"),
        ({"q0": np.full((4, 8), math.nan)}, r"q0\[0\] must be 8 finite numbers"),
        ({"q0": np.zeros((4, 7))}, "q0 must be"),
        ({"q0": np.zeros(7)}, "q0 must be 8 finite numbers"),
        ({"q0": "nearby"}, "q0 must be"),
        ({"q0": [[0.0] * 8, [0.0] * 7]}, "q0 must be"),
        ({"trace": True}, "keeps no trace"),
        ({"threads": 0}, "threads must be a whole number of at least 1"),
        ({"threads": "two"}, "threads must be a whole number"),
        ({"threads": True}, "threads must be a whole number"),
        ({"engine": "cuda"}, "no engine 'cuda'"),
        ({"damp": 1}, "no keyword 'damp'"),
    ],
)
def test_bad_options_are_refused_in_words(options, words, panda):
    with pytest.raises(pinik.PinikError, match=words):
        pinik.solve_many(panda, TIP, EYES, **options)


def test_a_robot_is_needed():
    with pytest.raises(pinik.InputError, match=r"robot must be what pinik\.load returns"):
        pinik.solve_many("panda", TIP, EYES)


@needs_native
def test_only_places_in_doubt_are_checked_in_python(panda, monkeypatch):
    """The engine reads exact matrices by itself; rounded ones are projected, and the first faulty one is named."""
    rng, seen = np.random.default_rng(0), []
    places = np.array([panda.placement(TIP, panda.random(rng)).homogeneous for _ in range(600)])
    exact = pinik.solve_many(panda, TIP, places)
    read = reading.read_placements
    monkeypatch.setattr(
        reading, "read_placements", lambda places, *more: seen.append(len(places)) or read(places, *more)
    )
    np.testing.assert_array_equal(pinik.solve_many(panda, TIP, places).q, exact.q)
    assert seen == []
    rounded = places.copy()
    rounded[[5, 400], :3, :3] = rounded[[5, 400], :3, :3].round(8)
    found = pinik.solve_many(panda, TIP, rounded)
    assert seen == [2]
    for index in (5, 400):
        R = found[index].targets[0].rotation
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-15)
        np.testing.assert_allclose(R, places[index, :3, :3], atol=1e-7)
    for row, column, value in ((0, 3, math.nan), (1, 3, 2e9), (0, 0, 3.0), (3, 3, 2.0)):
        faulty = rounded.copy()
        faulty[[301, 399], row, column] = value
        with pytest.raises(pinik.InputError, match=r"^places\[301\] must be"):
            pinik.solve_many(panda, TIP, faulty)


@needs_native
@pytest.mark.parametrize("threads", [1, 2, 5])
def test_places_are_read_alike_by_any_number_of_threads(threads, panda):
    rng = np.random.default_rng(1)
    places = np.array([panda.placement(TIP, panda.random(rng)).homogeneous for _ in range(700)])
    points = np.ascontiguousarray(places[:, :3, 3])
    goals, turned = reading._goals_at(places, threads)
    assert turned
    np.testing.assert_array_equal(goals[:, :3], points)
    np.testing.assert_array_equal(goals[:, 3:12], places[:, :3, :3].reshape(-1, 9))
    assert not goals[:, 12:].any()
    goals, turned = reading._goals_at(points, threads)
    assert not turned
    np.testing.assert_array_equal(goals[:, :3], points)
    assert not goals[:, 3:].any()


@pytest.mark.parametrize(
    ("what", "places", "message"),
    [
        ("tool0", [[None, None, 0.3], [0.1, 0.2, 0.3]], r"places\[1\] must leave the same axes free as places\[0\]"),
        ("tool0", [[None, None, 0.3], [None, None, "a"]], r"places\[1\]\[2\] must be a finite number; got 'a'"),
        (
            pinik.Target("tool0", [None, 0.1, 0.2]),
            [[None, None, 0.3]],
            "must have numbers along the axes where the target",
        ),
    ],
)
def test_free_axes_that_do_not_fit_are_refused_in_words(what, places, message):
    with pytest.raises(pinik.InputError, match=message):
        pinik.solve_many(load_quietly("ur5"), what, places)


@pytest.mark.parametrize("form", [list, lambda places: np.array(places, dtype=object)])
def test_places_may_leave_axes_free(form):
    robot = load_quietly("ur5")
    batch = pinik.solve_many(robot, "tool0", form([[None, None, 0.3], [None, None, 0.4]]))
    found = [robot.placement("tool0", q).translation[2] for q in batch.q]
    np.testing.assert_allclose(found, [0.3, 0.4], atol=1e-6)
