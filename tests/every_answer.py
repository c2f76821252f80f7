"""Every answer of an arm, found without pinik: closed forms, and a search in plain numpy from thousands of starts."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping
from xml.etree import ElementTree

import numpy as np
import pinocchio
from numpy.typing import NDArray

from urdf_texts import joint, link, robot

Array = NDArray[np.float64]

APART = 1e-3  # [rad or m]: nearer answers of the search are one
EXACT = 1e-11  # [rad, m]: the residual of an answer


def turned_near(angles: Array, near: Array | float = 0.0) -> Array:
    """Angles at the whole turns nearest to others [rad]."""
    return angles + 2.0 * math.pi * np.round((near - angles) / (2.0 * math.pi))


def inside(angles: Iterable[Array], lower: Array, upper: Array) -> list[Array]:
    """The answers that whole turns bring between limits [rad]."""
    ways = []
    for q in angles:
        lowest = q + 2.0 * math.pi * np.ceil((lower - q) / (2.0 * math.pi))
        ways += [q] if (lowest <= upper).all() else []
    return ways


def unlike(found: Iterable[Array], wanted: Iterable[Array], near: float = 1e-6) -> tuple[list[Array], list[Array]]:
    """(those of `wanted` that `found` lacks, those of `found` that are too many), whole turns aside."""
    left, missing = list(found), []
    for q in wanted:
        gaps = [np.abs(turned_near(q - other)).max() for other in left]
        if gaps and min(gaps) <= near:
            left.pop(int(np.argmin(gaps)))
        else:
            missing.append(q)
    return missing, left


class Arm:
    """The chain of one-axis joints from the root of a URDF to a link, in numpy alone.

    Attributes:
        names: The movable joints (n), from the root on.
        lower, upper: Their limits (n,) [rad or m]; infinite for continuous ones.
    """

    def __init__(self, text: str, tip: str, held: Mapping[str, float] | None = None) -> None:
        """Read the chain to a link; hinges in `held` are fixed at an angle [rad]."""
        above = {tag.find("child").attrib["link"]: tag for tag in ElementTree.fromstring(text).findall("joint")}
        tags = []
        while tip in above:
            tags.insert(0, above[tip])
            tip = above[tip].find("parent").attrib["link"]
        held = held or {}
        self._parts = []
        for tag in tags:
            kind, origin, axis, name = tag.attrib["type"], _origin(tag), _axis(tag), tag.attrib["name"]
            if name in held:
                kind, origin = "fixed", origin @ _moved(kind, axis, np.array([held[name]]))[0]
            self._parts.append((kind, origin, axis))
        moved = [tag for tag in tags if tag.attrib["type"] != "fixed" and tag.attrib["name"] not in held]
        self.names = [tag.attrib["name"] for tag in moved]
        limits = [
            (-math.inf, math.inf)
            if tag.attrib["type"] == "continuous"
            else (float(tag.find("limit").attrib["lower"]), float(tag.find("limit").attrib["upper"]))
            for tag in moved
        ]
        self.lower, self.upper = np.array(limits).T

    def walk(self, q: Array) -> tuple[Array, Array]:
        """The placements (N, 4, 4) and the Jacobians in the world's axes (N, 6, n) at N configurations (N, n)."""
        at, axes, origins = np.broadcast_to(np.eye(4), (len(q), 4, 4)), [], []
        for kind, origin, axis in self._parts:
            at = at @ origin
            if kind == "fixed":
                continue
            value = q[:, len(axes)]
            axes.append((kind, at[:, :3, :3] @ axis))
            origins.append(at[:, :3, 3])
            at = at @ _moved(kind, axis, value)
        tip = at[:, :3, 3]
        columns = [
            np.hstack([z, 0.0 * z]) if kind == "prismatic" else np.hstack([np.cross(z, tip - origin), z])
            for (kind, z), origin in zip(axes, origins, strict=True)
        ]
        return at, np.stack(columns, axis=2)

    def placement(self, q: Array) -> Array:
        """The placement (4, 4) at one configuration (n,)."""
        return np.array(self.walk(q[None])[0][0])

    def random(self, rng: np.random.Generator) -> Array:
        """A configuration (n,) between the limits; anywhere for continuous joints."""
        low = np.where(np.isfinite(self.lower), self.lower, -math.pi)
        return rng.uniform(low, np.where(np.isfinite(self.upper), self.upper, math.pi))

    def least_singular_value(self, q: Array) -> float:
        """Of the Jacobian at a configuration (n,), with positions in units of the arm's reach."""
        J = self.walk(q[None])[1][0].copy()
        J[:3] /= sum(float(np.linalg.norm(origin[:3, 3])) for _, origin, _ in self._parts)
        return float(np.linalg.svd(J, compute_uv=False)[-1])

    def answers(self, placement: Array, starts: int = 1000, seed: int = 0) -> list[Array]:
        """All configurations with a placement (4, 4), whole turns aside and whatever the limits, by damped steps."""
        rng = np.random.default_rng(seed)
        q = rng.uniform(-math.pi, math.pi, (starts, len(self.names)))
        for step in range(50):
            e, J = self._residual(q, placement)
            damping = min(1e-2, 0.1 ** (step / 4.0)) * (e**2).sum(axis=1)[:, None, None]
            A = J.transpose(0, 2, 1) @ J + (damping + 1e-14) * np.eye(J.shape[2])
            dq = np.linalg.solve(A, (J.transpose(0, 2, 1) @ e[:, :, None]))[:, :, 0]
            q = q + dq * np.minimum(1.0, 1.0 / np.maximum(np.abs(dq).max(axis=1, keepdims=True), 1e-9))
        reached = q[np.abs(self._residual(q, placement)[0]).max(axis=1) < EXACT]
        found: list[Array] = []
        while len(reached):
            found.append(turned_near(reached[0]))
            reached = reached[np.abs(turned_near(reached - reached[0])).max(axis=1) > APART]
        return found

    def _residual(self, q: Array, placement: Array) -> tuple[Array, Array]:
        at, J = self.walk(q)
        across = placement[:3, :3] @ at[:, :3, :3].transpose(0, 2, 1)
        twice = np.stack([across[:, i, j] - across[:, j, i] for i, j in ((2, 1), (0, 2), (1, 0))], axis=1)
        sine, cosine = np.linalg.norm(twice, axis=1) / 2.0, (np.trace(across, axis1=1, axis2=2) - 1.0) / 2.0
        angle = np.arctan2(sine, cosine)
        turn = twice * (angle / np.maximum(2.0 * sine, 1e-300))[:, None]
        return np.hstack([placement[:3, 3] - at[:, :3, 3], np.where(sine[:, None] > 0.0, turn, 0.0)]), J


