"""The targets of a solve, compiled: everything that does not depend on the configuration."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..checks import as_names
from ..model.chains import chain_of
from ..model.joint import Joint
from ..model.robot_model import RobotModel
from .coordinates import Coordinate
from .targets import Target, as_targets
from .term import Term
from .tolerance import Tolerance

__all__ = ["RADIAN", "Problem"]

_DEFAULT = Tolerance()

RADIAN = 0.3
"""The weight of an orientation error of one radian in a distance, relative to the chain's length."""


class Problem:
    """The targets for frames of a robot, compiled. A problem never changes, so any thread may read it.

    Attributes:
        robot: The robot.
        model: The robot's model, or a copy with an additional frame for each target that has a tool.
        targets: The targets that it was compiled from; it serves for all targets of the same kinds.
        terms: The targets, compiled.
        locked: The joints that must not move.
        target_jacobian: Whether Jacobians are taken at the target instead of the effector (thesis, eq. 3.9).
        tolerance: The tolerance of the targets that have none of their own.
        free: (nv,) whether a tangent coordinate moves a target frame and is not locked.
        coordinates: The free coordinates one by one, distal joints first, in the order of CCD.
        size: The number of residual rows m.
        size_of_chain: The length of the longest chain [m]; 1 if all lengths are 0.
        lightest: The smallest weight divided by the largest.
        is_wide: Whether a tolerance is so wide that an answer inside it is looked for if the exact one is not found.
        held_entries: The indices of the entries of q that must not change, if nq and nv differ; else None.
        columns_to_clear: The columns of J that are not free but may be nonzero; None if there are none.
    """

    def __init__(
        self,
        robot: RobotModel,
        targets: Target | Sequence[Target],
        *,
        locked: Iterable[str] = (),
        target_jacobian: bool = False,
        tolerance: Tolerance = _DEFAULT,
    ) -> None:
        """Compile the targets.

        Args:
            robot: The robot.
            targets: At least one.
            locked: Names of joints that must not move; the joints that mimic them do not move either.
            target_jacobian: Whether to take Jacobians at the target.
            tolerance: The tolerance of the targets that have none of their own.

        Raises:
            UnknownNameError: There is no such frame or joint.
            InputError: There is no target, or a locked joint mimics another one.
        """
        self.robot = robot
        self.targets = as_targets(targets)
        self.locked = tuple(robot.settable_joint(name) for name in as_names(locked, "locked"))
        self.target_jacobian = target_jacobian
        self.tolerance = tolerance
        self.model = robot.model
        ids = [
            (self._frame(target), None if target.relative_to is None else robot.frame_id(target.relative_to))
            for target in self.targets
        ]
        chains = [chain_of(self.model, robot.joints, frame, reference) for frame, reference in ids]
        self.free = self._free(joint for chain in chains for joint in chain.joints)
        still = {joint.id for joint in robot.joints if not self._moves(joint)}
        self.size_of_chain = max(chain.length(still) for chain in chains) or 1.0
        # Only the ratios of the weights matter; the largest is scaled to 1 so that residuals keep their magnitude.
        heaviest = max(target.weight for target in self.targets)
        self.lightest = min(target.weight for target in self.targets) / heaviest
        self.terms = tuple(
            Term(
                target,
                chain,
                *own,
                target.weight / heaviest,
                target.weight / heaviest * self.size_of_chain,
                target.tolerance or tolerance,
            )
            for target, chain, own in zip(self.targets, chains, ids, strict=True)
        )
        self.is_wide = any(term.tolerance.is_wide(self.size_of_chain) for term in self.terms)
        self.size = sum(term.size for term in self.terms)
        # Without a reference, the other columns are exactly zero. With one, the columns of joints that move both frames
        # cancel only up to rounding.
        relative = any(target.relative_to is not None for target in self.targets)
        self.columns_to_clear = np.flatnonzero(~self.free) if relative or self.locked else None
        self.coordinates = self._coordinates()
        self.held_entries = self._held_entries()

    @property
    def kinds(self) -> list[tuple[object, ...]]:
        """The kinds of the targets: frames and what is constrained, without numbers."""
        return [target.shape for target in self.targets]

    @property
    def squared_metres_per_radian(self) -> float:
        """The weight of a squared orientation error [rad²] in a squared distance [m²]."""
        return (RADIAN * self.size_of_chain) ** 2

    def moved(self, q: NDArray[np.float64], dq: NDArray[np.float64]) -> NDArray[np.float64]:
        """The configuration (nq,) after a motion dq (nv,) from `q`, where joints that are held keep exact values."""
        moved: NDArray[np.float64] = pinocchio.integrate(self.model, q, dq)
        if self.held_entries is not None:
            moved[self.held_entries] = q[self.held_entries]
        return moved

    def _frame(self, target: Target) -> int:
        """The index of the target's frame, or of a new frame at its tool."""
        frame_id = self.robot.frame_id(target.frame)
        if target.tool is None:
            return frame_id
        if self.model is self.robot.model:
            self.model = pinocchio.Model(self.robot.model)
        frame = self.model.frames[frame_id]
        name = f"tool {self.model.nframes}"
        placement = frame.placement * target.tool
        return int(
            self.model.addFrame(pinocchio.Frame(name, frame.parentJoint, frame_id, placement, pinocchio.OP_FRAME))
        )

    def _free(self, movers: Iterable[Joint]) -> NDArray[np.bool_]:
        free = np.zeros(self.model.nv, dtype=bool)
        for joint in movers:
            if joint.multiplier != 0.0:
                owner = self.robot.joint(joint.leader or joint.name)
                free[owner.idx_v : owner.idx_v + owner.nv] = True
        for joint in self.locked:
            free[joint.idx_v : joint.idx_v + joint.nv] = False
        return free

    def _moves(self, joint: Joint) -> bool:
        owner = joint if joint.leader is None else self.robot.joint(joint.leader)
        return joint.multiplier != 0.0 and bool(self.free[owner.idx_v : owner.idx_v + owner.nv].any())

    def _held_entries(self) -> NDArray[np.intp] | None:
        """The entries of q without a free coordinate, which integrating a zero step could change by rounding."""
        if self.model.nq == self.model.nv:
            return None
        held = np.ones(self.model.nq, dtype=bool)
        for joint in self.robot.joints:
            if self.free[joint.idx_v : joint.idx_v + joint.nv].any():
                held[joint.idx_q : joint.idx_q + joint.nq] = False
        return np.flatnonzero(held)

    def _coordinates(self) -> tuple[Coordinate, ...]:
        """The free tangent coordinates, distal joints first."""
        movers = {joint.id: joint for term in self.terms for joint in term.chain.joints}
        coordinates = []
        for joint in reversed(self.robot.joints):
            moved = [(j, j.multiplier) for j in movers.values() if j.leader == joint.name]
            if joint.id in movers:
                moved.insert(0, (joint, 1.0))
            moved = [(j, multiplier) for j, multiplier in moved if multiplier != 0.0]
            for index in range(joint.nv):
                if moved and self.free[joint.idx_v + index]:
                    coordinates.append(Coordinate(joint, index, tuple(moved)))
        # Sorted by the most distal mover, because a mimic joint may be more distal than joints after its leader.
        return tuple(sorted(coordinates, key=lambda c: max(mover.id for mover, _ in c.movers), reverse=True))
