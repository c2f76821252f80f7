"""Rotation matrices that people hand in: rounded ones are replaced by the nearest rotation, others are refused."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import homogeneous, random_rotation
from engines import needs_native
from pinik import InputError, InputWarning, Target
from pinik.rotations import as_rotation, as_rotations, as_se3

TIP = "panda_hand_tcp"


def polar(M: np.ndarray) -> np.ndarray:
    """The nearest rotation by Newton's iteration for the polar factor: X ← (X + X⁻ᵀ) / 2."""
    X = M
    for _ in range(30):
        X = 0.5 * (X + np.linalg.inv(X).T)
    return X


def rotations(count: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.array([random_rotation(rng) for _ in range(count)])


@contextmanager
def no_warning() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


class TestOneMatrix:
    @pytest.mark.parametrize("digits", [3, 4, 5])
    def test_rounded_to_digits_becomes_the_nearest_rotation_with_a_warning(self, digits):
        for R in rotations(50):
            rounded = np.round(R, digits)
            with pytest.warns(InputWarning, match="R is replaced by the nearest rotation matrix"):
                found = as_rotation(rounded, "R")
            np.testing.assert_allclose(found, polar(rounded), atol=1e-14)
            np.testing.assert_allclose(found @ found.T, np.eye(3), atol=1e-14)
            assert np.abs(found - R).max() <= 1.5 * 10.0**-digits

    def test_in_single_precision_is_replaced_in_silence(self):
        with no_warning():
            for R in rotations(50):
                found = as_rotation(R.astype(np.float32), "R")
                np.testing.assert_allclose(found, polar(R.astype(np.float32).astype(float)), atol=1e-14)

    def test_that_is_exact_is_taken_as_it_is(self):
        with no_warning():
            for R in rotations(50):
                np.testing.assert_allclose(as_rotation(R, "R"), R, atol=1e-15)

    def test_the_warning_says_how_far_off_it_was_and_points_at_the_callers_line(self):
        R = np.diag([1.0 + 3e-5, 1.0, 1.0])
        with pytest.warns(InputWarning) as given:
            Target("tip", rotation=R)
        (warning,) = given
        assert str(warning.message) == (
            "target 'tip': rotation is replaced by the nearest rotation matrix; the largest change of an entry is 3e-05"
        )
        assert warning.filename == __file__

    @pytest.mark.parametrize(("off", "words"), [(1.1e-3, "0.0011"), (0.1, "0.1"), (1e200, r"1e\+200")])
    def test_further_off_is_refused_with_the_distance(self, off, words):
        with pytest.raises(InputError, match=rf"R must be a rotation matrix .* by at most 0\.001; .* is {words} away"):
            as_rotation(np.diag([1.0, 1.0 + off, 1.0]), "R")

    def test_just_below_a_thousandth_off_is_replaced(self):
        with pytest.warns(InputWarning, match=r"change of an entry is 0\.001"):
            np.testing.assert_allclose(as_rotation(np.diag([1.0, 0.99901, 1.0]), "R"), np.eye(3), atol=1e-15)

    @pytest.mark.parametrize("M", [np.diag([1.0, 1.0, -1.0]), -np.eye(3), np.zeros((3, 3)), np.full((3, 3), 1e308)])
    def test_that_mirrors_or_is_no_rotation_at_all_is_refused(self, M):
        with pytest.raises(InputError, match="must be a rotation matrix"):
            as_rotation(M, "R")
        with pytest.raises(InputError, match=r"R\[1\] must be a rotation matrix"):
            as_rotations(np.array([np.eye(3), M]), "R")

    def test_in_a_placement_is_replaced_too(self):
        (R,) = rotations(1)
        with pytest.warns(InputWarning, match="place is replaced"):
            found = as_se3(homogeneous(np.round(R, 4), (1, 2, 3)), "place")
        np.testing.assert_allclose(found.rotation, polar(np.round(R, 4)), atol=1e-14)
        np.testing.assert_array_equal(found.translation, [1, 2, 3])


class TestRollPitchYaw:
    def test_in_degrees_warns_at_the_callers_line_and_is_taken_as_radians(self):
        with pytest.warns(InputWarning) as given:
            target = Target("tip", rpy=[180, 0, 30])
        (warning,) = given
        assert "target 'tip': rpy goes beyond a full turn in radians, and looks like degrees" in str(warning.message)
        assert warning.filename == __file__
        with no_warning():
            np.testing.assert_allclose(target.rotation, Target("tip", rpy=[180.0001, 0, 30]).rotation, atol=2e-4)

    @pytest.mark.parametrize("rpy", [[3, 0, 1], [6, -6, 0], [3.14, 0, 0], [7.3, 0, 0], np.radians([180, 90, 360])])
    def test_in_radians_is_taken_in_silence(self, rpy):
        with no_warning():
            Target("tip", rpy=rpy)


class TestManyMatrices:
    def test_are_what_each_alone_is(self):
        many = rotations(40)
        many[::3] = np.round(many[::3], 5)
        many[1] = many[1].astype(np.float32)
        with pytest.warns(InputWarning):
            found = as_rotations(many, "R")
        for R, alone in zip(found, many, strict=True):
            np.testing.assert_allclose(R, polar(alone), atol=1e-14)

    def test_are_one_warning_with_the_count_and_the_first(self):
        many = rotations(10)
        many[2, 0, 0] += 1e-7
        many[4, 0, 0] += 4e-5
        many[7, 0, 0] += 2e-4
        with pytest.warns(InputWarning) as given:
            as_rotations(many, "R")
        (warning,) = given
        words = str(warning.message)
        assert words.startswith("R: 2 are replaced by the nearest rotation matrix, first R[4]; ")
        changes = np.abs(many - np.array([polar(M) for M in many])).max(axis=(1, 2))
        assert words.endswith(f"the largest change of an entry is {changes[7]:.1g}")

    def test_the_first_that_is_too_far_off_is_named(self):
        many = rotations(10)
        many[3] = np.round(many[3], 4)
        many[5] *= 1.01
        many[8] *= 2.0
        with pytest.raises(InputError, match=r"R\[5\] must be a rotation matrix"):
            as_rotations(many, "R")

    def test_none_are_none(self):
        assert as_rotations(np.zeros((0, 3, 3)), "R").shape == (0, 3, 3)


def places(robot: pinik.Robot, count: int) -> np.ndarray:
    rng = np.random.default_rng(4)
    return np.array([robot.placement(TIP, robot.random(rng)).homogeneous for _ in range(count)])


class TestSolving:
    @pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
    def test_rounded_places_are_solved_where_the_nearest_rotations_are(self, panda, engine):
        exact = places(panda, 4)
        rounded = exact.copy()
        rounded[1:, :3, :3] = np.round(exact[1:, :3, :3], 4)
        with pytest.warns(InputWarning, match=r"places: 3 are .* first places\[1\]"):
            many = pinik.solve_many(panda, TIP, rounded, engine=engine)
        assert many.success.all()
        for q, place in zip(many.q, rounded, strict=True):
            turn = polar(place[:3, :3]).T @ panda.placement(TIP, q).rotation
            assert np.linalg.norm(pinocchio.log3(turn)) <= 1.001e-3

    def test_rounded_se3_are_one_warning(self, panda):
        rounded = [pinocchio.SE3(np.round(M[:3, :3], 4), M[:3, 3]) for M in places(panda, 3)]
        with pytest.warns(InputWarning) as given:
            pinik.solve_many(panda, TIP, rounded)
        assert len(given) == 1

    def test_one_rounded_placement_is_solved_with_a_warning(self, panda):
        (place,) = places(panda, 1)
        place[:3, :3] = np.round(place[:3, :3], 5)
        prepared = pinik.prepare(panda, Target(TIP, placement=np.eye(4)))
        for solve in (lambda: panda.solve(TIP, placement=place), lambda: prepared(place)):
            with pytest.warns(InputWarning, match="nearest rotation"):
                solution = solve()
            assert solution.success
            np.testing.assert_allclose(solution.targets[0].rotation, polar(place[:3, :3]), atol=1e-14)
