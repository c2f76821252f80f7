from __future__ import annotations

import json
import math
import pickle
from typing import Any

import numpy as np
import pinocchio
import pytest
from hypothesis import given
from hypothesis import strategies as st

from by_hand import homogeneous, random_placement, random_rotation, rotation_about, rotation_from_rpy
from pinik import InputError, Target, Tolerance, UnknownNameError

RIGHT_ANGLE = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]  # a quarter turn about z
HALF = math.sqrt(0.5)

angle = st.floats(-10, 10)
anything = st.floats(allow_nan=True, allow_infinity=True)


class TestOrientations:
    @pytest.mark.parametrize(
        "fields",
        [
            {"rotation": RIGHT_ANGLE},
            {"rpy": (0, 0, math.pi / 2)},
            {"quat_xyzw": (0, 0, HALF, HALF)},
            {"quat_wxyz": (HALF, 0, 0, HALF)},
            {"quat_wxyz": (-7, 0, 0, -7)},
            {"placement": homogeneous(np.array(RIGHT_ANGLE), (1, 2, 3))},
            {"placement": pinocchio.SE3(np.array(RIGHT_ANGLE, float), np.array([1.0, 2, 3]))},
        ],
    )
    def test_all_ways_to_say_a_quarter_turn_about_z_mean_it(self, fields):
        np.testing.assert_allclose(Target("tip", **fields).rotation, RIGHT_ANGLE, atol=1e-12)

    @pytest.mark.parametrize("place", [pinocchio.SE3.Identity(), np.eye(4)])
    def test_a_placement_in_the_positions_stead_is_refused_with_its_keyword(self, place):
        with pytest.raises(InputError, match=r"target 'tip': position must be 3 finite numbers; .* as placement="):
            Target("tip", place)

    @pytest.mark.filterwarnings("ignore:.* looks like degrees:pinik.InputWarning")
    @given(roll=angle, pitch=angle, yaw=angle)
    def test_rpy_turns_about_the_fixed_x_then_y_then_z(self, roll, pitch, yaw):
        np.testing.assert_allclose(
            Target("tip", rpy=(roll, pitch, yaw)).rotation, rotation_from_rpy(roll, pitch, yaw), atol=1e-12
        )

    @given(seed=st.integers(0, 2**32 - 1), length=st.floats(1e-3, 1e200))
    def test_quaternions_of_any_length_are_cos_and_sin_of_half_the_angle(self, seed, length):
        rng = np.random.default_rng(seed)
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        turn = rng.uniform(-math.pi, math.pi)
        w, xyz = length * math.cos(turn / 2), length * math.sin(turn / 2) * direction
        expected = rotation_about(direction, turn)
        np.testing.assert_allclose(Target("tip", quat_xyzw=(*xyz, w)).rotation, expected, atol=1e-12)
        np.testing.assert_allclose(Target("tip", quat_wxyz=(w, *xyz)).rotation, expected, atol=1e-12)

    def test_a_placement_is_position_and_rotation_at_once(self):
        M = random_placement(np.random.default_rng(1))
        for placement in (M, M.tolist(), pinocchio.SE3(M)):
            target = Target("tip", placement=placement)
            np.testing.assert_allclose(target.position, M[:3, 3])
            np.testing.assert_allclose(target.rotation, M[:3, :3], atol=1e-12)

    def test_a_rotation_with_the_rounding_of_a_text_file_is_made_exact(self):
        R = random_rotation(np.random.default_rng(2))
        made = Target("tip", rotation=np.round(R, 7)).rotation
        np.testing.assert_allclose(made, R, atol=1e-6)
        np.testing.assert_allclose(made @ made.T, np.eye(3), atol=1e-14)

    @pytest.mark.parametrize(
        ("name", "vector"),
        [
            ("x", (1, 0, 0)), ("y", (0, 1, 0)), ("z", (0, 0, 1)),
            ("-x", (-1, 0, 0)), ("-y", (0, -1, 0)), ("-z", (0, 0, -1)),
        ],
    )  # fmt: skip
    def test_axes_have_names(self, name, vector):
        assert Target("tip", axis=name, at=(0, 0, 0)).axis.tolist() == list(vector)

    @given(
        direction=st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: max(map(abs, v)) > 1e-3),
        exponent=st.integers(-290, 290),
    )
    def test_axes_and_directions_are_scaled_to_unit_length(self, direction, exponent):
        scaled = np.array(direction) * 10.0**exponent
        unit = np.array(direction) / np.linalg.norm(direction)
        target = Target("tip", axis=scaled, direction=scaled)
        np.testing.assert_allclose(target.axis, unit, atol=1e-12)
        np.testing.assert_allclose(target.direction, unit, atol=1e-12)

    def test_none_leaves_the_orientation_free(self):
        target = Target("tip", (1, 2, 3))
        assert (target.rotation, target.axis, target.direction, target.at) == (None, None, None, None)


