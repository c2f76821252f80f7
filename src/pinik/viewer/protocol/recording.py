"""A recording of the last 20 seconds of a session."""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..simulation.session import STEPS_PER_SECOND

__all__ = ["FRAMES_PER_SECOND", "SECONDS", "Recording"]

Array = NDArray[np.float64]

SECONDS = 20
FRAMES_PER_SECOND = 30

_BETWEEN = STEPS_PER_SECOND // FRAMES_PER_SECOND  # steps from one frame to the next
# Frames of one layout share all header bytes but these, which hold the step; see `packing.pack_frame`.
_STEP = slice(8, 12)
_BALLS = 20  # where their number is
_HEADER = 24


class _Moment(NamedTuple):
    """A frame that is kept: its bytes, its step, the steps since recordings began, and the configurations."""

    frame: bytes
    step: int
    at: int
    q: Array


class Recording:
    """The frame messages of the last 20 s, one for every second step, and the configurations that they show.

    Its time is that of the session, whose steps take a 60th of a second each, however long they took to compute.

    All frames show the same robot with the same number of instances and balls. A frame with another layout discards
    the earlier ones.
    """

    def __init__(self) -> None:
        self._moments: deque[_Moment] = deque()
        self._layout = b""

    def __len__(self) -> int:
        return len(self._moments)

    @property
    def frames(self) -> bytes:
        """The frame messages one after another, oldest first, each `frame_bytes` long."""
        return b"".join(moment.frame for moment in self._moments)

    @property
    def frame_bytes(self) -> int:
        """The length of one frame message; 0 if there is none."""
        return len(self._moments[0].frame) if self._moments else 0

    @property
    def times(self) -> Array:
        """When each of `q` and `balls` was (n,) [s], from 0 on.

        While nothing moves there are no frames. The last one then counts again right before the next one, so that
        nobody takes the pause for a slow motion.
        """
        at = np.array([at for at, _ in self._shown()], dtype=np.float64)
        return (at - at[:1]) / STEPS_PER_SECOND

    @property
    def q(self) -> Array:
        """The configurations (instances, n, nq) of at least one frame."""
        return np.stack([moment.q for _, moment in self._shown()], axis=1)

    @property
    def balls(self) -> Array:
        """The balls' placements (balls, n, 7) in at least one frame: x, y, z [m], qx, qy, qz, qw."""
        (count,) = struct.unpack_from("<f", self._moments[0].frame, _BALLS)
        rows = [np.frombuffer(moment.frame, "<f4", 7 * int(count), _HEADER) for _, moment in self._shown()]
        return np.array(rows, dtype=np.float64).reshape(len(rows), -1, 7).swapaxes(0, 1)

    def _shown(self) -> list[tuple[int, _Moment]]:
        """The frames with the steps at which they show something, twice before a pause."""
        shown: list[tuple[int, _Moment]] = []
        for moment in self._moments:
            if shown and moment.at - shown[-1][0] > _BETWEEN:
                shown.append((moment.at - _BETWEEN, shown[-1][1]))
            shown.append((moment.at, moment))
        return shown

    def add(self, frame: bytes, q: Sequence[Array]) -> None:
        """Add a frame message with the configuration (nq,) of each of its instances, if it is due.

        Call this with the frame of every step. A step before the last one counts as the next.
        """
        layout = frame[: _STEP.start] + frame[_STEP.stop : _HEADER]
        if layout != self._layout:
            self.clear()
            self._layout = layout
        (step,) = struct.unpack("<I", frame[_STEP])
        at = 0
        if self._moments:
            last = self._moments[-1]
            passed = step - last.step if step >= last.step else _BETWEEN
            if passed < _BETWEEN:
                return
            at = last.at + passed
        self._moments.append(_Moment(frame, step, at, np.array(q)))
        while at - self._moments[0].at >= SECONDS * STEPS_PER_SECOND:
            self._moments.popleft()

    def clear(self) -> None:
        """Discard all frames; the next one is kept."""
        self._moments.clear()
