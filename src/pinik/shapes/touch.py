"""What a checker finds: pairs that touch, and the pair that is the least apart."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["Gap", "Pair", "Touch"]

Point = tuple[float, float, float]


class Pair(NamedTuple):
    """Two solids that must not touch.

    Attributes:
        first, second: The indices of the solids.
        group: The number of its group, from 0: pairs of the same two owners are one group.
    """

    first: int
    second: int
    group: int


class Touch(NamedTuple):
    """A pair of solids that touch. Depth and normal are those of their convex hulls.

    Attributes:
        group: The group of the pair.
        depth: How far the hulls go into each other [m]; moved so far against the normal, the first is free.
        normal: A unit vector from the first to the second, in the world.
        points: The deepest points of the first and of the second, in the world [m].
        joints: The joints in Pinocchio's model to which the first and the second are fixed; 0 is the world.
    """

    group: int
    depth: float
    normal: Point
    points: tuple[Point, Point]
    joints: tuple[int, int]


class Gap(NamedTuple):
    """The pair of solids that are the least apart.

    Attributes:
        group: The group of the pair.
        distance: How far they are apart [m]; minus the depth where they touch.
        points: The nearest points of the first and of the second, in the world [m].
    """

    group: int
    distance: float
    points: tuple[Point, Point]
