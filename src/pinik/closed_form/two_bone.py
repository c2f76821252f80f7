"""Two bones in closed form: both solutions for any number of targets in one vectorised call."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_finite_number, as_many, as_numbers, as_plain
from ..errors import InputError

__all__ = ["ELBOWS", "TwoBoneAnswers", "elbow_angles", "two_bone"]

Array = NDArray[np.float64]

ELBOWS = ("up", "down")
"""The two answers in order: with the target to the right, the elbow is above the line to the target, or below it."""

_LONGEST = 1e150  # beyond, products of lengths overflow
_BLOCK = 8192  # targets per pass, so that their numbers stay in the processor's cache
_BORDER = 4.0 * np.finfo(np.float64).eps  # of the arm's length: how far outside rounding may put a target
_NO_SIDE = 1e-12  # the sine below which a pole points along the line to the target


@dataclass(frozen=True, eq=False)
class TwoBoneAnswers:
    """The two answers of `two_bone` for each of N targets.

    The second axis of `angles`, `elbows`, `tips` and `errors` is the elbow. Index 0 is "up": left of the line from the
    base to the target, or on the side of the pole. Index 1 is "down", the mirror image. Where the target is out of
    reach, both answers place the tip at the nearest point within reach.

    Attributes:
        l1, l2: Lengths of the bones, (N,) each [m].
        targets: (N, 2) or (N, 3) [m].
        angles: (N, 2 elbows, 2 joints) [rad], counter-clockwise: the first bone's from the x axis, in (−π, π], and the
            second bone's from the first bone, in [−π, 0] for the elbow up and in [0, π] for the elbow down. In space, x
            is the x axis of `plane`, which points at the target.
        distance: Distance from the base to the target (N,) [m].
        reachable: Whether the target lies in the annulus |l1 − l2| ≤ distance ≤ l1 + l2 (N,). The borders are
            included, with a margin of 4 units of rounding in the arm's length.
        shortfall: How far outside the annulus the target lies (N,) [m]; 0 where it is reachable.
        plane: For targets in space, the axes of the plane of each arm: (N, 3, 3), with columns x towards the target,
            y towards the pole, and z, about which the joints turn. None for targets in the plane.
    """

    l1: Array
    l2: Array
    targets: Array
    angles: Array
    distance: Array
    reachable: NDArray[np.bool_]
    shortfall: Array
    plane: Array | None

    def __len__(self) -> int:
        return len(self.targets)

    @property
    def too_far(self) -> NDArray[np.bool_]:
        """Whether the target lies beyond the outer border, so that the arm is stretched towards it (N,)."""
        return ~self.reachable & (self.distance > np.maximum(self.l1, self.l2))

    @property
    def too_near(self) -> NDArray[np.bool_]:
        """Whether the target lies in the hole around the base, so that the arm is folded (N,)."""
        return ~self.reachable & ~self.too_far

    @cached_property
    def elbows(self) -> Array:
        """Elbow positions by forward kinematics of `angles`: (N, 2, 2), or (N, 2, 3) in space [m]."""
        return self._in_space(self._bone(self.l1, self.angles[..., 0]))

    @cached_property
    def tips(self) -> Array:
        """Tip positions by forward kinematics of `angles`: (N, 2, 2), or (N, 2, 3) in space [m]."""
        return self.elbows + self._in_space(self._bone(self.l2, self.angles.sum(axis=-1)))

    @cached_property
    def errors(self) -> Array:
        """Distance from each tip to its target (N, 2) [m]."""
        return np.array(np.linalg.norm(self.tips - self.targets[:, np.newaxis], axis=-1))

    def _bone(self, length: Array, angle: Array) -> Array:
        return np.array(length[:, np.newaxis, np.newaxis] * np.stack([np.cos(angle), np.sin(angle)], axis=-1))

    def _in_space(self, points: Array) -> Array:
        return points if self.plane is None else np.asarray(points @ self.plane[:, :, :2].transpose(0, 2, 1))


def two_bone(l1: ArrayLike, l2: ArrayLike, targets: ArrayLike, pole: ArrayLike | None = None) -> TwoBoneAnswers:
    r"""Both ways in which two bones, hinged at the origin and at each other, reach each of N targets.

    Let the target be at distance $d$ in direction $\varphi$. The triangle with sides $l_1$, $l_2$, $d$ has the angle
    $\alpha$ at the base, and at the elbow the second bone deviates by $\beta'$ from the line of the first:

    $$\theta_1 = \varphi \pm \alpha, \quad \theta_2 = \mp \beta', \qquad
    \tan\tfrac{\alpha}{2} = \sqrt{\frac{(s - d)(s - l_1)}{s\,(s - l_2)}}, \quad
    \tan\tfrac{\beta'}{2} = \sqrt{\frac{s\,(s - d)}{(s - l_1)(s - l_2)}}, \quad s = \tfrac12 (l_1 + l_2 + d).$$

    These are the half-angle forms of the law of cosines, $\cos\alpha = (d^2 + l_1^2 - l_2^2) / (2 d l_1)$ and
    $\beta' = \pi - \beta$. An arc cosine would lose half the digits where the arm is stretched or folded. Outside the
    annulus the negative factor is replaced by 0, so that the arm stretches or folds towards the target. With the target
    at the base all directions are equivalent; then $\varphi = 0$, and $\alpha = \pi/2$ if the bones are equally long.

    Sources: Šimunić, §2.3, eqs. 2.3.1–2.3.3; Zucconi, "Inverse kinematics in two dimensions", whose B = π − β must turn
    against α; for the factors, Kahan, "Miscalculating area and angles of a needle-like triangle" (2014).

    Args:
        l1: Length of the bone at the base [m], at least 0; a number, or (N,).
        l2: Length of the other bone, likewise.
        targets: Target positions of the tip, from the base: (N, 2), or (N, 3) with a pole [m].
        pole: In space, the direction towards which the elbow bends: (3,) or (N, 3), of any length except 0. A pole
            along the line to the target is replaced by an axis across that line.

    Raises:
        InputError: A wrong shape; a number that is not finite or exceeds 1e150; a negative length; a zero pole; a pole
            in the plane, or none in space. The message gives the index of the first wrong entry.
    """
    shape = _shape(targets, "targets")
    size = shape[1] if len(shape) == 2 else 2
    if size not in (2, 3):
        raise InputError(f"targets must be N times 2 or 3 numbers; got an array of shape {shape}")
    points = as_many(targets, (size,), "targets")
    _refuse_the_first(_largest(points) > _LONGEST, points, "targets", f"at most {_LONGEST:g} in each entry")
    count = len(points)
    first, second = _lengths(l1, count, "l1"), _lengths(l2, count, "l2")
    poles = _poles(pole, count, size)
    angles, distance, outside = np.empty((count, 2, 2)), np.empty(count), np.empty(count)
    plane = None if poles is None else np.empty((count, 3, 3))
    for begin in range(0, count, _BLOCK):
        part = slice(begin, begin + _BLOCK)
        x, y = points[part, 0], points[part, 1]
        d = np.hypot(x, y)
        if plane is None or poles is None:
            direction = np.arctan2(y, x)
        else:
            direction = np.zeros(len(x))
            d = np.hypot(d, points[part, 2])
            plane[part] = _planes(points[part], d, poles[part])
        distance[part] = d
        angles[part], outside[part] = elbow_angles(first[part], second[part], direction, d)
    reachable = outside <= _BORDER * (first + second)
    return TwoBoneAnswers(first, second, points, angles, distance, reachable, np.where(reachable, 0.0, outside), plane)


def elbow_angles(l1: ArrayLike, l2: ArrayLike, direction: Array, distance: Array) -> tuple[Array, Array]:
    """The closed form for targets in these directions (N,) [rad] at these distances (N,) [m]; nothing is checked.

    Returns:
        `TwoBoneAnswers.angles` (N, 2, 2) [rad], and how far each target lies outside the annulus, negative inside
        (N,) [m].
    """
    alpha, bend, outside = _triangle(np.asarray(l1), np.asarray(l2), distance)
    angles = np.empty((len(distance), 2, 2))
    angles[:, 0, 0], angles[:, 1, 0] = _wrapped(direction + alpha), _wrapped(direction - alpha)
    angles[:, 0, 1], angles[:, 1, 1] = -bend, bend
    return angles, outside


def _triangle(l1: Array, l2: Array, d: Array) -> tuple[Array, Array, Array]:
    """For triangles with these sides: α, β', and how far d lies outside the annulus, negative inside; (N,) each."""
    beyond, inner, outer = _excess(l1, l2, d), _excess(d, l2, l1), _excess(d, l1, l2)  # 2(s − d), 2(s − l1), 2(s − l2)
    outside = -np.minimum(np.minimum(inner, outer), beyond)
    root, root_d, root_1, root_2 = (np.sqrt(np.maximum(factor, 0.0)) for factor in (l1 + l2 + d, beyond, inner, outer))
    alpha = 2.0 * np.arctan2(root_d * root_1, root * root_2)
    bend = 2.0 * np.arctan2(root * root_d, root_1 * root_2)
    at_base = (root_1 == 0.0) & (root_2 == 0.0)
    alpha[at_base] = 0.5 * np.pi  # the limit for equal bones as the target approaches the base
    return alpha, bend, outside


def _excess(a: Array, b: Array, c: Array) -> Array:
    """a + b − c, accurate to the last bits where it is not negative, because the larger terms are subtracted first."""
    return (np.maximum(a, b) - c) + np.minimum(a, b)


def _wrapped(angle: Array) -> Array:
    """Wrap angles from (−2π, 2π] into (−π, π], in place."""
    angle[angle > np.pi] -= 2.0 * np.pi
    angle[angle <= -np.pi] += 2.0 * np.pi
    return angle


def _planes(targets: Array, distance: Array, poles: Array) -> Array:
    """The axes of each arm's plane (N, 3, 3), in columns: towards the target, towards the pole, and normal to both."""
    at_base = np.flatnonzero(distance == 0.0)
    poles = poles.T / _largest(poles)  # (3, N) from here on, as numpy is slow along an axis of three
    poles /= np.sqrt(_dot(poles, poles))
    x = targets.T.copy()
    x[:, at_base] = _across(poles[:, at_base])
    x /= _largest(x.T)
    x /= np.sqrt(_dot(x, x))
    y = poles - _dot(poles, x) * x
    length = np.sqrt(_dot(y, y))
    sideless = np.flatnonzero(length < _NO_SIDE)
    y[:, sideless], length[sideless] = _across(x[:, sideless]), 1.0
    y /= length
    y -= _dot(y, x) * x  # again, because rounding leaves a part along x where the pole is nearly parallel to it
    y /= np.sqrt(_dot(y, y))
    z = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
    return np.stack([x, y, np.stack(z)], axis=-1).transpose(1, 0, 2)


def _across(directions: Array) -> Array:
    """A unit vector normal to each unit vector (3, N), made from the coordinate axis that is most nearly normal."""
    axes = np.eye(3)[:, np.abs(directions).argmin(axis=0)]
    across = axes - _dot(axes, directions) * directions
    return np.array(across / np.sqrt(_dot(across, across)))


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def _largest(vectors: Array) -> Array:
    """The largest absolute entry of each vector (N, k)."""
    sizes = np.abs(vectors[:, 0])
    for entry in vectors.T[1:]:
        np.maximum(sizes, np.abs(entry), out=sizes)
    return sizes


def _shape(value: ArrayLike, what: str) -> tuple[int, ...]:
    value = as_plain(value, what)
    try:
        return np.shape(value)
    except ValueError:  # rows of different lengths; the check of the numbers reports them
        return ()


def _lengths(value: ArrayLike, count: int, what: str) -> Array:
    """The lengths of a bone (count,), checked; a single number is repeated."""
    shape = _shape(value, what)
    if shape == ():
        lengths = np.full(1, as_finite_number(value, what))
    else:
        if shape != (count,):
            raise InputError(
                f"{what} must be one length, or one for each of the {count} targets; got an array of shape {shape}"
            )
        lengths = as_many(value, (), what)
    wrong = ~((lengths >= 0.0) & (lengths <= _LONGEST))
    _refuse_the_first(wrong, lengths, what, f"a bone's length, from 0 to {_LONGEST:g}")
    return np.broadcast_to(lengths, (count,))


def _poles(pole: ArrayLike | None, count: int, size: int) -> Array | None:
    """The poles (count, 3), checked, for targets in space; None for targets in the plane."""
    if size == 2:
        if pole is not None:
            raise InputError("pole must be None for targets in the plane (N, 2); a pole needs targets in space (N, 3)")
        return None
    if pole is None:
        raise InputError("pole must be given for targets in space (N, 3): the direction towards which the elbow bends")
    single = len(_shape(pole, "pole")) == 1
    poles = as_many(as_numbers(pole, "pole")[np.newaxis] if single else pole, (3,), "pole")
    if not single and len(poles) != count:
        raise InputError(f"pole must be one direction, or one for each of the {count} targets; got {len(poles)}")
    _refuse_the_first(_largest(poles) < 1e-300, poles, "pole", "a direction, not zero")
    return np.broadcast_to(poles, (count, 3))


def _refuse_the_first(wrong: NDArray[np.bool_], values: Array, what: str, right: str) -> None:
    for k in np.flatnonzero(wrong)[:1]:
        name = what if len(values) == 1 else f"{what}[{k}]"
        raise InputError(f"{name} must be {right}; got {values[k].tolist()}")
