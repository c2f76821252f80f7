"""The lion's body: each link's surfaces by colour, sculpted in the standing posture (see lion_anatomy)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from .lion_anatomy import CHEST, FORE_LEG, HEAD, HEAD_SIZE, HIND_LEG, NECK, SPINE, TAIL_DROOP, TAIL_SEGMENT
from .sculpt import (
    Field,
    Mesh,
    Point,
    Solid,
    ball,
    blend,
    carve,
    ellipsoid,
    half_space,
    joined,
    limb,
    lock,
    mesh,
    outside,
    outward,
    split,
    surface_point,
)

MATERIALS = {
    "tawny": (0.80, 0.56, 0.31),
    "pale": (0.93, 0.81, 0.62),
    "gold": (0.74, 0.45, 0.18),
    "mane": (0.60, 0.34, 0.14),
    "dark_mane": (0.36, 0.19, 0.09),
    "nose": (0.17, 0.10, 0.09),
    "amber": (0.91, 0.60, 0.10),
    "black": (0.05, 0.04, 0.04),
    "white": (0.97, 0.96, 0.92),
    "mouth": (0.66, 0.30, 0.28),
}
Surfaces = dict[str, Mesh]  # by material
TRUNK_CELL, LEG_CELL, HEAD_CELL = 0.030, 0.0175, 0.0125


def both(make: Callable[[float], Solid]) -> tuple[Solid, Solid]:
    """The same part on both sides; `make` gets the side's sign."""
    return make(1.0), make(-1.0)


def painted(shape: Mesh, base: str, **regions: Field) -> Surfaces:
    """A surface in one colour, except for some regions."""
    surfaces: Surfaces = {}
    for material, region in regions.items():
        inside, shape = split(shape, region)
        if len(inside.faces):
            surfaces[material] = inside
    return {base: shape, **surfaces}


# The trunk ------------------------------------------------------------------------------------------------------------

TRUNK = blend(
    0.10,
    ellipsoid((-0.10, 0, 0.885), (0.15, 0.135, 0.15)),  # rump
    ellipsoid((0.02, 0, 0.86), (0.20, 0.165, 0.185)),
    limb((0.02, 0, 0.88), (0.45, 0, 0.83), 0.165, 0.19),  # loins
    ellipsoid((0.42, 0, 0.79), (0.26, 0.185, 0.225)),
    ellipsoid((0.64, 0, 0.785), (0.28, 0.20, 0.26)),  # ribs
    ellipsoid((0.80, 0, 0.90), (0.17, 0.13, 0.18)),  # withers
    ellipsoid((0.86, 0, 0.78), (0.15, 0.155, 0.20)),  # breast
)
BELLY = ellipsoid((0.40, 0, 0.46), (0.80, 0.165, 0.18)).field
OVERLAP = 0.03


def trunk() -> dict[str, Surfaces]:
    """One skin, cut at the spine's joints; balls in the joints close the cuts when it bends."""
    skin = mesh(TRUNK, TRUNK_CELL)
    waist = mesh(ellipsoid(SPINE, (0.14, 0.146, 0.170)), 0.045)
    ribs = mesh(ellipsoid(CHEST, (0.17, 0.168, 0.205)), 0.05)

    def piece(start: float, end: float, *joints: Mesh) -> Surfaces:
        part, _ = split(skin, half_space((1, 0, 0), end + OVERLAP))
        part, _ = split(part, half_space((-1, 0, 0), OVERLAP - start))
        surfaces = painted(part, "tawny", pale=BELLY)
        return {**surfaces, "tawny": joined([surfaces["tawny"], *joints])}

    return {
        "pelvis": piece(-9.0, SPINE[0], waist),
        "spine": piece(SPINE[0], CHEST[0], waist, ribs),
        "chest": piece(CHEST[0], 9.0, ribs),
    }


# The head -------------------------------------------------------------------------------------------------------------

SKULL = blend(
    0.045,
    ellipsoid((1.20, 0, 1.12), (0.15, 0.128, 0.125)),
    limb((1.30, 0, 1.150), (1.465, 0, 1.085), 0.066, 0.051),  # bridge of the nose
    ellipsoid((1.39, 0, 1.060), (0.115, 0.082, 0.070)),  # muzzle
    *both(lambda s: ellipsoid((1.27, s * 0.080, 1.070), (0.085, 0.065, 0.082))),  # cheekbones
    *both(lambda s: limb((1.275, s * 0.066, 1.190), (1.355, s * 0.044, 1.160), 0.034, 0.018)),  # brows
)
MOUTH = half_space((-0.06, 0, 1), 1.008 - 0.06 * 1.2)  # below it is the jaw's
LIPS: Field = lambda x, y, z: np.maximum(MOUTH(x, y, z) - 0.001, 1.325 - x)  # noqa: E731


