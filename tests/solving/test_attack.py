"""A small part of the attack on solves; `python tools/attack_solves.py` runs as much of it as wanted."""

from __future__ import annotations

import collections

import numpy as np
import pinocchio
import pytest

import pinik
import solve_attack
from by_hand import link_placements, random_placement
from pinik import Status
from plain_certificate import plain_errors
from random_trees import random_tree
from robots import load_quietly
from solve_attack import FaultyAnswerError, Question, attack, check


def test_answers_to_anything_asked_of_any_robot_are_as_they_must_be():
    """Robots of up to 60 joints, some 800 solves by all methods and both engines."""
    counts: collections.Counter[str] = collections.Counter()
    for number in range(25):
        counts += attack(2026, number)
    print(dict(counts))
    assert counts["solves"] == 25 * solve_attack.QUESTIONS * (solve_attack.SOLVES + 2)
    for method in solve_attack.METHODS:
        assert sum(count for name, count in counts.items() if name.startswith(method) and name.endswith("solved")) > 8


def test_the_robots_are_of_every_kind_and_where_the_matrices_of_their_files_say():
    kinds: collections.Counter[str] = collections.Counter()
    for number in range(40):
        rng = np.random.default_rng([7, number])
        text = random_tree(rng)
        robot = load_quietly(text)
        if len(robot.mimics) < text.count("<mimic"):
            continue  # a follower is left free, with a warning
        kinds.update(joint.kind for joint in robot.joints)
        kinds["followers"] += len(robot.mimics)
        placements = {j.name: random_placement(rng, j.kind) for j in robot.joints if not j.has_one_axis}
        q = robot.configuration(robot.angles(robot.random(rng)), placements)
        expected = link_placements(text, robot.angles(q), placements)
        for link, placement in expected.items():
            scale = max(1.0, np.abs(placement).max())
            assert np.allclose(robot.placement(link, q).homogeneous, placement, atol=1e-11 * scale), (number, link)
    assert min(kinds[kind] for kind in ("revolute", "continuous", "prismatic", "floating", "planar", "followers")) > 10


class TestTheCheckRejects:
    """The attack would find each of these: an answer is spoilt, and its check must fail."""

    @pytest.fixture
    def asked(self, panda):
        q0 = panda.neutral()
        target = pinik.Target("panda_link5", panda.placement("panda_link5", panda.random(3)).translation)
        options = {"limits": True, "locked": (), "tolerance": (1e-4, 1e-3), "engine": "python"}
        solution = pinik.prepare(panda, target, **options)(target, q0)
        question = Question(panda, [target], "dls", {}, options, [q0])
        check(question, solution, q0)
        return question, solution, q0

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
    def test_a_spoilt_answer(self, spoil, words, asked):
        question, solution, q0 = asked
        outcome = solution._came_to._replace(**spoil(solution._came_to))
        with pytest.raises(FaultyAnswerError, match=words):
            check(question, pinik.Solution(outcome, solution._question), q0)


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
