"""A player of .glb files as simple as can be: pygltflib reads them, and what follows is glTF's own rules."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pygltflib

FROM_GLTF = np.array([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
"""From glTF's axes (z forward, x to the left, y up) to those of robots (x forward, y to the left, z up)."""


def matrix(x, y, z, w):
    """A rotation from a quaternion, written out."""
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


class Player:
    """A file that is played.

    Attributes:
        document: The file, as pygltflib reads it.
        tracks: (name of the node, "translation" or "rotation") → its times, and its values.
    """

    def __init__(self, path: Path) -> None:
        self.document = pygltflib.GLTF2().load(str(path))
        nodes = self.document.nodes
        self.parents = {child: k for k, node in enumerate(nodes) for child in node.children}
        self.tracks = {}
        for animation in self.document.animations:
            for channel in animation.channels:
                sampler = animation.samplers[channel.sampler]
                assert sampler.interpolation == "LINEAR"
                key = nodes[channel.target.node].name, channel.target.path
                assert key not in self.tracks
                self.tracks[key] = self.numbers(sampler.input).ravel(), self.numbers(sampler.output)

    @property
    def names(self):
        return [node.name for node in self.document.nodes]

    @property
    def duration(self):
        return max(times[-1] for times, _ in self.tracks.values())

    def numbers(self, index):
        """The numbers of an accessor."""
        accessor = self.document.accessors[index]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor.type]
        letter = {5126: "f", 5125: "I"}[accessor.componentType]
        content = struct.unpack(f"<{accessor.count * width}{letter}", self.bytes(accessor.bufferView))
        return np.array(content).reshape(accessor.count, width)

    def bytes(self, view):
        view = self.document.bufferViews[view]
        return self.document.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]

    def place(self, name, time, above=None):
        """Where a node is at a time (4, 4), in the robot's axes; in the world, or in that of a node above it."""
        (k,) = [k for k, node in enumerate(self.document.nodes) if node.name == name]
        whole = np.eye(4)
        while k is not None and self.document.nodes[k].name != above:
            whole = self._local(k, time) @ whole
            k = self.parents.get(k)
        return FROM_GLTF @ whole if above is None else whole

    def _local(self, k, time):
        node = self.document.nodes[k]
        if node.matrix is not None:
            return np.array(node.matrix).reshape(4, 4).T
        whole = np.eye(4)
        whole[:3, :3] = matrix(*self._value(node, "rotation", time, [0.0, 0.0, 0.0, 1.0]))
        whole[:3, 3] = self._value(node, "translation", time, [0.0, 0.0, 0.0])
        return whole

    def _value(self, node, path, time, rest):
        if (node.name, path) not in self.tracks:
            return np.array(getattr(node, path) or rest)
        times, rows = self.tracks[node.name, path]
        after = int(np.clip(np.searchsorted(times, time), 1, len(times) - 1))
        share = float(np.clip((time - times[after - 1]) / (times[after] - times[after - 1]), 0.0, 1.0))
        start, end = rows[after - 1], rows[after]
        if path == "translation":
            return (1.0 - share) * start + share * end
        angle = np.arccos(np.clip(abs(start @ end), -1.0, 1.0))
        if angle < 1e-6:
            return end
        sign = 1.0 if start @ end >= 0.0 else -1.0
        return (np.sin((1.0 - share) * angle) * start + sign * np.sin(share * angle) * end) / np.sin(angle)
