"""`pinik.track`: a path in one call, that keeps to its branch and says where and why it cannot."""

from __future__ import annotations

import json

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import origin
from engines import needs_native
from judge import judge
from pinik import Status, Target
from robots import load_quietly
from urdf_texts import joint, link
from urdf_texts import robot as robot_text

ENGINES = ["python", pytest.param("native", marks=needs_native)]
HOME = {
    "panda": ("panda_hand_tcp", [0.0, -0.7, 0.0, -2.3, 0.0, 1.6, 0.8, 0.0]),
    "ur5": ("tool0", [0.0, -1.5, 1.5, -1.5, -1.5, 0.0]),
    "xarm7": ("link_eef", [0.3, 0.4, -0.2, 0.9, 0.3, 0.8, 0.2]),
}


def circle(name, count=60, step=0.004):
    """(robot, frame, start, placements (N, 4, 4) along a circle, in steps of some millimetres)."""
    robot = load_quietly(name)
    frame, angles = HOME[name]
    q = np.array(angles)[: robot.model.nq]
    at = robot.placement(frame, q).homogeneous
    turn = np.linspace(0.0, 2.0 * np.pi, count)
    radius = step * count / (2.0 * np.pi)
    places = np.repeat(at[np.newaxis], count, axis=0)
    places[:, 0, 3] += radius * (np.cos(turn) - 1.0)
    places[:, 1, 3] += radius * np.sin(turn)
    return robot, frame, q, places


def straight_out(count=60):
    """(ur5, its frame, a start, placements (N, 4, 4) on a line that leaves the reach)."""
    robot = load_quietly("ur5")
    q = np.array([0.0, -1.5, 1.5, -1.5, 1.5, 0.0])
    places = np.repeat(robot.placement("tool0", q).homogeneous[np.newaxis], count, axis=0)
    places[:, 0, 3] += np.linspace(0.0, 0.8, count)
    return robot, "tool0", q, places


def assert_reached(robot, frame, places, track, tolerance=(1e-4, 1e-3)):
    """Every point that counts as reached is, by plain Pinocchio on the robot's own file, and inside the limits."""
    for place, q, status in zip(places, track.q, track.status, strict=False):
        errors = judge(robot, Target(frame, placement=place), q)
        assert not errors.outside
        assert errors.are_within(tolerance) == (status is Status.CONVERGED)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", list(HOME))
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd"])
def test_a_circle_in_small_steps_is_followed_without_a_jump(name, method, engine):
    robot, frame, q, places = circle(name)
    track = pinik.track(robot, frame, places, q, method, engine=engine)
    assert track.success, str(track)
    assert len(track) == len(places)
    assert_reached(robot, frame, places, track)
    assert np.abs(np.diff(track.angles, axis=0)).max() < 0.06
    assert track.engine == engine


@pytest.mark.parametrize("engine", ENGINES)
def test_ccd_on_the_xarm7_does_not_jump_in_steps_of_4_mm(engine):
    """It jumped by up to 7.2 rad between neighbours."""
    robot = load_quietly("xarm7")
    rng = np.random.default_rng(8)
    for _ in range(3 if engine == "python" else 20):
        q = np.clip(rng.uniform(-1.2, 1.2, robot.model.nq), robot.lower_q + 0.3, robot.upper_q - 0.3)
        places = np.repeat(robot.placement("link_eef", q).homogeneous[np.newaxis], 15, axis=0)
        places[:, :3, 3] += np.linspace(0.0, 0.06, 15)[:, np.newaxis] * rng.normal(size=3) / 1.8
        track = pinik.track(robot, "link_eef", places, q, "ccd", engine=engine)
        far = np.flatnonzero(np.abs(np.diff(track.angles, axis=0)).max(axis=1) > 0.5) + 1
        assert set(far) <= {jump.index for jump in track.jumps}
        assert not any(jump.why == "branch" for jump in track.jumps), str(track)


