"""`pinik.Tracker`: one call a tick; speeds, limits and the branch are kept, and the status says what holds it up."""

from __future__ import annotations

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from judge import judge
from pinik import Target, TrackerStatus
from robots import load_quietly

ENGINES = ["python", pytest.param("native", marks=needs_native)]
TIP = "panda_hand_tcp"
RATE = 100.0


def home(panda):
    return panda.poses["default"].copy()


def moved(place, *shift):
    place = place.homogeneous.copy()
    place[:3, 3] += shift
    return place


def drive(tracker, target, ticks):
    """The configurations of so many ticks towards one target, the start first (ticks + 1, nq)."""
    return np.array([tracker.q, *(tracker(target) for _ in range(ticks))])


def assert_within_speeds_and_limits(robot, way, velocity, rate=RATE):
    angles = np.array([[robot.angles(q)[name] for name in robot.joint_names] for q in way])
    for column, name in enumerate(robot.joint_names):
        if robot.joint(name).kind == "continuous":
            angles[:, column] = np.unwrap(angles[:, column])
    turned = np.abs(np.diff(angles, axis=0))
    assert (turned <= np.asarray(velocity) / rate * (1.0 + 1e-9)).all()
    assert (way >= robot.lower_q - 1e-12).all()
    assert (way <= robot.upper_q + 1e-12).all()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_far_target_is_approached_within_the_files_speeds_and_then_reached(panda, engine):
    tracker = pinik.Tracker(panda, TIP, home(panda), rate=RATE, engine=engine)
    assert tracker.engine == engine
    target = moved(panda.placement(TIP, home(panda)), 0.1, 0.25, 0.1)
    way, statuses, behind = [tracker.q], [], []
    for _ in range(200):
        way.append(tracker(target))
        statuses.append(tracker.status)
        behind.append(tracker.position_error)
        if tracker.status is TrackerStatus.OK:
            break
    assert_within_speeds_and_limits(panda, np.array(way), panda.velocity_limits)
    assert statuses[-1] is TrackerStatus.OK
    assert set(statuses[:-1]) == {TrackerStatus.LIMITED}
    assert behind == sorted(behind, reverse=True)
    errors = judge(panda, Target(TIP, placement=target), way[-1])
    assert errors.are_within((1e-6, 1e-5))
    assert tracker.position_error == pytest.approx(errors.position, abs=1e-12)
    assert len(way) > 10


@pytest.mark.parametrize("engine", ENGINES)
def test_a_slow_target_is_followed_at_every_tick(panda, engine):
    tracker = pinik.Tracker(panda, TIP, home(panda), rate=RATE, engine=engine)
    place = panda.placement(TIP, home(panda))
    for k in range(100):
        target = moved(place, 0.0, 0.001 * k, 0.0)
        q = tracker(target)
        assert tracker.status is TrackerStatus.OK
        assert judge(panda, Target(TIP, placement=target), q).are_within((1e-6, 1e-5))


@pytest.mark.parametrize("engine", ENGINES)
def test_out_of_reach_it_comes_to_the_nearest_point_and_does_not_jitter(engine):
    robot = load_quietly("ur5")
    q = np.array([0.0, -1.5, 1.5, -1.5, 1.5, 0.0])
    tracker = pinik.Tracker(robot, Target("tool0", [5.0, 0.0, 0.3]), q, rate=RATE, engine=engine)
    way = drive(tracker, np.array([5.0, 0.0, 0.3]), 600)
    assert tracker.status is TrackerStatus.HELD
    assert_within_speeds_and_limits(robot, way, robot.velocity_limits)
    assert np.abs(np.diff(way[-100:], axis=0)).max() < 1e-4
    nearest = robot.solve("tool0", [5.0, 0.0, 0.3], q0=way[-1])
    assert tracker.position_error == pytest.approx(nearest.position_error, abs=1e-3)
    errors = [judge(robot, Target("tool0", [5.0, 0.0, 0.3]), q).position for q in way]
    assert (np.diff(errors) < 1e-9).all()


