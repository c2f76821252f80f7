"""A run whose targets move has the same states in either engine, one after the other."""

from __future__ import annotations

import collections

import numpy as np
import pinocchio
import pytest

import pinik
from engines import distance, needs_native
from pinik import Status, Target, Tolerance
from pinik.solvers.registry import SOLVERS
from pinik.solving.options import Options
from pinik.solving.pursuit import pursue
from pinik.solving.question import Question
from problems import load

METHODS = ("ccd", "jt", "pinv", "dls")
DRIFT = 1e-6
"""How far the engines may be apart after some tens of steps [rad or m], since roundings spread."""


def pursuits(robot, targets, method, start, most=20, **options):
    """The same pursuit in the compiled engine and in Python."""
    made = []
    for engine in ("native", "python"):
        asked = Options(SOLVERS[method].make(), engine=engine, **options)
        made.append(pursue(Question.of(robot, targets, asked), start, most))
    assert [pursuit.engine for pursuit in made] == ["native", "python"]
    return made


def moving(robot, frames, rng, *, oriented=False, tolerance=None):
    """Targets for frames, near the places that they have at some configuration, and a little elsewhere at each call."""
    q = robot.random(rng)
    places = [robot.placement(frame, q) for frame in frames]

    def now():
        targets = []
        for frame, place in zip(frames, places, strict=True):
            place.translation = place.translation + 0.01 * rng.standard_normal(3)
            place.rotation = place.rotation @ pinocchio.exp3(0.02 * rng.standard_normal(3))
            asked = {"placement": place} if oriented else {"position": place.translation}
            targets.append(Target(frame, tolerance=tolerance, **asked))
        return tuple(targets)

    return now


def same_states(one, other, drift=DRIFT):
    assert (one.iteration, one.joint_updates, one.status) == (other.iteration, other.joint_updates, other.status)
    assert one.residual == pytest.approx(other.residual, abs=drift)
    for error, its in zip(one.errors, other.errors, strict=True):
        for mine, theirs in zip(error[:2], its[:2], strict=True):
            assert (mine is None) == (theirs is None)
            assert mine is None or mine == pytest.approx(theirs, abs=10 * drift)


CASES = [
    ("arm", ("tip",), {}),
    ("panda", ("panda_hand_tcp",), {"oriented": True}),
    ("ur5", ("tool0",), {"oriented": True}),
    ("lion_free", ("left_fore_paw", "right_fore_paw"), {}),
]


@needs_native
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("name", "frames", "kinds"), CASES)
def test_states_are_the_same_while_targets_move(name, frames, kinds, method):
    robot = load(name)
    rng = np.random.default_rng(3)
    statuses: collections.Counter[Status | None] = collections.Counter()
    parted = 0
    for _ in range(6):
        now = moving(robot, frames, rng, **kinds)
        ours, theirs = pursuits(robot, now(), method, robot.random(rng), polish=bool(rng.integers(2)))
        same_states(ours.state, theirs.state)
        for _ in range(5):
            targets = now()
            ours.aim_at(targets), theirs.aim_at(targets)
            for _ in range(4):
                if distance(robot, ours.state.q, theirs.state.q) > DRIFT:
                    break
                same_states(ours.state, theirs.state)
                statuses[ours.state.status] += 1
                ours.advance(1), theirs.advance(1)
        parted += distance(robot, ours.state.q, theirs.state.q) > DRIFT
    print(dict(statuses), parted)
    assert parted <= 1  # a step at a threshold, such as that of a limit
    assert sum(statuses.values()) > 60


def followed(ours, theirs, path, robot, steps, drift=DRIFT):
    """Lead both pursuits along a path of targets, compare all states, and return how often each status came."""
    statuses: collections.Counter[Status | None] = collections.Counter()
    for targets in path:
        ours.aim_at(targets), theirs.aim_at(targets)
        for _ in range(steps):
            same_states(ours.state, theirs.state, drift)
            assert distance(robot, ours.state.q, theirs.state.q) < drift
            statuses[ours.state.status] += 1
            ours.advance(1), theirs.advance(1)
    return statuses


