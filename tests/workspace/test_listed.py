"""Lists of targets: what is reached, certified by plain kinematics, and scores that mean what they say."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from judge import plain_placement
from pinik.workspace.listed import reach_targets


def test_targets_on_a_workpiece(panda):
    rng = np.random.default_rng(8)
    places = [panda.placement("panda_hand_tcp", panda.random(rng)).homogeneous for _ in range(20)]
    places.append(np.block([[np.eye(3), np.array([[2.0], [0], [0.4]])], [np.zeros(3), 1.0]]))
    answer = reach_targets(panda, "panda_hand_tcp", np.array(places))
    assert answer.reached.tolist() == [True] * 20 + [False]
    assert not answer.success
    assert (answer.score[:20] > 0).all()
    assert answer.score[20] == 0
    assert np.isnan(answer.manipulability[20])
    assert "20 of 21" in str(answer)
    for place, q, w, room in zip(places[:20], answer.q, answer.manipulability, answer.room, strict=False):
        difference = plain_placement(panda, "panda_hand_tcp", q).inverse().homogeneous @ place
        assert np.abs(difference - np.eye(4)).max() < 2e-3
        J = panda.jacobian("panda_hand_tcp", q)[:, :7]
        assert w == pytest.approx(np.prod(np.linalg.svd(J, compute_uv=False)))
        lower, upper, angles = panda.lower[:7], panda.upper[:7], q[:7]
        assert room == pytest.approx((2 * np.minimum(angles - lower, upper - angles) / (upper - lower)).min(), abs=1e-9)


def test_more_starts_never_lower_a_score(two_link):
    """Both elbows of two hinges have the same manipulability; the one nearer the middle has more room."""
    answer = reach_targets(two_link, "tip", [[0.3, 0.6, 0.0], [0.9, 0.0, 0.0]], locked=[])
    both = two_link.solve_all("tip", position=[0.3, 0.6, 0.0]).q
    rooms = [(1 - np.abs(q) / np.pi).min() for q in both]
    assert answer.room[0] == pytest.approx(max(rooms), abs=1e-4)
    assert answer.score[1] < 0.1, "a stretched arm has hardly any manipulability"
    assert answer.best == pytest.approx(0.2, rel=1e-3)


def test_several_frames_in_a_target_are_refused(arm):
    both = [[pinik.Target("tip", (0.1, 0.1, 0.9)), pinik.Target("tip", (0.1, 0.1, 0.9))]]
    with pytest.raises(pinik.InputError, match="one frame"):
        reach_targets(arm, both)
