"""Frames as bytes, laid out as docs/live-protocol.md says."""

from __future__ import annotations

import math
import struct

import numpy as np
import pinocchio
import pytest

from pinik.viewer.protocol.packing import InstanceBlock, JointPlacements, pack_frame


def test_two_of_one_robot_do_not_disturb_each_other(panda):
    one, other = JointPlacements(panda), JointPlacements(panda)
    frames = [panda.frame_id("panda_hand_tcp"), panda.frame_id("panda_link3")]
    q, q2 = panda.random(1), panda.random(2)
    first = one.at(q)
    kept = first.copy()
    other.at(q2)
    pinocchio.forwardKinematics(panda.model, panda.data, q2)
    points = one.points(frames)
    np.testing.assert_array_equal(first, kept)
    np.testing.assert_allclose(points[0], panda.placement("panda_hand_tcp", q).translation, atol=1e-12)
    np.testing.assert_allclose(points[1], panda.placement("panda_link3", q).translation, atol=1e-12)
    kept = points.copy()
    one.at(q2)
    one.points(frames)
    np.testing.assert_array_equal(points, kept)
    assert one.points([]).shape == (0, 3)


def test_a_frame_is_laid_out_as_the_protocol_says():
    balls = np.arange(14.0).reshape(2, 7)
    blocks = [
        InstanceBlock(
            figures=[1, 0.5, math.nan, 0.001, 3, 21, 0.25, 1],
            joints=np.full((3, 7), 10.0) + np.arange(3)[:, None],
            sides=np.array([0, -1, 2]),
            points=np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]),
        ),
        InstanceBlock(np.zeros(8), np.zeros((3, 7)), np.zeros(3), np.zeros((2, 3))),
    ]
    frame = pack_frame(7, 1234, balls, blocks)
    assert frame[:4] == b"PNKF"
    numbers = struct.unpack(f"<{(len(frame) - 4) // 4}f", frame[4:])
    assert numbers[:1] + numbers[2:5] == (7, 2, 3, 2)
    assert struct.unpack_from("<I", frame, 8) == (1234,)
    assert numbers[5:19] == tuple(range(14))
    block = numbers[19 : 19 + 8 + 21 + 3 + 6]
    assert block[:2] == (1, 0.5)
    assert math.isnan(block[2])
    assert block[3:8] == pytest.approx((0.001, 3, 21, 0.25, 1))
    assert block[8:29] == (10,) * 7 + (11,) * 7 + (12,) * 7
    assert block[29:32] == (0, -1, 2)
    assert block[32:] == pytest.approx((0.1, 0.2, 0.3, 0.4, 0.5, 0.6))
    assert numbers[19 + 38 :] == (0,) * 38


def test_a_frame_without_instances_or_balls_is_only_its_header():
    assert pack_frame(1, 2, np.zeros((0, 7)), []) == b"PNKF" + struct.pack("<fI3f", 1, 2, 0, 0, 0)


@pytest.mark.parametrize(
    ("figures", "joints", "points"), [(7, 3, 1), (8, 4, 1), (8, 3, 2)], ids=["figures", "joints", "points"]
)
def test_instances_that_do_not_fit_together_are_refused(figures, joints, points):
    good = InstanceBlock(np.zeros(8), np.zeros((3, 7)), np.zeros(3), np.zeros((1, 3)))
    bad = InstanceBlock(np.zeros(figures), np.zeros((joints, 7)), np.zeros(joints), np.zeros((points, 3)))
    with pytest.raises(ValueError, match="the same number of joints and points"):
        pack_frame(1, 1, np.zeros((1, 7)), [good, bad])
