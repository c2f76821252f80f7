"""`Robot`: a robot with forward and inverse kinematics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from .model.robot_model import RobotModel
from .problem.target_values import Position
from .problem.targets import Target
from .problem.tolerance import Tolerance
from .shapes.avoid import Avoided
from .shapes.collisions import Clearance, Collision, clearance, collision_pairs, collisions
from .shapes.pairs import CollisionPairs
from .shapes.world import World
from .solvers.registry import Method
from .solving import frame_arrays
from .solving.answer import answer
from .solving.branches import Branches
from .solving.configuration import Given, as_configuration
from .solving.native.recalling import recalling
from .solving.self_motion import SelfMotion, self_motion
from .solving.solution import Solution
from .solving.solve_all import solve_all
from .solving.words import UNWEIGHTED

__all__ = ["Robot"]


class Robot(RobotModel):
    """A robot, as `pinik.load` returns it: where its frames are, and how to move them where they should be."""

    def placements(self, frame: str, Q: ArrayLike, relative_to: str | None = None) -> NDArray[np.float64]:
        """The placements of a frame at N configurations, as `placement` computes them one by one.

        The compiled engine computes them on all processor cores: millions per second for an arm. Ctrl-C stops it.

        Args:
            frame: The name of the frame.
            Q: N configurations (N, nq).
            relative_to: The frame in which the placements are expressed; the world when None.

        Returns:
            The homogeneous matrices (N, 4, 4) of the frame [m].

        Raises:
            UnknownNameError: No such frame; the message lists near names.
            InputError: `Q` has a wrong shape, or one of its rows is not a configuration; the message names the first.
        """
        return frame_arrays.placements(self, frame, Q, relative_to)

    def jacobians(
        self,
        frame: str,
        Q: ArrayLike,
        axes: str | pinocchio.ReferenceFrame = "local_world_aligned",
        relative_to: str | None = None,
    ) -> NDArray[np.float64]:
        """The Jacobians of a frame at N configurations, as `jacobian` computes them one by one.

        The compiled engine computes them on all processor cores. Ctrl-C stops it.

        Args:
            frame: The name of the frame.
            Q: N configurations (N, nq).
            axes: Where and in which axes the velocities are expressed, as for `jacobian`.
            relative_to: A frame that replaces the world, as for `jacobian`.

        Returns:
            J (N, 6, nv), with the linear rows first [m/rad or m/m], then the angular rows [rad/rad or rad/m].

        Raises:
            UnknownNameError: No such frame; the message lists near names.
            InputError: Unknown axes, `Q` has a wrong shape, or one of its rows is not a configuration; the message
                names the first.
        """
        return frame_arrays.jacobians(self, frame, Q, axes, relative_to)

    def collisions(self, q: Given, world: World | None = None) -> list[Collision]:
        """What touches at a configuration: links of the robot, and links and objects of a world.

        Collisions are those of the `<collision>` shapes of the URDF, as coal computes them. Meshes are surfaces: what
        lies wholly inside one touches nothing. Links without collision shapes touch nothing; none are invented for
        them. `collision_pairs` says which pairs of links count. Links that are fixed to the world are not compared with
        objects in it.

        Args:
            q: The configuration (nq,); angles by joint name, with all other joints neutral; or a `Solution`.
            world: What stands around the robot.

        Returns:
            One `Collision` for each two links or link and object that touch, the deepest first; none if all is free.

        Raises:
            UnknownNameError: There is no such joint.
            InputError: `q` is not a configuration of this robot, `world` is no `World`, or the robot has no collision
                shapes.
            RobotLoadError: Its SRDF file cannot be read.
            MissingExtraError: It has collision meshes, and trimesh, which reads them, is not installed.

        Warns:
            UrdfWarning: A collision shape cannot be read, and nothing is said about it.
        """
        return collisions(self, as_configuration(self, q), world)

    def clearance(self, q: Given, world: World | None = None) -> Clearance:
        """How far the nearest two parts are apart at a configuration [m], with their names and nearest points.

        Arguments, errors and warnings are those of `collisions`, and so is what is compared.
        """
        return clearance(self, as_configuration(self, q), world)

    @property
    def collision_pairs(self) -> CollisionPairs:
        """Which pairs of links count as collisions, and why the others do not.

        They are those of the SRDF file if it disables any. Else pinik finds out, in up to a few seconds, and keeps what
        it found in the user's cache folder. Errors and warnings are those of `collisions`.
        """
        return collision_pairs(self)

    @recalling(place=2)
    def solve(
        self,
        targets: str | Target | Sequence[Target],
        position: Position | None = None,
        *,
        rotation: ArrayLike | None = None,
        rpy: ArrayLike | None = None,
        quat_xyzw: ArrayLike | None = None,
        quat_wxyz: ArrayLike | None = None,
        placement: pinocchio.SE3 | ArrayLike | None = None,
        axis: str | ArrayLike | None = None,
        direction: ArrayLike | None = None,
        at: ArrayLike | None = None,
        tool: pinocchio.SE3 | ArrayLike | None = None,
        relative_to: str | None = None,
        weight: float = UNWEIGHTED,
        method: Method = "dls",
        q0: ArrayLike | Mapping[str, float] | str | None = None,
        limits: bool = True,
        locked: Iterable[str] = (),
        restarts: int | None = None,
        seed: int = 0,
        max_iterations: int | None = None,
        tolerance: Tolerance | ArrayLike | None = None,
        time_limit: float | None = None,
        engine: str = "auto",
        trace: bool = False,
        polish: bool = True,
        choose: str = "first",
        choose_weights: Mapping[str, float] | None = None,
        avoid: Avoided = None,
        **solver_parameters: Any,
    ) -> Solution:
        """Find joint values that move frames of the robot to their targets.

        `pinik.solve` explains the arguments, the solution and the errors. Problems of the same kind are compiled only
        once.
        """
        wanted = (
            position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
        )  # fmt: skip
        given = (
            limits, locked, restarts, seed, max_iterations, tolerance, time_limit, engine, trace, polish, choose,
            choose_weights, avoid,
        )  # fmt: skip
        return answer(self, targets, method, wanted, q0, given, solver_parameters)

    def solve_all(
        self,
        targets: str | Target | Sequence[Target],
        position: Position | None = None,
        *,
        rotation: ArrayLike | None = None,
        rpy: ArrayLike | None = None,
        quat_xyzw: ArrayLike | None = None,
        quat_wxyz: ArrayLike | None = None,
        placement: pinocchio.SE3 | ArrayLike | None = None,
        axis: str | ArrayLike | None = None,
        direction: ArrayLike | None = None,
        at: ArrayLike | None = None,
        tool: pinocchio.SE3 | ArrayLike | None = None,
        relative_to: str | None = None,
        weight: float = UNWEIGHTED,
        method: Method = "dls",
        q0: ArrayLike | Mapping[str, float] | None = None,
        limits: bool = True,
        locked: Iterable[str] = (),
        restarts: int | None = None,
        seed: int = 0,
        max_iterations: int | None = None,
        tolerance: Tolerance | ArrayLike | None = None,
        time_limit: float | None = None,
        engine: str = "auto",
        avoid: Avoided = None,
        **solver_parameters: Any,
    ) -> Branches:
        """Find all distinct configurations that move frames of the robot to their targets, inside the limits.

        `pinik.solve_all` explains the arguments, the answers and the errors.
        """
        return solve_all(
            self, targets, method, position=position, rotation=rotation, rpy=rpy, quat_xyzw=quat_xyzw,
            quat_wxyz=quat_wxyz, placement=placement, axis=axis, direction=direction, at=at, tool=tool,
            relative_to=relative_to, weight=weight, q0=q0, limits=limits, locked=locked, restarts=restarts, seed=seed,
            max_iterations=max_iterations, tolerance=tolerance, time_limit=time_limit, engine=engine, avoid=avoid,
            **solver_parameters,
        )  # fmt: skip

    def self_motion(
        self,
        targets: str | Target | Sequence[Target],
        q: Given,
        *,
        position: Position | None = None,
        rotation: ArrayLike | None = None,
        rpy: ArrayLike | None = None,
        quat_xyzw: ArrayLike | None = None,
        quat_wxyz: ArrayLike | None = None,
        placement: pinocchio.SE3 | ArrayLike | None = None,
        axis: str | ArrayLike | None = None,
        direction: ArrayLike | None = None,
        at: ArrayLike | None = None,
        tool: pinocchio.SE3 | ArrayLike | None = None,
        relative_to: str | None = None,
        weight: float = UNWEIGHTED,
        points: int = 200,
        limits: bool = True,
        locked: Iterable[str] = (),
        tolerance: Tolerance | ArrayLike | None = None,
        seed: int = 0,
    ) -> SelfMotion:
        """Find how the joints may move from `q` while frames of the robot stay at their targets.

        `pinik.self_motion` explains the arguments, the answer and the errors.
        """
        return self_motion(
            self, targets, q, position=position, rotation=rotation, rpy=rpy, quat_xyzw=quat_xyzw, quat_wxyz=quat_wxyz,
            placement=placement, axis=axis, direction=direction, at=at, tool=tool, relative_to=relative_to,
            weight=weight, points=points, limits=limits, locked=locked, tolerance=tolerance, seed=seed,
        )  # fmt: skip
