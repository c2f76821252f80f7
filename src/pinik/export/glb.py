"""Robots that move as binary glTF 2.0 files (.glb), which browsers, Blender and many viewers play."""

from __future__ import annotations

import json
import os
import struct
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..files import write_whole
from ..version import __version__
from .moving import Moving, Shown, check_suffix, moving

__all__ = ["save_glb"]

_FLOAT, _UINT = 5126, 5125  # glTF's names of types, and of what a buffer is for
_VERTICES, _INDICES = 34962, 34963
_UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # glTF's y points up, and URDF's z


def save_glb(
    shown: Shown, path: str | os.PathLike[str], q: ArrayLike | None = None, *, times: ArrayLike | None = None
) -> None:
    """Write a robot with its visual shapes, at one configuration or moving through several, as a .glb file.

    Each link with shapes is a node of that name below the node "robot", and its placement [m] is relative to the
    robot's base. With several configurations they are the keys of one animation, linear in between.

    Args:
        shown: A solution, a track or a self-motion; or a robot with `q`.
        path: The file; its name ends with ".glb".
        q: A configuration (nq,) or several (n, nq) of a robot; neutral when None.
        times: When it is at each (n,) [s], increasing; those of a track, or 30 a second, when None.

    Raises:
        InputError: An argument has another kind, shape or range, or the robot has no shapes.
        MissingExtraError: trimesh is not installed.
        OSError: The file cannot be written.

    Warns:
        UrdfWarning: Some shapes could not be read.
    """
    write_whole(check_suffix(path, ".glb"), _Document(moving(shown, q, times)).content())


class _Document:
    """A glTF document that is being written: its JSON, and the one buffer with all numbers."""

    def __init__(self, scene: Moving) -> None:
        self._buffer = bytearray()
        self._accessors: list[dict[str, Any]] = []
        self._views: list[dict[str, Any]] = []
        self._materials: dict[tuple[float, ...], int] = {}
        self._meshes: list[dict[str, Any]] = []
        self._nodes: list[dict[str, Any]] = [{"name": "robot", "rotation": _UPRIGHT, "children": []}]
        self._animation: dict[str, Any] = {"name": "motion", "channels": [], "samplers": []}
        links = self._shapes(scene)
        self._move(scene, links)

    def content(self) -> bytes:
        """The whole file."""
        document = {
            "asset": {"version": "2.0", "generator": f"pinik {__version__}"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "materials": [_material(color) for color in self._materials],
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._buffer)}],
        }
        if self._animation["channels"]:
            document["animations"] = [self._animation]
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        head = struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(self._buffer), len(text), b"JSON")
        return head + text + struct.pack("<I4s", len(self._buffer), b"BIN\0") + bytes(self._buffer)

    def _shapes(self, scene: Moving) -> dict[str, int]:
        """Link → its node, for all links with shapes."""
        links: dict[str, int] = {}
        for shape in scene.shapes():
            if shape.link not in links:
                links[shape.link] = self._node({"name": shape.link, "children": []}, parent=0)
            vertices, normals = (
                np.asarray(rows, dtype=np.float32) for rows in (shape.mesh.vertices, shape.mesh.vertex_normals)
            )
            primitive = {
                "attributes": {
                    "POSITION": self._accessor(vertices, "VEC3", _VERTICES, bounds=True),
                    "NORMAL": self._accessor(normals, "VEC3", _VERTICES),
                },
                "indices": self._accessor(np.uint32(shape.mesh.faces).ravel(), "SCALAR", _INDICES),
                "material": self._materials.setdefault(tuple(shape.color), len(self._materials)),
            }
            self._meshes.append({"primitives": [primitive]})
            matrix = shape.placement.T.ravel().tolist()
            mesh = len(self._meshes) - 1
            self._node({"name": shape.name, "mesh": mesh, "matrix": matrix}, parent=links[shape.link])
        return links

    def _node(self, node: dict[str, Any], parent: int) -> int:
        self._nodes.append(node)
        self._nodes[parent]["children"].append(len(self._nodes) - 1)
        return len(self._nodes) - 1

    def _move(self, scene: Moving, links: dict[str, int]) -> None:
        """Each link where it is first, and its keys if there are several."""
        count = len(scene.q)
        keys = self._accessor(np.asarray(scene.times, dtype=np.float32), "SCALAR", bounds=True) if count > 1 else None
        for link, node in links.items():
            places, turns = scene.places(link)
            self._nodes[node] |= {"translation": places[0].tolist(), "rotation": turns[0].tolist()}
            if keys is not None:
                for name, values, kind in (("translation", places, "VEC3"), ("rotation", turns, "VEC4")):
                    sampler = {"input": keys, "output": self._accessor(np.asarray(values, dtype=np.float32), kind)}
                    self._animation["samplers"].append(sampler)
                    target = {"node": node, "path": name}
                    number = len(self._animation["samplers"]) - 1
                    self._animation["channels"].append({"sampler": number, "target": target})

    def _accessor(self, values: NDArray[Any], kind: str, use: int | None = None, bounds: bool = False) -> int:
        """Append numbers to the buffer, whose entries all have four bytes."""
        view = {"buffer": 0, "byteOffset": len(self._buffer), "byteLength": values.nbytes}
        self._views.append(view if use is None else view | {"target": use})
        self._buffer += np.ascontiguousarray(values).tobytes()
        accessor: dict[str, Any] = {
            "bufferView": len(self._views) - 1,
            "componentType": _UINT if values.dtype == np.uint32 else _FLOAT,
            "count": len(values),
            "type": kind,
        }
        if bounds:
            rows = values.reshape(len(values), -1)
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self._accessors.append(accessor)
        return len(self._accessors) - 1


def _material(color: tuple[float, ...]) -> dict[str, Any]:
    """A matt material. Colours of URDF are sRGB, and glTF's factors are linear."""
    *rgb, opacity = np.clip(color, 0.0, 1.0).tolist()
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb]
    look = {"baseColorFactor": [*linear, opacity], "metallicFactor": 0.0, "roughnessFactor": 0.7}
    material: dict[str, Any] = {"pbrMetallicRoughness": look, "doubleSided": True}
    return material | ({"alphaMode": "BLEND"} if opacity < 1.0 else {})
