"""Robots, their shapes and their motion as what the page gets (docs/live-protocol.md)."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pinocchio
import umsgpack
from numpy.typing import NDArray

from ...errors import EngineError
from ...extras import needed_by
from ...model.home import robot_size
from ...model.robot_model import Robot

if TYPE_CHECKING:
    from ...shapes.meshes import Color, Shape

__all__ = [
    "FRAME_MAGIC",
    "InstanceBlock",
    "JointPlacements",
    "Shapes",
    "make_shapes",
    "meshcat_script",
    "pack_frame",
    "robot_message",
]

Array = NDArray[np.float64]

FRAME_MAGIC = b"PNKF"
"""The first four bytes of a frame message."""

# What three.js calls them; as msgpack extension types, msgpack-lite's numbers for typed arrays.
_TYPED_ARRAYS = {"<f4": ("Float32Array", 0x17), "<u4": ("Uint32Array", 0x16)}


def meshcat_script() -> Path:
    """The JavaScript of meshcat's viewer, found without importing meshcat (which takes IPython and ZeroMQ in).

    Raises:
        EngineError: It is not there; the message says what would put it there.
    """
    spec = importlib.util.find_spec("meshcat")
    for folder in (spec and spec.submodule_search_locations) or ():
        script = Path(folder) / "viewer" / "dist" / "main.min.js"
        if script.is_file():
            return script
    raise EngineError(
        "meshcat's viewer (meshcat/viewer/dist/main.min.js) is missing: pip install 'meshcat>=0.3.2,<0.4'"
    )


def robot_message(robot: Robot, generation: int) -> dict[str, Any]:
    """The `robot` message: joints, links and frames by name and place.

    `size` [m] is `robot_size`. `frames` are the links that something moves, those at the ends first (all
    links, where nothing moves).
    """
    model = robot.model
    by_id = {joint.id: joint for joint in robot.joints}
    links = [model.frames[robot.frame_id(name)] for name in robot.description.links]
    moved = [link.name for link in links if link.parentJoint]
    carriers = {joint.parent for joint in robot.description.joints}
    return {
        "type": "robot",
        "generation": generation,
        "name": robot.name,
        "root": robot.root,
        "joints": [
            {
                "name": name,
                "parent": model.parents[joint_id],
                "kind": by_id[joint_id].kind if joint_id else "fixed",
                "placement": _seven(model.jointPlacements[joint_id]),
            }
            for joint_id, name in enumerate(model.names)
        ],
        "links": [
            {"name": link.name, "joint": link.parentJoint, "placement": _seven(link.placement)} for link in links
        ],
        "frames": sorted(moved, key=carriers.__contains__) or list(robot.description.links),
        "size": robot_size(robot),
        "warnings": list(robot.warnings),
    }


def _seven(placement: pinocchio.SE3) -> list[float]:
    return list(map(float, pinocchio.SE3ToXYZQUATtuple(placement)))


@dataclass(frozen=True)
class Shapes:
    """A robot's shapes as meshcat commands, one for each link and colour.

    Attributes:
        parts: (index of the link in the `robot` message, path of the object in meshcat's tree).
        commands: meshcat's `set_object` of each part, msgpack.
        warnings: A sentence about each shape that could not be read.
    """

    parts: tuple[tuple[int, str], ...]
    commands: tuple[bytes, ...]
    warnings: tuple[str, ...]

    def message(self, generation: int) -> dict[str, Any]:
        """The `shapes` message that follows the commands."""
        return {
            "type": "shapes",
            "generation": generation,
            "warnings": list(self.warnings),
            "parts": [{"link": link, "path": path} for link, path in self.parts],
        }


def make_shapes(robot: Robot) -> Shapes:
    """Read a robot's visual shapes and convert them; imports trimesh, and takes seconds for a large robot."""
    with needed_by("the robot's shape", "live"):
        from ...shapes.meshes import load_shapes  # over a second to import

    shapes, warnings = load_shapes(robot)
    by_link: dict[str, dict[Color, list[Shape]]] = {}
    for shape in shapes:
        by_link.setdefault(shape.link, {}).setdefault(shape.color, []).append(shape)
    parts, commands = [], []
    for index, link in enumerate(robot.description.links):
        for part, (color, same) in enumerate(by_link.get(link, {}).items()):
            path = f"/pinik/shapes/{index}/{part}"
            parts.append((index, path))
            commands.append(_set_object(path, *_merged(same), color))
    return Shapes(tuple(parts), tuple(commands), tuple(warnings))


def _merged(shapes: Sequence[Shape]) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Vertices (n, 6), position [m] and normal in the link's frame, and faces (m, 3); equal vertices are one."""
    vertices, faces, count = [], [], 0
    for shape in shapes:
        R, p = shape.placement[:3, :3], shape.placement[:3, 3]
        corners = np.hstack([shape.mesh.vertices @ R.T + p, shape.mesh.vertex_normals @ R.T])
        vertices.append(corners)
        faces.append(np.asarray(shape.mesh.faces) + count)
        count += len(corners)
    rows = np.vstack(vertices).astype("<f4")
    as_bytes = rows.view(np.dtype((np.void, rows.strides[0]))).ravel()
    _, first, inverse = np.unique(as_bytes, return_index=True, return_inverse=True)
    return rows[first], inverse[np.vstack(faces)].astype("<u4")


def _set_object(path: str, vertices: NDArray[np.float32], faces: NDArray[np.uint32], color: Color) -> bytes:
    """meshcat's command that puts a mesh at `path`, in three.js's object format 4.5."""
    red, green, blue, opacity = (min(max(channel, 0.0), 1.0) for channel in color)
    attributes = {"position": _typed(vertices[:, :3]), "normal": _typed(vertices[:, 3:])}
    geometry = {
        "uuid": f"{path}/geometry",
        "type": "BufferGeometry",
        "data": {"attributes": attributes, "index": _typed(faces)},
    }
    material = {
        "uuid": f"{path}/material",
        "type": "MeshStandardMaterial",
        "color": round(255 * red) << 16 | round(255 * green) << 8 | round(255 * blue),
        "roughness": 0.55,
        "metalness": 0.05,
        "transparent": opacity < 1.0,
        "opacity": opacity,
        "vertexColors": False,
        "side": 2,  # THREE.DoubleSide: many files have faces that look inwards
    }
    lowered = {
        "metadata": {"version": 4.5, "type": "Object"},
        "geometries": [geometry],
        "materials": [material],
        "object": {
            "uuid": f"{path}/mesh",
            "type": "Mesh",
            "geometry": geometry["uuid"],
            "material": material["uuid"],
        },
    }
    return bytes(umsgpack.packb({"type": "set_object", "path": path, "object": lowered}))


def _typed(array: NDArray[Any]) -> dict[str, Any]:
    name, code = _TYPED_ARRAYS[array.dtype.str]
    return {"itemSize": 3, "type": name, "array": umsgpack.Ext(code, array.tobytes()), "normalized": False}


class JointPlacements:
    """Where all joints of a robot are, for one thread, as numbers to send.

    Args:
        robot: Whose; the working memory is this object's own.
    """

    def __init__(self, robot: Robot) -> None:
        self._model = robot.model
        self._data = robot.model.createData()
        # The elements stay where they are and show each new result; indexing them anew costs as much as reading.
        self._joints = [self._data.oMi[joint_id] for joint_id in range(robot.model.njoints)]

    def at(self, q: Array) -> Array:
        """World placements (J, 7) of all joints at `q`, the universe first: x, y, z [m], qx, qy, qz, qw."""
        pinocchio.forwardKinematics(self._model, self._data, q)
        return np.array([pinocchio.SE3ToXYZQUATtuple(joint) for joint in self._joints])

    def points(self, frames: Sequence[int]) -> Array:
        """Origins (B, 3) in the world [m] of the frames with these indices, at the `q` that `at` had last."""
        origins = [pinocchio.updateFramePlacement(self._model, self._data, frame).translation for frame in frames]
        return np.array(origins).reshape(-1, 3)


class InstanceBlock(NamedTuple):
    """One instance's part of a frame.

    Attributes:
        figures: The eight figures of docs/live-protocol.md.
        joints: World placements (J, 7).
        sides: At which limit each joint sits (J,).
        points: The effectors' origins (B, 3) [m].
    """

    figures: Sequence[float]
    joints: Array
    sides: Array
    points: Array


def pack_frame(generation: int, step: int, balls: Array, blocks: Sequence[InstanceBlock]) -> bytes:
    """The message of one frame.

    Args:
        generation: Which robot it shows.
        step: Counts up.
        balls: Placements (B, 7): x, y, z [m], qx, qy, qz, qw.
        blocks: One for each instance, all of the same robot.
    """
    joints = len(blocks[0].joints) if blocks else 0
    pieces = [np.array([generation, step, len(blocks), joints, len(balls)]), np.ravel(balls)]
    for block in blocks:
        pieces += [np.ravel(part) for part in block]
    numbers = np.concatenate(pieces, dtype="<f4", casting="same_kind")
    if numbers.size != 5 + 7 * len(balls) + len(blocks) * (8 + 8 * joints + 3 * len(balls)):
        raise ValueError("a frame's blocks are eight figures, and alike in their numbers of joints and points")
    return FRAME_MAGIC + numbers.tobytes()
