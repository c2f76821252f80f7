"""Configurations: those that users give, checked, and random ones."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_many, as_vector
from ..errors import InputError
from .joint import Joint

__all__ = ["checked", "checked_many", "random_configuration"]

Array = NDArray[np.float64]

# How far the squared length of a quaternion or (cos, sin) pair may be from 1: up to rounding it is left as it is, so
# that an answer that is used as a start keeps its bits, and up to the largest error it is scaled.
UNIT_ROUNDING = 1e-14
LARGEST_UNIT_ERROR = 1e-3


def checked(model: pinocchio.Model, joints: Iterable[Joint], q: ArrayLike, what: str, of: str = "") -> Array:
    """A copy of a configuration (nq,) as float64, with quaternions and (cos, sin) pairs normalised.

    Args:
        model: The model.
        joints: All joints of the model.
        q: The configuration.
        what: What error messages call it.
        of: What it is, for error messages about its shape.

    Raises:
        InputError: A wrong shape, a number that is not finite, or a quaternion or (cos, sin) pair that is not of unit
            length.
    """
    values = as_vector(q, model.nq, what, of)
    if model.nq == model.nv:  # no quaternion, no (cos, sin)
        return values
    for joint in joints:
        circle = joint.circle(values)
        if circle is None:
            continue
        own, words = circle
        squared = float(own @ own)
        if not abs(squared - 1.0) <= LARGEST_UNIT_ERROR:
            raise InputError(
                f"{what}: {words} of {joint.kind} joint {joint.name!r} must be of unit length; got {own.tolist()}"
            )
        if abs(squared - 1.0) > UNIT_ROUNDING:
            own /= math.sqrt(squared)
    return values


def checked_many(model: pinocchio.Model, joints: Iterable[Joint], q: ArrayLike, what: str) -> Array:
    """Copies of N configurations (N, nq), checked and normalised as by `checked`."""
    values = as_many(q, (model.nq,), what)
    for joint in joints:
        circle = joint.circle(values.T)
        if circle is not None:
            squared = (circle[0] * circle[0]).sum(axis=0)
            for k in np.flatnonzero(np.abs(squared - 1.0) > LARGEST_UNIT_ERROR)[:1]:
                checked(model, [joint], values[k], f"{what}[{k}]")
            circle[0][:] /= np.where(np.abs(squared - 1.0) > UNIT_ROUNDING, np.sqrt(squared), 1.0)
    return values


def random_configuration(
    neutral: Array, joints: Sequence[Joint], limits: tuple[Array, Array], rng: np.random.Generator
) -> Array:
    """A random configuration (nq,) inside the limits; see `Robot.random`.

    Args:
        neutral: The neutral configuration (nq,).
        joints: All joints of the model.
        limits: Lower and upper limits of the entries of q, (nq,) each [rad or m].
        rng: The source of random numbers.
    """
    q = neutral.copy()
    lower, upper = limits
    for joint in joints:
        if joint.has_one_axis and joint.leader is None:
            low, high = joint.range_to_draw_from(float(lower[joint.idx_q]), float(upper[joint.idx_q]))
            joint.set_angle(q, rng.uniform(low, high))
    for joint in joints:
        if joint.kind == "floating":
            quaternion = rng.normal(size=4)
            q[joint.idx_q : joint.idx_q + 3] = rng.uniform(-1, 1, 3)
            q[joint.idx_q + 3 : joint.idx_q + 7] = quaternion / np.linalg.norm(quaternion)
        elif joint.kind == "planar":
            angle = rng.uniform(-math.pi, math.pi)
            q[joint.idx_q : joint.idx_q + 4] = (*rng.uniform(-1, 1, 2), math.cos(angle), math.sin(angle))
    return q
