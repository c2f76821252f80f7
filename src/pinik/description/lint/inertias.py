"""Masses and inertias that no body can have."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..flaw import Flaw
from ..xml import Element
from .plain import joint_values, named, plain_numbers

__all__ = ["inertias"]

_WHY = "Dynamics with this link is wrong, or fails; kinematics does not use it."
_ENTRIES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_ROUNDING = 1e-3  # of the largest moment: files round their inertias
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
                code, cause, common, mend = fault
                line = inertial.named("inertia")[0].line
                yield Flaw(named(link), cause, code=code, line=line, common=common, why=_WHY, mend=mend)


def _fault(mass: float, entries: list[float], reach: float) -> tuple[str, str, str, str] | None:
    """Code, cause, common cause and mend of what is wrong with a mass [kg] and an inertia [kg m²]."""
    if mass == 0.0:
        if not any(entries):
            return None
        cause = "it has an inertia, but its mass is 0"
        return "massless-inertia", cause, cause, "Give the mass, or remove <inertial>."
    ixx, ixy, ixz, iyy, iyz, izz = entries
    with np.errstate(all="ignore"):
        least, middle, most = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]]).tolist()
    if not math.isfinite(most):
        return None
    if not any(entries):
        cause = "its inertia is 0, though its mass is not"
        return "inertia-not-positive", cause, cause, "Give the inertia about the centre of mass."
    shown = f"{least:.3g}, {middle:.3g} and {most:.3g} kg m²"
    compute = "Compute the inertia about the centre of mass again."
    if least <= 0.0:
        common = "its inertia is not positive definite"
        return "inertia-not-positive", f"{common}: its principal moments are {shown}", common, compute
    if most > (least + middle) * (1.0 + _ROUNDING):
        common = "its inertia is that of no body, as one principal moment is larger than the sum of the others"
        return "inertia-triangle", f"{common}: {shown}", common, compute
    radius = math.sqrt((least + middle + most) / (2.0 * mass))  # of gyration [m]
    # The solid ball of the same mass and the same sum of moments.
    density = mass / (4.0 / 3.0 * math.pi * ((least + middle + most) / (1.2 * mass)) ** 1.5)
    if density > _DENSEST:
        common = f"its mass and inertia are those of a body of over {_DENSEST:g} kg/m³; osmium has 22,590"
        cause = f"its mass of {mass:g} kg and its inertia are those of a body of {density:.2g} kg/m³; osmium has 22,590"
        return "density", cause, common, "Check the units: kg and kg m²."
    if reach and radius > _FARTHER * reach:
        common = f"its mass and inertia are those of a body over {_FARTHER:g} times as large as the whole robot"
        cause = f"its mass of {mass:g} kg and its inertia are those of a body of about {2.0 * radius:.2g} m"
        return "density", cause, common, "Check the units: kg and kg m²."
    return None


def _mass(inertial: Element) -> float | None:
    found = inertial.named("mass")
    values = plain_numbers(found[0].attributes.get("value", "")) if len(found) == 1 else None
    return values[0] if values is not None and len(values) == 1 else None


def _inertia(inertial: Element) -> list[float] | None:
    found = inertial.named("inertia")
    if len(found) != 1:
        return None
    values = [plain_numbers(found[0].attributes.get(entry, "")) for entry in _ENTRIES]
    return [value[0] for value in values if value] if all(value and len(value) == 1 for value in values) else None
