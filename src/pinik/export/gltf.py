"""A glTF 2.0 document that is being written: its JSON, and the one buffer with all numbers and pictures."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..picture.solids import Solid
from ..version import __version__

__all__ = ["Document"]

Array = NDArray[np.float64]

_FLOAT, _UINT = 5126, 5125  # glTF's names of types, and of what a buffer is for
_VERTICES, _INDICES = 34962, 34963
_UNLIT = "KHR_materials_unlit"
_STILL = 1e-7  # [m, or of a quaternion]: what moves less has no keys


class Document:
    """A document with one scene, and one animation if anything moves.

    Attributes:
        root: The number of the node that holds all others.
    """

    def __init__(self, name: str, rotation: Sequence[float]) -> None:
        """Begin with a root that has a name and a rotation (x, y, z, w)."""
        self.root = 0
        self._buffer = bytearray()
        self._parts: dict[str, list[dict[str, Any]]] = {
            part: [] for part in ("nodes", "meshes", "materials", "textures", "images", "accessors", "bufferViews")
        }
        self._parts["nodes"].append({"name": name, "rotation": list(rotation)})
        self._materials: dict[tuple[Any, ...], int] = {}
        self._inputs: dict[bytes, int] = {}
        self._extensions: set[str] = set()
        self._channels: list[dict[str, Any]] = []
        self._samplers: list[dict[str, Any]] = []

    def content(self) -> bytes:
        """The whole file."""
        document = {
            "asset": {"version": "2.0", "generator": f"pinik {__version__}"},
            "scene": 0,
            "scenes": [{"name": self._parts["nodes"][0]["name"], "nodes": [0]}],
            "buffers": [{"byteLength": len(self._buffer)}],
        } | {name: part for name, part in self._parts.items() if part}
        if self._extensions:
            document["extensionsUsed"] = sorted(self._extensions)
        if self._channels:
            document["animations"] = [{"name": "motion", "channels": self._channels, "samplers": self._samplers}]
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        head = struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(self._buffer), len(text), b"JSON")
        return head + text + struct.pack("<I4s", len(self._buffer), b"BIN\0") + bytes(self._buffer)

    def node(self, name: str, parent: int, **fields: Any) -> int:
        """Add a node with these fields of glTF; returns its number."""
        nodes = self._parts["nodes"]
        nodes.append({"name": name, **fields})
        number = len(nodes) - 1
        nodes[parent].setdefault("children", []).append(number)
        return number

    def move(self, node: int, times: Array, positions: Array, turns: Array) -> None:
        """Put a node where it is first, and let it move if it does.

        Args:
            node: Its number.
            times: (n,) [s], from 0 on.
            positions: (n, 3) [m].
            turns: (n, 4) quaternions (x, y, z, w).
        """
        for path, rows, kind in (("translation", positions, "VEC3"), ("rotation", turns, "VEC4")):
            self._parts["nodes"][node][path] = rows[0].tolist()
            if (np.ptp(rows, axis=0) > _STILL).any():
                sampler = {"input": self._input(times), "output": self._accessor(_floats(rows), kind)}
                self._samplers.append(sampler)
                target = {"node": node, "path": path}
                self._channels.append({"sampler": len(self._samplers) - 1, "target": target})

    def _input(self, times: Array) -> int:
        """The accessor of these times, which all that moves shares."""
        when = _floats(times)
        if when.tobytes() not in self._inputs:
            self._inputs[when.tobytes()] = self._accessor(when, "SCALAR", bounds=True)
        return self._inputs[when.tobytes()]

    def mesh(self, name: str, surfaces: Sequence[tuple[Solid, int]], corners: ArrayLike | None = None) -> int:
        """Add a mesh of surfaces, each with its material; returns its number.

        Args:
            name: Its name.
            surfaces: The surfaces, and the numbers of their materials.
            corners: Where the vertices are in the material's picture (v, 2), if it has one: from the left and the top.
        """
        primitives = []
        for solid, material in surfaces:
            attributes = {
                "POSITION": self._accessor(_floats(solid.vertices), "VEC3", _VERTICES, bounds=True),
                "NORMAL": self._accessor(_floats(solid.normals), "VEC3", _VERTICES),
            }
            if corners is not None:
                attributes["TEXCOORD_0"] = self._accessor(_floats(corners), "VEC2", _VERTICES)
            indices = self._accessor(solid.faces.astype(np.uint32).ravel(), "SCALAR", _INDICES)
            primitives.append({"attributes": attributes, "indices": indices, "material": material})
        self._parts["meshes"].append({"name": name, "primitives": primitives})
        return len(self._parts["meshes"]) - 1

    def paint(self, color: Sequence[float], roughness: float = 0.55, metalness: float = 0.05) -> int:
        """The material of a colour (red, green, blue, opacity in 0..1); those of the live page are the standard.

        Colours of robots are sRGB, and glTF's factors are linear.
        """
        key = (*np.clip(color, 0.0, 1.0).tolist(), roughness, metalness)
        if key not in self._materials:
            *rgb, opacity = key[:4]
            linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb]
            look = {"baseColorFactor": [*linear, opacity], "metallicFactor": metalness, "roughnessFactor": roughness}
            name = "#" + "".join(f"{round(255 * part):02x}" for part in rgb)
            material: dict[str, Any] = {"name": name, "pbrMetallicRoughness": look, "doubleSided": True}
            self._materials[key] = self._add_material(material | ({"alphaMode": "BLEND"} if opacity < 1.0 else {}))
        return self._materials[key]

    def printed(self, name: str, png: bytes) -> int:
        """A material that shows a picture as it is, without light, on its front."""
        self._parts["images"].append({"name": name, "mimeType": "image/png", "bufferView": self._view(png)})
        self._parts["textures"].append({"source": len(self._parts["images"]) - 1})
        self._extensions.add(_UNLIT)
        look = {"baseColorTexture": {"index": len(self._parts["textures"]) - 1}, "metallicFactor": 0.0}
        return self._add_material({"name": name, "pbrMetallicRoughness": look, "extensions": {_UNLIT: {}}})

    def _add_material(self, material: dict[str, Any]) -> int:
        self._parts["materials"].append(material)
        return len(self._parts["materials"]) - 1

    def _accessor(self, values: NDArray[Any], kind: str, use: int | None = None, bounds: bool = False) -> int:
        """Add numbers, which all have four bytes."""
        accessor: dict[str, Any] = {
            "bufferView": self._view(np.ascontiguousarray(values).tobytes(), use),
            "componentType": _UINT if values.dtype == np.uint32 else _FLOAT,
            "count": len(values),
            "type": kind,
        }
        if bounds:
            rows = values.reshape(len(values), -1)
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self._parts["accessors"].append(accessor)
        return len(self._parts["accessors"]) - 1

    def _view(self, data: bytes, use: int | None = None) -> int:
        """Append bytes to the buffer, each piece at a multiple of four."""
        view = {"buffer": 0, "byteOffset": len(self._buffer), "byteLength": len(data)}
        self._parts["bufferViews"].append(view if use is None else view | {"target": use})
        self._buffer += data + bytes(-len(data) % 4)
        return len(self._parts["bufferViews"]) - 1


def _floats(values: ArrayLike) -> NDArray[np.float32]:
    return np.asarray(values, dtype=np.float32)
