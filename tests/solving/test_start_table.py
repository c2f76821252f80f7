"""The table that restarts begin from: near the target, the same in both engines."""

from __future__ import annotations

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import ZOO
from engines import needs_native
from pinik import Kinematics, Target
from pinik.model.limits import Limits
from pinik.problem.problem import Problem
from pinik.solving.starts import Starts, random_start
from robots import load_quietly

SIZE, NEAREST, OF_THE_TABLE = 256, 32, (1 << 64) - 1  # the definition that both engines meet


def starts_of(robot, targets, *, limits=True, locked=(), seed=0):
    kinematics = Kinematics(robot, targets, locked=locked)
    return Starts(kinematics, Limits.of(robot, limits), seed)


def sequence(starts, q0, count=NEAREST, target=0):
    return np.array([starts.next(q0, target=target, number=number) for number in range(1, count + 1)])


def table(robot, targets, q0, *, limits=True, seed=0):
    """All that the table holds, each drawn by itself."""
    problem = Problem(robot, targets)
    draw = {"seed": seed, "target": OF_THE_TABLE}
    neutral = robot.neutral()
    about = q0.copy()  # slides without limits are drawn about 0
    for joint in robot.joints:
        if joint.nv and joint.has_one_axis and problem.free[joint.idx_v]:
            about[joint.idx_q : joint.idx_q + joint.nq] = neutral[joint.idx_q : joint.idx_q + joint.nq]
    box = Limits.of(robot, limits)
    return np.array([random_start(problem, box, about, attempt=k, **draw) for k in range(SIZE)])


def squared_distance(robot, targets, q):
    """[m²] by plain Pinocchio: a radian is 0.3 of the chain's length, its square 2 − 2 cos."""
    of_a_radian = (0.3 * Problem(robot, targets).size_of_chain) ** 2
    model, data = robot.model, robot.model.createData()
    pinocchio.framesForwardKinematics(model, data, q)
    total = 0.0
    for t in targets:
        M = data.oMf[model.getFrameId(t.frame, pinocchio.BODY)]
        if t.relative_to is not None:
            M = data.oMf[model.getFrameId(t.relative_to, pinocchio.BODY)].actInv(M)
        M = M * (t.tool or pinocchio.SE3.Identity())
        own = 0.0
        if t.position is not None:
            own += np.sum((M.translation - t.position) ** 2)
        if t.rotation is not None:
            own += of_a_radian * (2.0 - 2.0 * (np.trace(t.rotation.T @ M.rotation) - 1.0) / 2.0)
        elif t.direction is not None:
            own += of_a_radian * (2.0 - 2.0 * (M.rotation @ t.axis) @ t.direction)
        total += t.weight**2 * own
    return total


def questions():
    panda, pr2, zoo = load_quietly("panda"), load_quietly("pr2"), load_quietly(ZOO, root="free_flyer")
    pose = panda.placement("panda_hand_tcp", panda.random(1))
    tool = pinocchio.SE3(pinocchio.exp3(np.array([0.3, 0.2, 0.1])), np.array([0.1, 0.0, 0.2]))
    return {
        "pose": (panda, [Target("panda_hand_tcp", placement=pose)]),
        "position": (panda, [Target("panda_hand_tcp", [0.4, 0.2, 0.5])]),
        "axis and tool": (panda, [Target("panda_link7", [0.4, 0, 0.5], axis="z", direction=[1, 0, -1], tool=tool)]),
        "two hands": (
            pr2,
            [
                Target("l_gripper_tool_frame", [0.6, 0.3, 0.9]),
                Target("r_gripper_tool_frame", [0.6, -0.3, 0.9], axis="x", direction=[1, 0, 0], weight=0.5),
            ],
        ),
        "hand to hand": (pr2, [Target("l_gripper_tool_frame", [0.1, 0.2, 0], relative_to="r_gripper_tool_frame")]),
        "every joint": (zoo, [Target("tip", [0.5, 0.2, 0.4]), Target("hand", rotation=np.eye(3))]),
    }


@pytest.mark.parametrize("limits", [True, False])
@pytest.mark.parametrize("name", questions())
def test_starts_are_the_tables_nearest_the_nearest_first(name, limits):
    robot, targets = questions()[name]
    q0 = robot.random(7)
    known = table(robot, targets, q0, limits=limits)
    distances = np.array([squared_distance(robot, targets, q) for q in known])
    got = sequence(starts_of(robot, targets, limits=limits), q0)
    expected = np.argsort(distances, kind="stable")[:NEAREST]
    np.testing.assert_allclose([squared_distance(robot, targets, q) for q in got], distances[expected], atol=1e-10)
    np.testing.assert_array_equal(got, known[expected])
    if limits:
        free = [j for j in robot.joints if j.has_one_axis and j.nq == 1]
        assert all(j.lower <= q[j.idx_q] <= j.upper for q in got for j in free)


