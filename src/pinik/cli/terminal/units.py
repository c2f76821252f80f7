"""Units in options and tables: angles in radians, or in degrees with --deg; lengths always in metres."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio

from ...model.joint import Joint

__all__ = ["Units", "counted", "duration", "length", "roll_pitch_yaw", "small_length"]


@dataclass(frozen=True)
class Units:
    """The unit of angles in the options and tables of a command.

    Attributes:
        degrees: Degrees instead of radians.
    """

    degrees: bool = False

    @property
    def angle(self) -> str:
        """The symbol of the unit."""
        return "deg" if self.degrees else "rad"

    def of(self, joint: Joint) -> str:
        """The unit of a one-axis joint's value."""
        return "m" if joint.kind == "prismatic" else self.angle

    def radians(self, value: float) -> float:
        """An angle in radians, from one in this unit."""
        return math.radians(value) if self.degrees else value

    def scalar(self, value: float, joint: Joint) -> float:
        """A joint's value in rad or m, from one in this unit."""
        return value if joint.kind == "prismatic" else self.radians(value)

    def show_angle(self, radians: float) -> str:
        """An angle as text, without its unit."""
        if math.isinf(radians):
            return _infinity(radians)
        return f"{math.degrees(radians):z.3f}" if self.degrees else f"{radians:z.5f}"

    def show_small_angle(self, radians: float) -> str:
        """An angular error as text, without its unit."""
        value, decimals = (math.degrees(radians), 3) if self.degrees else (radians, 5)
        return _small(value, decimals)

    def show_scalar(self, value: float, joint: Joint) -> str:
        """A joint's value (rad or m) as text, without its unit."""
        return length(value) if joint.kind == "prismatic" else self.show_angle(value)

    def show_limits(self, lower: float, upper: float, joint: Joint) -> tuple[str, str]:
        """A joint's limits (rad or m) as text, without their unit."""
        return self.show_scalar(lower, joint), self.show_scalar(upper, joint)

    def show_placement(self, placement: pinocchio.SE3) -> str:
        """A placement as text: xyz and fixed-axis roll, pitch, yaw."""
        return (
            f"xyz {_joined(map(length, placement.translation))} m, "
            f"rpy {_joined(map(self.show_angle, roll_pitch_yaw(placement)))} {self.angle}"
        )


def length(metres: float) -> str:
    """A length as text, without its unit."""
    return _infinity(metres) if math.isinf(metres) else f"{metres:z.5f}"


def small_length(metres: float) -> str:
    """A position error as text, without its unit."""
    return _small(metres, 6)


def duration(seconds: float) -> str:
    """A time as text, with its unit."""
    if seconds < 1e-3:
        return f"{1e6 * seconds:.0f} µs"
    return f"{1000.0 * seconds:.1f} ms" if seconds < 1.0 else f"{seconds:.2f} s"


def counted(count: int, noun: str) -> str:
    """A count with its noun, such as "3 joints"."""
    return f"{count} {noun}{'es' if noun.endswith('sh') else 's'}" if count != 1 else f"1 {noun}"


def _small(value: float, decimals: int) -> str:
    """Three significant digits, or as many decimals as matter, without an exponent."""
    shown = f"{value:.3g}"
    return f"{value:z.{decimals}f}" if "e" in shown or abs(value) < 10.0**-decimals else shown


def _infinity(value: float) -> str:
    return "∞" if value > 0 else "-∞"


def roll_pitch_yaw(placement: pinocchio.SE3) -> Sequence[float]:
    """Fixed-axis roll, pitch, yaw [rad]."""
    angles: list[float] = np.asarray(pinocchio.rpy.matrixToRpy(placement.rotation)).tolist()
    return angles


def _joined(words: Iterable[str]) -> str:
    return " ".join(words)
