"""Placements and Jacobians at many configurations: against plain Pinocchio, by finite differences, and one by one."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
import threading

import numpy as np
import pinocchio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pinik
from by_hand import ZOO, chains
from engines import needs_native
from pinik import InputError, UnknownNameError
from pinik.solving import frame_arrays
from pinik.solving.native import module
from robots import load_quietly

Array = np.ndarray

ROBOTS = [name for name in pinik.catalog() if name != "ur3_empty"]
ROOTS = ("fixed", "free_flyer", "planar")
AXES = {
    "local_world_aligned": pinocchio.LOCAL_WORLD_ALIGNED,
    "local": pinocchio.LOCAL,
    "world": pinocchio.WORLD,
}
TIP = "panda_hand_tcp"


@pytest.fixture(params=["native", "python"])
def engine(request, monkeypatch) -> str:
    """The compiled engine, and Pinocchio one by one where there is none."""
    if request.param == "native":
        if module.why_not():
            pytest.skip("there is no compiled engine")
    else:
        monkeypatch.setattr(frame_arrays, "why_not", lambda: "it is left out in this test")
    return request.param


def drawn(robot: pinik.Robot, count: int, seed: int = 0) -> Array:
    """Random configurations (count, nq) without the wild angles of rotors whose limits are ±1e16."""
    rng = np.random.default_rng(seed)
    Q = np.array([robot.random(rng) for _ in range(count)]).reshape(count, robot.model.nq)
    wild = [joint.idx_q for joint in robot.joints if joint.nq == 1]
    Q[:, wild] = np.where(np.abs(Q[:, wild]) > 10.0, rng.uniform(-3, 3, (count, len(wild))), Q[:, wild])
    return Q


def plain_placements(robot: pinik.Robot, frame: str, Q: Array) -> Array:
    """The placements of a frame in the world, by Pinocchio alone."""
    model, data, found = robot.model, robot.model.createData(), []
    for q in Q:
        pinocchio.framesForwardKinematics(model, data, q)
        found.append(data.oMf[robot.frame_id(frame)].homogeneous.copy())
    return np.array(found).reshape(-1, 4, 4)


def plain_jacobians(robot: pinik.Robot, frame: str, Q: Array, axes: str) -> Array:
    """The Jacobians of a frame in the world, by Pinocchio alone."""
    model, data = robot.model, robot.model.createData()
    found = [pinocchio.computeFrameJacobian(model, data, q, robot.frame_id(frame), AXES[axes]).copy() for q in Q]
    return np.array(found).reshape(-1, 6, model.nv)


def differences(robot: pinik.Robot, frame: str, q: Array, axes: str, relative_to: str) -> Array:
    """The Jacobian (6, nv) relative to a frame by central differences of plain placements."""
    step, columns = 1e-5, []
    steps = step * np.vstack([np.zeros(robot.model.nv), np.eye(robot.model.nv), -np.eye(robot.model.nv)])
    Q = np.array([pinocchio.integrate(robot.model, q, dq) for dq in steps])
    at = np.linalg.inv(plain_placements(robot, relative_to, Q)) @ plain_placements(robot, frame, Q)
    for plus, minus in zip(at[1 : robot.model.nv + 1], at[robot.model.nv + 1 :], strict=True):
        velocity = (plus[:3, 3] - minus[:3, 3]) / (2 * step)
        turn = plus[:3, :3] @ minus[:3, :3].T / (2 * step)
        spin = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        if axes == "local":
            velocity, spin = at[0, :3, :3].T @ velocity, at[0, :3, :3].T @ spin
        elif axes == "world":
            velocity = velocity - np.cross(spin, at[0, :3, 3])
        columns.append(np.concatenate((velocity, spin)))
    return np.array(columns).T


def some_frames(robot: pinik.Robot, count: int) -> list[str]:
    """Frames of a robot: the one with the most joints before it, and others at random."""
    frames = [robot.model.frames[robot.frame_id(name)] for name in robot.frame_names]
    deepest = max(frames, key=lambda frame: len(robot.model.supports[frame.parentJoint])).name
    return [deepest, *np.random.default_rng(1).choice(robot.frame_names, count - 1)]


@needs_native
@pytest.mark.parametrize("root", ROOTS)
@pytest.mark.parametrize("name", ROBOTS)
def test_placements_of_every_catalogue_robot_are_pinocchios(name, root):
    robot = load_quietly(name, root=root)
    Q = drawn(robot, 5)
    size = max(1.0, np.abs(Q).max(initial=0.0))
    for frame in some_frames(robot, 4):
        found = robot.placements(frame, Q)
        assert found.shape == (5, 4, 4)
        np.testing.assert_allclose(found, plain_placements(robot, frame, Q), atol=1e-13 * size, rtol=0)


@needs_native
@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("name", [n for n in ROBOTS if load_quietly(n).model.nv])
def test_jacobians_of_every_catalogue_robot_are_pinocchios(name, axes):
    for root in ROOTS:
        robot = load_quietly(name, root=root)
        Q = drawn(robot, 3)
        for frame in some_frames(robot, 3):
            found = robot.jacobians(frame, Q, axes)
            np.testing.assert_allclose(found, plain_jacobians(robot, frame, Q, axes), atol=1e-12, rtol=0)


@pytest.mark.parametrize("root", ROOTS)
@pytest.mark.parametrize(("frame", "relative_to"), [("tip", "hand"), ("hand", "tip"), ("tip", "body"), ("a", "tip")])
def test_relative_to_a_frame_are_those_seen_from_it(frame, relative_to, root, engine):
    robot = load_quietly(ZOO, root=root)
    Q = drawn(robot, 3)
    seen = np.linalg.inv(plain_placements(robot, relative_to, Q)) @ plain_placements(robot, frame, Q)
    np.testing.assert_allclose(robot.placements(frame, Q, relative_to), seen, atol=1e-13, rtol=0)
    for axes in AXES:
        expected = [differences(robot, frame, q, axes, relative_to) for q in Q]
        np.testing.assert_allclose(robot.jacobians(frame, Q, axes, relative_to), expected, atol=1e-6, rtol=0)


@needs_native
@pytest.mark.parametrize("name", ["talos_full", "tiago", "pr2", "romeo", "lion", "panda"])
def test_any_frame_relative_to_any_other_is_what_one_configuration_gives(name):
    robot = load_quietly(name, root="free_flyer")
    Q, rng = drawn(robot, 2), np.random.default_rng(2)
    for _ in range(10):
        frame, relative_to = rng.choice(robot.frame_names, 2)
        axes = rng.choice(list(AXES))
        placements = [robot.placement(frame, q, relative_to).homogeneous for q in Q]
        np.testing.assert_allclose(robot.placements(frame, Q, relative_to), placements, atol=1e-13, rtol=0)
        jacobians = [robot.jacobian(frame, q, axes, relative_to) for q in Q]
        np.testing.assert_allclose(robot.jacobians(frame, Q, axes, relative_to), jacobians, atol=1e-12, rtol=0)


@needs_native
@given(text=chains(("revolute", "continuous", "prismatic", "floating", "planar")), seed=st.integers(0, 9))
@settings(max_examples=40)
def test_of_any_chain_of_any_joints_are_pinocchios(text, seed):
    robot = load_quietly(text)
    Q = drawn(robot, 3, seed)
    frame = some_frames(robot, 1)[0]
    np.testing.assert_allclose(robot.placements(frame, Q), plain_placements(robot, frame, Q), atol=1e-12, rtol=0)
    if robot.model.nv:
        expected = plain_jacobians(robot, frame, Q, "local")
        np.testing.assert_allclose(robot.jacobians(frame, Q, "local"), expected, atol=1e-12, rtol=0)


def test_every_row_of_a_long_array_is_its_own(panda, engine):
    """In blocks of any size and from any thread."""
    count = 3 * 256 + 1 if engine == "native" else 5
    Q = drawn(panda, count)
    np.testing.assert_allclose(panda.placements(TIP, Q), plain_placements(panda, TIP, Q), atol=1e-13, rtol=0)
    expected = plain_jacobians(panda, TIP, Q, "local_world_aligned")
    np.testing.assert_allclose(panda.jacobians(TIP, Q), expected, atol=1e-13, rtol=0)


@needs_native
def test_the_number_of_threads_changes_nothing(panda, monkeypatch):
    Q, found = drawn(panda, 2000), []
    for count in (1, 2, 7):
        monkeypatch.setattr(frame_arrays, "processors", lambda count=count: count)
        found.append((panda.placements(TIP, Q), panda.jacobians(TIP, Q)))
    for placements, jacobians in found[1:]:
        np.testing.assert_array_equal(placements, found[0][0])
        np.testing.assert_array_equal(jacobians, found[0][1])


def test_any_array_of_numbers_is_taken_and_left_as_it_is(panda, engine):
    Q = drawn(panda, 4)
    expected = plain_placements(panda, TIP, Q)
    for given_as in (Q, Q.tolist(), np.asfortranarray(Q), np.repeat(Q, 2, axis=0)[::2], Q.astype(">f8"), tuple(Q)):
        before = np.array(given_as)
        np.testing.assert_allclose(panda.placements(TIP, given_as), expected, atol=1e-13, rtol=0)
        np.testing.assert_array_equal(np.array(given_as), before)
    np.testing.assert_allclose(panda.placements(TIP, Q.astype(np.float32)), expected, atol=1e-5, rtol=0)
    whole = np.zeros((2, panda.model.nq), dtype=int)
    np.testing.assert_allclose(panda.placements(TIP, whole), plain_placements(panda, TIP, whole + 0.0), atol=1e-13)


@pytest.mark.parametrize("root", ROOTS)
def test_pairs_and_quaternions_a_little_off_are_normalised(root, engine):
    robot = load_quietly(ZOO, root=root)
    Q = drawn(robot, 3)
    off = Q.copy()
    for joint in robot.joints:
        if joint.circle(Q[0]) is not None:
            entries = slice(joint.idx_q, joint.idx_q + joint.nq)
            first = {"floating": 3, "planar": 2}.get(joint.kind, 0)
            off[:, entries][:, first:] *= 1.0004
    assert np.abs(off - Q).max() > 1e-4
    before = off.copy()
    np.testing.assert_allclose(robot.placements("hand", off), plain_placements(robot, "hand", Q), atol=1e-13, rtol=0)
    expected = plain_jacobians(robot, "hand", Q, "world")
    np.testing.assert_allclose(robot.jacobians("hand", off, "world"), expected, atol=1e-12, rtol=0)
    np.testing.assert_array_equal(off, before)


def test_the_first_faulty_row_is_named(panda, kinova, engine):
    Q = drawn(panda, 600)
    Q[[40, 500], [2, 0]] = np.nan, np.inf
    for call in (panda.placements, panda.jacobians):
        with pytest.raises(InputError, match=r"^Q\[40\] must be 8 finite numbers; got \[.*nan"):
            call(TIP, Q)
    Q = drawn(kinova, 600)
    pair = next(joint for joint in kinova.joints if joint.nq == 2)
    Q[[30, 31], pair.idx_q] = 3.0
    for call in (kinova.placements, kinova.jacobians):
        with pytest.raises(
            InputError, match=rf"Q\[30\]: \(cos, sin\) of continuous joint '{pair.name}' must be of unit"
        ):
            call("j2s6s200_end_effector", Q)


def test_a_faulty_entry_of_a_joint_that_moves_nothing_is_named_too(lion, engine):
    Q = drawn(lion, 3)
    Q[2, lion.joint(lion.joint_names[-1]).idx_q] = np.nan
    with pytest.raises(InputError, match=r"^Q\[2\] must be"):
        lion.placements(lion.frame_names[1], Q)


@pytest.mark.parametrize(
    ("Q", "message"),
    [
        (np.zeros(8), r"Q must be N times 8 finite numbers; got an array of shape \(8,\)"),
        (np.zeros((2, 7)), r"Q must be N times 8 finite numbers; got an array of shape \(2, 7\)"),
        (np.zeros((2, 8, 1)), r"Q must be N times 8 finite numbers; got an array of shape \(2, 8, 1\)"),
        ([[0.0] * 8, [0.0] * 7], "Q must be an array of numbers; got rows of different lengths"),
        ("home", "Q must be an array of numbers; got 'home'"),
        (None, "Q must be an array of numbers; got None"),
        (np.zeros((2, 8), dtype=bool), "Q must be an array of numbers"),
    ],
)
def test_what_is_no_array_of_configurations_is_refused(Q, message, panda, engine):
    for call in (panda.placements, panda.jacobians):
        with pytest.raises(InputError, match=message):
            call(TIP, Q)


def test_unknown_names_are_refused_with_near_ones(panda, engine):
    Q = drawn(panda, 2)
    with pytest.raises(UnknownNameError, match=r"no frame 'panda_hnd_tcp'; did you mean 'panda_hand_tcp'"):
        panda.placements("panda_hnd_tcp", Q)
    with pytest.raises(UnknownNameError, match="no frame 'panda_hnd'"):
        panda.jacobians(TIP, Q, relative_to="panda_hnd")
    with pytest.raises(InputError, match=r"axes must be one of 'local_world_aligned', 'local', 'world'.*got 'body'"):
        panda.jacobians(TIP, Q, "body")


def test_pinocchios_own_reference_frames_are_taken(panda, engine):
    Q = drawn(panda, 2)
    for name, axes in AXES.items():
        np.testing.assert_array_equal(panda.jacobians(TIP, Q, axes), panda.jacobians(TIP, Q, name))


def test_of_no_configurations_there_are_none(panda, engine):
    assert panda.placements(TIP, np.zeros((0, 8))).shape == (0, 4, 4)
    assert panda.jacobians(TIP, np.zeros((0, 8))).shape == (0, 6, panda.model.nv)


def test_a_robot_without_joints_has_placements_and_empty_jacobians(engine):
    robot = load_quietly('<robot name="block"><link name="block"/></robot>')
    np.testing.assert_array_equal(robot.placements("block", np.zeros((3, 0))), np.tile(np.eye(4), (3, 1, 1)))
    assert robot.jacobians("block", np.zeros((3, 0))).shape == (3, 6, 0)


def test_the_arrays_belong_to_the_caller(panda, engine):
    Q = drawn(panda, 2)
    first, second = panda.placements(TIP, Q), panda.placements(TIP, Q)
    first[:] = 0.0
    np.testing.assert_allclose(second, plain_placements(panda, TIP, Q), atol=1e-13, rtol=0)


@needs_native
def test_several_threads_may_ask_at_once(panda):
    Q = drawn(panda, 3000)
    expected, found = panda.placements(TIP, Q), {}

    def work(k: int) -> None:
        found[k] = [panda.placements(TIP, Q) for _ in range(5)]

    threads = [threading.Thread(target=work, args=(k,)) for k in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(found) == list(range(6))
    for answers in found.values():
        for answer in answers:
            np.testing.assert_array_equal(answer, expected)


@needs_native
@pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")
def test_ctrl_c_stops_it():
    """In a process of its own, whose processor time is measured, as no other process uses it."""
    program = textwrap.dedent("""
        import signal, time
        import numpy as np
        import pinik

        signal.signal(signal.SIGALRM, signal.default_int_handler)
        panda = pinik.load("panda")
        Q = np.zeros((600_000, 8))
        wall, began = time.perf_counter(), time.process_time()
        panda.jacobians("panda_hand_tcp", Q)
        wall, whole = time.perf_counter() - wall, time.process_time() - began
        parts = []
        for _ in range(5):
            began = time.process_time()
            signal.setitimer(signal.ITIMER_REAL, wall / 10)
            try:
                panda.jacobians("panda_hand_tcp", Q)
            except KeyboardInterrupt:
                parts.append((time.process_time() - began) / whole)
        print(*parts)
    """)
    environment = os.environ | {"PYTHONWARNINGS": "ignore"}
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=150, env=environment)
    assert done.returncode == 0, done.stderr
    parts = [float(part) for part in done.stdout.split()]
    assert len(parts) == 5
    assert min(parts) < 0.6