def head() -> Surfaces:
    lips = blend(
        0.018,
        SKULL,
        *both(lambda s: ellipsoid((1.456, s * 0.041, 1.046), (0.062, 0.050, 0.050))),  # whisker pads
    )
    groove = limb((1.525, 0, 1.075), (1.525, 0, 1.00), 0.014, 0.014)
    solid = carve(lips, outside(groove), width=0.012)
    solid = carve(solid, lambda x, y, z: -0.005 - MOUTH(x, y, z), width=0.008)
    eye = surface_point(solid, (1.27, 0.038, 1.128), (0.975, 0.22, 0.0))
    liner = blend(
        1e-3,
        *both(lambda s: ellipsoid((eye[0], s * eye[1], eye[2]), (0.050, 0.030, 0.0225), (s * 10, 14, s * 24))),
        *both(lambda s: limb((eye[0] + 0.02, s * (eye[1] - 0.026), eye[2] - 0.008),
                             (eye[0] + 0.06, s * (eye[1] - 0.036), eye[2] - 0.032), 0.007, 0.003)),
    )  # fmt: skip
    pale = ellipsoid((1.475, 0, 1.030), (0.105, 0.14, 0.058), (0, 14, 0))
    skin, _ = split(mesh(solid, HEAD_CELL), half_space((-1, 0, 0), -1.14))  # the rest is under the mane
    surfaces = painted(skin, "tawny", black=liner.field, nose=LIPS, pale=pale.field)

    normal = outward(solid, eye)
    gaze = (normal[0] + 0.5, normal[1], normal[2])
    length = math.sqrt(sum(c * c for c in gaze))

    def on_eye(s: float, radius: float, towards_gaze: float) -> Mesh:
        at = [e - 0.0232 * n + (0.0030 + towards_gaze) * g / length for e, n, g in zip(eye, normal, gaze, strict=True)]
        return mesh(ball((at[0], s * at[1], at[2]), radius), radius / 2.6)

    surfaces["amber"] = joined(on_eye(s, 0.0300, 0.0) for s in (1, -1))
    surfaces["black"] = joined([surfaces["black"], *(on_eye(s, 0.0140, 0.0182) for s in (1, -1))])
    tip = blend(
        0.014,
        ellipsoid((1.500, 0, 1.098), (0.024, 0.041, 0.019), (0, 12, 0)),
        *both(lambda s: ellipsoid((1.507, s * 0.021, 1.083), (0.016, 0.017, 0.014))),
        ellipsoid((1.510, 0, 1.070), (0.010, 0.009, 0.020)),
    )
    surfaces["nose"] = joined([surfaces["nose"], mesh(tip, 0.0088)])
    surfaces["white"] = joined(_fang((1.452, s * 0.030, 1.022), (0.004, 0, -0.044), 0.010) for s in (1, -1))
    ears = [_ear(s) for s in (1, -1)]
    surfaces["tawny"] = joined([surfaces["tawny"], *(ear["tawny"] for ear in ears)])
    surfaces["dark_mane"] = joined(ear["dark_mane"] for ear in ears)
    return {material: part.grown(HEAD_SIZE, HEAD) for material, part in surfaces.items()}


def _ear(s: float) -> Surfaces:
    turn = (s * -28, -8, s * 20)
    shell = ellipsoid((1.200, s * 0.118, 1.226), (0.027, 0.044, 0.050), turn)
    hollow = ellipsoid((1.229, s * 0.124, 1.229), (0.028, 0.030, 0.035), turn)
    shape = mesh(carve(shell, outside(hollow), width=0.008), 0.0085)
    inside = ellipsoid((1.227, s * 0.124, 1.229), (0.030, 0.029, 0.034), turn)
    return painted(shape, "tawny", dark_mane=inside.field)


def _fang(root: Point, along: Point, radius: float) -> Mesh:
    path = [[root[i] + t * along[i] for i in range(3)] for t in (0.0, 0.4, 0.75, 1.0)]
    return lock(path, [radius, 0.85 * radius, 0.5 * radius, 0.08 * radius], (1, 0, 0), 1.0, 7)


