"""Sculpted shapes: distance fields, blended smoothly and meshed by surface nets; and tubes, lathes, extrusions.

Lengths are metres. Only +, -, *, /, sqrt, min, max and comparisons touch grids: every machine makes the same mesh.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = Sequence[float]
Field = Callable[[Array, Array, Array], Array]


@dataclass(frozen=True)
class Mesh:
    """Vertices (n, 3) and triangles (m, 3), seen from outside counter-clockwise."""

    vertices: Array
    faces: NDArray[np.int64]

    def moved(self, offset: Point) -> Mesh:
        return Mesh(self.vertices + np.asarray(offset, dtype=float), self.faces)

    def facing(self, axis: str) -> Mesh:
        """The mesh with its axes permuted cyclically, so that its z axis becomes this axis."""
        order = {"x": [2, 0, 1], "y": [1, 2, 0], "z": [0, 1, 2]}[axis]
        return Mesh(self.vertices[:, order], self.faces)

    def grown(self, factor: float, about: Point) -> Mesh:
        center = np.asarray(about, dtype=float)
        return Mesh((self.vertices - center) * factor + center, self.faces)

    def obj(self, scale: float = 1000.0) -> bytes:
        """Wavefront OBJ in millimetres, rounded to a tenth."""
        vertices = np.round(self.vertices * scale, 1) + 0.0
        lines = [f"v {x:g} {y:g} {z:g}" for x, y, z in vertices.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (self.faces + 1).tolist()]
        return ("\n".join(lines) + "\n").encode()


def joined(meshes: Iterable[Mesh]) -> Mesh:
    vertices, faces, count = [], [], 0
    for mesh in meshes:
        vertices.append(mesh.vertices)
        faces.append(mesh.faces + count)
        count += len(mesh.vertices)
    return Mesh(np.vstack(vertices), np.vstack(faces))


@dataclass(frozen=True)
class Solid:
    """A distance-like field, negative inside, and a box that holds the surface."""

    field: Field
    low: Array
    high: Array


def _turn(rpy: Point) -> list[list[float]]:
    (cr, cp, cy), (sr, sp, sy) = [math.cos(a) for a in rpy], [math.sin(a) for a in rpy]
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]


def ellipsoid(center: Point, radii: Point, rpy: Point = (0, 0, 0)) -> Solid:
    """`rpy` in degrees."""
    turn = _turn([math.radians(a) for a in rpy])

    def field(x: Array, y: Array, z: Array) -> Array:
        x, y, z = x - center[0], y - center[1], z - center[2]
        u, v, w = ((turn[0][i] * x + turn[1][i] * y + turn[2][i] * z) / radii[i] for i in range(3))
        near = np.sqrt(u * u + v * v + w * w)
        u, v, w = u / radii[0], v / radii[1], w / radii[2]
        slope = np.maximum(np.sqrt(u * u + v * v + w * w), 1e-9)
        return near * (near - 1.0) / slope

    reach = np.array([math.sqrt(sum((turn[i][j] * radii[j]) ** 2 for j in range(3))) for i in range(3)])
    middle = np.asarray(center, dtype=float)
    return Solid(field, middle - reach, middle + reach)


def ball(center: Point, radius: float) -> Solid:
    return ellipsoid(center, (radius, radius, radius))


def limb(a: Point, b: Point, radius_a: float, radius_b: float) -> Solid:
    """A round bar from a to b, tapering."""
    ab = [b[i] - a[i] for i in range(3)]
    square = sum(c * c for c in ab)

    def field(x: Array, y: Array, z: Array) -> Array:
        x, y, z = x - a[0], y - a[1], z - a[2]
        t = np.clip((x * ab[0] + y * ab[1] + z * ab[2]) / square, 0.0, 1.0)
        x, y, z = x - t * ab[0], y - t * ab[1], z - t * ab[2]
        return np.sqrt(x * x + y * y + z * z) - (radius_a + t * (radius_b - radius_a))

    pa, pb = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    return Solid(field, np.minimum(pa - radius_a, pb - radius_b), np.maximum(pa + radius_a, pb + radius_b))


def half_space(normal: Point, offset: float) -> Field:
    """The half space normal · p < offset."""
    length = math.sqrt(sum(c * c for c in normal))
    nx, ny, nz = (c / length for c in normal)
    return lambda x, y, z: nx * x + ny * y + nz * z - offset / length


def blend(width: float, *solids: Solid) -> Solid:
    """The union, with fillets about `width` wide where the parts meet."""

    def field(x: Array, y: Array, z: Array) -> Array:
        result = solids[0].field(x, y, z)
        for solid in solids[1:]:
            other = solid.field(x, y, z)
            h = np.maximum(width - np.abs(result - other), 0.0) / width
            result = np.minimum(result, other) - h * h * width * 0.25
        return result

    low = np.min([solid.low for solid in solids], axis=0) - width / 4
    high = np.max([solid.high for solid in solids], axis=0) + width / 4
    return Solid(field, low, high)


def carve(solid: Solid, *fields: Field, width: float = 0.0) -> Solid:
    """The part of the solid inside all the fields, its new edges rounded over `width`."""

    def field(x: Array, y: Array, z: Array) -> Array:
        result = solid.field(x, y, z)
        for other_field in fields:
            other = other_field(x, y, z)
            higher = np.maximum(result, other)
            if width:
                h = np.maximum(width - np.abs(result - other), 0.0) / width
                higher = higher + h * h * width * 0.25
            result = higher
        return result

    return Solid(field, solid.low, solid.high)


def outside(solid: Solid) -> Field:
    return lambda x, y, z: -solid.field(x, y, z)


def mesh(solid: Solid, cell: float) -> Mesh:
    """Surface nets: one vertex in each cell that the surface crosses, drawn onto the surface."""
    # Offset by an odd fraction of a cell, so that no node lies on a plane of symmetry.
    axes = [np.arange(lo - 1.37 * cell, hi + 2.4 * cell, cell) for lo, hi in zip(solid.low, solid.high, strict=True)]
    grid = np.meshgrid(*axes, indexing="ij")
    inside = solid.field(*grid) < 0
    counts = np.zeros([n - 1 for n in inside.shape], dtype=int)
    for corner in np.ndindex(2, 2, 2):
        counts += inside[tuple(slice(c, c + n) for c, n in zip(corner, counts.shape, strict=True))]
    crossed = (counts > 0) & (counts < 8)
    index = np.full(crossed.shape, -1)
    index[crossed] = np.arange(int(crossed.sum()))
    cells = np.argwhere(crossed)
    vertices = np.stack([axes[i][cells[:, i]] + cell / 2 for i in range(3)], axis=1)
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        starts = np.moveaxis(inside, axis, 0)[:-1]
        ends = np.moveaxis(inside, axis, 0)[1:]
        edges = np.argwhere(np.moveaxis(starts != ends, 0, axis))
        edges = edges[(edges[:, u] > 0) & (edges[:, v] > 0)]
        around = [edges.copy() for _ in range(4)]
        for k, (du, dv) in enumerate([(1, 1), (0, 1), (0, 0), (1, 0)]):
            around[k][:, u] -= du
            around[k][:, v] -= dv
        quads = np.stack([index[tuple(c.T)] for c in around], axis=1)
        leaving = inside[tuple(edges.T)]
        quads[~leaving] = quads[~leaving][:, ::-1]
        faces.append(quads)
    quads = np.vstack(faces)
    vertices = _drawn(solid.field, vertices, cell)
    return Mesh(vertices, _triangles(vertices, quads))


def _drawn(field: Field, points: Array, cell: float) -> Array:
    """The points moved onto the field's zero by Newton's method, at most a cell away."""
    moved, step = points.copy(), cell * 0.02
    for _ in range(5):
        x, y, z = moved.T
        value = field(x, y, z)
        slope = np.stack(
            [
                field(x + step, y, z) - field(x - step, y, z),
                field(x, y + step, z) - field(x, y - step, z),
                field(x, y, z + step) - field(x, y, z - step),
            ],
            axis=1,
        ) / (2 * step)
        square = np.maximum(slope[:, 0] ** 2 + slope[:, 1] ** 2 + slope[:, 2] ** 2, 0.05)
        moved = moved - slope * (0.8 * value / square)[:, None]
        moved = np.clip(moved, points - 0.9 * cell, points + 0.9 * cell)
    return moved


def _triangles(vertices: Array, quads: NDArray[np.int64]) -> NDArray[np.int64]:
    """Each quad cut along its shorter diagonal."""
    corner = vertices[quads]
    one, two = corner[:, 0] - corner[:, 2], corner[:, 1] - corner[:, 3]
    first = (one * one).sum(axis=1) <= (two * two).sum(axis=1)
    a, b = quads[first], quads[~first]
    return np.vstack([a[:, [0, 1, 2]], a[:, [0, 2, 3]], b[:, [0, 1, 3]], b[:, [1, 2, 3]]])


def split(shape: Mesh, field: Field) -> tuple[Mesh, Mesh]:
    """The parts of a surface inside and outside a field, cut along its zero."""
    value = field(*shape.vertices.T)
    value = np.where(np.abs(value) < 1e-7, 1e-7, value)
    return _side(shape, value), _side(shape, -value)


def _side(shape: Mesh, value: Array) -> Mesh:
    """The part where `value` is negative."""
    vertices = [tuple(v) for v in shape.vertices.tolist()]
    cut: dict[tuple[int, int], int] = {}

    def crossing(a: int, b: int) -> int:
        edge = (min(a, b), max(a, b))
        if edge not in cut:
            t = value[edge[0]] / (value[edge[0]] - value[edge[1]])
            p, q = vertices[edge[0]], vertices[edge[1]]
            cut[edge] = len(vertices)
            vertices.append(tuple(p[i] + t * (q[i] - p[i]) for i in range(3)))
        return cut[edge]

    faces: list[tuple[int, int, int]] = []
    negative = value < 0
    for a, b, c in shape.faces.tolist():
        inside = int(negative[a]) + int(negative[b]) + int(negative[c])
        if inside == 0:
            continue
        if inside == 3:
            faces.append((a, b, c))
            continue
        while negative[a] == negative[b] or negative[a] == negative[c]:
            a, b, c = b, c, a
        ab, ac = crossing(a, b), crossing(a, c)
        faces += [(a, ab, ac)] if inside == 1 else [(ab, b, c), (ab, c, ac)]
    used, compact = np.unique(np.array(faces, dtype=int).reshape(-1, 3), return_inverse=True)
    return Mesh(np.array(vertices)[used].reshape(-1, 3), compact.reshape(-1, 3))


def lock(path: Sequence[Point], widths: Sequence[float], flat: Point, thickness: float = 0.6, sides: int = 8) -> Mesh:
    """A lock of hair: a tube along `path` with these half-widths, flattened along `flat`, closed by points."""
    points = np.asarray(path, dtype=float)
    along = np.gradient(points, axis=0)
    rings = []
    for point, forward, width in zip(points, along, widths, strict=True):
        forward = forward / math.sqrt(float((forward * forward).sum()))
        thin = np.asarray(flat, dtype=float)
        thin = thin - forward * float((thin * forward).sum())
        thin = thin / math.sqrt(float((thin * thin).sum()))
        wide = np.cross(thin, forward)
        angles = [2 * math.pi * k / sides for k in range(sides)]
        rings.append([point + wide * (width * math.cos(a)) + thin * (thickness * width * math.sin(a)) for a in angles])
    return _skin(rings)


def lathe(profile: Sequence[tuple[float, float]], sides: int = 30) -> Mesh:
    """A solid of revolution about z from (radius, height) pairs, bottom to top."""
    angles = [2 * math.pi * k / sides for k in range(sides)]
    return _skin([[np.array([r * math.cos(a), r * math.sin(a), h]) for a in angles] for r, h in profile])


def plate(outline: Sequence[tuple[float, float]], bottom: float, top: float, bevel: float) -> Mesh:
    """A convex outline (counter-clockwise in x-y) made thick along z, its edges bevelled."""
    points = np.asarray(outline, dtype=float)
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    inward = np.stack([-(before + after)[:, 1], (before + after)[:, 0]], axis=1)
    inward = inward / np.sqrt((inward * inward).sum(axis=1))[:, None]
    rings = []
    for inset, height in ((bevel, bottom), (0.0, bottom + bevel), (0.0, top - bevel), (bevel, top)):
        ring = points + inset * inward
        rings.append([np.array([x, y, height]) for x, y in ring.tolist()])
    return _skin(rings)


def outward(solid: Solid, point: Point) -> Point:
    """The unit normal of the field at a point."""
    step, slope = 1e-4, []
    for i in range(3):
        ends = [[np.array(c + (sign * step if j == i else 0.0)) for j, c in enumerate(point)] for sign in (1, -1)]
        slope.append(float(solid.field(*ends[0]) - solid.field(*ends[1])))
    length = math.sqrt(sum(c * c for c in slope))
    return tuple(c / length for c in slope)


def surface_point(solid: Solid, start: Point, direction: Point) -> Point:
    """Where the ray from `start` (inside) leaves the solid, within 0.5 m."""
    near, far = 0.0, 0.5
    for _ in range(40):
        middle = (near + far) / 2
        x, y, z = (np.array(start[i] + middle * direction[i]) for i in range(3))
        near, far = (middle, far) if solid.field(x, y, z) < 0 else (near, middle)
    return tuple(start[i] + near * direction[i] for i in range(3))


def _skin(rings: Sequence[Sequence[Array]]) -> Mesh:
    """Triangles between successive rings of equal size, and a fan at each end."""
    size = len(rings[0])
    vertices = [vertex for ring in rings for vertex in ring]
    faces = []
    for r in range(len(rings) - 1):
        for k in range(size):
            a, b = r * size + k, r * size + (k + 1) % size
            faces += [(a, b, b + size), (a, b + size, a + size)]
    for first, turn in ((0, -1), ((len(rings) - 1) * size, 1)):
        vertices.append(np.mean(np.array(vertices[first : first + size]), axis=0))
        for k in range(size):
            faces.append((len(vertices) - 1, first + k, first + (k + 1) % size)[::turn])
    return Mesh(np.array(vertices), np.array(faces))