def _moved(kind: str, axis: Array, value: Array) -> Array:
    """The motions (N, 4, 4) of a joint at N values (N,) [rad or m]."""
    moved = np.broadcast_to(np.eye(4), (len(value), 4, 4)).copy()
    if kind == "prismatic":
        moved[:, :3, 3] = value[:, None] * axis
    else:
        K = np.cross(axis, np.eye(3)).T  # K x = axis × x
        moved[:, :3, :3] += np.sin(value)[:, None, None] * K + (1.0 - np.cos(value))[:, None, None] * (K @ K)
    return moved


def _origin(tag: ElementTree.Element) -> Array:
    said = {} if tag.find("origin") is None else tag.find("origin").attrib
    xyz, rpy = (np.array([float(word) for word in said.get(key, "0 0 0").split()]) for key in ("xyz", "rpy"))
    return np.array(pinocchio.SE3(pinocchio.rpy.rpyToMatrix(rpy), xyz).homogeneous)


def _axis(tag: ElementTree.Element) -> Array:
    said = tag.find("axis")
    axis = np.array([1.0, 0.0, 0.0] if said is None else [float(word) for word in said.attrib["xyz"].split()])
    return np.array(axis / (np.linalg.norm(axis) or 1.0))  # fixed joints may have no axis


def limit(lower: float, upper: float) -> str:
    return f'<limit lower="{lower!r}" upper="{upper!r}" effort="1" velocity="1"/>'


