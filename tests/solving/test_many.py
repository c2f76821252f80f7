"""`solve_many`: the answers of single solves, whatever the number of threads, for every kind of input."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import textwrap

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from judge import assert_good, assert_honest
from pinik import Status, Target

TIP = "panda_hand_tcp"
FIGURES = ("q", "status", "position_error", "orientation_error", "iterations", "joint_updates", "restarts")


@pytest.fixture(scope="module")
def poses(panda):
    """40 reachable placements (N, 4, 4)."""
    rng = np.random.default_rng(21)
    return np.array([panda.placement(TIP, panda.random(rng)).homogeneous for _ in range(40)])


def starts(panda, count):
    rng = np.random.default_rng(22)
    return np.array([panda.random(rng) for _ in range(count)])


def assert_same(a, b, figures=FIGURES):
    for name in figures:
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name), err_msg=name)


@pytest.mark.parametrize("method", ["ccd", "jt", "pinv", "dls"])
@pytest.mark.parametrize("kind", ["none", "one", "each", "nearest"])
def test_answers_are_those_of_single_solves(method, kind, panda, poses):
    """To the last bit, where the first attempt arrives; what is drawn later is keyed by each question's number."""
    each = starts(panda, len(poses))
    q0 = {"none": None, "one": each[0], "each": each, "nearest": "nearest"}[kind]
    many = pinik.solve_many(panda, TIP, poses, method, q0=q0)
    firsts = 0
    for k, pose in enumerate(poses):
        s = panda.solve(TIP, placement=pose, method=method, q0=each[k] if kind == "each" else q0)
        assert many.status[k] is s.status
        if s.restarts == 0:
            firsts += 1
            np.testing.assert_array_equal(many.q[k], s.q)
            assert (many.iterations[k], many.joint_updates[k], many.restarts[k]) == (s.iterations, s.joint_updates, 0)
            assert (many.position_error[k], many.orientation_error[k]) == (s.position_error, s.orientation_error)
    assert firsts
    assert_checked(panda, many)


def assert_checked(robot, many):
    """Every row is what it says, in the arrays and as a `Solution`."""
    for k, s in enumerate(many):
        assert_honest(s)
        assert s.robot is robot
        np.testing.assert_array_equal(s.q, many.q[k])
        assert many.success[k] == s.success
        for said, own in ((many.position_error[k], s.position_error), (many.orientation_error[k], s.orientation_error)):
            assert said == pytest.approx(math.nan if own is None else own, abs=1e-12, nan_ok=True)


@needs_native
@pytest.mark.parametrize("kind", ["none", "one", "each", "nearest"])
def test_answers_do_not_depend_on_the_number_of_threads(kind, panda, poses):
    each = starts(panda, len(poses))
    q0 = {"none": None, "one": each[0], "each": each, "nearest": "nearest"}[kind]
    hard = poses.copy()
    hard[::4, :3, 3] += 0.3  # some that need restarts
    one, *others = (
        pinik.solve_many(panda, TIP, hard, "pinv", q0=q0, threads=threads, engine="native", seed=5)
        for threads in (1, 2, 3, 64)
    )
    assert one.restarts.any()
    for other in others:
        assert_same(one, other)


@pytest.mark.parametrize("q0", [None, "nearest"])
@pytest.mark.parametrize("method", ["ccd", "dls"])
def test_the_python_engine_agrees_in_its_verdict(method, q0, panda, poses):
    python, auto = (
        pinik.solve_many(panda, TIP, poses[:12], method, q0=q0, engine=engine) for engine in ("python", "auto")
    )
    assert python.engine == "python"
    assert_same(python, auto, ("status",))
    assert_checked(panda, python)
    alone = python.restarts == 0
    np.testing.assert_allclose(python.q[alone], auto.q[alone], atol=1e-6)


def test_questions_draw_by_their_number(panda, poses):
    """The same hopeless question twice: each draws restarts of its own, and would not otherwise differ."""
    opposed = [[Target(TIP, [0.4, y, 0.5]) for y in (-0.2, 0.2)]] * 2
    many = pinik.solve_many(panda, opposed, restarts=40, max_iterations=1, method="jt")
    assert not many.success.any()
    assert not np.array_equal(many.q[0], many.q[1])


