"""Kinematics for LeRobot: a class with the interface of its `RobotKinematics`, computed by pinik.

    kinematics = RobotKinematics("so101.urdf", "gripper_frame_link", ["shoulder_pan", "shoulder_lift", ...])
    pose = kinematics.forward_kinematics(joints_in_degrees)
    joints_in_degrees = kinematics.inverse_kinematics(joints_in_degrees, desired_pose)

Run this file to see it follow a line with the SO-101: python examples/lerobot_kinematics.py
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

import pinik

Array = NDArray[np.float64]


class RobotKinematics:
    """Forward and inverse kinematics of one frame, with joint positions in degrees.

    Values behind those of `joint_names`, such as a gripper's opening, are kept as they are.
    """

    def __init__(
        self, urdf_path: str, target_frame_name: str = "gripper_frame_link", joint_names: Sequence[str] | None = None
    ) -> None:
        """Load the robot.

        Args:
            urdf_path: The path of a URDF file, or a name of pinik's catalogue.
            target_frame_name: The frame whose pose is computed.
            joint_names: The joints, in the order of the values; all joints of the robot when None.
        """
        self.robot = pinik.load(urdf_path)
        self.target_frame_name = target_frame_name
        self.joint_names = list(self.robot.joint_names if joint_names is None else joint_names)

    def forward_kinematics(self, joint_pos_deg: ArrayLike) -> Array:
        """The pose (4, 4) of the frame at joint positions [deg]."""
        return self.robot.placement(self.target_frame_name, self._configuration(joint_pos_deg)).homogeneous

    def inverse_kinematics(
        self,
        current_joint_pos: ArrayLike,
        desired_ee_pose: ArrayLike,
        position_weight: float = 1.0,
        orientation_weight: float = 0.01,
    ) -> Array:
        """The joint positions [deg] that bring the frame to a pose, starting from the current ones.

        An arm with fewer than six joints cannot reach every pose; the weights then say which error matters more.

        Args:
            current_joint_pos: The current joint positions [deg], as many as `joint_names` or more.
            desired_ee_pose: The pose of the frame (4, 4).
            position_weight: The weight of the position: 0 leaves it free, otherwise from 0.001 to 1000.
            orientation_weight: The weight of the orientation, likewise. One of the two must not be 0.

        Raises:
            ValueError: There are too few joint positions, or a weight is outside its range.
        """
        pose = np.asarray(desired_ee_pose, dtype=np.float64)
        targets = []
        if position_weight != 0.0:
            targets.append(pinik.Target(self.target_frame_name, pose[:3, 3], weight=position_weight))
        if orientation_weight != 0.0:
            targets.append(pinik.Target(self.target_frame_name, rotation=pose[:3, :3], weight=orientation_weight))
        solution = self.robot.solve(targets, q0=self._configuration(current_joint_pos), restarts=0)
        values = np.array(current_joint_pos, dtype=np.float64)
        values[: len(self.joint_names)] = [np.degrees(solution.angles[name]) for name in self.joint_names]
        return values

    def _configuration(self, degrees: ArrayLike) -> Array:
        values = np.radians(np.asarray(degrees, dtype=np.float64)[: len(self.joint_names)])
        if len(values) < len(self.joint_names):
            raise ValueError(
                f"there must be a value for each of {', '.join(self.joint_names)}; got {len(values)} values"
            )
        return self.robot.configuration(dict(zip(self.joint_names, values.tolist(), strict=True)))


def main() -> None:
    """Move the gripper of an SO-101 along a line of 10 cm."""
    arm = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll"]
    kinematics = RobotKinematics("so101", "gripper_frame_link", arm)
    values = np.array([0.0, -20.0, 40.0, 30.0, 0.0, 25.0])  # the last one is the gripper's
    pose = kinematics.forward_kinematics(values)
    for step in range(11):
        wanted = pose.copy()
        wanted[2, 3] += 0.01 * step
        values = kinematics.inverse_kinematics(values, wanted)
        missed = np.linalg.norm(kinematics.forward_kinematics(values)[:3, 3] - wanted[:3, 3])
        print(f"{step:2d}  {np.round(values, 2)}  {1000.0 * missed:.3f} mm off")


if __name__ == "__main__":
    main()
