"""Residual and Jacobian of some targets at one configuration."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..checks import as_names
from ..model.robot_model import Robot
from .coordinates import Coordinate
from .targets import Target, TargetError, as_targets
from .term import TargetTerm

__all__ = ["SQUARED_METRES_PER_RADIAN", "Kinematics", "Linearization"]

Array = NDArray[np.float64]

SQUARED_METRES_PER_RADIAN = 0.3**2
"""What orientation errors count in a distance."""


class Linearization(NamedTuple):
    """The targets seen from one configuration.

    Attributes:
        q: The configuration (nq,).
        e: Weighted residual (m,).
        J: Weighted Jacobian (m, nv), zero in the columns that are not free.
        errors: Each target's error, unweighted.
        residual: Norm of e, before anything shortens it.
        distance: How far off the targets are in all [m], weighted, a radian counted as 0.3 m.
        free: (nv,) whether the solver may move a tangent coordinate.
    """

    q: Array
    e: Array
    J: Array
    errors: list[TargetError]
    residual: float
    distance: float
    free: NDArray[np.bool_]


class Kinematics:
    """Some targets of a robot, made ready to be evaluated many times.

    Holds a `pinocchio.Data` of its own and is therefore for one thread.

    Attributes:
        robot: The robot.
        model: Its model, or a copy with one more frame for each target's tool.
        data: The `pinocchio.Data` of the last evaluation.
        targets: What is asked for.
        terms: The targets, compiled: see `TargetTerm`.
        lightest: The smallest weight as a part of the largest.
        size_of_chain: The longest of the targets' chains [m].
        held_entries: The entries of q that stay, where nq and nv differ; else None.
        free: (nv,) whether a tangent coordinate moves a target and is not locked.
        coordinates: The free ones one by one, distal joints first, as CCD visits them.
        locked: Joints that hold still.
        size: Number of residual rows m.
        evaluations: How many times a residual was computed.
    """

    def __init__(
        self,
        robot: Robot,
        targets: Target | Sequence[Target],
        *,
        locked: Iterable[str] = (),
        target_jacobian: bool = False,
    ) -> None:
        """Compile the targets.

        Args:
            robot: The robot.
            targets: At least one.
            locked: Names of joints that hold still; their followers with them.
            target_jacobian: Move the effector's point to the target in the Jacobian (thesis, eq. 3.9).

        Raises:
            UnknownNameError: No such frame or joint.
            InputError: No target, or a locked joint that follows another.
        """
        self.robot = robot
        self.locked = tuple(robot.settable_joint(name) for name in as_names(locked, "locked"))
        self.target_jacobian = target_jacobian
        self.evaluations = 0
        self.targets: tuple[Target, ...] = ()
        self.terms: list[TargetTerm] = []
        self.retarget(targets)

    def retarget(self, targets: Target | Sequence[Target]) -> None:
        """Ask for other targets; where only the places wanted differ, what was compiled is kept."""
        asked = as_targets(targets)
        if [t.shape for t in asked] == [t.shape for t in self.targets]:
            self.targets = asked
            for term, target in zip(self.terms, asked, strict=True):
                term.target = target
        else:
            self._compile(asked)

    def _compile(self, targets: tuple[Target, ...]) -> None:
        self.targets = targets
        self.model = self.robot.model
        ids = [(self._frame_id(t), _reference_id(self.robot, t)) for t in self.targets]
        self.data = self.model.createData()
        # Only their ratios mean something; with the heaviest at 1, numbers keep their size.
        weights = [target.weight for target in self.targets]
        heaviest = max(weights)
        self.lightest = min(weights) / heaviest
        self.terms = [
            TargetTerm(
                self.model, self.data, self.robot.joints, t, frame, reference, self.target_jacobian, t.weight / heaviest
            )
            for t, (frame, reference) in zip(self.targets, ids, strict=True)
        ]
        self.size = sum(term.size for term in self.terms)
        self.free = np.zeros(self.model.nv, dtype=bool)
        for term in self.terms:
            for joint in term.movers:
                if joint.multiplier == 0.0:
                    continue
                owner = self.robot.joint(joint.leader or joint.name)
                self.free[owner.idx_v : owner.idx_v + owner.nv] = True
        for joint in self.locked:
            self.free[joint.idx_v : joint.idx_v + joint.nv] = False
        # Without a reference the other columns are zero anyway; with one, what moves both cancels but for rounding.
        relative = any(target.relative_to is not None for target in self.targets)
        self._columns_to_clear = np.flatnonzero(~self.free) if relative or self.locked else None
        self.coordinates = self._coordinates()
        self.size_of_chain = max(term.chain_length for term in self.terms)
        self.held_entries = self._held_entries()

    def _held_entries(self) -> NDArray[np.intp] | None:
        """The entries of q that belong to no free coordinate, where integrating by 0 could change their last bits."""
        if self.model.nq == self.model.nv:
            return None
        held = np.ones(self.model.nq, dtype=bool)
        for joint in self.robot.joints:
            if self.free[joint.idx_v : joint.idx_v + joint.nv].any():
                held[joint.idx_q : joint.idx_q + joint.nq] = False
        return np.flatnonzero(held)

    def _coordinates(self) -> tuple[Coordinate, ...]:
        """The free tangent coordinates, distal joints first."""
        movers = {joint.id: joint for term in self.terms for joint in term.movers}
        coordinates = []
        for joint in reversed(self.robot.joints):
            moved = [(j, j.multiplier) for j in movers.values() if j.leader == joint.name]
            if joint.id in movers:
                moved.insert(0, (joint, 1.0))
            moved = [(j, multiplier) for j, multiplier in moved if multiplier != 0.0]
            for index in range(joint.nv):
                if moved and self.free[joint.idx_v + index]:
                    coordinates.append(Coordinate(joint, index, tuple(moved)))
        # By the most distal mover: a follower may lie beyond joints that come after its leader.
        return tuple(sorted(coordinates, key=lambda c: max(mover.id for mover, _ in c.movers), reverse=True))

    def linearize(self, q: Array) -> Linearization:
        """Residual, Jacobian and errors at `q` (nq,)."""
        self.evaluations += 1
        if len(self.terms) == 1:
            e, J, error = self.terms[0].linearize(q)
            errors = [error]
        else:
            parts = [term.linearize(q) for term in self.terms]
            e = np.concatenate([part[0] for part in parts])
            J = np.vstack([part[1] for part in parts])
            errors = [part[2] for part in parts]
        if self._columns_to_clear is not None:
            J[:, self._columns_to_clear] = 0.0
        return Linearization(q, e, J, errors, math.sqrt(e.dot(e)), self._distance(errors), self.free)

    def _distance(self, errors: list[TargetError]) -> float:
        squared = 0.0
        for term, (position, orientation) in zip(self.terms, errors, strict=True):
            own = 0.0 if position is None else position * position
            if orientation is not None:
                own += SQUARED_METRES_PER_RADIAN * orientation * orientation
            squared += term.weight * term.weight * own
        return math.sqrt(squared)

    def shortened(self, e: Array, longest: float) -> Array:
        """The residual with each position part cut to `longest` [m], its direction kept: ClampMag of the thesis."""
        e = e.copy()
        row = 0
        for term in self.terms:
            if term.target.position is not None:
                part = e[row : row + 3]
                length = math.sqrt(part.dot(part)) / term.weight
                if length > longest:
                    part *= longest / length
            row += term.size
        return e

    def _frame_id(self, target: Target) -> int:
        frame_id = self.robot.frame_id(target.frame)
        if target.tool is None:
            return frame_id
        if self.model is self.robot.model:
            self.model = pinocchio.Model(self.robot.model)
        frame = self.model.frames[frame_id]
        placement = frame.placement * target.tool
        name = f"tool {self.model.nframes}"
        return int(
            self.model.addFrame(pinocchio.Frame(name, frame.parentJoint, frame_id, placement, pinocchio.OP_FRAME))
        )


def _reference_id(robot: Robot, target: Target) -> int | None:
    return None if target.relative_to is None else robot.frame_id(target.relative_to)