@pytest.mark.parametrize("engine", ENGINES)
def test_forward_and_back_is_the_same_for_six_joints(engine):
    robot, frame, q, places = circle("ur5")
    options = {"tolerance": (1e-9, 1e-8), "engine": engine}
    there = pinik.track(robot, frame, places, q, **options)
    back = pinik.track(robot, frame, places[::-1], there.q[-1], **options)
    assert there.success
    assert back.success
    np.testing.assert_allclose(back.q[::-1], there.q, atol=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_each_point_is_solved_from_the_one_before_also_in_steps_that_a_run_alone_would_not_follow(engine):
    """The elbow stays on its side although the target goes half around the base between neighbours."""
    robot = load_quietly("ur5")
    q = np.array([-1.5, -1.5, 1.5, -1.5, -1.5, 0.0])
    places = []
    for turn in (0.0, 2.6):
        moved = q.copy()
        moved[0] += turn
        places.append(robot.placement("tool0", moved).homogeneous)
    track = pinik.track(robot, "tool0", np.array(places), q, engine=engine)
    assert track.reached.all()
    assert track.q[1] == pytest.approx(moved, abs=1e-2)


@pytest.mark.parametrize("engine", ENGINES)
def test_what_happens_at_a_miss_is_what_was_asked_for(engine):
    robot, frame, q, places = straight_out()
    hold, nearest, stop = (
        pinik.track(robot, frame, places, q, engine=engine, on_miss=on_miss) for on_miss in ("hold", "nearest", "stop")
    )
    first = int(np.flatnonzero(~hold.reached)[0])
    assert first == int(np.flatnonzero(~nearest.reached)[0])
    assert (hold.q[first:] == hold.q[first - 1]).all()
    assert len(stop) == first + 1
    assert (stop.q[-1] == stop.q[-2]).all()
    assert nearest.position_error[-1] < hold.position_error[-1]
    for track in (hold, nearest, stop):
        assert not track.success
        assert not track
        assert_reached(robot, frame, places, track)
        assert "the first miss is at" in str(track) or len(track) == first + 1
    assert hold.status[-1] is Status.UNREACHABLE
    errors = judge(robot, Target(frame, placement=places[-1]), nearest.q[-1])
    assert nearest.position_error[-1] == pytest.approx(errors.position, abs=1e-12)
    assert nearest.orientation_error[-1] == pytest.approx(errors.orientation, abs=1e-9)


def two_links(shoulder, elbow, lowest=None):
    """The text of an arm of two links of 1 m in a plane, with limits of plus and minus these [rad]."""
    return f"""<robot name="folded"><link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/>
      <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
        <limit lower="{-shoulder if lowest is None else lowest}" upper="{shoulder}" effort="1" velocity="2"/></joint>
      <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/>
        <axis xyz="0 0 1"/><limit lower="{-elbow}" upper="{elbow}" effort="1" velocity="3"/></joint>
      <joint name="end" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="1 0 0"/></joint></robot>"""


def two_link_behind_a_limit():
    """(an arm of two links, positions on an arc towards the lower limit of its shoulder)."""
    robot = pinik.load(two_links(shoulder=2.9, elbow=2.5, lowest=-1.0))
    turn = np.linspace(0.6, -0.6, 40)
    return robot, np.column_stack([1.2 * np.cos(turn), 1.2 * np.sin(turn), np.zeros(40)])


@pytest.mark.parametrize("engine", ENGINES)
def test_a_jump_that_a_limit_demands_is_reported_with_the_joint_and_its_side(engine):
    """With the elbow bent to the left the shoulder reaches its lower limit; the other elbow goes on."""
    robot, places = two_link_behind_a_limit()
    start = robot.configuration({"shoulder": -0.3, "elbow": 1.85})
    track = pinik.track(robot, "tip", places, start, engine=engine)
    assert track.reached.all()
    (jump,) = track.jumps
    assert jump.why == "limit"
    assert jump.limits == {"shoulder": "lower"}
    assert set(jump.changes) == {"shoulder", "elbow"}
    assert jump.changes["elbow"] == pytest.approx(track.angles[jump.index, 1] - track.angles[jump.index - 1, 1])
    assert abs(jump.changes["elbow"]) > 3.0
    assert not track.success
    assert "shoulder came to its lower limit" in str(track)
    gentle = np.abs(np.diff(track.angles, axis=0)).max(axis=1)
    gentle[jump.index - 1] = 0.0
    assert gentle.max() < 0.1


@pytest.mark.parametrize("engine", ENGINES)
def test_a_place_that_only_the_other_elbow_reaches_is_found_by_a_restart(engine):
    """The mirrored answer of equal bones lies outside the limits, and no run from the start comes to the other one."""
    robot = pinik.load(two_links(shoulder=2.9, elbow=2.5, lowest=-1.0))
    shoulder, elbow = 2.617, 2.34
    start = robot.configuration({"shoulder": -0.552, "elbow": 1.145})
    place = [np.cos(shoulder) + np.cos(shoulder + elbow), np.sin(shoulder) + np.sin(shoulder + elbow), 0.0]
    other_shoulder = np.arctan2(place[1], place[0]) + elbow / 2.0
    assert not -1.0 <= other_shoulder <= 2.9
    track = pinik.track(robot, "tip", [place], start, engine=engine)
    assert track.reached.all()
    assert track.angles[0] == pytest.approx([shoulder, elbow], abs=1e-3)
    assert not pinik.track(robot, "tip", [place], start, engine=engine, restarts=0).reached.any()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_jump_at_a_singular_place_is_reported_as_such(engine):
    """A tip that passes 2 mm beside its own base turns the shoulder by more than 2 rad between two neighbours."""
    robot = pinik.load(two_links(shoulder=6.0, elbow=3.2))
    across = np.arange(-0.205, 0.21, 0.01)
    places = np.column_stack([np.full(len(across), 0.002), across, np.zeros(len(across))])
    start = robot.configuration({"shoulder": 0.0, "elbow": -2.9})
    track = pinik.track(robot, "tip", places, start, engine=engine)
    assert track.reached.all()
    middle = int(np.flatnonzero(across > 0.0)[0])
    assert {middle} <= {jump.index for jump in track.jumps} <= {middle - 1, middle, middle + 1}
    for jump in track.jumps:
        assert jump.why == "singular"
        assert jump.limits == {}
        assert jump.conditioning < 0.03
    assert max(jump.changes["shoulder"] for jump in track.jumps) > 2.0
    assert "singular place" in str(track)


def test_angles_of_continuous_joints_are_unwound_from_the_starts():
    text = """<robot name="wheel"><link name="base"/><link name="arm"/><link name="tip"/>
      <joint name="hub" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
      <joint name="end" type="fixed"><parent link="arm"/><child link="tip"/><origin xyz="1 0 0"/></joint></robot>"""
    robot = pinik.load(text)
    turn = np.linspace(3.0, 3.0 + 5.0 * np.pi, 200)
    places = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(200)])
    track = pinik.track(robot, "tip", places, robot.configuration({"hub": 3.0}), tolerance=(1e-8, 1e-8))
    assert track.success
    np.testing.assert_allclose(track.angles[:, 0], turn, atol=1e-6)


