"""A recording keeps the last 20 seconds of a session's own time, in 30 frames per second."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from pinik.viewer.protocol.packing import InstanceBlock, pack_frame
from pinik.viewer.protocol.recording import Recording
from stand_ins import recorded, small_frame


def steps(recording):
    count, size = len(recording), recording.frame_bytes
    assert len(recording.frames) == count * size
    return [struct.unpack_from("<8xI", recording.frames, k * size)[0] for k in range(count)]


def test_every_second_frame_is_kept_as_it_came():
    recording = recorded(small_frame(k, mark=0.5) for k in range(7))
    assert steps(recording) == [0, 2, 4, 6]
    assert recording.frames == b"".join(small_frame(k, mark=0.5) for k in (0, 2, 4, 6))


def test_no_frame_is_lost_after_any_number_of_steps():
    for first in (2**24, 2**31, 2**32 - 8):
        recording = recorded(small_frame(first + k) for k in range(8))
        assert steps(recording) == [first, first + 2, first + 4, first + 6]


def test_twenty_seconds_are_kept_and_no_more():
    recording = recorded(small_frame(k) for k in range(60 * 21))
    assert len(recording) == 20 * 30
    assert steps(recording) == list(range(60, 60 * 21, 2))


def test_its_time_is_that_of_the_steps():
    recording = recorded(small_frame(k) for k in (100, 102, 103, 104, 105, 106, 107))
    assert steps(recording) == [100, 102, 104, 106]
    np.testing.assert_allclose(recording.times, np.arange(4) / 30)


def test_a_pause_without_frames_is_no_slow_motion():
    """Nothing moves for five seconds, and then the ball is put elsewhere."""
    recording, block = Recording(), InstanceBlock(np.zeros(8), np.ones((2, 7)), np.ones(2), np.ones((1, 3)))
    for step, place in ((0, 0.1), (2, 0.2), (302, 0.9), (304, 1.0)):
        recording.add(pack_frame(1, step, np.full((1, 7), place), [block]), [np.full(2, place)])
    np.testing.assert_allclose(recording.times, [0.0, 2 / 60, 5.0, 302 / 60, 304 / 60])
    np.testing.assert_allclose(recording.q[0, :, 0], [0.1, 0.2, 0.2, 0.9, 1.0])
    np.testing.assert_allclose(recording.balls[0, :, 0], [0.1, 0.2, 0.2, 0.9, 1.0], atol=1e-7)


def test_after_a_reset_time_goes_on():
    recording = recorded(small_frame(k) for k in (50, 52, 0, 1, 2, 4))
    assert steps(recording) == [50, 52, 0, 2, 4]
    np.testing.assert_allclose(recording.times, np.arange(5) / 30)


def test_steps_that_are_missing_take_their_time_too():
    recording = recorded(small_frame(10 * k) for k in range(200))
    assert steps(recording) == list(range(800, 2000, 10))
    assert recording.times[-1] == pytest.approx(1190 / 60)


def test_configurations_and_balls_are_those_of_the_frames():
    recording = Recording()
    rng = np.random.default_rng(3)
    q, balls = rng.uniform(-1.0, 1.0, (2, 5, 4)), rng.uniform(-1.0, 1.0, (3, 5, 7))
    block = InstanceBlock(np.zeros(8), np.ones((2, 7)), np.ones(2), np.ones((3, 3)))
    for k in range(5):
        recording.add(pack_frame(1, 2 * k, balls[:, k], [block, block]), list(q[:, k]))
    np.testing.assert_array_equal(recording.q, q)
    np.testing.assert_allclose(recording.balls, balls, atol=1e-7)


@pytest.mark.parametrize(
    "change",
    [{"generation": 2}, {"instances": 4}, {"joints": 3}, {"balls": 2}, {"instances": 2, "generation": 2}],
    ids=str,
)
def test_a_frame_of_another_layout_starts_anew(change):
    changed = [small_frame(k, **change) for k in (5, 6, 7)]
    recording = recorded([*map(small_frame, range(5)), *changed])
    assert steps(recording) == [5, 7]
    assert recording.frame_bytes == len(changed[0])


def test_what_was_cleared_is_gone_and_the_next_frame_kept():
    recording = recorded(small_frame(k) for k in range(3))
    recording.clear()
    assert (len(recording), recording.frames, recording.frame_bytes) == (0, b"", 0)
    recording.add(small_frame(3), [])
    assert steps(recording) == [3]
