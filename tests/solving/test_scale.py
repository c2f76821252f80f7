"""Where an arm is mounted and how large it is changes nothing: the verdicts and the counts of iterations stay."""

from __future__ import annotations

import functools

import numpy as np
import pinocchio
import pytest

import pinik
from engines import needs_native
from pinik import Target

METHODS = ("ccd", "jt", "pinv", "dls")
AXES = ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0")
MOUNTS = [(0.0, (0.0, 0.0, 0.0)), (1.0, (0.0, 0.0, 0.0)), (10.0, (1.0, -2.0, 0.5)), (50.0, (0.3, 0.0, 3.0))]
POSES = 8


@functools.cache
def arm(scale: float = 1.0, away: float = 0.0, rpy: tuple[float, ...] = (0.0, 0.0, 0.0)) -> pinik.Robot:
    """Six links of 0.2 m, `scale` times as large, on a fixed joint `away` from the root [m] and turned."""
    links = "".join(f'<link name="l{k}"/>' for k in range(8))
    joints = "".join(
        f'<joint name="j{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{0.2 * scale * (k > 0)!r} 0 {0.03 * scale * (k % 2)!r}"/><axis xyz="{axis}"/>'
        '<limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>'
        for k, axis in enumerate(AXES)
    )
    place = f"{away!r} {-0.4 * away!r} {0.1 * away!r}"
    return pinik.load(
        f'<robot name="six"><link name="root"/>{links}<joint name="mount" type="fixed"><parent link="root"/>'
        f'<child link="l0"/><origin xyz="{place}" rpy="{" ".join(map(repr, rpy))}"/></joint>{joints}'
        f'<joint name="end" type="fixed"><parent link="l6"/><child link="l7"/><origin xyz="{0.2 * scale!r} 0 0"/>'
        "</joint></robot>"
    )


@functools.cache
def poses() -> tuple[pinocchio.SE3, ...]:
    """Reachable poses of the arm of 1.2 m on the root, and one out of reach."""
    rng = np.random.default_rng(7)
    robot = arm()
    reachable = [robot.placement("l7", robot.random(rng)) for _ in range(POSES - 1)]
    return (*reachable, pinocchio.SE3(np.eye(3), np.array([1.5, 0.6, 0.2])))


def answers(robot: pinik.Robot, method: str, scale: float, with_orientation: bool, **options) -> list[tuple[str, int]]:
    """(status, iterations) for the poses, carried along with the arm."""
    mount = robot.placement("l0", robot.neutral())
    told = []
    for pose in poses():
        there = mount * pinocchio.SE3(pose.rotation, scale * pose.translation)
        target = Target("l7", placement=there) if with_orientation else Target("l7", there.translation)
        tolerance = (1e-4 * scale, 1e-3)
        s = pinik.solve(robot, target, method, tolerance=tolerance, restarts=3, max_iterations=60, **options)
        told.append((s.status.name, s.iterations))
    return told


ENGINES = ["python", pytest.param("native", marks=needs_native)]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("with_orientation", [False, True], ids=["position", "pose"])
@pytest.mark.parametrize("method", METHODS)
def test_a_mount_changes_nothing(method, with_orientation, engine):
    told = [answers(arm(1.0, *mount), method, 1.0, with_orientation, engine=engine) for mount in MOUNTS]
    assert told[1:] == told[:1] * (len(MOUNTS) - 1)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("with_orientation", [False, True], ids=["position", "pose"])
@pytest.mark.parametrize("method", METHODS)
def test_scale_changes_nothing(method, with_orientation, engine):
    """Powers of two, so that rounding is the same to the last bit."""
    scales = (2.0**-10, 1.0, 2.0**7)
    told = [answers(arm(scale), method, scale, with_orientation, engine=engine) for scale in scales]
    assert told[0] == told[1] == told[2]


@pytest.mark.parametrize("scale", [1e-3, 1e-2, 1.0, 100.0])
def test_the_pseudo_inverse_solves_arms_of_any_size(scale):
    """Its cut-off compares singular values, which must not mix metres with radians."""
    robot, rng = arm(scale), np.random.default_rng(3)
    solved = 0
    for _ in range(20):
        target = Target("l7", placement=robot.placement("l7", robot.random(rng)))
        solved += pinik.solve(robot, target, "pinv", tolerance=(1e-4 * scale, 1e-3)).success
    assert solved == 20


def test_a_tool_is_a_part_of_the_chain():
    """A lance as a tool, and the same lance as a link, take the same sweeps."""
    lance = pinik.load(
        '<robot name="lance"><link name="a"/><link name="b"/><link name="c"/><link name="end"/>'
        '<joint name="one" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
        '<joint name="two" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0.4 0 0"/>'
        '<axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
        '<joint name="tip" type="fixed"><parent link="c"/><child link="end"/><origin xyz="1 0 0"/></joint></robot>'
    )
    rng = np.random.default_rng(5)
    for _ in range(10):
        there = lance.placement("end", lance.random(rng))
        as_link = pinik.solve(lance, Target("end", placement=there), "ccd", engine="python")
        as_tool = pinik.solve(lance, Target("c", placement=there, tool=[1, 0, 0]), "ccd", engine="python")
        assert as_link.success
        assert (as_tool.status, as_tool.iterations) == (as_link.status, as_link.iterations)