def jaw() -> Surfaces:
    bone = blend(
        0.02,
        *both(lambda s: limb((1.21, s * 0.078, 1.022), (1.42, s * 0.040, 1.004), 0.042, 0.036)),
        ellipsoid((1.440, 0, 1.000), (0.052, 0.047, 0.043)),  # chin
        ellipsoid((1.32, 0, 0.998), (0.12, 0.060, 0.034)),
    )
    solid = carve(bone, lambda x, y, z: MOUTH(x, y, z) - 0.002, width=0.006)
    chin = ellipsoid((1.475, 0, 0.985), (0.062, 0.055, 0.045)).field
    surfaces = painted(mesh(solid, HEAD_CELL), "tawny", pale=chin)
    surfaces["mouth"] = mesh(ellipsoid((1.34, 0, 1.005), (0.105, 0.032, 0.026), (0, 1, 0)), 0.0145)
    surfaces["white"] = joined(_fang((1.464, s * 0.022, 0.992), (0.004, s * 0.002, 0.034), 0.008) for s in (1, -1))
    return {material: part.grown(HEAD_SIZE, HEAD) for material, part in surfaces.items()}


# The mane -------------------------------------------------------------------------------------------------------------


def _ruff(
    center: Point,
    radii: tuple[float, float],
    count: int,
    length: tuple[float, float, float],
    back: float,
    droop: float,
    width: float,
    *,
    first: float = 0.0,
    span: float = 360.0,
) -> Mesh:
    """Locks around a circle across x: `radii` across and up, `length` at the crown, the sides and the throat."""
    locks = []
    for k in range(count):
        turn = math.radians(first + span * (k + 0.5) / count)
        side, up = math.sin(turn), math.cos(turn)
        crown, sides, throat = length
        reach = sides + (crown - sides) * up * up if up > 0 else sides + (throat - sides) * up * up
        reach *= 1.0 + 0.07 * ((3 * k) % 5 - 2)
        lean = back * (1.0 + 0.10 * ((7 * k) % 3 - 1)) * (1.0 - 0.55 * max(0.0, -up))
        path = []
        for t in (0.0, 0.3, 0.6, 0.86, 1.0):
            out = reach * (t - 0.30 * t * t)
            path.append(
                (
                    center[0] - lean * reach * t * (0.35 + 0.65 * t),
                    center[1] + (radii[0] + out) * side,
                    center[2] + (radii[1] + out) * up - droop * t * t,
                )
            )
        widths = [width * f for f in (0.75, 1.0, 0.88, 0.48, 0.03)]
        locks.append(lock(path, widths, (0.25, side, up), 0.55, 6))
    return joined(locks)


def _bib() -> Mesh:
    """Locks that lie on the breast, row over row, from the neck down to between the legs."""
    center = (0.84, 0.0, 0.80)
    locks = []
    for count, half_width, top, bottom, lift in (
        (5, 26, -10, -66, 0.006),
        (7, 50, 14, -40, 0.016),
        (8, 62, 38, -8, 0.026),
    ):
        for k in range(count):
            across = 2.0 * k / (count - 1) - 1.0
            turn, down = math.radians(half_width * across), (0.0, 0.3, 0.6, 0.86, 1.0)
            end = bottom + 16 * across * across + 5 * (k % 2)
            path = []
            for t in down:
                rise = math.radians(top + (end - top) * t)
                narrowed = turn * (1.0 - 0.25 * t)
                towards = (math.cos(rise) * math.cos(narrowed), math.cos(rise) * math.sin(narrowed), math.sin(rise))
                skin = surface_point(TRUNK, center, towards)
                path.append(tuple(p + (lift - 0.012 * t) * d for p, d in zip(skin, towards, strict=True)))
            widths = [0.048 * f for f in (0.75, 1.0, 0.88, 0.48, 0.03)]
            locks.append(lock(path, widths, (math.cos(turn), math.sin(turn), 0.0), 0.45, 6))
    return joined(locks)


