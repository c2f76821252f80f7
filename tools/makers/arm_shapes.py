"""The arm's shapes: universal joints between turned segments, a base and a gripper, in the bones' axes."""

from __future__ import annotations

import math

from .sculpt import Mesh, joined, lathe, plate

MATERIALS = {
    "blue": (0.09, 0.33, 0.58),
    "silver": (0.78, 0.80, 0.82),
    "graphite": (0.16, 0.17, 0.19),
    "orange": (0.95, 0.48, 0.10),
}
Surfaces = dict[str, Mesh]  # by material

FOOT = 1.36  # distance of a fork's root from its joint's centre, in radii: clear of the other fork at 45 degrees
GRIP = 0.040  # [m], from the tip to each finger, which hold a ball of this radius
CHEEK = (0.74, 1.04)  # a fork's cheeks, in radii from the middle


def _cheek(side: float, towards: float, radius: float) -> Mesh:
    """One cheek of a fork, facing z: a round eye at the joint, narrowing to its root at `towards` * FOOT along y."""
    eye, root = 0.80 * radius, 0.64 * radius
    arc = [math.radians(a) for a in range(-195, 16, 15)]
    outline = [(eye * math.cos(a), eye * math.sin(a)) for a in arc] + [(root, FOOT * radius), (-root, FOOT * radius)]
    if towards < 0:
        outline = [(-x, -y) for x, y in outline]
    inner, outer = (c * radius for c in CHEEK)
    return plate(outline, *((inner, outer) if side > 0 else (-outer, -inner)), 0.06 * radius)


def fork(axis: str, towards: float, radius: float) -> Mesh:
    """Two cheeks that hold an axle along the bone's x or z."""
    cheeks = joined(_cheek(side, towards, radius) for side in (1, -1))
    if axis == "z":
        return cheeks
    return Mesh(cheeks.vertices[:, [2, 1, 0]] * (-1.0, 1.0, 1.0), cheeks.faces)


def knuckle() -> Surfaces:
    """The cross in a joint of radius 1: a hub and two axles with their caps."""
    hub = lathe([(0, -0.70), (0.40, -0.70), (0.70, -0.40), (0.70, 0.40), (0.40, 0.70), (0, 0.70)], 28)
    axle = lathe([(0, -1.10), (0.40, -1.10), (0.46, -1.05), (0.46, 1.05), (0.40, 1.10), (0, 1.10)], 28)
    cap = lathe([(0, -1.15), (0.17, -1.15), (0.22, -1.11), (0.22, 1.11), (0.17, 1.15), (0, 1.15)], 20)
    return {
        "graphite": joined([hub.facing("y"), axle, axle.facing("x")]),
        "orange": joined([cap, cap.facing("x")]),
    }


def segment(length: float, near: tuple[float, float], far: tuple[float, float]) -> Surfaces:
    """An arm's segment from its own joint's fork (about z) to the next joint's (about x); ends are (joint, rim)."""
    (radius, wide), (next_radius, narrow) = near, far
    start, end = FOOT * radius, length - FOOT * next_radius
    first, last = start + 0.04 * wide, end - 0.06 * narrow  # inside the flanges: no two faces lie in one place
    body = lathe([
        (0, first), (0.90 * wide, first), (0.90 * wide, start + 0.14 * wide), (0.97 * wide, start + 0.19 * wide),
        (0.97 * narrow, end - 0.19 * narrow), (0.90 * narrow, end - 0.14 * narrow), (0.90 * narrow, last), (0, last),
    ]).facing("y")  # fmt: skip
    flanges = [_flange(wide, start, 0.10 * wide), _flange(narrow, end, -0.10 * narrow)]
    forks = [fork("z", 1, radius), fork("x", -1, next_radius).moved((0, length, 0))]
    return {"blue": body, "silver": joined([*forks, *flanges])}


