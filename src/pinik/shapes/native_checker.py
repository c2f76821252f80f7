"""The checker of the compiled engine, which tells most pairs apart by balls and boxes before it asks coal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..engine import load
from ..model.compiled import native_robot
from ..model.robot_model import RobotModel
from .solids import Solid
from .touch import Gap, Pair, Touch

__all__ = ["NativeChecker"]

Array = NDArray[np.float64]

_GEOMETRIES: WeakKeyDictionary[Any, Any] = WeakKeyDictionary()


class NativeChecker:
    """Pairs of solids, checked by the compiled engine.

    Attributes:
        shapes: The `pinik._native.Shapes`, which a compiled solve can use as well.
    """

    def __init__(self, robot: RobotModel, solids: Sequence[Solid], pairs: Sequence[Pair]) -> None:
        self.shapes = load().Shapes(native_robot(robot))
        for solid in solids:
            at: pinocchio.SE3 = solid.placement
            self.shapes.add_shape(_geometry(solid), solid.joint, at.rotation, at.translation)
        for pair in pairs:
            self.shapes.add_pair(pair.first, pair.second, pair.group)

    def report(self, q: Array) -> list[Touch]:
        """All pairs that touch at q (nq,), in the order of the pairs."""
        found = self.shapes.report(q)
        return [Touch(group, depth, normal, (a, b), joints) for group, depth, normal, a, b, joints in found]

    def clearance(self, q: Array) -> Gap | None:
        """The pair that is the least apart at q (nq,); None without pairs."""
        group, distance, a, b = self.shapes.clearance(q)
        return None if group < 0 else Gap(group, distance, (a, b))

    def touches(self, Q: Array) -> NDArray[np.bool_]:
        """Whether anything touches at each of N configurations (N, nq)."""
        found: NDArray[np.bool_] = self.shapes.touches(Q, 1).astype(bool)
        return found

    def counts(self, Q: Array) -> NDArray[np.int64]:
        """In how many of N configurations (N, nq) each group touches."""
        found: NDArray[np.int64] = self.shapes.counts(Q, 1)
        return found


def _geometry(solid: Solid) -> Any:
    """The engine's geometry; the tree of a surface's triangles is built once, however often the surface is used."""
    module, surface = load(), solid.surface
    if surface is None:
        return module.Geometry(module.SolidKind[solid.kind], list(solid.size))
    if surface not in _GEOMETRIES:
        _GEOMETRIES[surface] = module.Geometry.mesh(surface.vertices, surface.faces.tolist())
    return _GEOMETRIES[surface]