class TestTools:
    def test_three_numbers_are_a_point_in_the_frame(self):
        for tool in ((0, 0, 0.1), [0, 0, 0.1], np.array([0, 0, 0.1])):
            np.testing.assert_array_equal(
                Target("tip", (1, 2, 3), tool=tool).tool.homogeneous, homogeneous(np.eye(3), (0, 0, 0.1))
            )

    def test_may_be_turned(self):
        M = random_placement(np.random.default_rng(3))
        for tool in (M, M.tolist(), pinocchio.SE3(M)):
            np.testing.assert_allclose(Target("tip", (1, 2, 3), tool=tool).tool.homogeneous, M, atol=1e-12)


class TestContradictions:
    @pytest.mark.parametrize(
        ("fields", "words"),
        [
            ({}, "nothing is asked for"),
            ({"tool": (0, 0, 1)}, "nothing is asked for"),
            ({"rpy": (0, 0, 0), "rotation": np.eye(3)}, "give the orientation once; got rotation and rpy"),
            (
                {"quat_xyzw": (0, 0, 0, 1), "quat_wxyz": (1, 0, 0, 0)},
                "give the orientation once; got quat_xyzw and quat_wxyz",
            ),
            (
                {"rpy": (0, 0, 0), "axis": "x", "direction": (1, 0, 0)},
                "give the orientation once; got rpy and axis",
            ),
            ({"placement": np.eye(4), "rpy": (0, 0, 0)}, "give the orientation once; got rpy and placement"),
            ({"placement": np.eye(4), "position": (1, 2, 3)}, "placement gives the position already"),
            ({"axis": "x"}, "axis= needs direction= or at=, and these need axis="),
            ({"position": (1, 2, 3), "direction": (1, 0, 0)}, "axis= needs direction= or at=, and these need axis="),
            ({"position": (1, 2, 3), "at": (1, 0, 0)}, "axis= needs direction= or at=, and these need axis="),
            ({"axis": "x", "direction": (1, 0, 0), "at": (1, 0, 0)}, "direction= or at=, not both"),
            (
                {"axis": "w", "direction": (1, 0, 0)},
                "axis must be one of x, y, z, -x, -y, -z or three numbers; got 'w'",
            ),
            ({"axis": (0, 0, 0), "direction": (1, 0, 0)}, "axis must not be zero, as it is a direction"),
            ({"axis": "x", "direction": (0, 0, 0)}, "direction must not be zero, as it is a direction"),
            ({"axis": "x", "direction": (1, 0)}, "direction must be 3 finite numbers"),
            ({"axis": "x", "at": (1, math.nan, 0)}, "at must be 3 finite numbers"),
            ({"position": (1, 2)}, r"position must be 3 finite numbers; got an array of shape \(2,\)"),
            ({"position": (1, 2, math.inf)}, "position must be 3 finite numbers"),
            ({"position": (0, 0, 1e10)}, r"position must be a point within 1e\+09 m of the origin"),
            ({"axis": "x", "at": (0, -1e10, 0)}, r"at must be a point within 1e\+09 m of the origin"),
            (
                {"placement": homogeneous(np.eye(3), (1e10, 0, 0))},
                r"placement must be a point within 1e\+09 m of the origin",
            ),
            ({"position": "here"}, "position must be 3 finite numbers; got 'here'"),
            ({"position": ("1", "2", "3")}, "position must be 3 finite numbers"),
            ({"position": (True, False, True)}, "position must be 3 finite numbers"),
            ({"position": (None, None, None)}, "position must have a coordinate that is not None"),
            ({"position": (1, 2, [3])}, "position must be 3 finite numbers"),
            ({"position": (1, 2, 10**400)}, "position must be 3 finite numbers"),
            ({"position": (1, 2, 3j)}, "position must be 3 finite numbers"),
            ({"position": np.array([1, 2, 3j])}, "position must be 3 finite numbers"),
            ({"rotation": np.eye(4)}, "rotation must be 3×3 finite numbers"),
            ({"rotation": 2 * np.eye(3)}, "orthonormal, determinant"),
            ({"rotation": np.diag([1, 1, -1])}, "orthonormal, determinant"),
            ({"rotation": np.full((3, 3), 1e200)}, "orthonormal, determinant"),
            ({"rpy": (0, 0)}, r"rpy must be 3 finite numbers \(roll, pitch, yaw in radians\)"),
            ({"quat_xyzw": (0, 0, 0, 0)}, "a quaternion must not be zero"),
            ({"quat_wxyz": (0, 0, 0)}, "quat_wxyz must be 4 finite numbers"),
            ({"quat_xyzw": (0, 0, 0)}, "quat_xyzw must be 4 finite numbers"),
            ({"placement": np.eye(3)}, "placement must be 4×4 finite numbers"),
            ({"placement": 2 * np.eye(4)}, "must be a homogeneous matrix, whose last row is 0 0 0 1"),
            ({"placement": np.diag([1, 1, -1, 1])}, "rotation matrix"),
            ({"position": (1, 2, 3), "tool": (0, 0)}, "tool must be 4×4 finite numbers"),
            ({"position": (1, 2, 3), "tool": (0, 0, math.nan)}, "tool must be 3 finite numbers"),
            (
                {"position": (1, 2, 3), "weight": 0},
                "from 0.001 to 1000; got 0; leave the target out",
            ),
            ({"position": (1, 2, 3), "weight": -1}, "weight must be a number from 0.001 to 1000"),
            ({"position": (1, 2, 3), "weight": math.nan}, "weight must be a finite number"),
            ({"position": (1, 2, 3), "weight": "2"}, "weight must be a finite number"),
            ({"position": (1, 2, 3), "weight": None}, "weight must be a finite number"),
            ({"position": (1, 2, 3), "relative_to": 3}, "relative_to must be the name of a frame; got 3"),
        ],
    )
    def test_are_refused_in_words_that_name_the_target(self, fields, words):
        with pytest.raises(InputError, match=f"target 'tip': .*{words}"):
            Target("tip", **fields)

    @pytest.mark.parametrize("frame", [None, 3, ["tip"], b"tip"])
    def test_a_frame_is_a_name(self, frame):
        with pytest.raises(InputError, match="a target's frame must be a name"):
            Target(frame, (1, 2, 3))

    @given(numbers=st.lists(anything, min_size=9, max_size=9))
    def test_any_nine_numbers_are_a_rotation_or_an_input_error(self, numbers):
        try:
            R = Target("tip", rotation=np.reshape(numbers, (3, 3))).rotation
        except InputError:
            return
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)

    @given(numbers=st.lists(anything, min_size=4, max_size=4))
    def test_any_four_numbers_are_a_quaternion_or_an_input_error(self, numbers):
        try:
            R = Target("tip", quat_xyzw=numbers).rotation
        except InputError:
            return
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)

    @given(numbers=st.lists(anything, min_size=3, max_size=3))
    def test_any_three_numbers_are_a_direction_or_an_input_error(self, numbers):
        try:
            direction = Target("tip", axis="x", direction=numbers).direction
        except InputError:
            return
        assert np.linalg.norm(direction) == pytest.approx(1.0)