class TestInputs:
    def test_frame_and_matrices_se3_and_targets_are_the_same_question(self, panda, poses):
        matrices = pinik.solve_many(panda, TIP, poses)
        for other in (
            pinik.solve_many(panda, TIP, [pinocchio.SE3(pose) for pose in poses]),
            pinik.solve_many(panda, TIP, poses.tolist()),
            pinik.solve_many(panda, TIP, np.asfortranarray(poses)),
            pinik.solve_many(panda, Target(TIP, placement=np.eye(4)), poses),
            pinik.solve_many(panda, [Target(TIP, placement=pose) for pose in poses]),
            pinik.solve_many(panda, [[Target(TIP, placement=pose)] for pose in poses]),
            pinik.solve_many(panda, (Target(TIP, placement=pose) for pose in poses)),
        ):
            assert_same(matrices, other)

    def test_positions(self, panda, poses):
        many = pinik.solve_many(panda, TIP, poses[:, :3, 3])
        assert many.success.all()
        assert np.isnan(many.orientation_error).all()
        for k, s in enumerate(many):
            np.testing.assert_array_equal(s.targets[0].position, poses[k, :3, 3])
            assert s.targets[0].rotation is None
            assert_good(s, {"frame": TIP, "position": poses[k, :3, 3]})
        assert_same(many, pinik.solve_many(panda, Target(TIP, [0, 0, 1]), poses))  # of which it takes what it asks for

    def test_rotations_alone(self, panda, poses):
        many = pinik.solve_many(panda, Target(TIP, rotation=np.eye(3)), poses)
        assert many.success.all()
        assert np.isnan(many.position_error).all()
        assert_checked(panda, many)
        for k, s in enumerate(many):
            np.testing.assert_allclose(s.targets[0].rotation, poses[k, :3, :3], atol=1e-12)

    def test_a_pattern_with_tool_and_reference(self, panda):
        tool = pinocchio.SE3(pinocchio.exp3(np.array([0.1, 0.2, 0.3])), np.array([0.0, 0.1, 0.05]))
        rng = np.random.default_rng(3)
        q = [panda.random(rng) for _ in range(10)]
        wanted = [panda.placement(TIP, each, "panda_link2") * tool for each in q]
        many = pinik.solve_many(
            panda, Target(TIP, placement=np.eye(4), tool=tool, relative_to="panda_link2", weight=2.0), wanted
        )
        assert many.success.all()
        for k, s in enumerate(many):
            asked = {"frame": TIP, "placement": wanted[k], "tool": tool, "relative_to": "panda_link2"}
            assert_good(s, asked)
            assert (s.targets[0].weight, s.targets[0].relative_to) == (2.0, "panda_link2")

    def test_several_targets_each_of_every_kind(self, lion):
        rng, asked = np.random.default_rng(4), []
        for _ in range(6):
            q = lion.random(rng)
            nose, tail = lion.placement("nose", q), lion.placement("tail_tip", q)
            asked.append(
                (Target("nose", nose.translation, axis="x", direction=nose.rotation[:, 0]),
                 Target("tail_tip", axis="x", at=tail.translation + tail.rotation[:, 0]))
            )  # fmt: skip
        many = pinik.solve_many(lion, asked)
        assert_checked(lion, many)
        assert many.success.sum() >= 4
        for s, targets in zip(many, asked, strict=True):
            assert [t.to_dict() for t in s.targets] == [t.to_dict() for t in targets]

    @pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
    @pytest.mark.parametrize(
        "nothing",
        [
            ([],),
            (TIP, []),
            (TIP, np.zeros((0, 3))),
            (TIP, np.zeros((0, 4, 4))),
            (Target(TIP, [0, 0, 1]), []),
            (Target(TIP, placement=np.eye(4)), []),
        ],
        ids=["targets", "places", "positions", "matrices", "a point nowhere", "a pose nowhere"],
    )
    def test_no_question_has_no_answer(self, nothing, engine, panda):
        for q0 in (None, panda.neutral(), np.zeros((0, 8)), "nearest"):
            many = pinik.solve_many(panda, *nothing, q0=q0, engine=engine)
            assert len(many) == len(list(many)) == 0
            assert many.q.shape == (0, 8)
            for figure in (*FIGURES[1:], "success", "time"):
                assert getattr(many, figure).shape == (0,), figure
            assert str(many).startswith("0 of 0 solved in ")
            with pytest.raises(IndexError, match="there are 0 solutions; got index 0"):
                many[0]


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
def test_a_robot_without_joints_is_asked_as_any_other(engine):
    robot = pinik.load('<robot name="stone"><link name="stone"/></robot>')
    many = pinik.solve_many(robot, "stone", [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]], engine=engine)
    assert many.q.shape == (2, 0)
    assert many.success.tolist() == [False, True]


