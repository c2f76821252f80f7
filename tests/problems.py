"""Inverse kinematics problems of every kind, made by hypothesis."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pinocchio
from hypothesis import strategies as st

import pinik
from by_hand import ZOO
from pinik.model.limits import Limits
from robots import load_quietly

# Source, options of load, and frames worth moving: chains, hands, humanoids; continuous, prismatic, floating and planar
# joints; mimic joints that carry the frame, and leaders whose followers do, several at once.
ROBOTS: dict[str, tuple[str, dict[str, str], tuple[str, ...]]] = {
    "panda": ("panda", {}, ("panda_hand_tcp", "panda_leftfinger", "panda_link5")),
    "ur5": ("ur5", {}, ("tool0", "forearm_link")),
    "z1": ("z1", {}, ("link06", "gripperMover")),
    "xarm7": ("xarm7", {}, ("link_eef",)),
    "kinova": ("kinova", {}, ("j2s6s200_end_effector", "j2s6s200_link_finger_tip_1")),
    "arm": ("arm", {}, ("tip",)),
    "two_link": ("two_link", {}, ("tip",)),
    "lion": ("lion", {}, ("nose", "tail_tip")),
    "lion_free": ("lion", {"root": "free_flyer"}, ("nose", "tail_tip")),
    "ur5_planar": ("ur5", {"root": "planar"}, ("tool0",)),
    "talos": ("talos", {}, ("gripper_left_joint", "leg_right_6_joint", "rgbd_link")),
    "talos_full": ("talos_full", {"root": "free_flyer"}, ("gripper_left_fingertip_1_link", "rgbd_link")),
    "tiago": ("tiago", {}, ("arm_tool_link", "wheel_left_link")),
    "baxter": ("baxter", {}, ("left_gripper", "right_wrist", "l_gripper_r_finger")),
    "pr2": ("pr2", {}, ("l_gripper_tool_frame", "l_gripper_l_finger_tip_link", "r_gripper_tool_frame")),
    "zoo": (ZOO, {}, ("tip", "hand", "a")),
    "zoo_free": (ZOO, {"root": "free_flyer"}, ("tip", "hand")),
}  # fmt: skip


class Problem(NamedTuple):
    """What to solve, from where, and how."""

    robot: pinik.Robot
    targets: list[pinik.Target]
    q0: np.ndarray
    method: str
    parameters: dict[str, Any]
    options: dict[str, Any]


def load(name: str) -> pinik.Robot:
    source, options, _ = ROBOTS[name]
    return load_quietly(source, **options)


def frames(name: str) -> list[str]:
    return [frame for frame in ROBOTS[name][2] if frame in load(name).frame_names]


def start(robot: pinik.Robot, rng: np.random.Generator, limits: bool = True) -> np.ndarray:
    """A configuration inside the limits, now and then with joints at them."""
    q = robot.random(rng)
    if limits and rng.random() < 0.3:
        box = Limits.of(robot)
        for entry in np.flatnonzero(np.isfinite(box.lower) & (rng.random(len(q)) < 0.3)):
            q[entry] = box.lower[entry] if rng.random() < 0.5 else box.upper[entry]
    return q


@st.composite
def problems(draw: st.DrawFn, names: tuple[str, ...] = tuple(ROBOTS), most_targets: int = 3) -> Problem:
    name = draw(st.sampled_from(names))
    robot = load(name)
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    limits = draw(st.booleans())
    method = draw(st.sampled_from(["ccd", "jt", "pinv", "dls"]))
    settable = list(robot.joint_names)
    locked = draw(st.lists(st.sampled_from(settable), max_size=2, unique=True))
    posed = robot.random(rng)
    kinds = st.sampled_from(["position", "pose", "rotation", "axis", "look", "axis+position", "partial position"])
    asked = draw(st.lists(kinds, min_size=1, max_size=draw(st.integers(1, most_targets))))
    targets = [target(draw, rng, robot, frames(name), posed, kind) for kind in asked]
    parameters = draw(parameters_of(method, robot))
    return Problem(robot, targets, start(robot, rng, limits), method, parameters, {"limits": limits, "locked": locked})


def target(
    draw: st.DrawFn, rng: np.random.Generator, robot: pinik.Robot, names: list[str], posed: np.ndarray, kind: str
) -> pinik.Target:
    """One that a configuration fulfils, or one that is moved off it."""
    frame = draw(st.sampled_from(names))
    about: dict[str, Any] = {"weight": draw(st.sampled_from([1.0, 1.0, 0.1, 7.0]))}
    others = [None, None, *(name for name in (*names, robot.frame_names[0]) if name != frame)]
    about["relative_to"] = draw(st.sampled_from(others))
    placement = robot.placement(frame, posed, about["relative_to"])
    if draw(st.booleans()):
        about["tool"] = pinocchio.SE3(pinocchio.exp3(rng.normal(size=3)), 0.3 * rng.normal(size=3))
        placement = placement * about["tool"]
    off = draw(st.sampled_from([0.0, 0.0, 0.3, 3.0]))
    position = placement.translation + off * rng.normal(size=3)
    if "position" in kind or kind == "look":
        about["position"] = position
    about["tolerance"] = draw(st.sampled_from([None, None, (1e-3, 0.3), ((0.1, 1e-4, 1e-3), 0.02)]))
    if kind == "partial position":
        free = draw(st.sampled_from([(0,), (2,), (0, 1), (1, 2)]))
        about["position"] = [None if k in free else x for k, x in enumerate(position.tolist())]
    if kind == "pose":
        about["placement"] = pinocchio.SE3(placement.rotation, position)
    elif kind == "rotation":
        about["rotation"] = placement.rotation
    elif kind.startswith("axis"):
        about |= {"axis": rng.normal(size=3), "direction": rng.normal(size=3)}
    elif kind == "look":
        about |= {"axis": draw(st.sampled_from(["x", "-z"])), "at": position + rng.normal(size=3)}
        if draw(st.booleans()):
            del about["position"]
    return pinik.Target(frame, **about)


def powers(low: float, high: float) -> st.SearchStrategy[float]:
    """Positive numbers, as many small ones as large ones."""
    return st.floats(math.log(low), math.log(high)).map(lambda x: min(max(math.exp(x), low), high))


@st.composite
def parameters_of(draw: st.DrawFn, method: str, robot: pinik.Robot) -> dict[str, Any]:
    """A few of a method's parameters, the rest left as they are."""
    one_axis = [joint.name for joint in robot.joints if joint.has_one_axis and joint.nv]
    several = st.lists(st.sampled_from(one_axis), max_size=4, unique=True)
    stiffness = several.flatmap(
        lambda names: st.fixed_dictionaries({n: st.sampled_from([0.0, 0.1, 0.5, 1.0]) for n in names})
    )
    jacobian = {"step_size": powers(0.01, 2.0), "target_jacobian": st.booleans()}
    clamps = {"max_step": powers(1e-3, 10.0) | st.none(), "max_residual": powers(1e-3, 3.0) | st.none()}
    own: dict[str, dict[str, st.SearchStrategy[Any]]] = {
        "dls": {
            "damping": powers(1e-4, 10.0),
            "rule": st.sampled_from(["constant", "residual", "sugihara", "manipulability"]),
            "manipulability": powers(1e-3, 1.0),
            "factorization": st.sampled_from(["ldlt", "svd"]),
        },
        "pinv": {
            "cutoff": st.just(0.0) | powers(1e-13, 0.5),
            "rest_posture": several.flatmap(lambda names: st.fixed_dictionaries({n: st.floats(-3, 3) for n in names})),
            "rest_gain": st.floats(0.0, 1.0),
        },
        "jt": {"alpha": powers(1e-3, 10.0) | st.none()},
        "ccd": {
            "relaxation": st.floats(0.01, 1.99) | st.none(),
            "position_weight": powers(0.01, 1e3),
            "scaling": st.sampled_from(["area", "printed"]),
        },
    }
    choices = own[method] | clamps | {"stiffness": stiffness} | ({} if method == "ccd" else jacobian)
    return {name: draw(value) for name, value in choices.items() if draw(st.booleans())}
