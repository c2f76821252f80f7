"""Whatever looks like an array is read as the numbers that it shows, or refused in words."""

from __future__ import annotations

import array
import warnings

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from pinik import Target

TIP = "panda_hand_tcp"
POSES = np.array([pinocchio.SE3(np.eye(3), np.array([0.4, 0.1 * k, 0.5])).homogeneous for k in range(3)])
POINTS = POSES[:, :3, 3].copy()


def masked(numbers, index=None):
    mask = np.zeros(np.shape(numbers), dtype=bool)
    if index is not None:
        mask[index] = True
    return np.ma.MaskedArray(numbers, mask)


def strided(numbers):
    """The same numbers, which do not lie side by side in memory."""
    wide = np.zeros((*numbers.shape[:-1], 2 * numbers.shape[-1]))
    wide[..., ::2] = numbers
    return wide[..., ::2]


def read_only(numbers):
    numbers = numbers.copy()
    numbers.setflags(write=False)
    return numbers


class Named(np.ndarray):
    """A subclass of arrays, as libraries of units define."""


SAME = {
    "a list": lambda a: a.tolist(),
    "a tuple of arrays": tuple,
    "a memoryview": memoryview,
    "memoryviews in a list": lambda a: [memoryview(row) for row in a],
    "nothing masked": masked,
    "nothing masked in a list": lambda a: [masked(row) for row in a],
    "numbers as objects": lambda a: a.astype(object).tolist(),
    "big-endian": lambda a: a.astype(">f8"),
    "extended": lambda a: a.astype(np.longdouble),
    "column by column": np.asfortranarray,
    "strided": strided,
    "backwards": lambda a: a[::-1].copy()[::-1],
    "read-only": read_only,
    "a subclass": lambda a: a.view(Named),
}


@pytest.fixture(autouse=True)
def no_warning_leaks():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
@pytest.mark.parametrize("form", SAME)
@pytest.mark.parametrize("numbers", [POSES, POINTS], ids=["poses", "points"])
def test_places_of_any_form_are_the_same_places(form, numbers, engine, panda):
    options = {"engine": engine, "max_iterations": 3, "restarts": 0}
    wanted = pinik.solve_many(panda, TIP, numbers, **options)
    assert np.array_equal(pinik.solve_many(panda, TIP, SAME[form](numbers), **options).q, wanted.q)


@pytest.mark.parametrize("form", SAME)
def test_starts_and_configurations_of_any_form_are_the_same(form, panda):
    starts = np.array([panda.random(k) for k in range(3)])
    options = {"max_iterations": 3, "restarts": 0}
    wanted = pinik.solve_many(panda, TIP, POINTS, q0=starts, **options).q
    assert np.array_equal(pinik.solve_many(panda, TIP, POINTS, q0=SAME[form](starts), **options).q, wanted)
    assert np.array_equal(panda.placements(TIP, SAME[form](starts)), panda.placements(TIP, starts))


HALF = np.array([0.5, 0.25, 0.125])


def released(array):
    view = memoryview(array)
    view.release()
    return view