def test_joints_that_would_be_too_fast_are_named_by_index_and_factor():
    robot, places = two_link_behind_a_limit()
    start = robot.configuration({"shoulder": -0.3, "elbow": 1.85})
    calm = pinik.track(robot, "tip", places[:20], start, times=np.arange(20.0))
    assert calm.too_fast == ()
    times = np.arange(20.0)
    times[10:] -= 0.99
    track = pinik.track(robot, "tip", places[:20], start, times=times)
    speeds = np.abs(np.diff(track.angles, axis=0))[9] / 0.01
    expected = {
        name for name, speed, most in zip(("shoulder", "elbow"), speeds, (2.0, 3.0), strict=True) if speed > most
    }
    assert expected
    assert {excess.joint for excess in track.too_fast} == expected
    for excess in track.too_fast:
        assert excess.index == 10
        assert excess.factor == pytest.approx(speeds[track.joint_names.index(excess.joint)] / excess.limit)
    assert "times too fast at 10" in str(track)


@pytest.mark.parametrize("limits", [True, False])
def test_the_closed_form_follows_a_path_too(limits):
    robot = load_quietly("two_link")
    turn = np.linspace(0.2, 1.2, 20)
    places = 0.6 * np.column_stack([np.cos(turn), np.sin(turn), np.zeros(20)])
    track = pinik.track(robot, "tip", places, robot.configuration({"joint2": 1.0}), "two_bone", limits=limits)
    assert track.success
    assert track.engine == "python"
    for place, q in zip(places, track.q, strict=True):
        assert judge(robot, Target("tip", place), q).are_within()


def test_without_limits_a_path_may_leave_them():
    robot, places = two_link_behind_a_limit()
    start = robot.configuration({"shoulder": -0.3, "elbow": 1.85})
    track = pinik.track(robot, "tip", places, start, limits=False)
    assert track.success
    assert track.angles[:, 0].min() < -1.0


@pytest.mark.parametrize("kind", ["matrices", "placements", "targets", "sequences", "pattern"])
def test_points_are_given_as_for_solve_many(panda, kind):
    _, frame, q, places = circle("panda", 10)
    targets = [Target(frame, placement=place) for place in places]
    given = {
        "matrices": (frame, places),
        "placements": (frame, [pinocchio.SE3(place) for place in places]),
        "targets": (targets, None),
        "sequences": ([[target] for target in targets], None),
        "pattern": (targets[0], places),
    }[kind]
    track = pinik.track(panda, *given, q0=q)
    np.testing.assert_array_equal(track.q, pinik.track(panda, frame, places, q).q)