@pytest.mark.parametrize("weight", [1e-3, 1, 1000])
def test_the_least_and_the_largest_weight_are_taken(weight):
    assert Target("tip", (1, 2, 3), weight=weight).weight == weight


class TestArrays:
    def test_handed_in_are_copied(self):
        position, at = np.array([1.0, 2, 3]), np.array([0.0, 0, 1])
        target = Target("tip", position, axis="x", at=at)
        position[:] = at[:] = 9.0
        assert target.position.tolist() == [1, 2, 3]
        assert target.at.tolist() == [0, 0, 1]

    def test_the_target_itself_cannot_be_changed(self):
        with pytest.raises(AttributeError):
            Target("tip", (1, 2, 3)).frame = "nose"

    def test_a_tool_is_copied_on_its_way_in_and_out(self):
        tool = pinocchio.SE3(np.eye(3), np.array([0.0, 0.0, 0.1]))
        target = Target("tip", (1, 2, 3), tool=tool)
        tool.translation = target.tool.translation = np.array([0.0, 0.0, 0.2])
        np.testing.assert_array_equal(target.tool.translation, [0, 0, 0.1])


class TestEquality:
    SAME: tuple[tuple[dict[str, Any], dict[str, Any]], ...] = (
        ({"position": (1, 2, 3)}, {"position": np.array([1.0, 2.0, 3.0])}),
        ({"position": (0.0, 1, 2)}, {"position": (-0.0, 1, 2)}),
        ({"rpy": (0, 0, 0)}, {"quat_wxyz": (1, 0, 0, 0)}),
        ({"placement": np.eye(4)}, {"position": (0, 0, 0), "rotation": np.eye(3)}),
        ({"axis": "x", "direction": (0, 0, 2)}, {"axis": (1, 0, 0), "direction": (0, 0, 1)}),
        (
            {"position": (1, 2, 3), "tool": (0, 0, 1)},
            {"position": (1, 2, 3), "tool": homogeneous(np.eye(3), (0, 0, 1))},
        ),
    )
    OTHERS: tuple[dict[str, Any], ...] = (
        {"position": (1, 2, 3)},
        {"position": (1, 2, 3.5)},
        {"position": (1, 2, 3), "weight": 2},
        {"position": (1, 2, 3), "relative_to": "base"},
        {"position": (1, 2, 3), "tool": (0, 0, 0.1)},
        {"position": (1, 2, 3), "tool": (0, 0, 0.2)},
        {"position": (1, 2, 3), "rpy": (0, 0, 0)},
        {"position": (1, 2, 3), "rpy": (0, 0, 1)},
        {"axis": "x", "direction": (1, 2, 3)},
        {"axis": "y", "direction": (1, 2, 3)},
        {"axis": "x", "at": (1, 2, 3)},
    )

    @pytest.mark.parametrize("pair", SAME)
    def test_the_same_question_asked_otherwise_is_equal_and_hashes_equal(self, pair):
        one, other = (Target("tip", **fields) for fields in pair)
        assert one == other
        assert hash(one) == hash(other)
        assert Target("nose", **pair[0]) != one

    def test_whatever_differs_makes_another_target(self):
        targets = [Target("tip", **fields) for fields in self.OTHERS]
        assert len(set(targets)) == len(targets)
        assert all((a == b) is (a is b) for a in targets for b in targets)
        assert targets[0] != "tip"

    def test_a_target_that_was_moved_is_equal_to_one_made_there(self):
        target = Target("tip", (1, 2, 3))
        assert hash(target) != hash(target.moved_to((3, 2, 1)))
        assert target.moved_to((3, 2, 1)) == Target("tip", (3, 2, 1)) != target