BAD = {
    "a masked entry": (lambda a: masked(a, (0,) * a.ndim), "must have no masked entries"),
    "all masked": (lambda a: np.ma.masked_all(a.shape), "must have no masked entries"),
    "masked in a list": (lambda a: [masked(row, 0) for row in a] if a.ndim > 1 else [np.ma.masked, *a[1:]], "masked"),
    "masked objects": (lambda a: masked(a.astype(object), (0,) * a.ndim), "must have no masked entries"),
    "bytes": (lambda a: bytes(a.size), "must be"),
    "a bytearray": (lambda a: bytearray(a.size), "must be"),
    "a memoryview of bytes": (lambda a: memoryview(bytes(a.size)), "must be"),
    "a released memoryview": (released, "must"),
    "characters": (lambda a: a.astype(str), "must be"),
    "booleans": (lambda a: a.astype(bool), "must be"),
    "booleans in lists": (lambda a: a.astype(bool).tolist(), "must be"),
    "complex": (lambda a: a + 1j, "must be"),
    "complex objects": (lambda a: (a + 1j).astype(object), "must be"),
    "a record": (lambda a: np.zeros(a.shape, dtype=[("x", float)]), "must be"),
    "dates": (lambda a: np.zeros(a.shape, dtype="datetime64[s]"), "must be"),
    "NaN in half precision": (lambda a: np.full(a.shape, np.nan, dtype=np.float16), "must be"),
    "beyond float64": (lambda a: np.full(a.shape, np.longdouble("1e4000")), "must be"),
    "a number": (lambda a: np.array(0.5), "must be"),
    "a text": (lambda a: "0.5", "must be"),
    "a set": (lambda a: {0.5}, "must be"),
}
TAKERS = {
    "solve_many": lambda robot, x: pinik.solve_many(robot, TIP, x(POSES)),
    "solve_many, points": lambda robot, x: pinik.solve_many(robot, TIP, x(POINTS)),
    "starts": lambda robot, x: pinik.solve_many(robot, TIP, POINTS, q0=x(np.array([robot.neutral()] * 3))),
    "q0": lambda robot, x: robot.solve(TIP, position=HALF, q0=x(robot.neutral())),
    "position": lambda robot, x: robot.solve(TIP, position=x(HALF)),
    "rotation": lambda robot, x: Target(TIP, rotation=x(np.eye(3))),
    "rpy": lambda robot, x: Target(TIP, rpy=x(HALF)),
    "quaternion": lambda robot, x: Target(TIP, quat_xyzw=x(np.array([0.5, 0.5, 0.5, 0.5]))),
    "placement": lambda robot, x: Target(TIP, placement=x(np.eye(4))),
    "axis": lambda robot, x: Target(TIP, axis=x(HALF), direction=HALF),
    "direction": lambda robot, x: Target(TIP, axis="x", direction=x(HALF)),
    "at": lambda robot, x: Target(TIP, axis="x", at=x(HALF)),
    "tool": lambda robot, x: Target(TIP, HALF, tool=x(HALF)),
    "tolerance": lambda robot, x: Target(TIP, HALF, tolerance=x(HALF[:2])),
    "a prepared place": lambda robot, x: pinik.prepare(robot, TIP, position=HALF)(x(HALF)),
    "configurations": lambda robot, x: robot.placements(TIP, x(np.array([robot.neutral()] * 3))),
    "a configuration": lambda robot, x: robot.placement(TIP, x(robot.neutral())),
    "a path": lambda robot, x: pinik.track(robot, TIP, x(POSES), robot.neutral()),
    "times": lambda robot, x: pinik.track(robot, TIP, POSES, robot.neutral(), times=x(np.arange(3.0))),
    "two_bone": lambda robot, x: pinik.two_bone(0.5, 0.5, x(POINTS), pole=HALF),
    "lengths": lambda robot, x: pinik.two_bone(x(HALF), 0.5, POINTS, pole=HALF),
    "a pole": lambda robot, x: pinik.two_bone(0.5, 0.5, POINTS, pole=x(HALF)),
}
FITS = {("a number", "lengths"), ("a text", "axis")}  # a length is a number; of axes, another error names them


@pytest.mark.parametrize("what", BAD)
@pytest.mark.parametrize("taker", TAKERS)
def test_what_shows_no_numbers_is_refused_in_words(taker, what, panda):
    made, words = BAD[what]
    if (what, taker) in FITS:
        return
    with pytest.raises(pinik.InputError, match=words):
        TAKERS[taker](panda, made)


@pytest.mark.parametrize("number", [np.array(0.5), np.float16(0.5), np.ma.MaskedArray(0.5), array.array("d", [0.5])[0]])
def test_a_number_of_any_type_is_that_number(number, panda):
    assert Target(TIP, HALF, weight=number).weight == 0.5
    assert panda.configuration({"panda_joint1": number})[0] == 0.5


@pytest.mark.parametrize("number", [np.ma.masked, np.array([0.5]), b"0.5", bytearray(b"0.5"), True, 0.5 + 0j, "0.5"])
def test_what_is_no_number_is_refused_in_words(number, panda):
    for refuses in (lambda: Target(TIP, HALF, weight=number), lambda: panda.configuration({"panda_joint1": number})):
        with pytest.raises(pinik.InputError, match="must"):
            refuses()


def test_starts_from_which_no_step_can_be_seen_are_refused(panda):
    for refuses in (
        lambda q: panda.solve(TIP, position=HALF, q0=q),
        lambda q: panda.solve(TIP, position=HALF, q0=dict(zip(panda.joint_names, q, strict=True))),
        lambda q: pinik.solve_many(panda, TIP, POINTS, q0=[q] * 3),
        lambda q: pinik.track(panda, TIP, POINTS, q),
    ):
        with pytest.raises(pinik.InputError, match="q0 must be within ±1e\\+09 rad or m"):
            refuses([1e300, *panda.neutral()[1:]])


@pytest.mark.parametrize("option", ["locked", "time_limit", "seed", "max_iterations"])
def test_a_released_memoryview_is_no_option(panda, option):
    with pytest.raises(pinik.InputError, match=f"{option} must be"):
        panda.solve(TIP, position=HALF, **{option: released(HALF)})
