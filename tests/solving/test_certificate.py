"""A verdict is what plain Pinocchio says of the very q that is returned, also where rounding decides."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native, python_step
from judge import judge
from pinik import Target
from plain_certificate import plain_errors
from problems import load
from random_trees import random_tree
from robots import load_quietly

ENGINES = ["python", pytest.param("native", marks=needs_native)]
ROUNDING = (1e-16, 1e-16)  # [m], [rad]
TOOL = pinocchio.SE3(pinocchio.exp3(np.array([0.3, -1.0, 0.7])), np.array([0.1, 0.05, -0.2]))


def kinds_of_targets(robot, frame, reference, rng):
    """Reachable targets of each kind, and a tool and a moving reference for some."""
    q = robot.random(rng)
    M, seen = robot.placement(frame, q), robot.placement(frame, q, reference)
    return [
        Target(frame, M.translation),
        Target(frame, placement=M),
        Target(frame, placement=seen * TOOL, tool=TOOL, relative_to=reference),
        Target(frame, [None, *M.translation[1:]]),
        Target(frame, axis="z", direction=M.rotation[:, 2]),
        Target(frame, seen.translation, axis=[1, 2, 3], at=seen.act(np.array([1.0, 2, 3])), relative_to=reference),
    ]


@needs_native
def test_of_ten_thousand_solves_to_a_tenth_of_a_femtometre_each_claim_is_plain_pinocchios():
    """Robots with axes along and across their frames, sliding, continuous, floating and mimic joints."""
    claims = 0
    for name, frame, reference in (
        ("ur5", "tool0", "shoulder_link"),
        ("panda", "panda_hand_tcp", "panda_link2"),
        ("kinova", "j2s6s200_end_effector", "j2s6s200_link_2"),
        ("zoo_free", "tip", "hand"),
        ("zoo", "hand", "base"),
    ):
        robot, rng = load(name), np.random.default_rng(1)
        for kind in range(6):
            asked = [[kinds_of_targets(robot, frame, reference, rng)[kind]] for _ in range(334)]
            options = {"tolerance": ROUNDING, "restarts": 0, "max_iterations": 25}
            many = pinik.solve_many(robot, asked, q0="nearest", engine="native", **options)
            for targets, q, success, position, orientation in zip(
                asked, many.q, many.success, many.position_error, many.orientation_error, strict=True
            ):
                ((metres, radians, _),) = plain_errors(robot, targets, q, ROUNDING)
                said = (position, orientation)
                for one, other in zip(said, (metres, radians), strict=True):
                    assert one == other or (math.isnan(one) and other is None), (name, kind, said, metres, radians)
                assert success == ((metres or 0.0) <= 1e-16 and (radians or 0.0) <= 1e-16)
                claims += int(success)
    print(claims)
    assert claims > 300


@needs_native
@pytest.mark.parametrize("name", ["panda", "ur5", "kinova"])
@pytest.mark.parametrize("tolerance", [1e-14, 5e-15])
def test_down_to_a_few_units_of_rounding_both_engines_claim_the_same_of_an_arm_of_a_metre(name, tolerance):
    """Below, each engine's own rounding decides where its steps end, and so what it can claim."""
    robot, rng = load(name), np.random.default_rng(2)
    frame = {"panda": "panda_hand_tcp", "ur5": "tool0", "kinova": "j2s6s200_end_effector"}[name]
    places = np.array([robot.placement(frame, robot.random(rng)).homogeneous for _ in range(60)])
    starts = np.array([robot.random(rng) for _ in range(60)])
    options = {"q0": starts, "tolerance": (tolerance, tolerance), "restarts": 0, "max_iterations": 60}
    by_python, by_native = (
        pinik.solve_many(robot, frame, places, engine=engine, **options).success for engine in ("python", "native")
    )
    np.testing.assert_array_equal(by_native, by_python)
    assert by_python.sum() > 20


@needs_native
def test_both_engines_measure_the_same_bits_on_any_robot():
    for number in range(30):
        rng = np.random.default_rng([5, number])
        robot = load_quietly(random_tree(rng))
        frame, other = (str(name) for name in rng.choice(robot.frame_names, 2))
        floats = not all(joint.has_one_axis for joint in robot.joints)
        for target in kinds_of_targets(robot, frame, other, rng):
            start = robot.random(rng)
            for engine in () if floats else ("python", "native"):  # nothing moves, so that both judge the start
                options = {"restarts": 0, "locked": robot.joint_names}
                solution = pinik.prepare(robot, target, engine=engine, **options)(target, start)
                ((metres, radians, _),) = plain_errors(robot, [target], solution.q, (1.0, 1.0))
                assert solution.errors[0] == (metres, radians), (number, target)


@pytest.mark.parametrize("engine", ENGINES)
def test_joints_that_do_not_move_the_target_keep_every_bit_of_a_start(engine):
    kinova = load("kinova")
    for seed in range(20):
        start = kinova.random(seed)
        for method in ("dls", "ccd"):
            target = Target(
                "j2s6s200_link_2", kinova.placement("j2s6s200_link_2", kinova.random(seed + 50)).translation
            )
            q = pinik.prepare(kinova, target, method, engine=engine, restarts=0)(target, start).q
            assert q[3:].tobytes() == start[3:].tobytes()  # after the second joint; two of these joints are (cos, sin)


