"""Masses and inertias that no body can have."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..flaw import Flaw
from ..links import INERTIA_ATTRIBUTES
from ..xml import Element
from .plain import joint_values, named, plain_numbers

__all__ = ["inertias"]

_ROUNDING = 1e-3  # of the largest moment: files round their inertias
_SINGULAR = 1e-12  # of the largest moment, or [m²] of the mass: no more than rounding leaves of zero
_DENSEST = 1e5  # [kg/m³]: four times osmium
_FARTHER = 10.0  # a radius of gyration this many times as long as all links together


def inertias(robot: Element) -> Iterator[Flaw]:
    """The flaws of the `<inertial>` elements of a robot description."""
    reach = sum(math.hypot(*joint.xyz) for joint in joint_values(robot) if joint.xyz is not None)
    for link in robot.named("link"):
        for inertial in link.named("inertial"):
            mass, moments = _mass(inertial), _inertia(inertial)
            if mass is None or moments is None or mass < 0.0:
                continue
            fault = _fault(mass, moments, reach)
            if fault is not None:
                line = inertial.named("inertia")[0].line
                yield Flaw(
                    named(link),
                    fault.cause,
                    code=fault.code,
                    line=line,
                    common=fault.common or fault.cause,
                )


class _Fault(NamedTuple):
    code: str
    cause: str
    common: str = ""


def _fault(mass: float, entries: list[float], reach: float) -> _Fault | None:
    """What is wrong with a mass [kg] and an inertia [kg m²]; `reach` is the length of all links together [m]."""
    if mass == 0.0:
        if not any(entries):
            return None
        cause = "it has an inertia, but its mass is 0"
        return _Fault(code="massless-inertia", cause=cause)
    ixx, ixy, ixz, iyy, iyz, izz = entries
    with np.errstate(all="ignore"):
        least, middle, most = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]]).tolist()
    if not math.isfinite(most):
        return None
    shown = f"{least:.3g}, {middle:.3g} and {most:.3g} kg m²"
    zero = _SINGULAR * max(mass, most)
    if least < -max(_ROUNDING * most, zero):
        common = "its inertia is not positive definite"
        cause = f"{common}: its principal moments are {shown}"
        return _Fault(code="inertia-not-positive", cause=cause, common=common)
    if middle <= zero:
        cause = "at least two of its principal moments of inertia are 0, though its mass is not"
        return _Fault(code="inertia-singular", cause=cause)
    if most - (least + middle) > _ROUNDING * most:
        common = "its inertia is that of no body, as one principal moment is larger than the sum of the others"
        return _Fault(code="inertia-triangle", cause=f"{common}: {shown}", common=common)
    with np.errstate(all="ignore"):  # a file may have any numbers, which overflow or underflow here
        radius = np.sqrt((least + middle + most) / np.float64(2.0 * mass))  # of gyration [m]
        # The solid ball of the same mass and the same sum of moments.
        density = mass / (4.0 / 3.0 * math.pi * np.sqrt((least + middle + most) / np.float64(1.2 * mass)) ** 3)
    if density > _DENSEST:
        common = f"its mass and inertia are those of a body of over {_DENSEST:g} kg/m³; osmium has 22,590"
        cause = f"its mass of {mass:g} kg and its inertia are those of a body of {density:.2g} kg/m³; osmium has 22,590"
        return _Fault(code="density", cause=cause, common=common)
    if reach and radius > _FARTHER * reach:
        common = f"its mass and inertia are those of a body over {_FARTHER:g} times as large as the whole robot"
        cause = f"its mass of {mass:g} kg and its inertia are those of a body of about {2.0 * radius:.2g} m"
        return _Fault(code="density", cause=cause, common=common)
    return None


def _mass(inertial: Element) -> float | None:
    found = inertial.named("mass")
    values = plain_numbers(found[0].attributes.get("value", "")) if len(found) == 1 else None
    return values[0] if values is not None and len(values) == 1 else None


def _inertia(inertial: Element) -> list[float] | None:
    found = inertial.named("inertia")
    if len(found) != 1:
        return None
    values = [plain_numbers(found[0].attributes.get(entry, "")) for entry in INERTIA_ATTRIBUTES]
    return [value[0] for value in values if value] if all(value and len(value) == 1 for value in values) else None