@pytest.mark.parametrize("engine", ENGINES)
def test_it_never_goes_to_another_branch_by_itself(engine):
    """A target that only the other elbow reaches, as the shoulder is at its limit, is held and not jumped to."""
    text = """<robot name="folded"><link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/>
      <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="2.9" effort="1" velocity="2"/></joint>
      <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/>
        <axis xyz="0 0 1"/><limit lower="-2.5" upper="2.5" effort="1" velocity="3"/></joint>
      <joint name="end" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="1 0 0"/></joint></robot>"""
    robot = pinik.load(text)
    start = robot.configuration({"shoulder": -0.3, "elbow": 1.85})
    tracker = pinik.Tracker(robot, Target("tip", [1.2, 0.0, 0.0]), start, rate=50.0, engine=engine)
    way = [start]
    for turn in np.linspace(0.6, -0.6, 300):
        way.append(tracker(np.array([1.2 * np.cos(turn), 1.2 * np.sin(turn), 0.0])))
    way = np.array(way)
    assert (way[:, 1] > 0.5).all()
    assert tracker.status is TrackerStatus.HELD
    assert_within_speeds_and_limits(robot, way, robot.velocity_limits, 50.0)


@pytest.mark.parametrize("engine", ENGINES)
def test_speeds_are_given_as_one_number_or_by_name(panda, engine):
    target = moved(panda.placement(TIP, home(panda)), 0.0, 0.3, 0.0)
    slow = pinik.Tracker(panda, TIP, home(panda), rate=RATE, velocity=0.2, engine=engine)
    assert_within_speeds_and_limits(panda, drive(slow, target, 30), 0.2)
    assert slow.status is TrackerStatus.LIMITED
    one = pinik.Tracker(panda, TIP, home(panda), rate=RATE, velocity={"panda_joint1": 0.1}, engine=engine)
    expected = panda.velocity_limits.copy()
    expected[panda.joint_names.index("panda_joint1")] = 0.1
    assert one.velocity == pytest.approx(expected)
    assert_within_speeds_and_limits(panda, drive(one, target, 30), expected)


@pytest.mark.parametrize("engine", ENGINES)
def test_it_goes_on_from_a_measured_configuration(panda, engine):
    tracker = pinik.Tracker(panda, TIP, home(panda), rate=RATE, engine=engine)
    measured = home(panda)
    measured[0] += 0.2
    tracker.reset(measured)
    assert tracker.q == pytest.approx(measured)
    target = panda.placement(TIP, measured)
    assert tracker(target) == pytest.approx(measured, abs=1e-4)
    assert tracker.status is TrackerStatus.OK


@needs_native
@pytest.mark.parametrize("method", ["dls", "pinv", "ccd"])
def test_both_engines_tick_alike(panda, method):
    target = moved(panda.placement(TIP, home(panda)), 0.05, 0.1, -0.05)
    ways = []
    for engine in ("python", "native"):
        tracker = pinik.Tracker(panda, TIP, home(panda), rate=RATE, method=method, engine=engine)
        ways.append(drive(tracker, target, 12))
    np.testing.assert_allclose(ways[0], ways[1], atol=1e-7)


@needs_native
def test_both_engines_tick_alike_with_a_free_root_and_several_targets():
    robot = load_quietly("lion", root="free_flyer")
    q = robot.poses["relaxed"]
    targets = [
        Target("nose", robot.placement("nose", q).translation + np.array([0.3, 0.1, 0.0])),
        Target("left_fore_paw", robot.placement("left_fore_paw", q).translation),
    ]
    ways = [
        drive(pinik.Tracker(robot, targets, q, rate=RATE, velocity=0.3, engine=engine), targets, 5)
        for engine in ("python", "native")
    ]
    np.testing.assert_allclose(ways[0], ways[1], atol=1e-7)


def test_targets_are_given_in_every_form(panda):
    place = panda.placement(TIP, home(panda))
    place.translation[1] += 0.002
    answers = []
    for target in (place, place.homogeneous, place.homogeneous.tolist(), Target(TIP, placement=place)):
        tracker = pinik.Tracker(panda, TIP, home(panda))
        answers.append(tracker(target))
    for answer in answers[1:]:
        np.testing.assert_allclose(answer, answers[0], atol=1e-12)


