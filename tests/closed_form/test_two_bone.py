"""Two bones: every answer by forward kinematics in extended precision, lengths from a micrometre to a thousand km."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import pinik
from pinik import two_bone

UP, DOWN = 0, 1

lengths = st.floats(-6.0, 6.0).map(lambda exponent: 10.0**exponent)
directions = st.floats(-math.pi, math.pi)
# Many targets near the borders, where an arc cosine loses its digits.
near_a_border = st.floats(-16.0, -1.0).map(lambda exponent: 10.0**exponent)
parts = st.one_of(
    st.floats(0.0, 1.0), near_a_border, near_a_border.map(lambda part: 1.0 - part), st.sampled_from([0.0, 1.0])
)
vectors = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 1e-3)


def tips_by_extended_precision(l1, l2, angles):
    """(2 elbows, 2): forward kinematics with 64 bits of mantissa where the machine has them."""
    first, second = np.moveaxis(np.asarray(angles, dtype=np.longdouble), -1, 0)
    l1, l2 = np.longdouble(l1), np.longdouble(l2)
    x = l1 * np.cos(first) + l2 * np.cos(first + second)
    y = l1 * np.sin(first) + l2 * np.sin(first + second)
    return np.stack([x, y], axis=-1)


def in_annulus(l1, l2, part):
    return abs(l1 - l2) + part * (l1 + l2 - abs(l1 - l2))


class TestInsideTheAnnulus:
    @given(lengths, lengths, parts, directions)
    def test_every_answer_hits_its_target(self, l1, l2, part, direction):
        d = in_annulus(l1, l2, part)
        target = np.array([d * math.cos(direction), d * math.sin(direction)])
        answers = two_bone(l1, l2, [target])
        assert answers.reachable.all()
        assert answers.shortfall.tolist() == [0.0]
        errors = np.linalg.norm(tips_by_extended_precision(l1, l2, answers.angles[0]) - target, axis=-1)
        assert (errors <= 1e-12 * (l1 + l2)).all()
        assert (answers.errors <= 1e-12 * (l1 + l2)).all()
        assert answers.distance[0] == pytest.approx(d, rel=1e-15)

    @given(lengths, st.floats(0.0, 1.0), directions)
    def test_equal_bones_hit_targets_down_to_the_base(self, length, part, direction):
        target = [part * length * math.cos(direction), part * length * math.sin(direction)]
        answers = two_bone(length, length, [target])
        assert answers.reachable.all()
        errors = np.linalg.norm(tips_by_extended_precision(length, length, answers.angles[0]) - target, axis=-1)
        assert (errors <= 1e-12 * length).all()

    @given(lengths, lengths, parts, directions)
    def test_the_elbows_are_mirror_images_in_their_ranges(self, l1, l2, part, direction):
        d = in_annulus(l1, l2, part)
        target = np.array([d * math.cos(direction), d * math.sin(direction)])
        answers = two_bone(l1, l2, [target])
        (first_up, up), (first_down, down) = answers.angles[0]
        assert up == -down
        assert 0.0 <= down <= math.pi
        assert all(-math.pi < first <= math.pi for first in (first_up, first_down))
        off = math.remainder(first_up + first_down - 2.0 * math.atan2(target[1], target[0]), math.tau)
        assert abs(off) < 1e-14

    def test_up_is_left_of_the_line_to_the_target_and_down_right(self):
        answers = two_bone(1.0, 0.7, [[1.2, 0.0]])
        assert answers.elbows[0, UP, 1] > 0.1
        assert answers.elbows[0, DOWN] == pytest.approx(answers.elbows[0, UP] * [1.0, -1.0])

    def test_the_textbook_triangle_of_three_four_and_five(self):
        up, down = two_bone(3.0, 4.0, [[5.0, 0.0]]).angles[0]
        assert up == pytest.approx([math.acos(3.0 / 5.0), -math.pi / 2.0], abs=1e-15)
        assert down == pytest.approx([-math.acos(3.0 / 5.0), math.pi / 2.0], abs=1e-15)

    @given(lengths, lengths, st.floats(-15.5, -1.0))
    def test_the_bend_keeps_its_digits_near_the_stretch(self, l1, l2, exponent):
        d = (l1 + l2) * (1.0 - 10.0**exponent)
        if d < abs(l1 - l2):
            return
        a, b, c = Fraction(l1), Fraction(l2), Fraction(d)
        sine_squared = ((a + b) ** 2 - c**2) / (4 * a * b)  # of half the bend, exact
        if not 0 <= sine_squared <= Fraction(1, 2):
            return
        bend = 2.0 * math.asin(math.sqrt(sine_squared))
        assert two_bone(l1, l2, [[d, 0.0]]).angles[0, DOWN, 1] == pytest.approx(bend, rel=1e-14)


class TestAtTheBorders:
    @given(lengths, lengths)
    def test_the_outer_border_is_reached_with_a_straight_arm(self, l1, l2):
        answers = two_bone(l1, l2, [[l1 + l2, 0.0]])
        assert answers.reachable.all()
        bend = np.abs(answers.angles[0, :, 1]).max()
        assert bend <= 2e-8 * (l1 + l2) / math.sqrt(l1 * l2)  # what half of the sum's last bit bends it by
        assert two_bone(0.5, 0.25, [[0.75, 0.0]]).angles.tolist() == [[[0.0, 0.0], [0.0, 0.0]]]

    def test_the_inner_border_is_reached_with_a_folded_arm(self):
        longer_first = two_bone(0.75, 0.5, [[0.25, 0.0]])
        assert np.abs(longer_first.angles[0]).tolist() == [[0.0, math.pi], [0.0, math.pi]]
        longer_last = two_bone(0.5, 0.75, [[0.25, 0.0]])
        assert np.abs(longer_last.angles[0]).tolist() == [[math.pi, math.pi], [math.pi, math.pi]]
        assert longer_first.reachable.all()
        assert longer_last.reachable.all()

    @given(lengths, lengths, directions, st.sampled_from([0.0, math.pi]))
    def test_where_an_arm_stretched_or_folded_ends_counts_as_reachable(self, l1, l2, direction, bend):
        target = [
            l1 * math.cos(direction) + l2 * math.cos(direction + bend),
            l1 * math.sin(direction) + l2 * math.sin(direction + bend),
        ]
        answers = two_bone(l1, l2, [target])
        assert answers.reachable.all()
        assert (answers.errors <= 1e-12 * (l1 + l2)).all()

    @given(lengths)
    def test_equal_bones_reach_the_base_as_they_do_next_to_it(self, length):
        at, beside = two_bone(length, length, [[0.0, 0.0], [1e-12 * length, 0.0]]).angles
        assert at == pytest.approx(np.array([[math.pi / 2, -math.pi], [-math.pi / 2, math.pi]]), abs=1e-15)
        assert beside == pytest.approx(at, abs=1e-11)

    def test_a_bone_of_no_length_leaves_a_circle(self):
        answers = two_bone([1.0, 0.0], [0.0, 1.0], [[0.6, 0.8], [0.6, 0.8]])
        assert answers.reachable.all()
        assert answers.errors.max() < 1e-15
        assert two_bone(0.0, 0.0, [[0.0, 0.0], [3.0, 0.0]]).shortfall.tolist() == [0.0, 3.0]


class TestOutsideTheAnnulus:
    @given(lengths, lengths, st.floats(1e-9, 1e3), directions)
    def test_too_far_is_answered_with_the_arm_stretched_at_the_target(self, l1, l2, part, direction):
        d = (l1 + l2) * (1.0 + part)
        target = np.array([d * math.cos(direction), d * math.sin(direction)])
        answers = two_bone(l1, l2, [target])
        assert answers.too_far.all()
        assert not answers.too_near.any()
        assert not answers.reachable.any()
        missed = float(Fraction(d) - Fraction(l1) - Fraction(l2))
        assert answers.shortfall[0] == pytest.approx(missed, abs=1e-15 * d)
        assert answers.errors == pytest.approx(answers.shortfall[0], abs=1e-14 * d)
        assert answers.angles[0, :, 1].tolist() == [0.0, 0.0]

    @given(lengths, lengths, st.floats(0.0, 1.0 - 1e-9), directions)
    @example(1.0, 0.25, 0.0, 0.0)
    def test_too_near_is_answered_with_the_arm_folded_at_the_target(self, l1, l2, part, direction):
        if abs(l1 - l2) < 1e-6 * (l1 + l2):
            return
        d = abs(l1 - l2) * part
        target = np.array([d * math.cos(direction), d * math.sin(direction)])
        answers = two_bone(l1, l2, [target])
        assert answers.too_near.all()
        assert not answers.too_far.any()
        missed = float(abs(Fraction(l1) - Fraction(l2)) - Fraction(d))
        assert answers.shortfall[0] == pytest.approx(missed, abs=1e-15 * (l1 + l2))
        assert answers.errors == pytest.approx(answers.shortfall[0], abs=1e-14 * (l1 + l2))
        assert np.abs(answers.angles[0, :, 1]).tolist() == [math.pi, math.pi]

    def test_no_point_of_the_arm_s_reach_is_nearer(self):
        turns = np.linspace(-np.pi, np.pi, 721)
        first, second = np.meshgrid(turns, turns)
        reached = np.stack(
            [
                0.5 * np.cos(first) + 0.3 * np.cos(first + second),
                0.5 * np.sin(first) + 0.3 * np.sin(first + second),
            ],
            axis=-1,
        )
        for target in ([1.0, 0.2], [0.05, -0.1], [0.0, 0.0], [-0.4, 0.9]):
            least = np.linalg.norm(reached - target, axis=-1).min()
            shortfall = two_bone(0.5, 0.3, [target]).shortfall[0]
            assert shortfall <= least + 1e-12
            assert shortfall == pytest.approx(least, abs=1e-4)


class TestInSpace:
    @given(lengths, lengths, parts, vectors, vectors)
    def test_every_answer_hits_with_the_first_elbow_on_the_pole_s_side(self, l1, l2, part, direction, pole):
        u = np.array(direction) / math.hypot(*direction)
        target = in_annulus(l1, l2, part) * u
        answers = two_bone(l1, l2, [target], pole)
        size = l1 + l2
        assert answers.reachable.all()
        assert (answers.errors <= 1e-12 * size).all()
        assert np.linalg.norm(answers.elbows[0], axis=-1) == pytest.approx([l1, l1], rel=1e-12)
        lower = np.linalg.norm(answers.tips[0] - answers.elbows[0], axis=-1)
        assert lower == pytest.approx([l2, l2], rel=1e-12, abs=1e-14 * size)
        R = answers.plane[0]
        assert np.abs(R.T @ R - np.eye(3)).max() < 1e-14
        assert np.linalg.det(R) == pytest.approx(1.0)
        sides = answers.elbows[0] @ np.array(pole)
        assert sides[UP] >= sides[DOWN] - 1e-12 * size
        across = np.cross(u, pole)
        if np.linalg.norm(across) > 1e-3:
            assert np.abs(answers.elbows[0] @ across).max() <= 1e-11 * size

    def test_a_pole_s_length_does_not_matter(self):
        short, long = (
            two_bone(1.0, 0.8, [[0.3, 0.9, -0.4]], scale * np.array([1.0, -2.0, 0.5])) for scale in (1e-9, 1e9)
        )
        assert short.elbows == pytest.approx(long.elbows, abs=1e-14)

    @pytest.mark.parametrize("pole", [(0.0, 0.0, 2.0), (0.0, 0.0, -1.0)])
    def test_a_pole_along_the_line_to_the_target_gives_some_elbow(self, pole):
        answers = two_bone(1.0, 0.8, [[0.0, 0.0, 1.2]], pole)
        assert answers.errors.max() < 1e-15
        assert np.linalg.norm(answers.elbows[0, :, :2], axis=-1).min() > 0.1

    def test_a_target_at_the_base_sends_the_elbow_to_the_pole(self):
        answers = two_bone(0.5, 0.5, [[0.0, 0.0, 0.0]], [0.0, 3.0, 4.0])
        assert answers.elbows[0, UP] == pytest.approx([0.0, 0.3, 0.4], abs=1e-15)
        assert answers.errors.max() < 1e-15

    def test_targets_in_a_plane_are_answered_as_in_the_plane(self):
        rng = np.random.default_rng(3)
        flat = rng.uniform(-1.0, 1.0, (50, 2))
        left = np.column_stack([-flat[:, 1], flat[:, 0], np.zeros(50)])
        spatial = two_bone(0.6, 0.5, np.column_stack([flat, np.zeros(50)]), left)
        assert spatial.elbows[:, :, :2] == pytest.approx(two_bone(0.6, 0.5, flat).elbows, abs=1e-14)


class TestManyAtOnce:
    def test_each_is_answered_as_if_it_were_alone(self):
        rng = np.random.default_rng(5)
        count = 20_000  # more than are worked on at once
        l1, l2 = rng.uniform(0.1, 1.0, count), rng.uniform(0.1, 1.0, count)
        targets, poles = rng.normal(size=(count, 3)), rng.normal(size=(count, 3))
        flat, spatial = two_bone(l1, l2, targets[:, :2]), two_bone(l1, l2, targets, poles)
        assert len(flat) == len(spatial) == count
        for k in (0, 8191, 8192, 19_999):
            alone = two_bone(l1[k], l2[k], targets[k : k + 1, :2])
            assert alone.angles[0] == pytest.approx(flat.angles[k], abs=1e-15)
            alone = two_bone(l1[k], l2[k], targets[k : k + 1], poles[k])
            assert alone.elbows[0] == pytest.approx(spatial.elbows[k], abs=1e-14)
            assert alone.shortfall[0] == pytest.approx(spatial.shortfall[k], abs=1e-15)
        assert np.abs(flat.errors - flat.shortfall[:, np.newaxis]).max() < 1e-14
        assert np.abs(spatial.errors - spatial.shortfall[:, np.newaxis]).max() < 1e-14

    @pytest.mark.parametrize(("size", "pole"), [(2, None), (3, (0.0, 0.0, 1.0)), (3, np.empty((0, 3)))])
    def test_no_target_gives_no_answer(self, size, pole):
        answers = two_bone(1.0, 1.0, np.empty((0, size)), pole)
        assert len(answers) == 0
        assert answers.angles.shape == (0, 2, 2)
        assert answers.tips.shape == (0, 2, size)
        assert answers.reachable.shape == answers.shortfall.shape == (0,)

    def test_no_input_is_changed(self):
        targets, pole = np.array([[0.3, 0.2, 0.5], [0.0, 0.0, 0.0]]), np.array([0.0, 2.0, 0.0])
        kept = targets.copy(), pole.copy()
        two_bone(1.0, 1.0, targets, pole)
        assert (targets == kept[0]).all()
        assert (pole == kept[1]).all()


GOOD = [[0.5, 0.1], [0.2, 0.2], [0.1, 0.3]]
IN_SPACE = [[0.5, 0.1, 0.0], [0.2, 0.2, 0.0]]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((-1.0, 1.0, GOOD), "l1 is a bone's length"),
        ((1.0, [1.0, 1.0, -0.25], GOOD), r"l2\[2\] is a bone's length, from 0 to 1e\+150; got -0.25"),
        (([1.0, math.nan, 1.0], 1.0, GOOD), r"l1\[1\]"),
        ((math.inf, 1.0, GOOD), "l1 must be a finite number"),
        ((True, 1.0, GOOD), "l1 must be a finite number"),
        (("1", 1.0, GOOD), "l1 must be a finite number"),
        (([1.0, 1.0], 1.0, GOOD), r"l1 is one length or one for each of the 3 targets; got an array of shape \(2,\)"),
        ((np.ones((3, 1)), 1.0, GOOD), r"shape \(3, 1\)"),
        ((1.0, 1.0, [[0.0, 0.0], [math.nan, 1.0]]), r"targets\[1\] must be 2 finite numbers; got \[nan, 1.0\]"),
        ((1.0, 1.0, [[0.0, 0.0], [1e200, 1.0]]), r"targets\[1\] is at most 1e\+150"),
        ((1.0, 1.0, [0.5, 0.1]), r"targets must be N times 2 finite numbers; got an array of shape \(2,\)"),
        ((1.0, 1.0, np.zeros((3, 4))), r"N times 2 or 3 numbers; got an array of shape \(3, 4\)"),
        ((1.0, 1.0, [[1.0, 2.0], [3.0]]), "rows of different lengths"),
        ((1.0, 1.0, [["a", "b"]]), "targets must be an array of numbers"),
        ((1.0, 1.0, GOOD, [0.0, 1.0, 0.0]), "a pole goes with targets in space"),
        ((1.0, 1.0, IN_SPACE), "need a pole"),
        ((1.0, 1.0, IN_SPACE, [[0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]), r"pole\[1\] is a direction and cannot be zero"),
        ((1.0, 1.0, IN_SPACE, [0.0, 0.0, 0.0]), "pole is a direction and cannot be zero"),
        ((1.0, 1.0, IN_SPACE, np.ones((3, 3))), "one for each of the 2 targets; got 3"),
        ((1.0, 1.0, IN_SPACE, [0.0, 1.0]), "pole must be N times 3"),
        ((1.0, 1.0, IN_SPACE, [0.0, math.inf, 0.0]), r"pole\[0\] must be 3 finite numbers"),
    ],
)
def test_wrong_input_is_refused_in_words(arguments, words):
    with pytest.raises(pinik.InputError, match=words):
        two_bone(*arguments)