def _flange(radius: float, root: float, height: float) -> Mesh:
    """A disc where a fork meets a segment."""
    low, high = min(root, root + height), max(root, root + height)
    low, bevel = low - 0.04 * radius, 0.05 * radius
    return lathe([(0, low), (radius - bevel, low), (radius, low + bevel), (radius, high - bevel),
                  (radius - bevel, high), (0, high)]).facing("y")  # fmt: skip


def base(height: float, radius: float, rim: float) -> Surfaces:
    """The foot on the ground (its middle at the origin, y up) and the first fork."""
    foot = lathe([(0, 0), (0.155, 0), (0.155, 0.012), (0.150, 0.017), (0, 0.017)], 36).facing("y")
    top = height - FOOT * radius
    cone = lathe(
        [(0, 0.014), (0.118, 0.014), (0.108, 0.021), (rim + 0.002, top), (rim - 0.002, top + 0.004), (0, top + 0.004)],
        36,
    )
    bolts = [
        lathe([(0, 0.010), (0.010, 0.010), (0.010, 0.022), (0.008, 0.024), (0, 0.024)], 6).facing("y").moved(
            (0.134 * math.sin(turn), 0, 0.134 * math.cos(turn))
        )
        for turn in (math.radians(60 * k + 30) for k in range(6))
    ]  # fmt: skip
    return {
        "graphite": foot,
        "blue": cone.facing("y"),
        "silver": joined([fork("x", -1, radius).moved((0, height, 0)), *bolts]),
    }


def gripper(length: float, radius: float, rim: float) -> Surfaces:
    """The hand on its fork: a palm along z and two parallel fingers, the tip (`length` from the joint) between them."""
    root = FOOT * radius
    wrist = _flange(rim, root, 0.10 * rim)
    palm = plate(_rounded(0.100, 0.034, 0.014), root + 0.003, root + 0.046, 0.006).facing("y")
    rail = plate(_rectangle((-0.090, root + 0.040), (0.090, root + 0.053)), -0.020, 0.020, 0.002)
    # Made across x, then turned. Seen along z (x to the right, y up): the right finger, from its carriage on the rail
    # to its end.
    bottom, top = root + 0.047, length + 0.034
    carriage = plate(_rectangle((0.034, bottom), (0.088, bottom + 0.020)), -0.026, 0.026, 0.004)
    outline = [(GRIP + 0.007, bottom), (0.082, bottom), (0.082, bottom + 0.026), (0.064, top), (GRIP + 0.007, top)]
    finger = plate(outline, -0.018, 0.018, 0.004)
    pad = plate(_rectangle((GRIP, length - 0.028), (GRIP + 0.010, top - 0.003)), -0.015, 0.015, 0.002)
    return {
        "silver": joined([fork("z", 1, radius), wrist, _quarter(rail)]),
        "blue": _quarter(palm),
        "graphite": joined(_quarter(part) for part in (finger, _other_side(finger), carriage, _other_side(carriage))),
        "orange": joined(_quarter(part) for part in (pad, _other_side(pad))),
    }


def _quarter(shape: Mesh) -> Mesh:
    """The mesh turned about y, from x to z."""
    return Mesh(shape.vertices[:, [2, 1, 0]] * (-1.0, 1.0, 1.0), shape.faces)


def _other_side(shape: Mesh) -> Mesh:
    """The mesh mirrored in x."""
    return Mesh(shape.vertices * (-1.0, 1.0, 1.0), shape.faces[:, ::-1])


def _rectangle(low: tuple[float, float], high: tuple[float, float]) -> list[tuple[float, float]]:
    return [low, (high[0], low[1]), high, (low[0], high[1])]


def _rounded(half_x: float, half_z: float, corner: float) -> list[tuple[float, float]]:
    """A rectangle with round corners, for a plate that will face y (its own x is then z, its y is x)."""
    points = []
    for quarter, (sx, sz) in enumerate(((1, 1), (1, -1), (-1, -1), (-1, 1))):
        for step in range(5):
            turn = math.radians(90 * quarter + 22.5 * step)
            z = sz * (half_z - corner) + corner * math.cos(turn)
            x = sx * (half_x - corner) + corner * math.sin(turn)
            points.append((z, x))
    return points
