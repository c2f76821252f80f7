"""Collisions of a robot with itself and with the world around it."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ..description.flaw import Flaw, summarised
from ..echoes import bounded
from ..errors import InputError, UrdfWarning
from ..model.robot_model import RobotModel
from .checker import Checker, make_checker
from .native_checker import NativeChecker
from .pairs import CollisionPairs, find_pairs, solid_pairs
from .robot_solids import robot_solids
from .solids import Solid
from .touch import Pair
from .world import World

__all__ = ["Clearance", "Collision", "Guard", "RobotShapes", "clearance", "collision_pairs", "collisions", "shapes_of"]

if TYPE_CHECKING:
    from .._native import Shapes

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Collision:
    """Two links that touch, or a link and an object of the world.

    Attributes:
        pair: The names of both: two links, or a link and the object.
        depth: How far they go into each other [m]: the shortest way along which one could be moved to part their convex
            hulls. That is exact for primitives and convex meshes, and at least as long as needed for others.
        normal: A unit vector (3,) from the first to the second, in the world; moved by the depth against it, the first
            is free of the second.
        points: The deepest point of each hull in the other (2, 3), in the world [m].
        with_world: Whether the second is an object of the world, which may have the name of a link. The first is always
            a link of the robot.
    """

    pair: tuple[str, str]
    depth: float
    normal: Array = field(compare=False)
    points: Array = field(compare=False)
    with_world: bool = False

    @property
    def links(self) -> tuple[str, ...]:
        """The names of the robot's links among the two."""
        return self.pair[:1] if self.with_world else self.pair


@dataclass(frozen=True)
class Clearance:
    """How far the nearest two parts are apart.

    Attributes:
        distance: Their distance [m]; minus the depth where they touch, and infinite if there is nothing to compare.
        pair: The names of both: two links, or a link and an object of the world; None if there is nothing to compare.
        points: The nearest point of each (2, 3), in the world [m]; None if there is nothing to compare.
        with_world: Whether the second is an object of the world, as for a `Collision`.
    """

    distance: float
    pair: tuple[str, str] | None
    points: Array | None = field(compare=False)
    with_world: bool = False


@dataclass(frozen=True, eq=False)
class Guard:
    """A checker, with the names of its groups of pairs: first those of two links, then those of a link and an object.

    Attributes:
        checker: The checker.
        names: The two names of each group.
        own: The number of groups of two links.
    """

    checker: Checker
    names: Sequence[tuple[str, str]]
    own: int

    @property
    def native_shapes(self) -> Shapes:
        """The compiled engine's shapes and pairs, which only its own checker has."""
        assert isinstance(self.checker, NativeChecker)
        shapes: Shapes = self.checker.shapes
        return shapes

    def touches(self, q: Array) -> bool:
        """Whether anything touches at a valid configuration (nq,)."""
        return bool(self.checker.touches(q[None])[0])

    def collisions(self, q: Array) -> list[Collision]:
        """What touches at a valid configuration, the deepest first; of each two names their deepest shapes."""
        deepest: dict[int, Collision] = {}
        for touch in self.checker.report(q):
            known = deepest.get(touch.group)
            if known is None or touch.depth > known.depth:
                at = np.array(touch.points)
                names, normal = self.names[touch.group], np.array(touch.normal)
                deepest[touch.group] = Collision(names, touch.depth, normal, at, touch.group >= self.own)
        return sorted(deepest.values(), key=lambda collision: -collision.depth)

    def clearance(self, q: Array) -> Clearance:
        """The least distance at a valid configuration."""
        gap = self.checker.clearance(q)
        if gap is None:
            return Clearance(np.inf, None, None)
        return Clearance(gap.distance, self.names[gap.group], np.array(gap.points), gap.group >= self.own)


class RobotShapes:
    """A robot's collision shapes, and which pairs of its links count; read once for each robot by `shapes_of`.

    Attributes:
        solids: The collision shapes.
        flaws: Shapes of the file that could not be read.
    """

    solids: tuple[Solid, ...]
    flaws: tuple[Flaw, ...]

    def __init__(self, robot: RobotModel) -> None:
        self.solids, flaws = robot_solids(robot)
        self.flaws = tuple(flaws)
        self._pairs: CollisionPairs | None = None
        self._guards: dict[str, tuple[tuple[Solid, ...], Guard]] = {}

    def pairs(self, robot: RobotModel) -> CollisionPairs:
        """Which pairs of links count, and why the others do not."""
        if self._pairs is None:
            self._pairs = find_pairs(robot, self.solids)
        return self._pairs

    def guard(
        self, robot: RobotModel, around: tuple[Solid, ...] = (), *, itself: bool = True, engine: str = "auto"
    ) -> Guard:
        """The checker for the robot itself, for what is around it, or for both; the last one is kept.

        Parts that are fixed to the world are not compared with it.

        Args:
            robot: The robot.
            around: The shapes around it.
            itself: Whether the robot's own links are compared with each other.
            engine: "native", "python", or "auto" for the compiled engine where there is one.
        """
        kept = self._guards.get(f"{itself} {engine}")
        if kept is not None and kept[0] == around:
            return kept[1]
        own = self.pairs(robot).counting if itself else ()
        pairs, names = solid_pairs(self.solids, own), list(own)
        groups: dict[tuple[str, str], int] = {}
        for (first, solid), (second, other) in itertools.product(
            enumerate(self.solids), enumerate(around, len(self.solids))
        ):
            if solid.joint != 0:
                group = groups.setdefault((solid.owner, other.owner), len(names) + len(groups))
                pairs.append(Pair(first, second, group))
        guard = Guard(make_checker(robot, (*self.solids, *around), pairs, engine), [*names, *groups], len(names))
        self._guards[f"{itself} {engine}"] = (around, guard)
        return guard


_KEPT: WeakKeyDictionary[RobotModel, RobotShapes] = WeakKeyDictionary()


def shapes_of(robot: RobotModel) -> RobotShapes:
    """A robot's collision shapes, which are read when they are first asked for.

    Raises:
        InputError: The robot has no collision shapes.
        MissingExtraError: There are meshes, and trimesh, which reads them, is not installed.

    Warns:
        UrdfWarning: A collision shape cannot be read, and nothing is said about it; once for each sort of flaw.
    """
    if robot not in _KEPT:
        shapes = _KEPT[robot] = RobotShapes(robot)
        for words in summarised(shapes.flaws):
            warnings.warn(bounded(f"{robot.name}: collisions are not complete: {words}"), UrdfWarning, stacklevel=4)
    shapes = _KEPT[robot]
    if not shapes.solids:
        raise InputError(
            f"{robot.name!r} has no collision shapes (<collision> in its URDF), so pinik cannot tell what touches"
        )
    return shapes


def collisions(robot: RobotModel, q: Array, world: World | None = None) -> list[Collision]:
    """See `Robot.collisions`."""
    return shapes_of(robot).guard(robot, _solids(world)).collisions(q)


def clearance(robot: RobotModel, q: Array, world: World | None = None) -> Clearance:
    """See `Robot.clearance`."""
    return shapes_of(robot).guard(robot, _solids(world)).clearance(q)


def collision_pairs(robot: RobotModel) -> CollisionPairs:
    """See `Robot.collision_pairs`."""
    return shapes_of(robot).pairs(robot)


def _solids(world: World | None) -> tuple[Solid, ...]:
    """The shapes of a world, which is checked."""
    if world is not None and not isinstance(world, World):
        raise InputError(f"must be a pinik.World; got {world!r}", argument="world")
    return () if world is None else world.solids
