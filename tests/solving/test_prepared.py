"""Questions prepared once and asked often: never another answer than `pinik.solve`'s, never a stale one."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from judge import assert_honest
from pinik import Status, Target

TIP = "panda_hand_tcp"
ENGINES = ["python", pytest.param("native", marks=needs_native)]


def poses(robot, frame, count, seed=1):
    rng = np.random.default_rng(seed)
    return [robot.placement(frame, robot.random(rng)) for _ in range(count)]


def assert_same(a, b):
    """Two solutions of one question by one engine: to the last bit."""
    assert a.engine == b.engine
    np.testing.assert_array_equal(a.q, b.q)
    assert (a.status, a.iterations, a.restarts, a.errors, a.message) == (
        b.status, b.iterations, b.restarts, b.errors, b.message,
    )  # fmt: skip
    assert [t.to_dict() for t in a.targets] == [t.to_dict() for t in b.targets]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
def test_asked_often_is_solved_anew_each_time(engine, method, panda):
    """SE3, matrix, Target, list of one: the same as a fresh `pinik.solve`, for each of several places in turn."""
    options = {"method": method, "engine": engine, "restarts": 3}
    ask = pinik.prepare(panda, Target(TIP, placement=np.eye(4)), **options)
    rng = np.random.default_rng(2)
    for pose in poses(panda, TIP, 4):
        q0, target = panda.random(rng), Target(TIP, placement=pose)
        fresh = pinik.prepare(panda, target, **options)(target, q0)
        assert_same(fresh, pinik.solve(panda, target, q0=q0, **options))
        for place in (pose, pose.homogeneous, pose.homogeneous.tolist(), target, [target]):
            assert_same(fresh, ask(place, q0))
        assert_same(fresh, ask(pose, q0.tolist()))


@pytest.mark.parametrize("engine", ENGINES)
def test_positions_rotations_and_axes(engine, panda):
    kinds = {
        "position": lambda M: Target(TIP, M.translation),
        "rotation": lambda M: Target(TIP, rotation=M.rotation),
        "axis": lambda M: Target(TIP, M.translation, axis="z", direction=M.rotation[:, 2]),
        "relative": lambda M: Target(TIP, placement=M, relative_to="panda_link1", tool=[0, 0, 0.1]),
    }
    for kind, make in kinds.items():
        ask = pinik.prepare(panda, make(pinocchio.SE3.Identity()), engine=engine)
        for pose in poses(panda, TIP, 3):
            target = make(pose)
            expected = pinik.solve(panda, target, engine=engine)
            assert_same(expected, ask(target))
            if kind == "position":
                assert_same(expected, ask(pose.translation.copy()))
                assert_same(expected, ask(pose.translation.tolist()))
                assert_same(expected, ask(pose))  # of which it takes what was asked for
            elif kind != "axis":
                assert_same(expected, ask(pose))


@pytest.mark.parametrize("engine", ENGINES)
def test_what_it_was_not_prepared_for_is_refused_in_words(engine, panda, lion):
    pose = pinik.prepare(panda, Target(TIP, placement=np.eye(4)), engine=engine)
    point = pinik.prepare(panda, Target(TIP, [0, 0, 1]), engine=engine)
    axis = pinik.prepare(panda, Target(TIP, axis="z", direction=[0, 0, 1]), engine=engine)
    two = pinik.prepare(lion, [Target("nose", [0, 0, 1]), Target("tail_tip", [0, 0, 1])], engine=engine)
    for ask, place, words in (
        (pose, [0.1, 0.2, 0.3], "asks for an orientation too"),
        (pose, Target(TIP, [0, 0, 1]), "targets must be of the same kinds"),
        (pose, Target("panda_link5", placement=np.eye(4)), "targets must be of the same kinds"),
        (pose, Target(TIP, placement=np.eye(4), weight=2.0), "targets must be of the same kinds"),
        (pose, np.full((4, 4), math.nan), "SE3 or a homogeneous matrix"),
        (pose, np.eye(3), "SE3 or a homogeneous matrix"),
        (pose, np.diag([1.0, 1.0, -1.0, 1.0]), "must be a rotation matrix"),
        (pose, np.ones((4, 4)), "last row"),
        (pose, "here", "SE3 or a homogeneous matrix"),
        (pose, 3, "SE3 or a homogeneous matrix"),
        (point, [0.1, math.nan, 0.3], "must be 3 finite numbers"),
        (point, np.array([1e10, 0, 0]), "must be a point within"),
        (point, [0.1, 0.2], "SE3 or a homogeneous matrix"),
        (axis, np.eye(4), "asks for an axis's direction"),
        (two, np.eye(4), "targets must be 2 Target objects"),
        (two, Target("nose", [0, 0, 1]), "targets must be of the same kinds"),
    ):
        with pytest.raises(pinik.InputError, match=words):
            ask(place)
    for q0 in ([0.0] * 7, np.full(8, math.nan), 3):
        with pytest.raises(pinik.InputError, match="q0 must be 8 finite numbers"):
            pose(np.eye(4), q0)
    with pytest.raises(
        pinik.InputError, match=r"got 'nearby' \(the robot's poses are given as robot\.poses\['default'\]\)"
    ):
        pose(np.eye(4), "nearby")


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
def test_without_a_place_it_asks_for_what_it_was_prepared_with(engine, panda):
    ask = pinik.prepare(panda, Target(TIP, [0.4, 0.1, 0.5]), engine=engine)
    assert_same(ask(), ask([0.4, 0.1, 0.5]))
    there = ask(np.array([0.3, -0.2, 0.6]))
    np.testing.assert_array_equal(there.targets[0].position, [0.3, -0.2, 0.6])
    assert_same(ask(), ask([0.4, 0.1, 0.5]))
    np.testing.assert_array_equal(ask.targets[0].position, [0.4, 0.1, 0.5])


@needs_native
class TestTheQuickPath:
    """`at` answers what is beyond doubt and leaves all else to the slow path, which comes to the same or says why."""

    @pytest.fixture
    def ask(self, panda):
        return pinik.prepare(panda, Target(TIP, placement=np.eye(4)), engine="native")

    @pytest.fixture
    def pose(self, panda):
        return poses(panda, TIP, 1)[0]

    def test_takes_what_is_beyond_doubt(self, ask, pose, panda):
        q0 = panda.random(4)
        expected = ask(Target(TIP, placement=pose), q0)
        for place in (pose, np.ascontiguousarray(pose.homogeneous)):
            quick = ask.at(place, q0)
            assert quick is not None
            assert_same(quick, expected)
        assert ask.at(pose) is not None
        assert ask.at(pose, "nearest") is not None

    def test_leaves_what_is_in_doubt(self, ask, pose, panda):
        M, q0 = np.ascontiguousarray(pose.homogeneous), panda.random(4)
        expected = ask(pose, q0)
        wide = np.zeros((8, 8))
        wide[::2, ::2] = M
        tilted = M.copy()
        tilted[:3, :3] = tilted[:3, :3] @ (np.eye(3) + 1e-9 * np.ones((3, 3)))
        for place in (
            M.astype(np.float32),
            wide[::2, ::2],
            M.astype(np.longdouble),
            M.tolist(),
            tilted,
            M.astype(">f8"),
        ):
            assert ask.at(place, q0) is None
            s = ask(place, q0)
            assert s.success
            np.testing.assert_allclose(s.q, expected.q, atol=1e-3)
        assert_same(ask(wide[::2, ::2], q0), expected)
        R = ask(tilted, q0).targets[0].rotation
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-15)  # projected
        for start in (
            q0.tolist(),
            q0.astype(np.float32),
            np.repeat(q0, 2)[::2],
            q0[:7],
            q0 * math.nan,
            "nearby",
            1,
            b"x",
        ):
            assert ask.at(M, start) is None

    def test_leaves_numbers_that_are_wrong(self, ask, pose):
        for row, column, value in ((0, 3, math.nan), (0, 0, math.nan), (0, 3, math.inf), (1, 3, 2e9), (3, 0, 1e-3),
                                   (3, 3, 2.0), (3, 1, math.nan)):  # fmt: skip
            M = np.ascontiguousarray(pose.homogeneous)
            M[row, column] = value
            assert ask.at(M) is None
            with pytest.raises(pinik.InputError):
                ask(M)
        for place in (np.zeros((4, 4)), np.eye(3), np.zeros(3), np.zeros(0), "here", 3, object()):
            assert ask.at(place) is None
        mirrored = np.ascontiguousarray(pose.homogeneous) @ np.diag([1.0, 1.0, -1.0, 1.0])
        assert ask.at(mirrored) is None

    def test_normalises_what_a_slow_path_would(self, tiago):
        """A pair of cosine and sine that is a little off unit length, or far off."""
        frame = "arm_tool_link"
        ask = pinik.prepare(tiago, Target(frame, placement=np.eye(4)), engine="native")
        pose, q0 = poses(tiago, frame, 1)[0], tiago.neutral()
        wheel = tiago.joint("wheel_left_joint").idx_q
        q0[wheel : wheel + 2] *= 1.0001
        s = ask.at(pose, q0)
        assert s is not None
        assert np.linalg.norm(s.q[wheel : wheel + 2]) == pytest.approx(1.0, abs=1e-12)
        assert_same(s, ask(Target(frame, placement=pose), q0))
        q0[wheel : wheel + 2] *= 1.1
        assert ask.at(pose, q0) is None
        with pytest.raises(pinik.InputError, match="of unit length"):
            ask(pose, q0)


@pytest.mark.parametrize("prepared", [True, False])
@pytest.mark.parametrize("engine", ENGINES)
def test_what_is_handed_in_may_change_afterwards(engine, prepared, panda):
    """Also before anything of the solution is looked at."""
    M, q0 = np.ascontiguousarray(poses(panda, TIP, 1)[0].homogeneous), panda.random(3)
    tolerance, locked = np.array([1e-4, 1e-3]), ["panda_joint1"]
    expected = panda.solve(TIP, placement=M.copy(), q0=q0.copy(), engine=engine, locked=("panda_joint1",))
    if prepared:
        options = {"engine": engine, "locked": locked, "tolerance": tolerance}
        s = pinik.prepare(panda, Target(TIP, placement=np.eye(4)), **options)(M, q0)
    else:
        s = panda.solve(TIP, placement=M, q0=q0, tolerance=tolerance, locked=locked, engine=engine)
    M[:], q0[:], tolerance[:], locked[:] = 7.0, 0.5, 1.0, ["panda_joint2"]
    assert_same(s, expected)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_solution_does_not_change_with_what_is_asked_next(engine, panda):
    ask = pinik.prepare(panda, Target(TIP, [0.4, 0.1, 0.5]), engine=engine, trace=True)
    places = [np.array([0.4, 0.1, 0.5]), np.array([0.3, -0.2, 0.6]), np.array([3.0, 0.0, 0.0])]
    solutions = [ask(place) for place in places]
    for s, place in zip(solutions, places, strict=True):
        np.testing.assert_array_equal(s.targets[0].position, place)
        assert_honest(s, {"frame": TIP, "position": place})
        assert s.trace[-1].position_error < s.trace[0].position_error
    assert [s.status for s in solutions] == [Status.CONVERGED, Status.CONVERGED, Status.UNREACHABLE]
    message, errors = solutions[2].message, solutions[2].errors
    again = ask(places[2])
    assert (again.errors, again.status) == (errors, Status.UNREACHABLE)
    assert solutions[2].message == message
    np.testing.assert_array_equal(again.q, solutions[2].q)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_configuration_that_a_verdict_is_about_cannot_be_changed(engine, panda):
    s = panda.solve(TIP, [3.0, 0.0, 0.0], engine=engine)
    for twin in (s, pickle.loads(pickle.dumps(s)), copy.copy(s), copy.deepcopy(s)):
        with pytest.raises(ValueError, match="read-only"):
            twin.q[:] = 0.0
        np.testing.assert_array_equal(twin.q, s.q)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_solution_can_be_copied_and_pickled(engine, panda):
    for place in ([0.4, 0.1, 0.5], [3.0, 0.0, 0.0]):
        s = panda.solve(TIP, place, engine=engine, trace=True, damping=0.5)
        for twin in (pickle.loads(pickle.dumps(s)), copy.copy(s), copy.deepcopy(s)):
            assert twin.to_dict() == s.to_dict()
            assert (twin.engine, twin.time, twin.success, str(twin)) == (s.engine, s.time, s.success, str(s))
            assert len(twin.trace) == len(s.trace)
            assert twin.angles == s.angles
        assert not np.shares_memory(copy.deepcopy(s).q, s.q)


def test_a_solutions_repr_is_short(lion):
    s = lion.solve([Target("nose", [0.1, 0.2, 9.0]), Target("tail_tip", [0.1, 0.2, 9.0])], restarts=1)
    assert repr(s).startswith("Solution(UNREACHABLE: unreachable: ")
    assert len(repr(s)) < 1000
