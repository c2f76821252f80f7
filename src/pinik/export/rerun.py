"""Robots that move as Rerun recordings (.rrd)."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ..extras import needed_by
from ..files import write_whole
from .moving import Moving, Shown, check_suffix, moving

__all__ = ["save_rrd"]


def save_rrd(
    shown: Shown, path: str | os.PathLike[str], q: ArrayLike | None = None, *, times: ArrayLike | None = None
) -> None:
    """Write a robot with its visual shapes, moving through its configurations, as a .rrd file for Rerun's viewer.

    Each link with shapes is an entity "robot/NAME", placed relative to the robot's base [m] along the timeline "time";
    "angles/NAME" holds each joint's angle [rad or m].

    Args:
        shown, q, times: As for `save_glb`.
        path: The file; its name ends with ".rrd".

    Raises:
        InputError: An argument has another kind, shape or range, or the robot has no shapes.
        MissingExtraError: rerun-sdk or trimesh is not installed.
        OSError: The file cannot be written.

    Warns:
        UrdfWarning: Some shapes could not be read.
    """
    file = check_suffix(path, ".rrd")
    scene = moving(shown, q, times)
    with tempfile.TemporaryDirectory() as folder:
        draft = Path(folder) / "draft.rrd"
        _record(scene, draft)
        write_whole(file, draft.read_bytes())


def _record(scene: Moving, path: Path) -> None:
    with needed_by("a .rrd file", "rerun"):
        import rerun

    recording = rerun.RecordingStream(f"pinik: {scene.robot.name}", send_properties=False)
    recording.save(path)
    recording.log("/", rerun.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    when = [rerun.TimeColumn("time", duration=scene.times)]
    shapes = scene.shapes()
    for link in dict.fromkeys(shape.link for shape in shapes):
        places, turns = scene.places(link)
        columns = rerun.Transform3D.columns(translation=places, quaternion=turns)
        recording.send_columns(rerun.new_entity_path(["robot", link]), when, columns)
    for number, shape in enumerate(shapes):
        entity = rerun.new_entity_path(["robot", shape.link, str(number)])
        at = rerun.Transform3D(translation=shape.placement[:3, 3], mat3x3=shape.placement[:3, :3])
        recording.log(entity, at, static=True)
        color = np.round(255.0 * np.clip(shape.color, 0.0, 1.0)).astype(np.uint8)
        mesh = rerun.Mesh3D(
            vertex_positions=shape.mesh.vertices, triangle_indices=shape.mesh.faces,
            vertex_normals=shape.mesh.vertex_normals, albedo_factor=color,
        )  # fmt: skip
        recording.log(entity, mesh, static=True)
    angles = [scene.robot.angles(q) for q in scene.q]
    for name in scene.robot.joint_names:
        values = np.array([own[name] for own in angles])
        recording.send_columns(rerun.new_entity_path(["angles", name]), when, rerun.Scalars.columns(scalars=values))
    recording.disconnect()
