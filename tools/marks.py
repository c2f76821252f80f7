"""Targets as bodies for a picture: axes, balls, arrows, planes, cones and boxes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pinocchio
from numpy.typing import NDArray

import pinik
from pinik.picture.bodies import Body
from pinik.picture.solids import Solid, ball, rod

Array = NDArray[np.float64]

AXES = ("#d81f2f", "#1d9a4a", "#1f5fd0")
GOAL, FREE, WITHIN, TOOL = "#d81f2f", "#8a4fd3", "#f08c00", "#2b3540"
_WIDE = 0.05  # [rad] an orientation tolerance above this is drawn
_QUAD = np.array([[0, 1, 2], [0, 2, 3]])


def as_color(text: str) -> Array:
    """ "#rrggbb" as (3,) in 0..1."""
    return np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0


class Marks:
    """What is drawn of some targets.

    Args:
        unit: The length of the axes that are drawn [m].
        back: The unit vector (3,) to the camera.

    Attributes:
        solid: The opaque bodies.
        points: Names of places (3,) [m], for labels.
    """

    def __init__(self, unit: float, back: Array) -> None:
        self.unit, self.back = unit, back
        self.solid: list[Body] = []
        self.points: dict[str, Array] = {}
        self._clear: list[Body] = []
        self._count = 0

    def translucent(self) -> list[list[Body]]:
        """The translucent bodies, each a layer of its own."""
        return [[body] for body in self._clear]

    def add(self, robot: pinik.Robot, target: pinik.Target, q: Array) -> None:
        """Draw a target as it stands when the robot is at `q` (nq,)."""
        here = robot.placement(target.frame, q)
        reached = here if target.tool is None else here * target.tool
        reference = pinocchio.SE3.Identity()
        if target.relative_to is not None:
            reference = robot.placement(target.relative_to, q)
        goal = reached.translation
        if target.position is not None:
            own = reference.actInv(goal)
            goal = reference.act(np.where(target.along, target.position, own))
        self._named(goal=goal, frame=here.translation, reference=reference.translation)
        if target.tool is not None:
            self._rod(here.translation, goal, 0.035, TOOL)
        if target.relative_to is not None:
            self._triad(reference.translation, reference.rotation, 0.8)
            self._dashes(reference.translation, goal, FREE)
        if target.position is not None and not all(target.along):
            self._free(goal, reference.rotation, target.along)
        if target.rotation is not None:
            thin = target.tolerance is not None
            self._triad(goal, reference.rotation @ target.rotation, thick=0.012 if thin else 0.03)
        elif target.position is not None:
            self._ball(goal, 0.14 if target.axis is None else 0.06)
        if target.axis is not None:
            self._axis(goal, reached.rotation @ target.axis, target, reference)
        if target.tolerance is not None:
            rotation = reference.rotation if target.rotation is None else reference.rotation @ target.rotation
            self._within(goal, rotation, reached, target.tolerance)

        self._count += 1

    def _named(self, **points: Array) -> None:
        """Keep places for labels; those of the second target end in 2."""
        suffix = "" if self._count == 0 else str(self._count + 1)
        self.points |= {name + suffix: np.asarray(point) for name, point in points.items()}

    def _axis(self, goal: Array, axis: Array, target: pinik.Target, reference: pinocchio.SE3) -> None:
        color = AXES[int(np.argmax(np.abs(target.axis)))]
        if target.at is not None:
            at = reference.act(target.at)
            self._named(at=at)
            self._ball(at, 0.16)
            self._dashes(goal, at, color)
        self._arrow(goal, goal + self.unit * axis, color)
        middle, radius = goal + 0.55 * self.unit * axis, 0.3 * self.unit
        front = self.back - (self.back @ axis) * axis
        front /= np.linalg.norm(front)
        turn = np.linspace(0.4 * np.pi, 2.05 * np.pi, 48)
        ring = middle + radius * (np.cos(turn)[:, None] * front + np.sin(turn)[:, None] * np.cross(axis, front))
        for a, b in pairwise(ring[:-6]):
            self._rod(a, b, 0.018, FREE)
        self._arrow(ring[-8], ring[-1], FREE, 0.025)
        self._named(spin=ring[0], axis=goal + 0.8 * self.unit * axis)

    def _free(self, goal: Array, rotation: Array, along: tuple[bool, bool, bool]) -> None:
        """A plane if one axis is asked for, a line if two are."""
        ways = [rotation[:, k] for k in range(3) if not along[k]]
        half = 1.6 * self.unit
        if len(ways) == 1:
            self._rod(goal - 2.0 * half * ways[0], goal + 2.0 * half * ways[0], 0.03, FREE)
            return
        corners = goal + half * np.array([a * ways[0] + b * ways[1] for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
        self._flat(corners, FREE, 0.28)
        for a, b in pairwise([*corners, corners[0]]):
            self._rod(a, b, 0.012, FREE)
        for way in ways:
            for sign in (-1.0, 1.0):
                self._arrow(goal + 0.2 * sign * self.unit * way, goal + 0.75 * sign * self.unit * way, FREE, 0.02)
        self._named(corner=corners[1])

    def _within(self, goal: Array, rotation: Array, reached: pinocchio.SE3, tolerance: pinik.Tolerance) -> None:
        if tolerance.box is not None:
            half = np.array(tolerance.box)
            for k in range(3):
                for side in (-1.0, 1.0):
                    signs = np.insert(np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float), k, side, axis=1)
                    corners = goal + (signs * half) @ rotation.T
                    self._flat(corners, WITHIN, 0.5)
                    for a, b in pairwise([*corners, corners[0]]):
                        self._rod(a, b, 0.008, WITHIN)
            self._named(end=goal + rotation[:, 0] * half[0])
            self._ball(reached.translation, 0.05, TOOL)
            self._named(answer=reached.translation)
        elif tolerance.orientation > _WIDE:
            tip = goal + 1.25 * self.unit * np.cos(tolerance.orientation) * rotation[:, 2]
            wide = 1.25 * self.unit * np.sin(tolerance.orientation)
            self._clear.append(Body(rod(goal, tip, 1e-6, wide), as_color(WITHIN), 0.3, glow=0.4))
            self._arrow(goal, goal + 1.25 * self.unit * reached.rotation[:, 2], TOOL, 0.025)
            self._named(answer=goal + 1.25 * self.unit * reached.rotation[:, 2])
            self._named(rim=tip + wide * rotation[:, 0])

    def _triad(self, at: Array, rotation: Array, share: float = 1.0, thick: float = 0.03) -> None:
        for k, color in enumerate(AXES):
            self._arrow(at, at + share * self.unit * rotation[:, k], color, thick)
        self._ball(at, 1.6 * thick, "#ffffff")

    def _arrow(self, start: Array, end: Array, color: str, thick: float = 0.03) -> None:
        head = min(4.5 * thick * self.unit / float(np.linalg.norm(end - start)), 0.8)
        neck = end - head * (end - start)
        self._rod(start, neck, thick, color)
        self.solid.append(Body(rod(neck, end, 2.2 * thick * self.unit, 1e-6), as_color(color), glow=0.25))
        self.solid.append(Body(rod(neck - 1e-3 * (end - start), neck, 1e-6, 2.2 * thick * self.unit), as_color(color)))

    def _dashes(self, start: Array, end: Array, color: str) -> None:
        count = max(round(float(np.linalg.norm(end - start)) / (0.16 * self.unit)), 1)
        for k in range(count):
            a, b = start + (end - start) * np.array([[k + 0.2], [k + 0.8]]) / count
            self._rod(a, b, 0.014, color)

    def _rod(self, start: Array, end: Array, thick: float, color: str) -> None:
        radius = thick * self.unit
        self.solid.append(Body(rod(start, end, radius, radius), as_color(color), glow=0.25))

    def _ball(self, at: Array, size: float, color: str = GOAL) -> None:
        self.solid.append(Body(ball(at, size * self.unit), as_color(color), gloss=0.6, glow=0.4))

    def _flat(self, corners: Array, color: str, opacity: float) -> None:
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normals = np.tile(normal / np.linalg.norm(normal), (4, 1))
        self._clear.append(Body(Solid(corners, normals, _QUAD), as_color(color), opacity, glow=0.6))