def test_a_target_of_another_kind_is_refused(panda):
    tracker = pinik.Tracker(panda, TIP, home(panda))
    with pytest.raises(pinik.InputError):
        tracker(Target("panda_link5", [0.3, 0.0, 0.5]))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"rate": 0.0}, "rate must be"),
        ({"velocity": -1.0}, "velocity must be"),
        ({"velocity": {"panda_joint1": 0.0}}, "velocity of 'panda_joint1' must be"),
        ({"velocity": {"nobody": 1.0}}, "no joint 'nobody'"),
        ({"restarts": 3}, "no keyword 'restarts'"),
    ],
)
def test_what_cannot_be_is_refused_in_words(panda, words, message):
    with pytest.raises(pinik.PinikError, match=message):
        pinik.Tracker(panda, TIP, home(panda), **words)


def test_the_returned_configuration_belongs_to_the_caller(panda):
    tracker = pinik.Tracker(panda, TIP, home(panda))
    q = tracker(panda.placement(TIP, home(panda)))
    q[:] = 9.0
    assert tracker.q == pytest.approx(home(panda), abs=1e-5)
    assert pinocchio.isNormalized(panda.model, tracker.q)


def shifted(robot, frame, q, seed, far):
    """A placement (4, 4) at a distance [m] from that of the frame, in a random direction."""
    place = robot.placement(frame, q).homogeneous
    way = np.random.default_rng(seed).normal(size=3)
    place[:3, 3] += far * way / np.linalg.norm(way)
    return place


@pytest.mark.parametrize("engine", ENGINES)
def test_a_target_that_moved_30_cm_at_once_is_reached_where_a_straight_line_comes_to_a_limit(engine):
    """The tracker stayed at its start, LIMITED, for ever."""
    robot = load_quietly("z1")
    q = robot.random(6)
    target = shifted(robot, "gripperMover", q, 6, 0.3)
    tracker = pinik.Tracker(robot, "gripperMover", q, rate=RATE, engine=engine)
    way = drive(tracker, target, 80)
    assert tracker.status is TrackerStatus.OK
    assert judge(robot, Target("gripperMover", placement=target), way[-1]).are_within((1e-6, 1e-5))
    assert_within_speeds_and_limits(robot, way, robot.velocity_limits)


@needs_native
@pytest.mark.parametrize(
    ("name", "frame"),
    [
        ("ur5", "tool0"),
        ("panda", TIP),
        ("xarm7", "link_eef"),
        ("z1", "gripperMover"),
        ("kinova", "j2s6s200_end_effector"),
    ],
)
def test_no_target_leaves_it_limited_without_motion(name, frame):
    """After 600 ticks at a target 30 cm away, it is there, or at rest and HELD; a third was frozen and LIMITED."""
    robot = load_quietly(name)
    for seed in range(12):
        q = robot.random(seed)
        target = shifted(robot, frame, q, seed, 0.3)
        tracker = pinik.Tracker(robot, frame, q, rate=RATE)
        way = drive(tracker, target, 600)
        assert tracker.status in (TrackerStatus.OK, TrackerStatus.HELD), seed
        assert np.abs(np.diff(way[-20:], axis=0)).max() < 1e-4, seed
        assert_within_speeds_and_limits(robot, way, robot.velocity_limits)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["jt", "ccd"])
def test_a_method_that_needs_more_iterations_is_behind_and_not_held(method, engine):
    """The target moves by 2 mm in every tick; these methods called it out of reach."""
    robot = load_quietly("ur5")
    start = np.array([0.3, -1.2, 1.4, -0.5, 1.0, 0.2])
    place = robot.placement("tool0", start)
    tracker = pinik.Tracker(robot, "tool0", start, rate=RATE, method=method, engine=engine)
    for k in range(1, 31):
        q = tracker(moved(place, 0.0, 0.002 * k, 0.0))
        error = judge(robot, Target("tool0", placement=moved(place, 0.0, 0.002 * k, 0.0)), q).position
        assert tracker.status is (TrackerStatus.OK if error <= 1e-6 else TrackerStatus.LIMITED)
        assert error < 0.005
    drive(tracker, moved(place, 0.0, 0.06, 0.0), 100)
    assert tracker.status is TrackerStatus.OK
    drive(tracker, moved(place, 3.0, 0.0, 0.0), 500)
    assert tracker.status is TrackerStatus.HELD