class TestAnAxisTowardsAPointThatItsFrameNearlyTouches:
    """docs/targets.md: nearer than 1e-6 m the frame counts as pointing at the point; farther away, the angle counts."""

    @pytest.mark.parametrize("engine", ENGINES)
    @pytest.mark.parametrize("distance", [0.0, 1e-12, 1e-9, 0.9e-6, 1.1e-6, 1e-5])
    def test_both_engines_and_the_judge_say_the_same(self, distance, engine, panda):
        names = ("ccd", "jt", "pinv", "dls")
        rng = np.random.default_rng(2)
        for method in names:
            q = panda.random(rng)
            M = panda.placement("panda_hand_tcp", q)
            away = M.rotation @ np.array([0.0, 1.0, 0.0])  # a right angle to the axis
            target = Target("panda_hand_tcp", axis="z", at=M.translation + distance * away)
            solution = pinik.prepare(panda, target, method, engine=engine, restarts=0, max_iterations=1)(target, q)
            found = judge(panda, target, solution.q).orientation
            assert solution.orientation_error == pytest.approx(found, abs=1e-8)
            if distance < 1e-6:
                assert (found, solution.success, solution.iterations) == (0.0, True, 0)

    @pytest.mark.parametrize("engine", ENGINES)
    def test_such_a_frame_is_drawn_nowhere(self, engine, panda):
        q = panda.random(4)
        M = panda.placement("panda_hand_tcp", q)
        still = [
            Target("panda_hand_tcp", M.translation, axis="z", at=M.translation + 5e-7),
            Target("panda_link3", [0, 0, 9]),
        ]
        traced = pinik.prepare(panda, still, "dls", engine=engine, restarts=0, trace=True, max_iterations=1)(still, q)
        assert traced.trace[0].errors[0].orientation == 0.0


@needs_native
@pytest.mark.parametrize("cutoff", [0.0, 1e-12, 1e-10])
def test_a_singular_value_that_is_mostly_rounding_moves_neither_engine(cutoff, ur5):
    """A wrist a trillionth off its singular configuration: along that singular value no step is taken."""
    q = ur5.configuration({"shoulder_lift_joint": -1.0, "elbow_joint": 1.0, "wrist_2_joint": 1e-11})
    M = ur5.placement("tool0", q)
    target = Target(
        "tool0", placement=pinocchio.SE3(pinocchio.exp3(np.array([0.1, 0.2, 0.3])) @ M.rotation, M.translation)
    )
    options = {"cutoff": cutoff, "max_step": None, "restarts": 0, "max_iterations": 1, "limits": False}
    native = pinik.prepare(ur5, target, "pinv", engine="native", trace=True, **options)(target, q).trace[1].q
    python = python_step(pinik.prepare(ur5, target, "pinv", engine="python", **options))(q)
    assert np.abs(native - q).max() < 10.0
    assert np.abs(native - python).max() < 1e-9


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("method", ["dls", "pinv", "jt", "ccd"])
def test_no_warning_of_numpy_leaks_from_steps_and_ranges_without_bounds(method, engine):
    """Limits as wide as numbers go, a target far away, and steps of any length."""
    wide = load_quietly("""<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
      <joint name="j" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
        <limit lower="-1.7e308" upper="1.7e308" effort="1" velocity="1"/></joint>
      <joint name="k" type="revolute"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/>
        <limit lower="-1e308" upper="1.7e308" effort="1" velocity="1"/></joint></robot>""")
    parameters = {"jt": {"alpha": 1e3}, "pinv": {"cutoff": 0.0}, "dls": {"damping": 1e-9}, "ccd": {}}[method]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        wide.random(0)
        for limits in (True, False):
            solution = wide.solve(
                "c", position=[3.0, 0.0, 9e8], method=method, engine=engine, limits=limits, max_step=None,
                max_iterations=200, restarts=3, **parameters,
            )  # fmt: skip
            assert np.isfinite(solution.q).all()
            str(solution)


class Runaway(pinik.JacobianSolver):
    """A method whose steps have no bound, or are no numbers."""

    step_is: float = 0.0

    def direction(self, J, e):
        return np.full(J.shape[1], type(self).step_is)


@pytest.mark.parametrize("step", [math.nan, math.inf, -math.inf, 1e308, 1e200])
def test_a_step_that_is_no_step_is_not_taken_and_warns_of_nothing(step, panda):
    Runaway.step_is = step
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solution = panda.solve("panda_hand_tcp", position=[0.4, 0.0, 0.5], method=Runaway, locked=["panda_joint1"],
                               restarts=0, limits=False)  # fmt: skip
    assert solution.status is pinik.Status.STALLED
    assert np.array_equal(solution.q, panda.neutral())
