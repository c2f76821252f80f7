"""The arm's looks: cardan joints between lathed segments, a base, a gripper; in the bones' axes."""

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

FOOT = 1.36  # where a fork's root is, in radii from its joint's centre: clear of the other fork at 45 degrees
FLANGE = 1.24  # in radii, so that the cheeks stand on it
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


def segment(length: float, radius: float, next_radius: float) -> Surfaces:
    """An arm's segment from its own joint's fork (about z) to the fork that holds the next (about x)."""
    start, end = FOOT * radius, length - FOOT * next_radius
    wide, narrow = FLANGE * radius, FLANGE * next_radius
    body = lathe([
        (0, start), (0.90 * wide, start), (0.90 * wide, start + 0.20 * radius), (0.97 * wide, start + 0.26 * radius),
        (0.97 * narrow, end - 0.26 * next_radius), (0.90 * narrow, end - 0.20 * next_radius), (0.90 * narrow, end),
        (0, end),
    ]).facing("y")  # fmt: skip
    flanges = [_flange(wide, start, 0.16 * radius), _flange(narrow, end, -0.16 * next_radius)]
    forks = [fork("z", 1, radius), fork("x", -1, next_radius).moved((0, length, 0))]
    return {"blue": body, "silver": joined([*forks, *flanges])}


def _flange(radius: float, root: float, height: float) -> Mesh:
    """A disc where a fork meets a segment."""
    low, high = min(root, root + height), max(root, root + height)
    low, bevel = low - 0.04 * radius, 0.05 * radius
    return lathe([(0, low), (radius - bevel, low), (radius, low + bevel), (radius, high - bevel),
                  (radius - bevel, high), (0, high)]).facing("y")  # fmt: skip


def base(height: float, radius: float) -> Surfaces:
    """The foot on the ground (its middle at the origin, y up) and the first fork."""
    foot = lathe([(0, 0), (0.155, 0), (0.155, 0.012), (0.150, 0.017), (0, 0.017)], 36).facing("y")
    top = height - FOOT * radius
    rim = FLANGE * radius
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


def gripper(length: float, radius: float) -> Surfaces:
    """The hand on its fork: a palm across x and two fingers that close on the tip, `length` from the joint."""
    root = FOOT * radius
    wrist = _flange(FLANGE * radius, root, 0.16 * radius)
    palm = plate(_rounded(0.062, 0.030, 0.014), root + 0.004, root + 0.042, 0.006).facing("y")
    # Seen along z (x to the right, y up): the right finger, from its carriage to the pad.
    bottom, knee, top = root + 0.036, root + 0.066, length + 0.008
    outline = [(0.030, bottom), (0.054, bottom), (0.054, knee), (0.026, top), (0.014, top), (0.014, top - 0.030)]
    finger = plate(outline, -0.011, 0.011, 0.0025)
    pad = plate(_rectangle((0.010, top - 0.034), (0.016, top - 0.004)), -0.009, 0.009, 0.0015)
    carriage = plate(_rectangle((0.024, root + 0.038), (0.058, root + 0.052)), -0.016, 0.016, 0.003)
    return {
        "silver": joined([fork("z", 1, radius), wrist]),
        "blue": palm,
        "graphite": joined([finger, _other_side(finger), carriage, _other_side(carriage)]),
        "orange": joined([pad, _other_side(pad)]),
    }


def _other_side(shape: Mesh) -> Mesh:
    """Mirrored in x."""
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
