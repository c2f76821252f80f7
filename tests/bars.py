"""Planar arms of bars, and balls in their way, whose distances follow by hand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import pinik
from urdf_texts import joint, link, robot

THICK = 0.04
BALL = 0.05


def bar(name: str, length: float) -> str:
    """A link that is a bar along its x axis."""
    shape = f'<collision><origin xyz="{length / 2} 0 0"/><geometry><box size="{length} {THICK} {THICK}"/></geometry>'
    return link(name, f"{shape}</collision>")


def planar(*lengths: float, limits: tuple[float, float] = (-3.0, 3.0)) -> str:
    """An arm of bars in the plane z = 0, with hinges j0, j1, …; the limits are those of j0."""
    parts, reach, before = [link("base"), link("tip")], 0.0, "base"
    for number, length in enumerate(lengths):
        low, high = limits if number == 0 else (-3.0, 3.0)
        ends = f'<limit lower="{low}" upper="{high}" effort="1" velocity="1"/>'
        at = f'<origin xyz="{reach} 0 0"/><axis xyz="0 0 1"/>'
        parts += [bar(f"b{number}", length), joint(f"j{number}", before, f"b{number}", at, limit=ends)]
        before, reach = f"b{number}", length
    parts.append(joint("t", before, "tip", f'<origin xyz="{reach} 0 0"/>', kind="fixed", limit=""))
    return robot(*parts)


def gap(machine: pinik.Robot, lengths: Sequence[float], q: np.ndarray, centre: np.ndarray) -> float:
    """The distance [m] of a ball of radius BALL from the bars of a planar arm, from its centre and each box, by hand.

    It is at least −BALL, where the centre is inside a bar.
    """
    distances = []
    for number, length in enumerate(lengths):
        local = machine.placement(f"b{number}", q).actInv(centre) - np.array([length / 2, 0.0, 0.0])
        outside = np.maximum(np.abs(local) - [length / 2, THICK / 2, THICK / 2], 0.0)
        distances.append(float(np.linalg.norm(outside)))
    return min(distances) - BALL


def world_of(*centres: np.ndarray) -> pinik.World:
    """A world of balls of radius BALL: ball0, ball1, …"""
    world = pinik.World()
    for number, centre in enumerate(centres):
        world.add_sphere(f"ball{number}", BALL, centre)
    return world