class TestMovedTo:
    M, N = (random_placement(np.random.default_rng(seed)) for seed in (5, 6))

    def test_a_placement_takes_the_parts_that_the_target_asks_for(self):
        for place in (self.N, self.N.tolist(), pinocchio.SE3(self.N)):
            assert Target("tip", placement=self.M).moved_to(place) == Target("tip", placement=self.N)
            assert Target("tip", rotation=self.M[:3, :3]).moved_to(place) == Target("tip", rotation=self.N[:3, :3])
            assert Target("tip", (1, 2, 3)).moved_to(place) == Target("tip", self.N[:3, 3])

    @pytest.mark.parametrize(
        ("fields", "place", "words"),
        [
            ({"axis": "x", "direction": (0, 0, 1)}, np.eye(4), "asks for an axis's direction; give a Target"),
            ({"rpy": (0, 0, 0)}, (1, 2, 3), "asks for an orientation too; give an SE3 or a 4×4 matrix"),
            ({"position": (1, 2, 3)}, [1, 2, "3"], "position must be 3 finite numbers"),
            ({"position": (1, 2, 3)}, [1, None, 3], "position must have numbers where the target asks for them"),
            ({"position": (1, 2, 3)}, np.eye(3), "placement must be 4×4 finite numbers"),
            ({"position": (1, 2, 3)}, [[1, 2], [3]], "placement must be 4×4 finite numbers"),
            ({"position": (1, 2, 3)}, np.ma.masked_array([1, 2, 3], [0, 0, 1]), "place"),
        ],
    )
    def test_a_place_that_is_none_is_refused_in_words_that_name_the_target(self, fields, place, words):
        with pytest.raises(InputError, match=f"target 'tip':? {words}"):
            Target("tip", **fields).moved_to(place)


