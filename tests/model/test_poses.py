"""Poses of an SRDF: numbers inside the limits, or an error that names pose and joint."""

from __future__ import annotations

import math
import pickle
import re
from pathlib import Path

import pytest

import pinik
from by_hand import axis, limit, mimic
from pinik.description import catalog
from robots import load_quietly
from urdf_texts import joint, link, robot

ROBOT = robot(
    *map(link, "abcdef"),
    joint("hinge", "a", "b", axis(0, 0, 1), limit=limit(-1, 1)),
    joint("slide", "b", "c", axis(0, 0, 1), limit=limit(0, 2), kind="prismatic"),
    joint("wheel", "c", "d", axis(0, 0, 1), kind="continuous", limit=""),
    joint("wrist", "d", "e", axis(0, 0, 1), limit=limit(2, 6)),
    joint("thumb", "e", "f", axis(0, 0, 1), mimic("hinge", 0.5), limit=limit(-1, 1)),
)


@pytest.fixture
def posed(tmp_path):
    """Loads the robot beside an SRDF with one pose."""

    def load(*settings: tuple[str, str], pose: str = "home", strict: bool = True) -> pinik.Robot:
        joints = "".join(f'<joint name="{name}" value="{value}"/>' for name, value in settings)
        (tmp_path / "r.urdf").write_text(ROBOT)
        (tmp_path / "r.srdf").write_text(
            f'<robot name="r"><group_state name="calm" group="g"/>\n<group_state name="{pose}" group="g">{joints}'
            "</group_state></robot>"
        )
        return pinik.load(tmp_path / "r.urdf", strict=strict)

    return load


@pytest.mark.parametrize("value", ["nan", "1e400", "inf", "abc", "0,5", "", "0.1 0.2", "1_0", "0x1", "1e300"])
@pytest.mark.parametrize("name", ["hinge", "slide", "wheel", "thumb"])
def test_what_is_no_number_is_an_error_that_names_pose_and_joint(posed, name, value):
    loaded = posed((name, value))
    with pytest.raises(pinik.RobotLoadError) as caught:
        _ = loaded.poses
    assert caught.value.element == f"pose 'home', joint '{name}'"
    assert re.search(
        r"r\.srdf: pose 'home', joint '\w+': its value must be a number .*; got .* \(line 2\)$", str(caught.value)
    )


@pytest.mark.parametrize(
    ("name", "value", "range_"),
    [("hinge", "99", "-1..1"), ("hinge", "-1.002", "-1..1"), ("slide", "6.3", "0..2"), ("wrist", "0.5", "2..6")],
)
def test_a_pose_with_a_number_outside_the_limits_is_left_out_with_a_warning_that_names_them(posed, name, value, range_):
    loaded = posed((name, value), strict=False)
    cause = rf"limits {range_}; got {value} \(line 2 of r\.srdf\); the pose is left out"
    with pytest.warns(pinik.UrdfWarning, match=rf"^r: pose 'home', joint '{name}': .* {cause}$") as said:
        assert list(loaded.poses) == ["calm"]
    assert [Path(warning.filename).name for warning in said] == ["test_poses.py"]
    with pytest.raises(KeyError, match=rf"no pose 'home'.*joint '{name}': .* {cause}") as caught:
        _ = loaded.poses["home"]  # in silence, as it was said
    assert isinstance(caught.value, pinik.UnknownNameError)
    assert pinik.draw(loaded, size=(40, 30)).size == (40, 30)


def test_with_strict_a_pose_outside_the_limits_is_an_error_whenever_the_poses_are_asked_for(posed):
    loaded = posed(("hinge", "99"))
    for strict in (loaded, loaded.with_root("planar"), pickle.loads(pickle.dumps(loaded))):
        for _ in range(2):
            with pytest.raises(
                pinik.RobotLoadError, match=r"r\.srdf: pose 'home', joint 'hinge': .*; got 99"
            ) as caught:
                _ = strict.poses
            assert caught.value.element == "pose 'home', joint 'hinge'"
    assert loaded.solve("b", rpy=[0, 0, 0.5]).success


