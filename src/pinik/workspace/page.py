"""One HTML file that shows a map, to turn and to slice, without a server."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..extras import needed_by
from ..files import write_whole
from ..picture.arguments import view_direction
from ..picture.bodies import Body, bodies_of
from ..robot import Robot
from .colors import ANCHORS
from .drawing import quantity_of
from .pose import shown_configuration
from .voxel_map import VoxelMap

__all__ = ["save_page"]

Array = NDArray[np.float64]

_TITLES = {
    "share": "Share of the orientations",
    "manipulability": "Manipulability",
    "room": "Distance to the joint limits",
    "branches": "Distinct answers",
}
_STEPS = 2**16 - 1


def save_page(reach: VoxelMap, path: str | os.PathLike[str], robot: Robot | None = None) -> None:
    """See `ReachMap.save_page`."""
    from html import escape  # with its list of entities

    machine = reach.require_robot(robot, "the page of a map")
    if not reach.workspace().any():
        raise InputError("no cell of the map is reached, so there is nothing to show")
    with needed_by("the page of a map", "live"):
        from ..viewer.web.document import document, json_in_html

    title = f"What {reach.frame} of {reach.robot} can reach"
    pieces = {"title": escape(title).encode(), "map": json_in_html(_document(reach, machine, title))}
    write_whole(path, document("reach.html", pieces))


def _document(reach: VoxelMap, robot: Robot, title: str) -> dict[str, Any]:
    rows = np.flatnonzero(reach.counts.found)
    cells = reach.counts.cells[rows]
    quantities = {}
    for name, words in _TITLES.items():
        if name != "branches" or reach.counts_branches:
            values, largest = quantity_of(reach, name)
            own = values.ravel()[cells].astype("<f4")
            quantities[name] = {"title": words, "largest": largest, "values": _packed(own.tobytes())}
    down = None
    if reach.orientations.directions > 1:
        pointing = reach.counts.reached[rows][:, reach.orientations.down].any(axis=1)
        down = _packed(pointing.astype(np.uint8).tobytes())
    q = shown_configuration(reach, robot, view_direction("angle"))
    placement = np.eye(4) if reach.relative_to is None else robot.placement(reach.relative_to, q).homogeneous
    return {
        "title": title,
        "summary": str(reach),
        "origin": list(reach.grid.origin),
        "size": reach.grid.size,
        "shape": list(reach.grid.shape),
        "placement": placement.tolist(),
        "colors": list(ANCHORS),
        "cells": _packed(cells.astype("<i4").tobytes()),
        "quantities": quantities,
        "down": down,
        "robot": _robot(bodies_of(robot, q)),
    }


def _robot(bodies: list[Body]) -> dict[str, Any]:
    """The robot's surfaces: positions in 16 bits within each one's box, normals in 8, and the corners of triangles."""
    parts, pieces, at = [], [], 0
    for body in bodies:
        vertices, normals = body.solid.vertices, body.solid.normals
        rows, first, inverse = np.unique(
            np.hstack([vertices, normals]).astype(np.float32), axis=0, return_index=True, return_inverse=True
        )
        low = vertices.min(axis=0)
        step = np.ptp(vertices, axis=0) / _STEPS
        positions = np.rint((vertices[first] - low) / np.where(step > 0.0, step, 1.0)).astype("<u2")
        faces = inverse.reshape(-1)[body.solid.faces].astype("<u4")
        content = {
            "index": faces.tobytes(),
            "position": positions.tobytes(),
            "normal": np.rint(127.0 * normals[first]).astype(np.int8).tobytes(),
        }
        start = {}
        for name, piece in content.items():
            start[name] = at
            pieces.append(piece + bytes(-len(piece) % 4))
            at += len(pieces[-1])
        parts.append(
            {
                "color": body.color.tolist(),
                "opacity": body.opacity,
                "low": low.tolist(),
                "step": step.tolist(),
                "vertices": len(rows),
                "faces": len(faces),
                "start": start,
            }
        )
    return {"parts": parts, "bytes": _packed(b"".join(pieces))}


def _packed(data: bytes) -> str:
    with needed_by("the page of a map", "live"):
        from ..viewer.protocol.packed_frames import deflated
        from ..viewer.web.document import as_base64

    return as_base64(deflated(data))
