"""Frames one after another in few bytes, for files: neighbours differ little, so their differences compress well."""

from __future__ import annotations

import zlib

import numpy as np

__all__ = ["EXACT", "deflated", "packed_frames"]

EXACT = 6
"""The numbers at the beginning of a frame that stay exact: the magic bytes, and the five of the header."""
_ROUNDED = 8  # bits of the 23 of a number's mantissa; what is left is exact to 15 µm at a metre
_LEVEL = 1  # higher levels save less than a tenth, and take twice the time


def packed_frames(frames: bytes, frame_bytes: int) -> bytes:
    """Pack frames of one layout.

    Each number is taken as 32 bits, rounded to 15 bits of mantissa, and replaced by its difference from the frame
    before. All first bytes of these differences follow one another, number by number, then all second bytes, and so on;
    the whole is deflated. `pinik/unpack.js` reads it.

    Args:
        frames: The frame messages, one after another.
        frame_bytes: The length of each of them, a multiple of four.
    """
    if not frames:
        return deflated(b"")
    bits = np.frombuffer(frames, "<u4").reshape(-1, frame_bytes // 4).astype(np.uint64)
    half, low = 1 << (_ROUNDED - 1), (1 << _ROUNDED) - 1
    finite = (bits & 0x7F800000) != 0x7F800000  # a NaN must stay one
    bits[:, EXACT:] = np.where(finite, (bits + half) & ~np.uint64(low), bits)[:, EXACT:]
    rounded = bits.astype("<u4")
    rounded[1:] -= rounded[:-1].copy()
    planes = np.ascontiguousarray(rounded.T).view(np.uint8).reshape(-1, 4).T
    return deflated(planes.tobytes())


def deflated(data: bytes) -> bytes:
    """Compress data into a raw deflate stream."""
    squeeze = zlib.compressobj(_LEVEL, zlib.DEFLATED, -zlib.MAX_WBITS)
    return squeeze.compress(data) + squeeze.flush()
