"""ikpy: SciPy's least squares over the chain."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from ikpy.chain import Chain


class Ikpy:
    """`inverse_kinematics_frame` with orientation "all" and the tolerance of its documentation's example.

    Looser than its default, that solves as many targets in less time; its JAX backend takes longer on these arms.
    It has no restarts of its own: one descent from the given start.
    """

    TOLERANCE = 1e-4

    def __init__(self, arm: dict[str, Any]) -> None:
        warnings.simplefilter("ignore")
        names = arm["elements"][1::2]
        # It goes on below the tip, to the end of the robot; those links are cut off again.
        links = Chain.from_urdf_file(arm["urdf"], base_elements=arm["elements"]).links[: len(names) + 1]
        if [link.name for link in links[1:]] != names:
            raise ValueError(f"it made another chain of the file: {[link.name for link in links[1:]]}")
        mask = [False, *(name in arm["joints"] for name in names)]
        self._chain = Chain(links, active_links_mask=mask)
        self._active = np.array(mask)

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        whole = np.zeros(len(self._active))
        whole[self._active] = q
        return whole

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._chain.inverse_kinematics_frame(
            target, initial_position=start, orientation_mode="all", tol=self.TOLERANCE
        )

    def answer(self, solved: np.ndarray) -> np.ndarray:
        return np.asarray(solved)[self._active]