@needs_native
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd"])
@pytest.mark.parametrize("name", list(HOME))
def test_both_engines_go_the_same_way(name, method):
    robot, frame, q, places = circle(name, 25)
    python, native = (pinik.track(robot, frame, places, q, method, engine=engine) for engine in ("python", "native"))
    np.testing.assert_allclose(native.q, python.q, atol=1e-6)
    assert (native.status == python.status).all()
    np.testing.assert_array_equal(native.iterations, python.iterations)


@needs_native
@pytest.mark.parametrize("on_miss", ["hold", "nearest", "stop"])
def test_both_engines_miss_and_jump_at_the_same_points(on_miss):
    robot, frame, q, places = straight_out(30)
    folded, points = two_link_behind_a_limit()
    start = folded.configuration({"shoulder": -0.3, "elbow": 1.85})
    for machine, what, where, begin in ((robot, frame, places, q), (folded, "tip", points, start)):
        python, native = (
            pinik.track(machine, what, where, begin, engine=engine, on_miss=on_miss) for engine in ("python", "native")
        )
        assert (native.status == python.status).all()
        assert [(j.index, j.why, j.limits) for j in native.jumps] == [(j.index, j.why, j.limits) for j in python.jumps]
        np.testing.assert_array_equal(native.restarts, python.restarts)


def test_a_moving_reference_several_targets_and_axes_are_followed(lion):
    standing = lion.poses["relaxed"]
    nose = lion.placement("nose", standing).translation
    paw = lion.placement("left_fore_paw", standing).translation
    forward, left, up = np.eye(3)
    points = [
        [Target("left_fore_paw", paw + z * up), Target("nose", axis="x", at=nose + forward + 3.0 * z * left)]
        for z in np.linspace(0.0, 0.1, 15)
    ]
    track = pinik.track(lion, points, q0=standing)
    assert track.success, str(track)
    for targets, q in zip(points, track.q, strict=True):
        assert judge(lion, targets, q).are_within()


def test_the_json_form_is_plain_and_complete(panda):
    _, frame, q, places = circle("panda", 5)
    track = pinik.track(panda, frame, places, q, times=np.arange(5.0))
    document = json.loads(json.dumps(track.to_dict(), allow_nan=False))
    assert document["points"] == document["reached"] == 5
    assert document["angles"] == track.angles.tolist()
    assert document["success"] is True


def test_the_json_form_has_no_infinity(panda):
    _, frame, q, places = circle("panda", 3)
    track = pinik.track(panda, frame, places, q, times=[0.0, 1e-320, 1.0])
    infinite = [np.isinf(excess.speed) for excess in track.too_fast]
    assert any(infinite)
    excesses = json.loads(json.dumps(track.to_dict(), allow_nan=False))["too_fast"]
    assert [excess["speed"] is None for excess in excesses] == infinite


@pytest.mark.parametrize("what", ["tool0", Target("tool0", [None, None, 0.0])])
def test_places_leave_axes_free(what):
    robot = load_quietly("ur5")
    heights = np.linspace(0.4, 0.2, 10)
    track = pinik.track(robot, what, [[None, None, z] for z in heights], [0.3, -1.2, 1.4, -0.5, 1.0, 0.2])
    assert track.success
    found = [robot.placement("tool0", q).translation[2] for q in track.q]
    np.testing.assert_allclose(found, heights, atol=1e-6)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"on_miss": "skip"}, pinik.UnknownNameError, "no on_miss 'skip'"),
        ({"times": [0.0, 1.0]}, pinik.InputError, "times must be one number for each of the 5 points"),
        ({"times": [0.0, 1.0, 1.0, 2.0, 3.0]}, pinik.InputError, "times must increase"),
        ({"places": np.zeros((0, 3))}, pinik.InputError, "at least one point"),
        ({"trace": True}, pinik.InputError, "keeps no trace"),
        ({"q0": "nearest"}, pinik.InputError, "q0 must be a configuration, or angles by joint name"),
        ({"dampng": 1.0}, pinik.UnknownNameError, "no keyword 'dampng'"),
    ],
)
def test_what_cannot_be_is_refused_in_words(panda, change, error, message):
    _, frame, q, places = circle("panda", 5)
    arguments = {"places": places, "q0": q} | change
    with pytest.raises(error, match=message):
        pinik.track(panda, frame, **arguments)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_robot_without_joints_has_a_path_without_angles(engine):
    fixed = joint("j", "a", "b", origin((1, 0, 0)), kind="fixed", limit="")
    robot = load_quietly(robot_text(link("a"), link("b"), fixed))
    track = pinik.track(robot, "b", [[1.0, 0.0, 0.0], [1.0, 0.5, 0.0]], engine=engine)
    assert track.angles.shape == (2, 0)
    assert list(track.reached) == [True, False]
