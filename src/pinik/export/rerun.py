"""Robots that move as Rerun recordings (.rrd)."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..extras import needed_by
from ..files import write_whole
from ..picture.arguments import as_color
from ..picture.draw import BALL, PINNED
from .keys import places_of
from .scene import ARM, Scene, Shown, check_suffix, scene_of

__all__ = ["save_rrd"]

Array = NDArray[np.float64]


def save_rrd(
    shown: Shown, path: str | os.PathLike[str], q: ArrayLike | None = None, *, times: ArrayLike | None = None
) -> None:
    """Write a robot with its visual shapes, moving through its configurations, as a .rrd file for Rerun's viewer.

    Each link with shapes is an entity "robot/NAME", placed relative to the robot's base [m] along the timeline "time";
    "angles/NAME" holds each joint's angle [rad or m].

    The robots of a live view stand side by side. Each has the name of its method before its entities: "robot/dls/NAME",
    and "angles/dls/NAME". "robot/dls/ball FRAME" is a ball, and "robot/dls/name" the label with the method.

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
    scene = scene_of(shown, q, times)
    scene.warn()
    with tempfile.TemporaryDirectory() as folder:
        draft = Path(folder) / "draft.rrd"
        _record(scene, draft)
        write_whole(file, draft.read_bytes())


def _record(scene: Scene, path: Path) -> None:
    with needed_by("a .rrd file", "rerun"):
        import rerun

    recording = rerun.RecordingStream("pinik", send_properties=False)
    recording.save(path)
    recording.log("/", rerun.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    when = [rerun.TimeColumn("time", duration=scene.times)]

    def move(entity: str, places: Array, turns: Array) -> None:
        columns = rerun.Transform3D.columns(translation=places, quaternion=turns)
        recording.send_columns(entity, when, columns)

    for actor, offset in zip(scene.actors, scene.offsets, strict=True):
        parts = ["robot", actor.name] if actor.name else ["robot"]
        if actor.name:
            recording.log(rerun.new_entity_path(parts), rerun.Transform3D(translation=offset), static=True)
        for link in dict.fromkeys(shape.link for shape in scene.shapes):
            move(rerun.new_entity_path([*parts, link]), *places_of(scene.robot, link, actor.q))
        for number, shape in enumerate(scene.shapes):
            entity = rerun.new_entity_path([*parts, shape.link, str(number)])
            at = rerun.Transform3D(translation=shape.placement[:3, 3], mat3x3=shape.placement[:3, :3])
            recording.log(entity, at, static=True)
            mesh = rerun.Mesh3D(
                vertex_positions=shape.mesh.vertices, triangle_indices=shape.mesh.faces,
                vertex_normals=shape.mesh.vertex_normals, albedo_factor=_bytes(shape.color),
            )  # fmt: skip
            recording.log(entity, mesh, static=True)
        for one in scene.balls:
            entity = rerun.new_entity_path([*parts, f"ball {one.frame}"])
            move(entity, one.positions, one.quat_xyzw)
            color = _bytes(as_color(PINNED if one.pinned else BALL, "color"))
            sphere = rerun.Ellipsoids3D(
                radii=[scene.ball_radius], colors=[color], fill_mode=rerun.components.FillMode.Solid
            )
            recording.log(entity, sphere, static=True)
            if one.oriented:
                recording.log(entity, rerun.TransformAxes3D(ARM * scene.ball_radius), static=True)
        if actor.title:
            color = _bytes(as_color(actor.color, "color"))
            label = rerun.Points3D([scene.plate], labels=[actor.title], colors=[color], show_labels=True)
            recording.log(rerun.new_entity_path([*parts, "name"]), label, static=True)
        angles = [scene.robot.angles(q) for q in actor.q]
        for name in angles[0]:  # followers included
            values = np.array([own[name] for own in angles])
            entity = rerun.new_entity_path(["angles", *parts[1:], name])
            recording.send_columns(entity, when, rerun.Scalars.columns(scalars=values))
    recording.disconnect()


def _bytes(color: ArrayLike) -> NDArray[np.uint8]:
    """A colour in 0..1 as Rerun takes it: sRGB, as robot files have it."""
    return np.round(255.0 * np.clip(color, 0.0, 1.0)).astype(np.uint8)