class TestAlone:
    @pytest.mark.parametrize(
        "orientation",
        [{"rpy": (1, 2, 3)}, {"axis": "x", "direction": (0, 0, 1)}, {"axis": (1, 1, 0), "at": (1, 2, 3)}],
    )
    def test_a_part_is_the_target_without_the_other_part(self, orientation):
        position = (1, None, 3)
        others: dict[str, Any] = {"tool": (0, 0, 0.1), "relative_to": "base", "weight": 2.0, "tolerance": (0.1, 0.2)}
        both = Target("tip", position, **orientation, **others)
        assert {both: both.shape}  # what it remembers must not go over to its parts
        place, turn = Target("tip", position, **others), Target("tip", **orientation, **others)
        for part, alone, other in (("position", place, turn), ("orientation", turn, place)):
            assert both.alone(part) == alone == alone.alone(part)
            assert both.alone(part).shape == alone.shape
            assert other.alone(part) is None


class TestPickles:
    @pytest.mark.parametrize(
        "fields",
        [
            {"position": (1, None, 3), "weight": 0.5},
            {"placement": random_placement(np.random.default_rng(7)), "tolerance": ((0.1, 0.2, 0.3), 0.4)},
            {"axis": "y", "at": (1, 2, 3), "tool": random_placement(np.random.default_rng(8)), "relative_to": "base"},
        ],
    )
    def test_take_a_target_there_and_back(self, fields):
        target = Target("tip", **fields)
        assert {target: target.shape}  # what a target remembers is left out
        again = pickle.loads(pickle.dumps(target))
        assert vars(again).keys() == vars(Target("tip", **fields)).keys()
        assert again == target
        assert (again.shape, again.tolerance) == (target.shape, target.tolerance)
        for value in vars(again).values():
            assert not isinstance(value, np.ndarray) or not value.flags.writeable