def test_a_reset_forgets_the_last_tick_and_takes_angles_by_joint_name(panda):
    tracker = pinik.Tracker(panda, TIP, home(panda), rate=RATE)
    tracker(moved(panda.placement(TIP, home(panda)), 0.0, 0.4, 0.0))
    assert tracker.status is TrackerStatus.LIMITED
    tracker.reset({"panda_joint4": -2.0})
    assert tracker.status is TrackerStatus.OK
    assert tracker.position_error is None
    assert tracker.orientation_error is None
    assert tracker.angles == pytest.approx(panda.angles(panda.configuration({"panda_joint4": -2.0})))


@pytest.mark.parametrize("engine", ENGINES)
def test_angles_of_continuous_joints_are_unwound(engine):
    robot = load_quietly("kinova")
    wheel, frame = "j2s6s200_joint_1", "j2s6s200_end_effector"
    others = {"j2s6s200_joint_2": 3.0, "j2s6s200_joint_3": 1.5, "j2s6s200_joint_5": 1.0}
    tracker = pinik.Tracker(robot, frame, {wheel: 9.3} | others, rate=RATE, engine=engine)
    assert tracker.angles[wheel] == pytest.approx(9.3)
    for turn in np.arange(9.3, 9.6, 0.005):
        tracker(robot.placement(frame, robot.configuration({wheel: turn} | others)))
    assert tracker.status is TrackerStatus.OK
    assert tracker.angles[wheel] == pytest.approx(turn, abs=1e-3)


def test_infinite_speeds_are_no_limit(panda):
    for velocity in (np.inf, dict.fromkeys(panda.joint_names, np.inf)):
        tracker = pinik.Tracker(panda, TIP, home(panda), velocity=velocity)
        assert np.isinf(tracker.velocity).all()
        tracker(moved(panda.placement(TIP, home(panda)), 0.0, 0.1, 0.0))
        assert tracker.status is TrackerStatus.OK


def test_a_start_near_the_target_is_refused_in_words(panda):
    with pytest.raises(pinik.InputError, match="q0 must be a configuration, or angles by joint name"):
        pinik.Tracker(panda, TIP, "nearest")


@pytest.mark.parametrize("engine", ENGINES)
def test_a_position_with_free_axes_moves_as_a_list(engine):
    robot = load_quietly("ur5")
    start = np.array([0.3, -1.2, 1.4, -0.5, 1.0, 0.2])
    tracker = pinik.Tracker(robot, Target("tool0", [None, None, 0.3]), start, engine=engine)
    way = drive(tracker, [None, None, 0.2], 100)
    assert tracker.status is TrackerStatus.OK
    assert robot.placement("tool0", way[-1]).translation[2] == pytest.approx(0.2, abs=1e-6)
    with pytest.raises(pinik.InputError, match="must have numbers where the target asks for them"):
        tracker([0.1, None, None])


def test_the_parameters_of_the_method_are_heeded(panda):
    """A step of at most 0.001 rad in each of at most 20 iterations is as far as a joint comes in a tick."""
    target = pinocchio.SE3(np.eye(3), np.array([0.0, 0.0, 0.3])) * panda.placement(TIP, home(panda))
    tracker = pinik.Tracker(panda, TIP, home(panda), rate=1.0, velocity=np.inf, max_step=0.001)
    moved_by = np.abs(tracker(target) - home(panda)).max()
    assert 0.0 < moved_by <= 20 * 0.001 * (1.0 + 1e-9)
    with pytest.raises(pinik.InputError, match="max_step"):
        pinik.Tracker(panda, TIP, max_step=-1.0)
