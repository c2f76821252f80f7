"""A recording keeps the last 20 seconds, at most 30 frames per second."""

from __future__ import annotations

import struct

import pytest

from stand_ins import recorded, small_frame


def steps(recording):
    count, size = len(recording), recording.frame_bytes
    assert len(recording.frames) == count * size
    return [struct.unpack_from("<4x5f", recording.frames, k * size)[1] for k in range(count)]


def test_every_second_frame_is_kept_as_it_came():
    recording = recorded(small_frame(k, mark=0.5) for k in range(7))
    assert steps(recording) == [0, 2, 4, 6]
    assert recording.frames == b"".join(small_frame(k, mark=0.5) for k in (0, 2, 4, 6))


def test_twenty_seconds_are_kept_and_no_more():
    recording = recorded(small_frame(k) for k in range(60 * 21))
    assert len(recording) == 20 * 30
    assert steps(recording) == list(range(60, 60 * 21, 2))


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
    recording.add(small_frame(3), 1.0)
    assert steps(recording) == [3]
