"""Packed frames, read back byte by byte as docs/live-protocol.md says."""

from __future__ import annotations

import zlib

import numpy as np
import pytest

from pinik.viewer.protocol.packed_frames import packed_frames
from stand_ins import small_frame


def read_back(packed, frame_bytes):
    """The numbers of the frames (frames, frame_bytes / 4)."""
    data = zlib.decompress(packed, -zlib.MAX_WBITS)
    count, columns = len(data) // 4, frame_bytes // 4
    rows = count // columns
    bits = np.zeros((rows, columns), dtype=np.uint32)
    for row in range(rows):
        for column in range(columns):
            change = sum(data[plane * count + column * rows + row] << 8 * plane for plane in range(4))
            bits[row, column] = ((int(bits[row - 1, column]) if row else 0) + change) % 2**32
    return bits.view("<f4")


def frames_of(rng, count, numbers):
    header = np.tile(np.frombuffer(b"PNKF", "<f4"), (count, 1))
    steps = np.column_stack([np.full(count, 3.0), np.arange(count) + 16_000_003, np.full((count, 3), [2, 5, 1])])
    walk = np.cumsum(rng.normal(0, 0.01, (count, numbers)), axis=0)
    return np.hstack([header, steps, walk]).astype("<f4")


def test_numbers_come_back_to_within_fifteen_micrometres_a_metre_and_the_header_exactly():
    frames = frames_of(np.random.default_rng(1), 40, 30)
    frames[3, 8], frames[4, 9], frames[5, 10], frames[6, 11] = np.nan, -0.0, 1e-30, 3.0e38
    back = read_back(packed_frames(frames.tobytes(), 4 * 36), 4 * 36)
    np.testing.assert_array_equal(back[:, :6].view(np.uint32), frames[:, :6].view(np.uint32))
    np.testing.assert_allclose(back[:, 6:], frames[:, 6:], rtol=2.0**-16 * 1.001, atol=0, equal_nan=True)
    assert np.isnan(back[3, 8])


def test_a_recording_takes_a_quarter_of_its_bytes():
    frames = frames_of(np.random.default_rng(2), 600, 300)
    smooth = np.sin(np.linspace(0, 6, 600))[:, None] * np.linspace(0.1, 1, 300)
    frames[:, 6:] = smooth
    assert len(packed_frames(frames.tobytes(), 4 * 306)) < frames.nbytes / 4


def test_one_frame_and_none():
    frame = small_frame(0)
    assert read_back(packed_frames(frame, len(frame)), len(frame)).shape == (1, len(frame) // 4)
    assert zlib.decompress(packed_frames(b"", 0), -zlib.MAX_WBITS) == b""


@pytest.mark.parametrize("extra", [1, 3])
def test_bytes_that_are_no_whole_frames_are_refused(extra):
    frame = small_frame(0)
    with pytest.raises(ValueError, match="cannot reshape"):
        packed_frames(frame * 2 + b"\0" * 4 * extra, len(frame))
