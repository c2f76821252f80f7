"""Robots written by hand, and where their links are: 4×4 matrices multiplied along the tree of a URDF text.

An oracle that knows neither pinik nor Pinocchio, and moves floating and planar joints, as yourdfpy does not.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from xml.etree import ElementTree

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from urdf_texts import joint, link, robot

Array = NDArray[np.float64]


def origin(xyz: Sequence[float], rpy: Sequence[float] = (0, 0, 0)) -> str:
    return f'<origin xyz="{_words(xyz)}" rpy="{_words(rpy)}"/>'


def axis(*xyz: float) -> str:
    return f'<axis xyz="{_words(xyz)}"/>'


def limit(lower: float, upper: float) -> str:
    return f'<limit lower="{float(lower)!r}" upper="{float(upper)!r}" effort="1" velocity="1"/>'


def mimic(leader: str, multiplier: float = 1.0, offset: float = 0.0) -> str:
    return f'<mimic joint="{leader}" multiplier="{multiplier!r}" offset="{offset!r}"/>'


def _words(numbers: Sequence[float]) -> str:
    return " ".join(repr(float(number)) for number in numbers)


# Every kind of joint in two branches: base ~ body ─ a ─ b ─ c ─ tip, and body ═ d ─ e ─ f ─ g ─ hand, whose four
# one-axis joints follow those of the first branch.
ZOO = robot(
    *(link(name) for name in ("base", "body", "a", "b", "c", "tip", "d", "e", "f", "g", "hand")),
    joint("drift", "base", "body", origin((0.1, 0.2, 0.3), (0.4, -0.5, 0.6)), kind="floating", limit=""),
    joint("k_turn", "body", "a", origin((0.2, 0, 0.1), (0.3, 0, 0)), axis(1, 2, 3), kind="continuous"),
    joint("l_hinge", "a", "b", origin((0, 0.3, 0), (0, 0.7, 0)), axis(0, 1, 0), limit=limit(-2, 1.5)),
    joint("m_slide", "b", "c", origin((0.1, 0, 0.2)), axis(1, 0, 1), kind="prismatic", limit=limit(-0.2, 0.6)),
    joint("n_fixed", "c", "tip", origin((0, 0.1, 0.25), (1, 2, 3)), kind="fixed", limit=""),
    joint("s_plane", "body", "d", origin((-0.2, 0.1, 0), (0.2, 0.5, -1)), axis(0, 0, 1), kind="planar", limit=""),
    joint("t_hinge", "d", "e", origin((0.3, 0, 0)), axis(0, 0, -1), mimic("l_hinge", -0.5, 0.1)),
    joint("u_slide", "e", "f", origin((0, 0.2, 0)), axis(0, 1, 0), mimic("l_hinge", 0.1), kind="prismatic"),
    joint("v_turn", "f", "g", origin((0.1, 0, 0)), axis(1, 0, 0), mimic("l_hinge", 0.5), kind="continuous"),
    joint("w_hinge", "g", "hand", origin((0.1, 0, 0.1)), axis(0, 1, 1), mimic("m_slide", 3.0, -0.2)),
)


def two_hinges(l1: float, l2: float, low: float = -math.pi, high: float = math.pi) -> str:
    """A planar arm of two hinges about z, whose elbow turns through low..high."""
    return robot(
        *(link(name) for name in ("base", "upper", "fore", "tip")),
        joint("shoulder", "base", "upper", axis(0, 0, 1), kind="continuous", limit=""),
        joint("elbow", "upper", "fore", origin((l1, 0, 0)), axis(0, 0, 1), limit=limit(low, high)),
        joint("end", "fore", "tip", origin((l2, 0, 0)), kind="fixed", limit=""),
    )


@st.composite
def chains(draw: st.DrawFn, kinds: Sequence[str] = ("revolute", "continuous", "prismatic", "fixed")) -> str:
    """URDF texts of one chain from "l0" to "tip" with random places, axes, limits and mimics.

    A follower's limits cut its leader's, and leave it the middle of its range at least.
    """
    number = st.floats(-1.0, 1.0).map(lambda x: round(x, 3))
    vector = st.tuples(number, number, number)
    angles = st.tuples(*[st.floats(-math.pi, math.pi).map(lambda x: round(x, 3))] * 3)
    count = draw(st.integers(1, 6))
    parts = []
    leaders: dict[str, tuple[str, float]] = {}
    for i in range(count):
        name, kind = f"j{i}", draw(st.sampled_from(kinds))
        words, bounds = [origin(draw(vector), draw(angles))], ""
        if kind in ("revolute", "continuous", "prismatic"):
            middle, half = draw(number), draw(st.floats(0.0, 3.0))
            words.append(axis(*draw(vector.filter(any))))
            fit = [n for n, (leader, _) in leaders.items() if (leader, kind) != ("continuous", "prismatic")]
            if fit and draw(st.booleans()):
                leader, multiplier, offset = draw(st.sampled_from(fit)), 2.0 * draw(number), draw(number)
                words.append(mimic(leader, multiplier, offset))
                middle = multiplier * leaders[leader][1] + offset
            else:
                leaders[name] = (kind, 0.0 if kind == "continuous" else middle)
            if kind != "continuous":
                bounds = limit(middle - half - 1e-6, middle + half)
        elif kind == "planar":
            words.append(axis(*draw(vector.filter(any))))
        parts.append(joint(name, f"l{i}", f"l{i + 1}", *words, kind=kind, limit=bounds))
    end = joint("end", f"l{count}", "tip", origin(draw(vector)), kind="fixed", limit="")
    return robot(*(link(f"l{i}") for i in range(count + 1)), link("tip"), *parts, end)


def link_placements(
    text: str,
    angles: Mapping[str, float],
    joint_placements: Mapping[str, Array] | None = None,
    base: Array | None = None,
) -> dict[str, Array]:
    """Link → 4×4, for these angles (followers' are worked out) and placements; `base` is the root link's."""
    joints = {tag.attrib["name"]: tag for tag in ElementTree.fromstring(text).findall("joint")}
    children = {_end(tag, "child") for tag in joints.values()}
    root = next(_end(tag, "parent") for tag in joints.values() if _end(tag, "parent") not in children)
    placed = {root: np.eye(4) if base is None else base}
    while len(placed) <= len(joints):
        for name, tag in joints.items():
            parent, child = _end(tag, "parent"), _end(tag, "child")
            if parent in placed and child not in placed:
                motion = (joint_placements or {}).get(name)
                if motion is None:
                    motion = _motion(tag, _angle(joints, name, angles))
                placed[child] = placed[parent] @ _origin(tag) @ motion
    return placed


def _end(tag: ElementTree.Element, role: str) -> str:
    return tag.find(role).attrib["link"]


def _angle(joints: Mapping[str, ElementTree.Element], name: str, angles: Mapping[str, float]) -> float:
    follows = joints[name].find("mimic")
    if follows is None:
        return angles.get(name, 0.0)
    leader = _angle(joints, follows.attrib["joint"], angles)
    return float(follows.get("multiplier", "1")) * leader + float(follows.get("offset", "0"))


def _origin(tag: ElementTree.Element) -> Array:
    element = tag.find("origin")
    if element is None:
        return np.eye(4)
    x, y, z = (float(word) for word in element.get("xyz", "0 0 0").split())
    roll, pitch, yaw = (float(word) for word in element.get("rpy", "0 0 0").split())
    return homogeneous(rotation_from_rpy(roll, pitch, yaw), (x, y, z))


def _motion(tag: ElementTree.Element, angle: float) -> Array:
    kind, element = tag.attrib["type"], tag.find("axis")
    if kind not in ("revolute", "continuous", "prismatic"):
        return np.eye(4)
    direction = np.array([1.0, 0, 0] if element is None else [float(w) for w in element.attrib["xyz"].split()])
    direction /= np.linalg.norm(direction)
    if kind == "prismatic":
        return homogeneous(np.eye(3), angle * direction)
    return homogeneous(rotation_about(direction, angle), (0, 0, 0))


def homogeneous(rotation: Array, translation: Sequence[float] | Array) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = translation
    return matrix


def rotation_about(direction: Array, angle: float) -> Array:
    """Rodrigues: cos·I + sin·[a]× + (1 − cos)·aaᵀ."""
    x, y, z = direction
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    outer = np.outer(direction, direction)
    return math.cos(angle) * np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * outer


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> Array:
    """Rz(yaw) Ry(pitch) Rx(roll), each matrix written out."""
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def random_rotation(rng: np.random.Generator) -> Array:
    direction = rng.normal(size=3)
    return rotation_about(direction / np.linalg.norm(direction), rng.uniform(-math.pi, math.pi))


def joint_axes(text: str) -> dict[str, Array]:
    """Joint → its unit axis in its own frame, x where the text gives none."""
    axes = {}
    for tag in ElementTree.fromstring(text).findall("joint"):
        element = tag.find("axis")
        direction = np.array([1.0, 0, 0] if element is None else [float(w) for w in element.attrib["xyz"].split()])
        axes[tag.attrib["name"]] = direction / (np.linalg.norm(direction) or 1.0)
    return axes


def random_placement(
    rng: np.random.Generator, kind: str = "floating", normal: Sequence[float] | Array = (0.0, 0.0, 1.0)
) -> Array:
    """A 4×4 of a floating joint, or of a planar one that moves across `normal`."""
    if kind == "planar":
        across = np.array(normal)
        turn = rotation_about(across, rng.uniform(-math.pi, math.pi))
        way = rng.uniform(-1, 1, 3)
        return homogeneous(turn, way - (way @ across) * across)
    return homogeneous(random_rotation(rng), rng.uniform(-1, 1, 3))
