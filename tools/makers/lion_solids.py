"""What of the lion can touch others: balls, cylinders and boxes inside its skin.

What gives way has no part in it: the mane, and the flanks, into which a lion that sits draws its thighs.
"""

from __future__ import annotations

from collections.abc import Sequence

from .description import Collision, Vector, box, capsule, sphere
from .lion_anatomy import (
    CHEST,
    FORE_LEG,
    HEAD,
    HEAD_SIZE,
    HIND_LEG,
    JAW,
    NECK,
    PELVIS,
    SPINE,
    TAIL_DROOP,
    TAIL_SEGMENT,
)

FORE_RADII = {"upper_arm": 0.070, "forearm": 0.050, "metacarpus": 0.043}  # [m]
HIND_RADII = {"thigh": 0.070, "shank": 0.050, "metatarsus": 0.039}
FREE = 0.45  # where the uppermost segment of a leg leaves the trunk's skin, as a part of its length


def solids() -> dict[str, list[Collision]]:
    """Each link's shapes, in the link's frame."""
    made = {
        "pelvis": _capsule(PELVIS, 0.150, (-0.08, 0.0, 0.87), (0.10, 0.0, 0.86)),
        "spine": _capsule(SPINE, 0.100, (0.20, 0.0, 0.89), (0.40, 0.0, 0.86)),
        "chest": [
            *_capsule(CHEST, 0.150, (0.54, 0.0, 0.83), (0.74, 0.0, 0.83)),
            sphere(0.160, _from(CHEST, (0.80, 0.0, 0.83))),
        ],
        "neck": _capsule(NECK, 0.115, (0.93, 0.0, 0.97), (1.03, 0.0, 1.036)),
        "head": [sphere(0.128 * HEAD_SIZE, _head((1.20, 0.0, 1.12))), *_muzzle()],
        "jaw": capsule(0.036 * HEAD_SIZE, _jaw((1.29, 0.0, 1.0)), _jaw((1.43, 0.0, 1.0))),
    }
    for side in (1.0, -1.0):
        name = "left" if side > 0 else "right"
        for leg, radii, toes in ((FORE_LEG, FORE_RADII, 1.18), (HIND_LEG, HIND_RADII, 1.06)):
            points = [(x, side * y, z) for x, y, z in leg.values()]
            for number, (link, radius) in enumerate(radii.items()):
                start, end = points[number], points[number + 1]
                first = start if number else _between(start, end, FREE)
                made[f"{name}_{link}"] = _capsule(start, radius, first, end)
            end_of_leg = "fore" if leg is FORE_LEG else "hind"
            made[f"{name}_{end_of_leg}_toes"] = [_paw(points[3], points[4], toes)]
    for number in range(1, len(TAIL_DROOP) + 1):
        made[f"tail{number}"] = capsule(0.046 - 0.004 * number, (0.0, 0.0, 0.0), (-TAIL_SEGMENT, 0.0, 0.0))
    return made


def _muzzle() -> list[Collision]:
    return capsule(0.060 * HEAD_SIZE, _head((1.30, 0.0, 1.10)), _head((1.455, 0.0, 1.075)))


def _paw(heel: Vector, sole: Vector, size: float) -> Collision:
    """A box around a paw, whose frame lies on the sole."""
    x, y, z = _from(heel, sole)
    return box((0.170 * size, 0.116 * size, 0.066 * size), (x + 0.025 * size, y, z + 0.033 * size))


def _capsule(origin: Sequence[float], radius: float, start: Vector, end: Vector) -> list[Collision]:
    return capsule(radius, _from(origin, start), _from(origin, end))


def _from(origin: Sequence[float], point: Sequence[float]) -> Vector:
    return (round(point[0] - origin[0], 6), round(point[1] - origin[1], 6), round(point[2] - origin[2], 6))


def _between(start: Vector, end: Vector, part: float) -> Vector:
    x, y, z = (a + part * (b - a) for a, b in zip(start, end, strict=True))
    return x, y, z


def _head(point: Vector) -> Vector:
    """A point of the head, which is sculpted smaller, in the head's frame."""
    x, y, z = _from(HEAD, point)
    return (HEAD_SIZE * x, HEAD_SIZE * y, HEAD_SIZE * z)


def _jaw(point: Vector) -> Vector:
    """The same in the jaw's frame."""
    x, y, z = _head(point)
    return _from(_from(HEAD, JAW), (x, y, z))