class TestSolutions:
    def test_one_of_many_is_a_solution_with_the_same_figures(self, panda, poses):
        far = poses.copy()
        far[3, :3, 3] = (5.0, 0.0, 0.0)
        far[4, :3, 3] += 0.3
        many = pinik.solve_many(panda, TIP, far, restarts=2)
        for k, s in enumerate(many):
            single = panda.solve(TIP, placement=far[k], q0=many.q[k], restarts=0, max_iterations=1)
            assert isinstance(s, pinik.Solution)
            assert (s.status, s.iterations, s.joint_updates, s.restarts, s.time) == (
                many.status[k], many.iterations[k], many.joint_updates[k], many.restarts[k], many.time[k],
            )  # fmt: skip
            np.testing.assert_array_equal(s.q, many.q[k])
            assert s.position_error == pytest.approx(many.position_error[k], abs=1e-12)
            assert s.message.startswith("converged") == bool(many.success[k])
            if s.success:
                assert s.message == single.message
        assert many[3].status is Status.UNREACHABLE
        assert "beyond its chain's reach" in many[3].message
        assert many[3].to_dict()["status"] == "UNREACHABLE"

    def test_one_of_many_names_the_engine(self, panda, poses):
        many = pinik.solve_many(panda, TIP, poses[:2])
        assert many[0].engine == many.engine

    def test_an_index_is_one_of_a_sequence(self, panda, poses):
        many = pinik.solve_many(panda, TIP, poses[:5])
        assert len(many) == len(list(many)) == 5
        np.testing.assert_array_equal(many[-1].q, many[4].q)
        np.testing.assert_array_equal(many[np.int64(1)].targets[0].position, poses[1, :3, 3])
        for index in (5, -6):
            with pytest.raises(IndexError, match=f"there are 5 solutions; got index {index}"):
                many[index]

    def test_a_solution_stays_when_another_is_looked_at(self, panda, poses):
        many = pinik.solve_many(panda, TIP, poses[:5])
        first, second = many[0], many[1]
        np.testing.assert_array_equal(first.targets[0].position, poses[0, :3, 3])
        np.testing.assert_array_equal(second.targets[0].position, poses[1, :3, 3])
        with pytest.raises(ValueError, match="read-only"):
            first.q[:] = 0.0
        many.q[0] = 0.0  # the arrays are one's own
        assert first.q.any()

    def test_its_words_are_short(self, panda, poses):
        many = pinik.solve_many(panda, TIP, poses[:5])
        assert str(many).startswith("5 of 5 solved in ")
        assert many.total_time > 0.0
        assert (many.time >= 0.0).all()
        assert [s.status for s in many] == [Status.CONVERGED] * 5
        assert_checked(panda, many)


@needs_native
@pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")
@pytest.mark.parametrize(
    "call",
    [
        "pinik.solve_many(panda, opposed, method='jt', threads=1, restarts=10**6, engine='native')",
        "pinik.solve_many(panda, opposed, method='jt', threads=2, restarts=10**6, engine='native')",
        "pinik.solve(panda, opposed[0], method='jt', restarts=10**6, engine='native')",
    ],
)
def test_ctrl_c_stops_it_within_a_tenth_of_a_second(call):
    """A hopeless question in a process of its own; its processor time is measured, which no other process uses."""
    program = textwrap.dedent(f"""
        import os, signal, threading, time
        import numpy as np
        import pinik

        panda = pinik.load("panda")
        opposed = [[pinik.Target("panda_hand_tcp", [0.4, y, 0.5]) for y in (-0.2, 0.2)]] * 20_000
        sent = []

        def interrupt():
            began = time.process_time()
            while time.process_time() - began < 1.0:  # until it computes
                time.sleep(0.01)
            sent.append(time.process_time())
            os.kill(os.getpid(), signal.SIGINT)

        for _ in range(3):
            thread = threading.Thread(target=interrupt)
            try:
                thread.start()
                {call}
            except KeyboardInterrupt:
                print(time.process_time() - sent[-1])
            thread.join()
    """)
    environment = os.environ | {"PYTHONWARNINGS": "ignore"}
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=150, env=environment)
    assert done.returncode == 0, done.stderr
    took = [float(line) for line in done.stdout.split()]
    assert len(took) == 3
    assert 0.0 <= min(took) < 0.1 * 2  # of two threads


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
@pytest.mark.parametrize(("kind", "none"), [("position", "orientation_error"), ("direction", "position_error")])
def test_an_error_that_is_not_asked_for_is_nan(kind, none, engine, panda):
    asked = {"position": {"position": [0.4, 0.0, 0.5]}, "direction": {"axis": "z", "direction": [0.0, 0.0, -1.0]}}
    many = pinik.solve_many(panda, [Target(TIP, **asked[kind])] * 2, engine=engine)
    assert np.isnan(getattr(many, none)).all()