ROUNDED = "0.7071 0 0 0.7071"  # whose square is 0.99998


@pytest.mark.parametrize(
    ("kind", "value", "words"),
    [
        ("floating", "0 0 0 0 0 0 0", "the quaternion xyzw must be of unit length; got 0 0 0 0"),
        ("floating", "0 0 0 0 0 0 1e-200", "the quaternion xyzw must be of unit length; got 0 0 0 1e-200"),
        ("floating", "0 0 0 0 0 0 2", "the quaternion xyzw must be of unit length; got 0 0 0 2"),
        ("planar", "0 0 0 0", r"\(cos, sin\) must be of unit length; got 0 0"),
        ("planar", "0 0 3 4", r"\(cos, sin\) must be of unit length; got 3 4"),
        ("floating", f"0 0 1 {ROUNDED}", None),
    ],
)
def test_a_quaternion_is_of_unit_length_up_to_rounding_or_refused(tmp_path, kind, value, words):
    text = robot(link("a"), link("b"), joint("base", "a", "b", axis(0, 0, 1), kind=kind, limit=""))
    (tmp_path / "r.urdf").write_text(text)
    (tmp_path / "r.srdf").write_text(f'<robot name="r">{state("g", base=value)}</robot>')
    loaded = pinik.load(tmp_path / "r.urdf")
    if words is None:
        assert loaded.poses["home"] == pytest.approx([0, 0, 1, math.sqrt(0.5), 0, 0, math.sqrt(0.5)], abs=1e-15)
        return
    with pytest.raises(pinik.RobotLoadError, match=rf"pose 'home', joint 'base': {words} \(line 1\)"):
        _ = loaded.poses


@pytest.mark.parametrize(
    ("name", "value", "angle"),
    [
        ("hinge", "0.25", 0.25),
        ("hinge", "1.0009", 1.0),  # rounded
        ("slide", "-0.0004", 0.0),
        ("hinge", repr(0.5 + 2 * math.pi), 0.5),  # a whole turn
        ("wrist", "-0.5", 2 * math.pi - 0.5),
        ("wrist", repr(3.0 + 20 * math.pi), 3.0),
        ("wheel", "7.5", 7.5 - 2 * math.pi),
        ("absent", "nan", None),
    ],
)
def test_a_number_that_is_rounded_or_whole_turns_away_is_taken_inside(posed, name, value, angle):
    loaded = posed((name, value))
    angles = loaded.angles(loaded.poses["home"])
    expected = dict.fromkeys(angles, 0.0)
    if angle is not None:
        expected |= {name: angle} | ({"thumb": angle / 2} if name == "hinge" else {})
    assert angles == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("name", ["Hinge", "hnige", "hingee", "hing", "hinga"])
def test_a_misspelt_joint_is_an_error_that_names_the_one_that_was_meant(posed, name):
    with pytest.raises(
        pinik.RobotLoadError, match=rf"pose 'home', joint '{name}': the robot has no such.*near: 'hinge'"
    ):
        _ = posed((name, "0.5")).poses


def test_joints_that_another_robot_has_are_skipped(posed):
    """Robots with fewer joints share an SRDF; a name near to one that the pose sets itself is no slip."""
    loaded = posed(
        ("root_joint", "0 0 1 0 0 0 1"), ("hinge", "0.5"), ("hinga", "0.1"), ("elbow", "0.3"), ("slide7", "1")
    )
    assert loaded.angles(loaded.poses["home"])["hinge"] == pytest.approx(0.5)


def test_a_joint_that_is_set_in_two_ways_is_an_error_that_shows_both(posed):
    with pytest.raises(pinik.RobotLoadError, match=r"pose 'home', joint 'hinge': it is set twice, to 0.5 and to -0.5"):
        _ = posed(("hinge", "0.5"), ("hinge", "-0.5")).poses
    loaded = posed(("hinge", "0.5"), ("hinge", "0.50"))
    assert loaded.angles(loaded.poses["home"])["hinge"] == pytest.approx(0.5)


