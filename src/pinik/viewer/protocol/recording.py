"""A recording of the last 20 seconds of a session."""

from __future__ import annotations

import math
from collections import deque

__all__ = ["FRAMES_PER_SECOND", "SECONDS", "Recording"]

SECONDS = 20
FRAMES_PER_SECOND = 30

_PERIOD = 1.0 / FRAMES_PER_SECOND - 1e-6  # [s]; slightly less than two steps, so that rounding never skips a frame
# Frames of one layout share all header bytes but these, which hold the step; see `packing.pack_frame`.
_STEP = slice(8, 12)
_HEADER = 24


class Recording:
    """The frame messages of the last 20 s, at most 30 per second.

    All frames show the same robot with the same number of instances and balls. A frame with another layout discards
    the earlier ones.
    """

    def __init__(self) -> None:
        self._frames: deque[bytes] = deque(maxlen=SECONDS * FRAMES_PER_SECOND)
        self._layout = b""
        self._due = -math.inf

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def frames(self) -> bytes:
        """The frame messages one after another, oldest first, each `frame_bytes` long."""
        return b"".join(self._frames)

    @property
    def frame_bytes(self) -> int:
        """The length of one frame message; 0 if there is none."""
        return len(self._frames[0]) if self._frames else 0

    def add(self, frame: bytes, now: float) -> None:
        """Add a frame message from time `now` [s], unless the last one kept is too recent.

        Call this with every frame.
        """
        layout = frame[: _STEP.start] + frame[_STEP.stop : _HEADER]
        if layout != self._layout:
            self.clear()
            self._layout = layout
        if now >= self._due:
            # Count from the time that was due, so that a late frame does not slow the pace; after a pause, from now.
            self._due = max(self._due + _PERIOD, now) if self._frames else now + _PERIOD
            self._frames.append(frame)

    def clear(self) -> None:
        """Discard all frames; the next one is kept."""
        self._frames.clear()
        self._due = -math.inf
