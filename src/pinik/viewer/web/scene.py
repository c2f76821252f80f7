"""A robot's shapes as meshcat commands, and meshcat's viewer that draws them."""

from __future__ import annotations

import importlib.util
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import umsgpack
from numpy.typing import NDArray

from ...errors import EngineError
from ...extras import needed_by
from ...robot import Robot

if TYPE_CHECKING:
    from ...shapes.meshes import Color, Shape

__all__ = ["Shapes", "collision_shapes", "make_shapes", "meshcat_script"]

_COARSE = 20_000  # triangles of a whole robot, as a processor without a graphics card draws it
# dtype → three.js's name, and the msgpack extension type that msgpack-lite gives this typed array.
_TYPED_ARRAYS = {"<f4": ("Float32Array", 0x17), "<u4": ("Uint32Array", 0x16)}


def meshcat_script() -> Path:
    """Find the JavaScript of meshcat's viewer without importing meshcat, which would import IPython and ZeroMQ.

    Raises:
        EngineError: The file is missing; the message says what to install.
    """
    spec = importlib.util.find_spec("meshcat")
    for folder in (spec and spec.submodule_search_locations) or ():
        script = Path(folder) / "viewer" / "dist" / "main.min.js"
        if script.is_file():
            return script
    raise EngineError(
        "meshcat's viewer (meshcat/viewer/dist/main.min.js) is missing: pip install 'meshcat>=0.3.2,<0.4'"
    )


@dataclass(frozen=True)
class Shapes:
    """A robot's shapes as meshcat commands, one per link and colour.

    Attributes:
        parts: For each part, the index of its link in the `robot` message and its path in meshcat's tree.
        commands: For each part, meshcat's `set_object` command as msgpack.
        warnings: One sentence per shape that could not be read.
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

    def messages(self, generation: int) -> list[str | bytes]:
        """The commands, and the message that follows them."""
        return [*self.commands, json.dumps(self.message(generation))]


def make_shapes(robot: Robot) -> Shapes:
    """Read and convert a robot's visual shapes. This imports trimesh and takes seconds for a large robot."""
    with needed_by("the robot's shape", "live"):
        from ...shapes.meshes import load_shapes  # over a second to import

    shapes, warnings = load_shapes(robot)
    share = _COARSE / max(1, sum(len(shape.mesh.faces) for shape in shapes))
    return _converted(robot, shapes, warnings, "/pinik/shapes", share)


def collision_shapes(robot: Robot) -> Shapes:
    """Read and convert a robot's collision shapes, likewise."""
    with needed_by("the robot's collision shapes", "live"):
        from ...shapes.meshes import load_collision_shapes

    return _converted(robot, *load_collision_shapes(robot), "/pinik/collisions", 1.0)  # always drawn in detail


def _converted(robot: Robot, shapes: Sequence[Shape], warnings: Sequence[str], root: str, share: float) -> Shapes:
    """Convert shapes into commands for parts below `root` in meshcat's tree; `share` is as for `_with_coarse`."""
    by_link: dict[str, dict[Color, list[Shape]]] = {}
    for shape in shapes:
        by_link.setdefault(shape.link, {}).setdefault(shape.color, []).append(shape)
    parts, commands = [], []
    for index, link in enumerate(robot.description.links):
        for part, (color, same) in enumerate(by_link.get(link, {}).items()):
            path = f"{root}/{index}/{part}"
            parts.append((index, path))
            commands.append(_set_object(path, *_with_coarse(*_merged(same), share), color))
    return Shapes(tuple(parts), tuple(commands), tuple(warnings))


def _merged(shapes: Sequence[Shape]) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Merge shapes into vertices (n, 6), position [m] and normal in the link's frame, and faces (m, 3).

    Equal vertices become one.
    """
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


def _with_coarse(
    vertices: NDArray[np.float32], faces: NDArray[np.uint32], share: float
) -> tuple[NDArray[np.float32], NDArray[np.uint32], dict[str, int]]:
    """Append to a mesh one with about this share of the triangles, for pages that a processor draws.

    Returns:
        The vertices, the faces, and where the appended ones begin: how many indices are `fine`, and the `first` vertex
        of the others. If there are few triangles, nothing is appended, and both are 0.
    """
    with needed_by("the robot's shape", "live"):
        from ...shapes.simplified import simplified

    coarse = simplified(vertices[:, :3], faces, share)
    if coarse is None:
        return vertices, faces, {"fine": 0, "first": 0}
    corners = np.hstack([coarse.vertices, coarse.vertex_normals]).astype("<f4")
    appended = (coarse.faces + len(vertices)).astype("<u4")
    begins = {"fine": faces.size, "first": len(vertices)}
    return np.vstack([vertices, corners]), np.vstack([faces, appended]), begins


def _set_object(
    path: str, vertices: NDArray[np.float32], faces: NDArray[np.uint32], begins: dict[str, int], color: Color
) -> bytes:
    """Return meshcat's command that puts a mesh at `path`, in three.js's object format 4.5."""
    red, green, blue, opacity = (min(max(channel, 0.0), 1.0) for channel in color)
    attributes = {"position": _typed(vertices[:, :3]), "normal": _typed(vertices[:, 3:])}
    geometry = {
        "uuid": f"{path}/geometry",
        "type": "BufferGeometry",
        "data": {"attributes": attributes, "index": _typed(faces)},
        "userData": begins,
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
        "side": 2,  # THREE.DoubleSide, because many files have faces that point inwards
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