def state(group: str, **angles: object) -> str:
    joints = "".join(f'<joint name="{name}" value="{value}"/>' for name, value in angles.items())
    return f'<group_state name="home" group="{group}">{joints}</group_state>'


def test_states_of_one_name_for_several_groups_are_one_pose_and_for_one_group_an_error(tmp_path):
    def loaded(*states: str) -> pinik.Robot:
        (tmp_path / "r.urdf").write_text(ROBOT)
        (tmp_path / "r.srdf").write_text(f'<robot name="r">{"".join(states)}</robot>')
        return pinik.load(tmp_path / "r.urdf")

    both = loaded(state("arm", hinge=0.5), state("hand", slide=1.5))
    assert both.angles(both.poses["home"]) == pytest.approx(
        {"hinge": 0.5, "slide": 1.5, "wheel": 0.0, "wrist": 0.0, "thumb": 0.25}
    )
    with pytest.raises(
        pinik.RobotLoadError, match=r"pose 'home', joint 'hinge': it is set twice, to 0\.5 and to 0\.25"
    ):
        _ = loaded(state("arm", hinge=0.5), state("hand", hinge=0.25)).poses
    with pytest.raises(pinik.RobotLoadError, match="pose 'home': it is given twice for group 'arm', first on line 1"):
        _ = loaded(state("arm", hinge=0.5), state("arm", slide=1.5)).poses


@pytest.mark.parametrize(("kind", "needed"), [("planar", 4), ("floating", 7)])
def test_a_wrong_count_of_numbers_is_an_error_for_a_joint_of_the_file_but_not_for_the_root(tmp_path, kind, needed):
    text = robot(link("a"), link("b"), joint("base", "a", "b", axis(0, 0, 1), kind=kind, limit=""))
    (tmp_path / "r.urdf").write_text(text)
    (tmp_path / "r.srdf").write_text(f'<robot name="r">{state("g", base="0.1 0.2 0.3")}</robot>')
    with pytest.raises(pinik.RobotLoadError, match=f"joint 'base': its value must be {needed} numbers.*got 3"):
        _ = pinik.load(tmp_path / "r.urdf").poses
    (tmp_path / "r.srdf").write_text(f'<robot name="r">{state("g", root_joint="0 0 1 0 0 0 1")}</robot>')
    rooted = pinik.load(tmp_path / "r.urdf", root="planar")
    assert rooted.poses["home"] == pytest.approx(rooted.neutral())


def test_those_who_never_ask_for_poses_are_not_stopped(posed):
    loaded = posed(("hinge", "nan"))
    assert loaded.solve("b", rpy=[0, 0, 0.5]).success
    assert pinik.draw(loaded, size=(40, 30)).size == (40, 30)


BENT_TOO_FAR = {"simple_humanoid", "simple_humanoid_classical"}


@pytest.mark.parametrize("name", sorted(set(catalog.catalog()) - {"ur3_empty"} - BENT_TOO_FAR))
def test_the_catalogue_s_poses_are_inside_the_limits(name):
    loaded = load_quietly(name)
    for q in loaded.poses.values():
        assert (q >= loaded.lower_q).all()
        assert (q <= loaded.upper_q).all()


@pytest.mark.parametrize("name", sorted(BENT_TOO_FAR))
def test_the_catalogue_s_poses_beyond_the_file_s_own_limits_are_left_out_by_name(name):
    with pytest.warns(pinik.UrdfWarning, match=r"pose 'half_sitting', joint '.LEG_.* within its limits"):
        assert "half_sitting" not in load_quietly(name).poses


def test_a_name_of_any_length_is_shortened_in_the_error(posed):
    loaded = posed(("hinge", "9" * 5000), pose="p" * 5000)
    with pytest.raises(pinik.RobotLoadError) as caught:
        _ = loaded.poses
    assert len(str(caught.value)) < 600