def test_the_table_is_told_apart_by_the_seed_and_by_nothing_else(panda):
    pose = [Target("panda_hand_tcp", [0.4, 0.2, 0.5])]
    q0 = panda.random(1)
    first = sequence(starts_of(panda, pose), q0)
    np.testing.assert_array_equal(first, sequence(starts_of(panda, pose), q0, target=3))
    used = starts_of(panda, [Target("panda_hand_tcp", [0.1, 0.1, 0.9])])
    sequence(used, panda.random(2), count=5)
    used._kinematics.retarget(pose)
    np.testing.assert_array_equal(first, sequence(used, q0))
    other = sequence(starts_of(panda, pose, seed=1), q0)
    drawn = [0, 1, 2, 3, 4, 5, 6]
    assert not np.isclose(first[:, drawn], other[:, drawn]).all(axis=1).any()


def test_starts_beyond_the_nearest_are_drawn_by_attempt_target_and_seed(panda):
    pose = [Target("panda_hand_tcp", [0.4, 0.2, 0.5])]
    q0, problem = panda.random(1), Problem(panda, pose)
    starts = starts_of(panda, pose, seed=4)
    sequence(starts, q0, count=2)
    for number in (NEAREST + 1, NEAREST + 2, 60):
        for target in (0, 9):
            drawn = starts.next(q0, target=target, number=number)
            expected = random_start(problem, Limits.of(panda), q0, seed=4, target=target, attempt=number)
            np.testing.assert_array_equal(drawn, expected)


def test_what_is_not_drawn_is_as_in_the_start():
    """Locked joints, those that move no target, floating ones: and the table is for where they are."""
    zoo = load_quietly(ZOO, root="free_flyer")
    targets = [Target("tip", [0.5, 0.2, 0.4])]
    starts = starts_of(zoo, targets, locked=["l_hinge"])
    turn = zoo.joint("k_turn").idx_q
    drawn = [turn, turn + 1, zoo.joint("m_slide").idx_q]
    for seed in (1, 2, 3):
        q0 = zoo.random(seed)
        got = sequence(starts, q0, count=6)
        for q in got:
            np.testing.assert_array_equal(np.delete(q, drawn), np.delete(q0, drawn))
            assert (q[drawn] != q0[drawn]).all()
        distances = [squared_distance(zoo, targets, q) for q in got]
        assert distances == sorted(distances)
        np.testing.assert_array_equal(got, sequence(starts_of(zoo, targets, locked=["l_hinge"]), q0, count=6))


@pytest.mark.parametrize("engine", ["python", pytest.param("native", marks=needs_native)])
def test_nearest_begins_where_the_table_says(engine, panda):
    rng = np.random.default_rng(5)
    ask = pinik.prepare(panda, Target("panda_hand_tcp", placement=np.eye(4)), engine=engine, trace=True, seed=2)
    for _ in range(5):
        target = Target("panda_hand_tcp", placement=panda.placement("panda_hand_tcp", panda.random(rng)))
        expected = sequence(starts_of(panda, [target], seed=2), panda.neutral(), count=1)[0]
        lower = np.delete(np.arange(8), panda.joint("panda_finger_joint1").idx_q)
        for s in (ask(target, "nearest"), panda.solve(target, q0="nearest", engine=engine, trace=True, seed=2)):
            np.testing.assert_allclose(s.trace[0].q[lower], expected[lower], atol=1e-15)


@needs_native
@pytest.mark.parametrize("q0", ["given", "nearest"])
@pytest.mark.parametrize("name", questions())
def test_both_engines_begin_their_attempts_at_the_same_configurations(name, q0):
    """Those of the table, then (after 32) drawn ones."""
    robot, targets = questions()[name]
    start = Limits.of(robot).clip(robot.random(9))
    asked = {"restarts": 36, "max_iterations": 1, "tolerance": (1e-12, 1e-12), "trace": True, "seed": 3}
    ours, theirs = (
        pinik.solve(robot, targets, q0=start if q0 == "given" else q0, engine=engine, **asked).trace
        for engine in ("native", "python")
    )
    firsts = [[state for state in states if state.iteration == 0][:37] for states in (ours, theirs)]
    assert len(firsts[0]) == len(firsts[1]) == 37
    for k, (a, b) in enumerate(zip(*firsts, strict=True)):
        assert a.attempt == b.attempt == k
        np.testing.assert_allclose(a.q, b.q, atol=1e-14)
