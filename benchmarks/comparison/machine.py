"""The machine that is measured on: its name, the core that peers are kept on, and how much it changes meanwhile."""

from __future__ import annotations

import os
import platform
import time
from pathlib import Path

import numpy as np
import pinocchio

__all__ = ["Yardstick", "about_machine", "all_cores", "can_pin"]

PIECE = 200  # forward kinematics in one piece of work


def all_cores() -> list[int]:
    """The cores that this process may use."""
    return sorted(os.sched_getaffinity(0)) if can_pin() else list(range(os.cpu_count() or 1))


def can_pin() -> bool:
    """Whether the system can keep a process on one core."""
    return hasattr(os, "sched_setaffinity")


def about_machine() -> str:
    """Processor, number of cores, system, and the load before anything is measured."""
    load = f", load {os.getloadavg()[0]:.2f} before the run" if hasattr(os, "getloadavg") else ""
    return f"{_processor()}, {len(all_cores())} cores, {platform.system()}{load}"


class Yardstick:
    """The same piece of work, timed again and again between the turns of the peers: what differs is the machine.

    Attributes:
        nanoseconds: The time of each piece.
    """

    def __init__(self, core: int | None) -> None:
        self.nanoseconds: list[int] = []
        self._core = core
        self._model = pinocchio.buildSampleModelManipulator()
        self._data = self._model.createData()
        self._q = pinocchio.neutral(self._model)

    def measure(self) -> None:
        """Time one piece, on the core of the peers if they have one."""
        cores = all_cores()
        if self._core is not None:
            os.sched_setaffinity(0, {self._core})
        try:
            for _ in range(2):  # the first brings everything back into the caches
                began = time.perf_counter_ns()
                for _ in range(PIECE):
                    pinocchio.forwardKinematics(self._model, self._data, self._q)
                taken = time.perf_counter_ns() - began
            self.nanoseconds.append(taken)
        finally:
            if self._core is not None:
                os.sched_setaffinity(0, cores)

    def noise(self) -> tuple[float, float]:
        """By how much the 10th and the 90th percentile differ from the median [%]."""
        low, middle, high = np.percentile(self.nanoseconds, [10, 50, 90])
        return float(100 * (low / middle - 1)), float(100 * (high / middle - 1))


def _processor() -> str:
    """The processor's name, as far as the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