def mane() -> dict[str, Surfaces]:
    cap = blend(0.05, ellipsoid((1.10, 0, 1.08), (0.13, 0.185, 0.20)), ellipsoid((1.14, 0, 1.02), (0.09, 0.15, 0.13)))
    scruff = blend(0.06, limb(NECK, HEAD, 0.200, 0.180), ellipsoid((0.97, 0, 0.95), (0.17, 0.195, 0.25)))
    return {
        "head": {
            "gold": _ruff((1.245, 0, 1.085), (0.128, 0.118), 28, (0.11, 0.13, 0.13), 0.70, 0.020, 0.026),
            "mane": joined([
                mesh(cap, 0.05),
                _ruff((1.210, 0, 1.085), (0.138, 0.133), 30, (0.15, 0.20, 0.17), 0.62, 0.035, 0.032, first=6),
            ]),
            "dark_mane": _ruff((1.145, 0, 1.080), (0.150, 0.160), 30, (0.22, 0.23, 0.20), 0.75, 0.055, 0.038),
        },
        "neck": {
            "dark_mane": joined([
                mesh(scruff, 0.065),
                _ruff((1.06, 0, 1.03), (0.155, 0.165), 28, (0.24, 0.22, 0.21), 0.75, 0.05, 0.044, first=6),
                _ruff((0.98, 0, 0.97), (0.160, 0.190), 28, (0.26, 0.20, 0.16), 0.95, 0.05, 0.044),
            ]),
        },
        "chest": {
            "dark_mane": joined([
                mesh(ellipsoid((0.89, 0, 0.90), (0.14, 0.165, 0.22)), 0.065),
                _ruff((0.90, 0, 0.90), (0.12, 0.17), 13, (0.26, 0.15, 0.15), 1.0, 0.06, 0.048, first=-95, span=190),
                _bib(),
            ]),
        },
    }  # fmt: skip


# The legs (left) ------------------------------------------------------------------------------------------------------


def _above_ground(solid: Solid) -> Solid:
    return carve(solid, half_space((0, 0, -1), 0.0), width=0.008)


def _paw(at: Point, heel: Point, size: float) -> Surfaces:
    """A paw around its frame `at`, from the joint `heel`: a pad, four toes, their claws."""
    x, y, _ = at

    def point(forward: float, left: float, up: float) -> Point:
        return (x + forward * size, y + left * size, up * size)

    toes = [(0.052, -0.044), (0.072, -0.016), (0.072, 0.016), (0.052, 0.044)]
    pad = blend(
        0.014 * size,
        ball(heel, 0.041 * size),
        ellipsoid((x + 0.005, y, 0.036 * size), (0.068 * size, 0.058 * size, 0.040 * size)),
        *(ellipsoid(point(tx, ty, 0.027), (0.040 * size, 0.0205 * size, 0.030 * size), (0, 14, 0)) for tx, ty in toes),
    )
    claws = [
        lock(
            [point(tx + 0.030, ty, 0.022), point(tx + 0.045, ty, 0.020), point(tx + 0.053, ty, 0.008)],
            [0.007 * size, 0.006 * size, 0.001], (0, 1, 0), 0.7, 5)
        for tx, ty in toes
    ]  # fmt: skip
    return {"tawny": mesh(_above_ground(pad), 0.0115), "nose": joined(claws)}


def _grown_from_trunk(limb_: Solid) -> Solid:
    """A limb with a fillet onto the trunk, which ends just under the trunk's skin."""
    under = Solid(lambda x, y, z: TRUNK.field(x, y, z) + 0.009, TRUNK.low, TRUNK.high)
    return Solid(
        carve(blend(0.10, limb_, under), lambda x, y, z: limb_.field(x, y, z) - 0.055).field,
        limb_.low - 0.06,
        limb_.high + 0.06,
    )


def fore_leg() -> dict[str, Surfaces]:
    shoulder, elbow, wrist, toes, paw = (FORE_LEG[name] for name in ("shoulder", "elbow", "wrist", "toes", "paw"))
    upper = blend(
        0.07,
        limb(shoulder, elbow, 0.092, 0.064),
        ellipsoid((0.795, 0.150, 0.85), (0.105, 0.062, 0.17), (0, 14, 0)),  # shoulder blade
        ellipsoid((0.725, 0.152, 0.68), (0.085, 0.060, 0.125), (0, 20, 0)),  # triceps
    )
    forearm = blend(
        0.05,
        limb(elbow, wrist, 0.058, 0.043),
        ellipsoid((0.712, 0.147, 0.41), (0.056, 0.051, 0.105), (0, -7, 0)),
        ball((0.652, 0.147, 0.522), 0.032),  # point of the elbow
    )
    metacarpus = blend(0.04, limb(wrist, toes, 0.043, 0.048), limb(wrist, (0.722, 0.135, 0.145), 0.035, 0.028))
    return {
        "upper_arm": {"tawny": mesh(_grown_from_trunk(upper), 0.024)},
        "forearm": {"tawny": mesh(forearm, LEG_CELL)},
        "metacarpus": {"tawny": mesh(metacarpus, LEG_CELL)},
        "fore_toes": _paw(paw, toes, 1.18),
    }


