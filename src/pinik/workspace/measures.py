"""How well a configuration can move: its manipulability, and its room to the joint limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..solving.frame_arrays import jacobians
from ..solving.sampling import Sampler

__all__ = ["manipulabilities", "rooms"]

Array = NDArray[np.float64]


def manipulabilities(sampler: Sampler, q: Array, rows: int) -> Array:
    """The manipulability √det(J Jᵀ) (Yoshikawa 1985) at configurations (N, nq), (N,).

    J has the linear rows in metres, then the angular ones in radians, and a column for each coordinate that moves the
    frame. If these are fewer than the rows, it is √det(Jᵀ J), the product of the singular values in either case.

    Args:
        sampler: Knows the frame, its tool and the coordinates that move it.
        q: The configurations.
        rows: 3 for the linear rows alone, or 6.
    """
    problem = sampler.problem
    target = problem.targets[0]
    J = jacobians(sampler.robot, target.frame, q, "local_world_aligned", target.relative_to)[:, :, problem.free]
    if target.tool is not None and target.tool.translation.any():
        there = sampler.placements(q)[:, :3, :3] @ np.array(target.tool.rotation).T  # the frame's own rotation
        arm = there @ target.tool.translation
        J[:, :3] += np.cross(J[:, 3:], arm[:, :, None], axis=1)
    J = J[:, :rows]
    squares = J @ J.transpose(0, 2, 1) if J.shape[1] <= J.shape[2] else J.transpose(0, 2, 1) @ J
    return np.asarray(np.sqrt(np.maximum(np.linalg.det(squares), 0.0)))


def rooms(sampler: Sampler, q: Array) -> Array:
    """How far configurations (N, nq) are from the joint limits, (N,): 0 at one, 1 if all joints are in the middle.

    It is the least of all joints that move the frame and have limits on both sides, as a share of half the range; 1 if
    none has.
    """
    entries = [joint.idx_q for joint in sampler.drawn if joint.nq == 1]
    lower, upper = sampler.limits.lower[entries], sampler.limits.upper[entries]
    bounded = np.isfinite(upper - lower) & (upper > lower)
    values = q[:, np.array(entries, dtype=np.intp)[bounded]]
    lower, upper = lower[bounded], upper[bounded]
    shares = 2.0 * np.minimum(values - lower, upper - values) / (upper - lower)
    return np.asarray(shares.min(axis=1, initial=1.0).clip(0.0, 1.0))
