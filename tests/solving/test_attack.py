"""A small part of the attack on solves; `python tools/attack_solves.py` runs as much of it as wanted."""

from __future__ import annotations

import collections
from dataclasses import replace

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import joint_axes, link_placements, random_placement
from pinik import Status
from plain_certificate import plain_error_rows, plain_errors
from random_questions import METHODS, Question, random_question
from random_trees import random_tree
from robots import load_quietly
from solve_attack import FaultyAnswerError, attack, check, check_many


def test_answers_to_anything_asked_of_any_robot_are_as_they_must_be():
    """Robots of up to 60 joints, some 5,000 solves by all methods and both engines."""
    counts: collections.Counter[str] = collections.Counter()
    for number in range(25):
        counts += attack(2026, number)
    print(dict(counts))
    assert counts["solves"] > 4000
    for ending in (*(f"{method} native converged" for method in METHODS), "python converged", "unreachable", "stalled"):
        assert sum(count for name, count in counts.items() if name.endswith(ending)) > 0, ending


def test_errors_in_arrays_are_those_of_one_configuration_after_the_other():
    """The arrays by which the attack measures many answers, against the certificate of one."""
    kinds: collections.Counter[str] = collections.Counter()
    for number in range(40):
        rng = np.random.default_rng([11, number])
        question = random_question(load_quietly(random_tree(rng)), rng)
        robot, tolerance = question.robot, question.options["tolerance"]
        q = np.array([robot.random(rng) for _ in question.sets])
        rows = plain_error_rows(robot, question.sets, q)
        for i, targets in enumerate(question.sets):
            for found, errors in zip(plain_errors(robot, targets, q[i], tolerance), rows, strict=True):
                pairs = zip(found[:2], (errors.metres, errors.radians), (errors.blur, errors.turn_blur), strict=True)
                for name, (one, many, blur) in zip(("metres", "radians"), pairs, strict=True):
                    assert (one is None) is (many is None)
                    if one is not None:
                        assert abs(one - many[i]) <= blur[i]
                        kinds[name] += 1
                if found[2] is not None:
                    assert np.allclose(found[2], errors.offsets[i], rtol=0.0, atol=errors.blur[i])
                    kinds["offsets"] += 1
    assert min(kinds[name] for name in ("metres", "radians", "offsets")) > 50


def test_the_robots_are_of_every_kind_and_where_the_matrices_of_their_files_say():
    kinds: collections.Counter[str] = collections.Counter()
    for number in range(80):
        rng = np.random.default_rng([7, number])
        text = random_tree(rng)
        robot = load_quietly(text)
        if len(robot.mimics) < text.count("<mimic"):
            continue  # a follower is left free, with a warning
        kinds.update(joint.kind for joint in robot.joints)
        kinds["followers"] += len(robot.mimics)
        axes = joint_axes(text)
        moved = [j for j in robot.joints if not j.has_one_axis]
        placements = {j.name: random_placement(rng, j.kind, axes[j.name]) for j in moved}
        q = robot.configuration(robot.angles(robot.random(rng)), placements)
        expected = link_placements(text, robot.angles(q), placements)
        for link, placement in expected.items():
            scale = max(1.0, np.abs(placement).max())
            assert np.allclose(robot.placement(link, q).homogeneous, placement, atol=1e-11 * scale), (number, link)
    assert min(kinds[kind] for kind in ("revolute", "continuous", "prismatic", "floating", "planar", "followers")) > 10


class TestTheCheckRejects:
    """The attack would find each of these: an answer is spoilt, and its check must fail."""

    @pytest.fixture
    def question(self, panda):
        places = [panda.placement("panda_link5", panda.random(seed)).translation for seed in (3, 4, 5, 6)]
        options = {"limits": True, "locked": (), "tolerance": (1e-4, 1e-3), "engine": "python"}
        sets = [[pinik.Target("panda_link5", place)] for place in places]
        return Question(panda, sets, "dls", {}, options, [panda.neutral()] * 4)

    @pytest.mark.parametrize(
        ("spoil", "words"),
        [
            (lambda out: {"q": np.where(np.arange(8) == 2, np.nan, out.q)}, "not finite"),
            (lambda out: {"status": Status.STALLED}, "plain Pinocchio finds"),
            (lambda out: {"errors": (pinik.TargetError(2e-4, None),)}, "the judge"),
            (lambda out: {"q": out.q + np.eye(8)[6] * 1e-15}, "must stay"),
            (lambda out: {"q": out.q + np.eye(8)[6] * 9.0}, "outside the limits"),
            (lambda out: {"q": out.q + np.eye(8)[0]}, "plain Pinocchio finds"),
        ],
    )
    def test_a_spoilt_answer(self, spoil, words, question):
        [target] = question.sets[0]
        solution = pinik.prepare(question.robot, target, **question.options)(target, question.starts[0])
        check(question, solution, 0)
        outcome = solution._came_to._replace(**spoil(solution._came_to))
        with pytest.raises(FaultyAnswerError, match=words):
            check(question, pinik.Solution(outcome, solution._question), 0)

    @pytest.mark.parametrize(
        ("spoil", "words"),
        [
            (lambda out: {"q": np.where(np.arange(8) == 2, np.nan, out.q)}, "not finite"),
            (lambda out: {"status": np.where(np.arange(4) == 2, Status.STALLED, out.status)}, "plain Pinocchio finds"),
            (lambda out: {"position_error": out.position_error + 1e-9}, "it says .*, plain Pinocchio finds"),
            (lambda out: {"orientation_error": np.zeros(4)}, "where nothing was asked"),
            (lambda out: {"q": out.q + np.eye(4, 8, 5) * 1e-15}, "must stay"),
            (lambda out: {"q": out.q + np.eye(4, 8, 5) * 9.0}, "outside the limits"),
            (lambda out: {"q": out.q + np.eye(4, 8)}, "plain Pinocchio finds"),
        ],
    )
    def test_a_spoilt_answer_among_many(self, spoil, words, question):
        many = pinik.solve_many(question.robot, question.sets, q0=np.array(question.starts), **question.options)
        check_many(question, many)
        with pytest.raises(FaultyAnswerError, match=words):
            check_many(question, replace(many, **spoil(many)))


def test_plain_pinocchio_agrees_with_a_hand_on_a_tool_in_a_moving_frame(panda):
    """The certificate that the attack compares claims with is itself compared with matrices multiplied here."""
    q = panda.random(5)
    tool = pinocchio.SE3(pinocchio.exp3(np.array([0.1, 0.2, 0.3])), np.array([0.0, 0.1, 0.2]))
    target = pinik.Target("panda_hand_tcp", [0.1, None, 0.3], axis="y", at=[1.0, 2.0, 3.0], tool=tool,
                          relative_to="panda_link2")  # fmt: skip
    M = np.linalg.inv(panda.placement("panda_link2", q).homogeneous) @ panda.placement("panda_hand_tcp", q).homogeneous
    M = M @ tool.homogeneous
    line = np.array([1.0, 2.0, 3.0]) - M[:3, 3]
    ((metres, radians, offset),) = plain_errors(panda, [target], q, ((1.0, 1.0, 1.0), 1.0))
    assert metres == pytest.approx(np.hypot(M[0, 3] - 0.1, M[2, 3] - 0.3), abs=1e-14)
    assert offset == pytest.approx((0.1 - M[0, 3], 0.0, 0.3 - M[2, 3]), abs=1e-14)
    assert radians == pytest.approx(np.arccos(line @ M[:3, 1] / np.linalg.norm(line)), abs=1e-12)