def hinge_arm(axes: str, steps: list[tuple[float, float, float]], bounds: tuple[float, float], **kinds: str) -> str:
    """The URDF of an arm: joints j1, j2, … about (or along) the axes of `axes`, the last link called tip.

    Args:
        axes: A letter for each joint.
        steps: From the base to joint 1, from there to joint 2, and so on, at last to the tip [m].
        bounds: The limits of all joints [rad or m].
        kinds: The kinds of joints that are not revolute.
    """
    letters = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
    parts = [link("l0")]
    for number, (axis, step) in enumerate(zip(axes, steps, strict=False), start=1):
        words = (f'<origin xyz="{" ".join(map(repr, step))}"/>', f'<axis xyz="{letters[axis]}"/>')
        name = f"j{number}"
        ends = (f"l{number - 1}", f"l{number}")
        parts += [link(ends[1]), joint(name, *ends, *words, kind=kinds.get(name, "revolute"), limit=limit(*bounds))]
    end = f'<origin xyz="{" ".join(map(repr, steps[-1]))}"/>'
    return robot(*parts, link("tip"), joint("end", f"l{len(axes)}", "tip", end, kind="fixed", limit=""))


PUMA = {"height": 0.6, "offset": 0.12, "upper": 0.43, "fore": 0.41, "hand": 0.09}  # [m]


def puma(bounds: tuple[float, float] = (-math.pi, math.pi)) -> str:
    """An arm with a shoulder offset and a wrist whose three axes meet in a point."""
    steps = [
        (0.0, 0.0, PUMA["height"]), (0.0, PUMA["offset"], 0.0), (PUMA["upper"], 0.0, 0.0), (PUMA["fore"], 0.0, 0.0),
        (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (PUMA["hand"], 0.0, 0.0),
    ]  # fmt: skip
    return hinge_arm("zyyxyx", steps, bounds)


def puma_answers(placement: Array) -> list[Array]:
    """Up to eight, by Pieper (1968): the wrist's centre gives the first three joints, the rest is the wrist's turn."""
    R, (x, y, z) = placement[:3, :3], placement[:3, 3] - PUMA["hand"] * placement[:3, 0]
    d, a, b = PUMA["offset"], PUMA["upper"], PUMA["fore"]
    ways: list[Array] = []
    if math.hypot(x, y) < d:
        return ways
    for front in (1.0, -1.0):
        r = front * math.sqrt(x * x + y * y - d * d)  # in the plane of the bones, which is d beside the first axis
        q1 = math.atan2(y, x) - math.atan2(d, r)
        h = PUMA["height"] - z  # a turn about y lowers what points along x
        cosine = (r * r + h * h - a * a - b * b) / (2.0 * a * b)
        if abs(cosine) > 1.0:
            continue
        for q3 in (math.acos(cosine), -math.acos(cosine)):
            q2 = math.atan2(h, r) - math.atan2(b * math.sin(q3), a + b * math.cos(q3))
            W = (_turn(2, q1) @ _turn(1, q2 + q3)).T @ R  # a turn about x, one about y, one about x
            bend = math.acos(min(1.0, max(-1.0, W[0, 0])))
            for q5 in (bend, -bend):
                sign = math.copysign(1.0, q5)
                q4, q6 = math.atan2(sign * W[1, 0], -sign * W[2, 0]), math.atan2(sign * W[0, 1], sign * W[0, 2])
                ways.append(turned_near(np.array([q1, q2, q3, q4, q5, q6])))
    return ways


def planar_answers(lengths: tuple[float, float, float], x: float, y: float, heading: float) -> list[Array]:
    """Up to two, of three parallel hinges: the law of cosines without the last bone, which points along the heading."""
    a, b, c = lengths
    u, v = x - c * math.cos(heading), y - c * math.sin(heading)
    cosine = (u * u + v * v - a * a - b * b) / (2.0 * a * b)
    if abs(cosine) > 1.0:
        return []
    ways = []
    for second in {math.acos(cosine), -math.acos(cosine)}:
        first = math.atan2(v, u) - math.atan2(b * math.sin(second), a + b * math.cos(second))
        ways.append(turned_near(np.array([first, second, heading - first - second])))
    return ways


def whole_turns(q: Array, lower: Array, upper: Array) -> list[Array]:
    """Everything that a whole turn of each hinge, or none, makes of a configuration (n,) between limits."""
    tried = itertools.product(*[[angle + 2.0 * math.pi * k for k in (-1, 0, 1)] for angle in q])
    return [np.array(way) for way in tried if (lower <= way).all() and (way <= upper).all()]


def _turn(axis: int, angle: float) -> Array:
    return np.array(pinocchio.utils.rotate("xyz"[axis], angle))