class TestJson:
    rng = np.random.default_rng(4)
    TARGETS: tuple[dict[str, Any], ...] = (
        {"position": (1, 2, 3)},
        {"rotation": random_rotation(rng)},
        {"rpy": (1, 2, 3), "position": (0, 0, 1), "weight": 0.5},
        {"quat_wxyz": (1, 2, 3, 4), "tool": (0, 0, 0.1)},
        {"placement": random_placement(rng), "relative_to": "base"},
        {"axis": "-y", "direction": (1, 2, 3), "position": (1, 2, 3)},
        {"axis": (1, 1, 0), "at": (1, 2, 3), "tool": random_placement(rng)},
    )

    @pytest.mark.parametrize("fields", TARGETS)
    def test_takes_a_target_there_and_back(self, fields):
        target = Target("tip", **fields)
        written = json.loads(json.dumps(target.to_dict()))
        again = Target.from_dict(written)
        assert again.frame == "tip"
        assert (again.relative_to, again.weight) == (target.relative_to, target.weight)
        for name in ("position", "rotation", "axis", "direction", "at"):
            before, after = getattr(target, name), getattr(again, name)
            if before is None:
                assert after is None
            else:
                np.testing.assert_allclose(after, before, atol=1e-15)
        if target.tool is None:
            assert again.tool is None
        else:
            np.testing.assert_allclose(again.tool.homogeneous, target.tool.homogeneous, atol=1e-15)

    def test_says_only_what_was_asked_for(self):
        assert Target("tip", (1, 2, 3)).to_dict() == {"frame": "tip", "position": [1.0, 2.0, 3.0]}

    def test_takes_every_keyword_of_a_target(self):
        target = Target.from_dict({"frame": "tip", "rpy": [0, 0, math.pi / 2], "position": None, "weight": 2})
        np.testing.assert_allclose(target.rotation, RIGHT_ANGLE, atol=1e-12)
        assert target.position is None
        assert target.weight == 2.0

    def test_with_an_unknown_key_is_refused_with_near_ones(self):
        with pytest.raises(UnknownNameError, match="no target keyword 'positon'; did you mean 'position'") as caught:
            Target.from_dict({"frame": "tip", "positon": [1, 2, 3]})
        assert "quat_xyzw" in caught.value.valid

    @pytest.mark.parametrize(
        ("fields", "got"), [({}, "nothing"), ({"position": [1, 2, 3], "weight": 2}, "position, weight")]
    )
    def test_without_a_frame_is_refused(self, fields, got):
        with pytest.raises(InputError, match=f"a target must name its frame; got only {got}$"):
            Target.from_dict(fields)

    @pytest.mark.parametrize("tolerance", [[0.1, 0.2], [[0.1, 0.2, 0.3], 0.4]])
    def test_writes_a_tolerance_as_it_was_given(self, tolerance):
        assert Target("tip", (1, 2, 3), tolerance=tolerance).to_dict()["tolerance"] == tolerance

    @pytest.mark.parametrize("fields", [None, [1, 2, 3], "tip", 3])
    def test_that_is_no_object_is_refused(self, fields):
        with pytest.raises(InputError, match="a target must be an object such as"):
            Target.from_dict(fields)


class TestTolerance:
    def test_is_a_tenth_of_a_millimetre_and_a_milliradian_unless_told_otherwise(self):
        assert Tolerance.of(None) == Tolerance() == (1e-4, 1e-3)

    def test_is_two_numbers_metres_and_radians(self):
        for value in ((1e-3, 1e-2), [1e-3, 1e-2], np.array([1e-3, 1e-2]), Tolerance(1e-3, 1e-2)):
            tolerance = Tolerance.of(value)
            assert (tolerance.position, tolerance.orientation) == (1e-3, 1e-2)

    @pytest.mark.parametrize(
        "bad", [1e-3, (1e-3,), (1, 2, 3), (0, 1e-3), (1e-3, -1), (math.nan, 1), (1, math.inf), "tight"]
    )
    def test_is_nothing_else(self, bad):
        with pytest.raises(InputError, match=r"tolerance must be (2 finite|two positive) numbers"):
            Tolerance.of(bad)


def test_free_axes_come_in_arrays_of_objects_and_as_places():
    target = Target("tip", np.array([None, None, 0.3], dtype=object))
    assert target == Target("tip", [None, None, 0.3])
    assert target.moved_to([None, None, 0.2]) == Target("tip", [None, None, 0.2])
    with pytest.raises(InputError, match="must have numbers where the target asks for them"):
        target.moved_to([0.1, None, None])


def test_an_error_about_a_position_with_free_axes_names_the_coordinate_that_was_given():
    with pytest.raises(InputError, match=r"position\[2\] must be a finite number; got True"):
        Target("tip", [None, None, True])