@needs_native
@pytest.mark.parametrize("method", METHODS)
def test_a_wide_tolerance_is_used_once_the_targets_move_or_the_run_stalls(method):
    robot = load("ur5")
    rng = np.random.default_rng(5)
    place = robot.placement("tool0", robot.random(rng)).translation
    wide = Tolerance((0.3, 0.3, 1e-4), 0.01)
    beside = [place - 0.02 * k * place for k in range(5)]
    path = [(Target("tool0", position=at, rpy=[0.1 * k, 0.0, 0.0], tolerance=wide),) for k, at in enumerate(beside)]
    start = robot.random(rng)
    ours, theirs = pursuits(robot, path[0], method, start, most=30)
    followed(ours, theirs, [*path, path[-1], path[-1]], robot, 15)
    narrow = [(pinik.Target("tool0", position=t.position, rotation=t.rotation),) for (t,) in path]
    exact, _ = pursuits(robot, narrow[0], method, start, most=30)
    for targets in [*narrow, narrow[-1], narrow[-1]]:
        exact.aim_at(targets)
        exact.advance(15)
    assert distance(robot, exact.state.q, ours.state.q) > 1e-3  # the wide tolerance was used


@needs_native
@pytest.mark.parametrize("method", METHODS)
def test_out_of_reach_and_back_again(method):
    robot = load("arm")
    near = robot.placement("tip", robot.random(np.random.default_rng(2))).translation
    path = [(Target("tip", position=factor * near),) for factor in (1.0, 20.0, 30.0, 1.0)]
    ours, theirs = pursuits(robot, path[0], method, robot.neutral(), most=5)
    statuses = followed(ours, theirs, path, robot, 8)
    assert statuses[Status.MAX_ITERATIONS] > 0  # five steps do not suffice out of reach


@needs_native
def test_the_same_targets_again_do_not_interrupt_the_wait_for_a_stall():
    robot = load("ur5")
    start = robot.random(np.random.default_rng(1))
    wide = Tolerance((0.02, 0.02, 0.001), 0.01)
    far = (Target("tool0", position=[0.7, 0.5, 0.5], rpy=[0.3, 2.0, 0.5], tolerance=wide),)  # reach, but not so turned
    ours, theirs = pursuits(robot, far, "ccd", start, 200)
    followed(ours, theirs, [far] * 6, robot, 30)
    narrow = (Target("tool0", position=far[0].position, rotation=far[0].rotation),)
    exact, _ = pursuits(robot, narrow, "ccd", start, 200)
    for _ in range(6):
        exact.aim_at(narrow)
        exact.advance(29)
    assert distance(robot, exact.state.q, ours.state.q) > 1e-3  # it has waited, and then used the wide tolerance


@needs_native
def test_many_steps_at_once_end_where_single_steps_do():
    robot = load("panda")
    rng = np.random.default_rng(4)
    now = moving(robot, ("panda_hand_tcp",), rng, oriented=True)
    start = robot.random(rng)
    single, _ = pursuits(robot, now(), "dls", start, most=100)
    whole, _ = pursuits(robot, (single_target := now()), "dls", start, most=100)
    single.aim_at(single_target), whole.aim_at(single_target)
    while single.state.status is None:
        single.advance(1)
    whole.advance(1000)
    assert whole.state.status is Status.CONVERGED
    assert whole.state.iteration == single.state.iteration
    assert (whole.state.q == single.state.q).all()
    pinocchio.framesForwardKinematics(robot.model, robot.data, whole.state.q)
    at = robot.data.oMf[robot.model.getFrameId("panda_hand_tcp")].translation
    assert np.linalg.norm(at - single_target[0].position) < 1e-4


def test_a_method_of_ones_own_runs_in_python():
    class Own(pinik.DampedLeastSquares):
        name = "own"

    robot = load("arm")
    target = Target("tip", position=robot.placement("tip", robot.random(np.random.default_rng(0))).translation)
    own = pursue(Question.of(robot, target, Options(Own.make())), robot.neutral(), 200)
    assert own.engine == "python"
    assert own.advance(200).status is Status.CONVERGED
    with pytest.raises(pinik.EngineError, match="written in Python"):
        pursue(Question.of(robot, target, Options(Own.make(), engine="native")), robot.neutral(), 200)