def hind_leg() -> dict[str, Surfaces]:
    knee, hock, toes, paw = (HIND_LEG[name] for name in ("knee", "hock", "toes", "paw"))
    thigh = blend(
        0.08,
        limb((0.0, 0.090, 0.80), (0.06, 0.120, 0.68), 0.095, 0.085),
        limb((0.06, 0.125, 0.68), knee, 0.080, 0.069),
        ellipsoid((-0.045, 0.105, 0.755), (0.150, 0.072, 0.200), (0, -10, 0)),  # buttock
        ellipsoid((0.05, 0.118, 0.69), (0.125, 0.066, 0.190), (0, -28, 0)),
    )
    shank = blend(
        0.05,
        limb(knee, hock, 0.066, 0.040),
        ellipsoid((0.07, 0.143, 0.43), (0.062, 0.052, 0.125), (0, 45, 0)),
        limb((0.0, 0.140, 0.40), (-0.145, 0.135, 0.268), 0.030, 0.022),  # Achilles' tendon
    )
    metatarsus = blend(0.04, limb(hock, toes, 0.039, 0.0435), limb(hock, (-0.137, 0.135, 0.250), 0.034, 0.026))
    return {
        "thigh": {"tawny": mesh(_grown_from_trunk(thigh), 0.025)},
        "shank": {"tawny": mesh(shank, LEG_CELL)},
        "metatarsus": {"tawny": mesh(metatarsus, LEG_CELL)},
        "hind_toes": _paw(paw, toes, 1.06),
    }


# The tail, each segment in its own frame along -x ---------------------------------------------------------------------


def tail(number: int, count: int) -> Surfaces:
    """A segment bent so that the tail at rest is one smooth curve."""
    thick = [0.046 - 0.024 * min(k / (count - 1), 1.0) for k in (number - 1, number)]
    if number == 1:
        thick[0] = 0.062
    after = TAIL_DROOP[number] if number < count else 0.0
    slopes = [math.tan(math.radians(turn / 2)) for turn in (TAIL_DROOP[number - 1] if number > 1 else 0.0, -after)]
    path, widths = [], []
    for t in (-0.5, -0.4, -0.25, 0.0, 0.17, 0.33, 0.5, 0.67, 0.83, 1.0, 1.25, 1.4, 1.5):
        s = min(max(t, 0.0), 1.0)
        beyond = t - s  # of a cap, where 0.5 is the radius
        width = thick[0] + s * (thick[1] - thick[0])
        rise = TAIL_SEGMENT * (slopes[0] * s * (1 - s) ** 2 - slopes[1] * s * s * (1 - s))
        step = 2 * beyond * width
        path.append((-TAIL_SEGMENT * s - step, 0.0, rise + step * (slopes[0] if t < 0 else slopes[1])))
        widths.append(max(width * math.sqrt(max(1 - 4 * beyond * beyond, 0.0)), 0.002))
    surfaces: Surfaces = {"tawny": lock(path, widths, (0, 0, 1), 1.0, 12)}
    if number == count:
        surfaces["dark_mane"] = joined(_tuft(k) for k in range(11))
    return surfaces


def _tuft(k: int) -> Mesh:
    turn = 2 * math.pi * k / 10
    y, z = (0.0, 0.0) if k == 10 else (math.cos(turn), math.sin(turn))
    end = TAIL_SEGMENT + 0.15 - (0.055 if k % 2 else 0.0)
    path: Sequence[Point] = [
        (-0.030, 0.012 * y, 0.012 * z),
        (-0.09, 0.032 * y, 0.032 * z),
        (-0.16, 0.040 * y, 0.040 * z),
        (-end + 0.05, 0.024 * y, 0.024 * z),
        (-end, 0.010 * y, 0.010 * z),
    ]
    return lock(path, [0.014, 0.024, 0.027, 0.017, 0.001], (0, y, z) if k < 10 else (0, 0, 1), 0.75, 6)
