"""Keys of an animation: when what is where, so close together that players, which know no joints, get it right."""

from __future__ import annotations

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..robot import Robot

__all__ = ["filled_in", "places_of", "turned_the_short_way"]

Array = NDArray[np.float64]

_FARTHEST = np.pi / 3  # [rad or m] that a joint moves between two keys; beyond π a player would take the short way


def filled_in(robot: Robot, q: Array, times: Array) -> tuple[Array, Array]:
    """Configurations (n, nq) and times (n,) with others between them where a joint moves far."""
    rates = np.ones(robot.model.nv)  # how much faster the fastest follower of a joint turns
    for joint in robot.joints:
        if joint.leader is not None:
            rates[joint.idx_v] = max(rates[joint.idx_v], abs(joint.multiplier))
    rows, when = [q[:1]], [times[:1]]
    for before, after, start, end in zip(q[:-1], q[1:], times[:-1], times[1:], strict=True):
        way = rates * pinocchio.difference(robot.model, before, after)
        count = max(1, int(np.ceil(np.abs(way).max(initial=0.0) / _FARTHEST)))
        shares = np.arange(1, count + 1) / count
        rows.append(np.array([pinocchio.interpolate(robot.model, before, after, share) for share in shares[:-1]]
                             + [after]))  # fmt: skip
        when.append(start + shares * (end - start))
    return np.vstack(rows), np.concatenate(when)


def places_of(robot: Robot, frame: str, q: Array, relative_to: str | None = None) -> tuple[Array, Array]:
    """A frame's positions (n, 3) [m] and orientations (n, 4) as quaternions (x, y, z, w), in the world or a frame."""
    placements = robot.placements(frame, q, relative_to)
    rows = np.array([pinocchio.SE3ToXYZQUATtuple(pinocchio.SE3(one)) for one in placements])
    return rows[:, :3], turned_the_short_way(rows[:, 3:])


def turned_the_short_way(turns: Array) -> Array:
    """Quaternions (n, 4), each with the sign that makes it the nearer one to that before: q and −q are equal."""
    signs = np.where(np.sum(turns[1:] * turns[:-1], axis=1) < 0.0, -1.0, 1.0)
    turned: Array = turns * np.concatenate([[1.0], np.cumprod(signs)])[:, None]
    return turned
