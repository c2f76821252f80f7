"""The lion's joints when it stands [m]: x from the hips, y from the middle (left side), z from the ground."""

from __future__ import annotations

PELVIS = (0.0, 0.0, 0.80)
SPINE = (0.14, 0.0, 0.855)
CHEST = (0.45, 0.0, 0.81)
NECK = (0.88, 0.0, 0.94)
HEAD = (1.13, 0.0, 1.10)
JAW = (1.208, 0.0, 1.045)
NOSE = (1.565, 0.0, 1.085)
TAIL = (-0.19, 0.0, 0.93)

FORE_LEG = {
    "shoulder": (0.82, 0.135, 0.76),
    "elbow": (0.69, 0.145, 0.505),
    "wrist": (0.735, 0.135, 0.165),
    "toes": (0.775, 0.135, 0.055),
    "paw": (0.805, 0.135, 0.0),
}
HIND_LEG = {
    "hip": (0.0, 0.115, 0.80),
    "knee": (0.15, 0.145, 0.50),
    "hock": (-0.11, 0.135, 0.24),
    "toes": (-0.06, 0.135, 0.055),
    "paw": (-0.03, 0.135, 0.0),
}

HEAD_SIZE = 1.12  # the head is sculpted smaller and scaled about its joint

TAIL_SEGMENT = 0.15
TAIL_DROOP = (-35, -22, -16, -4, 14, 20)  # [deg], each segment relative to the one before
