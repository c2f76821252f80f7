"""`pinik.self_motion`: curves and surfaces of solutions, against closed forms, the judge, and kernels by numpy."""

from __future__ import annotations

import inspect
import itertools
import json
import math
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pinocchio
import pytest

import pinik
from judge import judge
from pinik import InputError, Target, UnknownNameError
from robots import load_quietly

EXACT = (1e-8, 1e-8)
TIP = "panda_hand_tcp"
TURN = 2.0 * math.pi


def assert_certified(robot, targets, q, limits=True):
    """By the judge: on the targets to 1e-8 m and rad, and inside the limits."""
    for one in q:
        assert judge(robot, targets, one).are_within(EXACT)
    if limits:
        assert (q >= robot.lower_q).all()
        assert (q <= robot.upper_q).all()


def polyline(points):
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


# --- an arm with spherical shoulder and wrist, like an iiwa, in closed form -------------------------------------------

UPPER, FORE, HAND, SHOULDER = 0.42, 0.4, 0.126, np.array([0.0, 0.0, 0.36])
SRS_LIMITS = np.deg2rad([170.0, 120.0, 170.0, 120.0, 170.0, 120.0, 175.0])


def srs_text():
    axes = ["0 0 1", "0 1 0"] * 3 + ["0 0 1"]
    offsets = [0.0, SHOULDER[2], 0.0, UPPER, 0.0, FORE, 0.0]
    parts = ['<robot name="srs"><link name="l0"/>']
    for k, (axis, offset, limit) in enumerate(zip(axes, offsets, SRS_LIMITS, strict=True), start=1):
        parts.append(
            f'<link name="l{k}"/><joint name="j{k}" type="revolute"><parent link="l{k - 1}"/><child link="l{k}"/>'
            f'<origin xyz="0 0 {offset}"/><axis xyz="{axis}"/>'
            f'<limit lower="{-limit}" upper="{limit}" effort="1" velocity="1"/></joint>'
        )
    parts.append(
        '<link name="tip"/><joint name="hand" type="fixed"><parent link="l7"/><child link="tip"/>'
        f'<origin xyz="0 0 {HAND}"/></joint></robot>'
    )
    return "".join(parts)


@pytest.fixture(scope="module")
def srs():
    return load_quietly(srs_text())


def rz(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def ry(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def srs_place(q):
    """(elbow, wrist, rotation of the hand) of the arm, as products of rotations."""
    upper = rz(q[0]) @ ry(q[1])
    fore = upper @ rz(q[2]) @ ry(q[3])
    elbow = SHOULDER + UPPER * upper[:, 2]
    return elbow, elbow + FORE * fore[:, 2], fore @ rz(q[4]) @ ry(q[5]) @ rz(q[6])


class ElbowCircle:
    """All configurations with the hand where it is at `q`, in closed form: the elbow goes round a circle."""

    def __init__(self, q):
        self.elbow, self.wrist, self.rotation = srs_place(q)
        line = self.wrist - SHOULDER
        distance = np.linalg.norm(line)
        self.normal = line / distance
        along = (UPPER**2 - FORE**2 + distance**2) / (2.0 * distance)
        self.centre = SHOULDER + along * self.normal
        self.radius = math.sqrt(UPPER**2 - along**2)
        self.across = (self.elbow - self.centre) / self.radius
        self.third = np.cross(self.normal, self.across)
        self.signs = [math.copysign(1.0, math.sin(q[k])) for k in (1, 3, 5)]
        self.bend = q[3]

    def configuration(self, swivel):
        """Joint angles (7,) in (−π, π] with the elbow turned by `swivel` from where it is at `q`."""
        shoulder, bend, wrist = self.signs
        elbow = self.centre + self.radius * (math.cos(swivel) * self.across + math.sin(swivel) * self.third)
        x, y, z = (elbow - SHOULDER) / UPPER
        q1, q2 = math.atan2(shoulder * y, shoulder * x), shoulder * math.acos(z)
        x, y, _ = (rz(q1) @ ry(q2)).T @ (self.wrist - elbow)
        q3 = math.atan2(bend * y, bend * x)
        left = (rz(q1) @ ry(q2) @ rz(q3) @ ry(self.bend)).T @ self.rotation
        q5 = math.atan2(wrist * left[1, 2], wrist * left[0, 2])
        q7 = math.atan2(wrist * left[2, 1], -wrist * left[2, 0])
        return np.array([q1, q2, q3, self.bend, q5, wrist * math.acos(left[2, 2]), q7])

    def whole(self, count):
        return np.array([self.configuration(swivel) for swivel in TURN * np.arange(count + 1) / count])


def random_srs(seed):
    return np.random.default_rng(seed).uniform(-0.9, 0.9, 7) * SRS_LIMITS


@pytest.mark.parametrize("seed", range(6))
def test_the_elbow_of_an_srs_arm_goes_once_round_its_circle(srs, seed):
    q = random_srs(seed)
    circle = ElbowCircle(q)
    motion = pinik.self_motion(srs, "tip", q, points=120, limits=False)
    assert motion.dimension == 1
    assert motion.closed
    assert motion.complete
    assert len(motion) == 120
    assert_certified(srs, Target("tip", placement=srs.placement("tip", q)), motion.q, limits=False)
    elbows = np.array([srs_place(one)[0] for one in motion.q]) - circle.centre
    assert np.allclose(np.linalg.norm(elbows, axis=1), circle.radius, atol=1e-8)
    assert np.allclose(elbows @ circle.normal, 0.0, atol=1e-8)
    swivels = np.unwrap(np.arctan2(elbows @ circle.third, elbows @ circle.across))
    steps = np.diff(np.append(swivels, swivels[0] + math.copysign(TURN, swivels[1] - swivels[0])))
    assert (np.sign(steps) == np.sign(steps[0])).all()
    assert abs(steps).sum() == pytest.approx(TURN, abs=1e-6)
    for one, swivel in zip(motion.q, swivels, strict=True):
        away = one - circle.configuration(swivel)
        assert np.allclose(away - TURN * np.round(away / TURN), 0.0, atol=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_length_and_turns_of_the_elbow_circle_are_those_of_the_closed_form(srs, seed):
    q = random_srs(seed)
    motion = srs.self_motion("tip", q, limits=False)
    whole = np.unwrap(ElbowCircle(q).whole(8_000), axis=0)
    assert motion.length == pytest.approx(polyline(whole), rel=1e-5)
    turns = np.round((whole[-1] - whole[0]) / TURN).astype(int)
    sign = (
        1
        if not turns.any()
        else (1 if motion.turns[f"j{np.flatnonzero(turns)[0] + 1}"] * turns[turns != 0][0] > 0 else -1)
    )
    assert motion.turns == {f"j{k + 1}": sign * int(n) for k, n in enumerate(turns) if n}


@pytest.mark.parametrize("seed", range(8))
def test_the_arcs_of_an_srs_arm_are_the_parts_of_its_circle_inside_the_limits(srs, seed):
    q = random_srs(seed)
    motion = pinik.self_motion(srs, "tip", q)
    count = 10_000
    whole = ElbowCircle(q).whole(count)
    inside = (np.abs(whole[:-1]) <= SRS_LIMITS).all(axis=1)
    assert inside[0]
    steps = np.diff(whole, axis=0)
    lengths = np.linalg.norm(steps - TURN * np.round(steps / TURN), axis=1)
    if inside.all():
        assert motion.closed
        return
    first = int(np.flatnonzero(~inside)[0])
    runs = [
        list(group)
        for is_in, group in itertools.groupby(np.roll(np.arange(count), -first), lambda k: inside[k])
        if is_in
    ]
    wanted = [float(lengths[run].sum()) for run in runs]
    own = next(k for k, run in enumerate(runs) if 0 in run)
    assert motion.length == pytest.approx(wanted[own], abs=2e-2)
    assert sorted(arc.length for arc in motion.arcs) == pytest.approx(sorted(wanted), abs=2e-2)
    for arc in motion.arcs:
        assert_certified(srs, Target("tip", placement=srs.placement("tip", q)), arc.q[::20])
        for end, at in zip(arc.ends, (arc.q[0], arc.q[-1]), strict=True):
            assert end.why == "limit"
            for name, side in end.limits.items():
                limit = SRS_LIMITS[int(name[1]) - 1]
                assert at[int(name[1]) - 1] == (limit if side == "upper" else -limit)


def test_another_branch_of_an_srs_arm_is_another_family(srs):
    q = random_srs(1)
    motion = pinik.self_motion(srs, "tip", q)
    circle = ElbowCircle(q)
    assert all(motion.contains(circle.configuration(swivel)) for swivel in np.linspace(0.0, TURN, 50))
    for k in (0, 2):  # the shoulder's and the wrist's other branch
        circle.signs[k] *= -1.0
        other = circle.configuration(0.7)
        assert judge(srs, Target("tip", placement=srs.placement("tip", q)), other).are_within((1e-6, 1e-6))
        assert not motion.contains(other)
        circle.signs[k] *= -1.0


def test_where_the_upper_arm_is_upright_the_shoulder_turns_against_it(srs):
    """Joints 1 and 3 are in line there: half a turn against each other leads to the other place with joint 2 at 0."""
    q = np.array([0.3, 0.0, 0.5, 1.0, 0.4, 0.7, 0.2])
    motion = pinik.self_motion(srs, "tip", q, limits=False)
    assert motion.dimension == 1
    assert motion.complete
    assert len(motion.arcs) == 4
    assert sorted(arc.length for arc in motion.arcs)[:2] == pytest.approx([math.sqrt(2.0) * math.pi] * 2, abs=1e-4)
    for turn in (0.4, -2.0, 3.0):
        assert motion.contains(q + turn * np.array([1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0]))
    for arc in motion.arcs:
        assert_certified(srs, Target("tip", placement=srs.placement("tip", q)), arc.q[::10], limits=False)
        assert all(end.why == "singular" for end in arc.ends)
        assert np.abs(arc.q[[0, -1], 1]).max() < 1e-4


@pytest.mark.parametrize("bend", [1e-2, 1e-4])
def test_an_arm_that_is_almost_stretched_turns_about_itself(srs, bend):
    q = np.array([0.3, 0.6, 0.5, bend, 0.4, 0.5, 0.2])
    motion = pinik.self_motion(srs, "tip", q, limits=False)
    assert motion.closed
    assert motion.length == pytest.approx(math.sqrt(2.0) * TURN, rel=1e-4)
    assert set(motion.turns) == {"j3", "j5"}


def test_an_arm_that_stays_stretched_turns_upper_arm_and_forearm_against_each_other(srs):
    """With joint 4 at 0, joints 3 and 5 are in line: the sum of their angles stays, and no other joint can move."""
    q = np.array([0.3, 0.6, 0.5, 0.0, 0.4, 0.5, 0.2])
    motion = pinik.self_motion(srs, "tip", q, limits=False)
    assert motion.dimension == 1
    assert motion.closed
    assert motion.length == pytest.approx(math.sqrt(2.0) * TURN, rel=1e-9)
    assert abs(motion.turns["j3"] + motion.turns["j5"]) == 0
    assert_certified(srs, Target("tip", placement=srs.placement("tip", q)), motion.q, limits=False)
    assert np.abs(motion.q[:, 2] + motion.q[:, 4] - 0.9).max() < 1e-7
    assert np.abs((motion.q - q)[:, [0, 1, 3, 5, 6]]).max() < 1e-7
    assert not motion.complete  # where other curves cross this one is not seen
    arcs = pinik.self_motion(srs, "tip", q).arcs
    # Joint 3 from 0.9 − 170° to 170°, joint 5 the other way; and both beyond, with a turn between them.
    assert arcs[0].length == pytest.approx(math.sqrt(2.0) * (2.0 * SRS_LIMITS[2] - 0.9))
    assert [end.limits for end in arcs[0].ends] in (
        [{"j3": "upper"}, {"j5": "upper"}],
        [{"j5": "upper"}, {"j3": "upper"}],
    )
    assert len(arcs) == 2
    assert arcs[1].length == pytest.approx(math.sqrt(2.0) * (2.0 * SRS_LIMITS[2] + 0.9 - TURN))


@pytest.mark.parametrize(("bent", "dimension"), [([], 3), ([3], 2), ([1, 5], 1), ([1, 3], 1), ([1, 3, 5], 1)])
def test_the_dimension_of_an_srs_arm_is_that_of_its_hinges_in_line(srs, bent, dimension):
    """Joints 1, 3, 5 and 7 are in line with the next one if the joint between is at 0: of k in line, k − 1 are free.

    Without the elbow's bend no other motion is left; with it, there is the elbow's circle.
    """
    q = np.array([0.3, 0.0, -0.2, 0.0, 0.5, 0.0, 0.4])
    q[bent] = 0.7
    assert pinik.self_motion(srs, "tip", q, points=20).dimension == dimension


def test_near_singular_places_a_family_has_each_of_its_arcs_once(srs):
    """One story, told by `self_motion` from a configuration and by the families of all answers."""
    for q in ([0.3, 0.5, 0.2, 0.0, 0.4, 0.6, 0.1], [0.3, 0.5, 0.2, 1e-4, 0.4, 0.6, 0.1]):
        motion = pinik.self_motion(srs, "tip", q)
        families = srs.solve_all("tip", placement=srs.placement("tip", q)).families
        # The shoulder and the wrist can each be bent to either side.
        assert len(families) == 4
        assert [len(family.arcs) for family in families] == [2, 2, 2, 2]
        (own,) = [family for family in families if family.contains(q)]
        assert sorted(arc.length for arc in own.arcs) == pytest.approx(
            sorted(arc.length for arc in motion.arcs), abs=1e-3
        )
        for family in families:
            sums = [angle for arc in family.arcs for angle in (arc.q[:, 2] + arc.q[:, 4]).tolist()]
            away = np.array(sums) - sums[0]
            assert np.abs(away - TURN * np.round(away / TURN)).max() < 1e-3


# --- planar arms, in closed form --------------------------------------------------------------------------------------


def planar(lengths, kind="revolute", limit=50.0):
    ends = [0.0, *lengths]
    parts = ['<robot name="planar"><link name="l0"/>']
    for k in range(1, len(lengths) + 1):
        parts.append(
            f'<link name="l{k}"/><joint name="j{k}" type="{kind}"><parent link="l{k - 1}"/><child link="l{k}"/>'
            f'<origin xyz="{ends[k - 1]} 0 0"/><axis xyz="0 0 1"/>'
            f'<limit lower="{-limit}" upper="{limit}" effort="1" velocity="1"/></joint>'
        )
    parts.append(
        f'<link name="tip"/><joint name="end" type="fixed"><parent link="l{len(lengths)}"/><child link="tip"/>'
        f'<origin xyz="{lengths[-1]} 0 0"/></joint></robot>'
    )
    return load_quietly("".join(parts))


def elbows(lengths, distance, first):
    """The two configurations of three links with the tip at (distance, 0) and the first joint given; NaN if none."""
    a, b, c = lengths
    x, y = distance - a * math.cos(first), -a * math.sin(first)
    cosine = (x * x + y * y - b * b - c * c) / (2.0 * b * c)
    both = []
    for sign in (1.0, -1.0):
        third = sign * math.acos(cosine) if abs(cosine) <= 1.0 else math.nan
        absolute = math.atan2(y, x) - math.atan2(c * math.sin(third), b + c * math.cos(third))
        both.append(np.array([first, absolute - first, third]))
    return both


@pytest.mark.parametrize("distance", [0.5, 0.9, 1.15, 1.25, 1.5, 2.0, 2.39])
def test_three_links_have_one_closed_curve_or_two_as_grashof_says(distance):
    lengths = (1.0, 0.8, 0.6)
    robot = planar(lengths)
    angles = np.linspace(0.0, TURN, 4000, endpoint=False)
    both = np.array([elbows(lengths, distance, angle) for angle in angles])  # (N, 2, 3)
    start = both[np.flatnonzero(~np.isnan(both[:, 0, 2]))[7], 0]
    motion = pinik.self_motion(robot, "tip", start, position=[distance, 0.0, 0.0], limits=False, points=300)
    assert motion.dimension == 1
    assert motion.closed
    assert_certified(robot, Target("tip", position=[distance, 0.0, 0.0]), motion.q, limits=False)
    # Grashof, the base being the fourth link: two curves, mirror images of each other, if the shortest and the longest
    # link are together shorter than the other two
    links = sorted((*lengths, distance))
    assert motion.contains(-start) is not (links[0] + links[3] < links[1] + links[2])
    if not np.isnan(both).any():  # the first joint turns round and round: the curve can be measured over its angle
        whole = np.unwrap(both[:, 0], axis=0)
        assert motion.length == pytest.approx(
            polyline(np.vstack((whole, whole[:1] + TURN * np.round((whole[-1] - whole[0]) / TURN)))), rel=1e-3
        )


def test_an_arm_of_continuous_joints_makes_the_same_motion():
    lengths, place = (1.0, 0.8, 0.6), [0.9, 0.0, 0.0]
    turning, hinged = planar(lengths, "continuous"), planar(lengths)
    start = elbows(lengths, 0.9, 1.0)[0]
    q = turning.configuration(dict(zip(turning.joint_names, start, strict=True)))
    free = pinik.self_motion(turning, "tip", q, position=place)
    other = pinik.self_motion(hinged, "tip", start, position=place, limits=False)
    assert free.closed
    assert free.length == pytest.approx(other.length, rel=1e-9)
    assert (
        {name: abs(n) for name, n in free.turns.items()}
        == {name: abs(n) for name, n in other.turns.items()}
        == {"j3": 1}
    )
    assert np.abs(np.diff(free.angles, axis=0)).max() < 0.2
    assert_certified(turning, Target("tip", position=place), free.q, limits=False)


def test_a_limit_of_many_turns_ends_an_arc_after_as_many():
    robot = planar((1.0, 0.8, 0.6), limit=TURN + 1.0)
    motion = pinik.self_motion(robot, "tip", [0.0, 0.0, 0.0], position=[2.4, 0.0, 0.0], points=5)
    assert motion.dimension == 0
    held = pinik.self_motion(robot, "l1", [0.5, 0.3, 0.0], position=[0.0, 0.0, 0.0], points=41)
    assert held.dimension == 1  # of the one joint that moves the frame, none of whose motion moves its origin
    assert held.length == pytest.approx(2.0 * (TURN + 1.0))
    assert held.angles[:, 0] == pytest.approx(np.linspace(*held.angles[[0, -1], 0], 41), abs=1e-9)
    assert sorted(held.angles[[0, -1], 0]) == pytest.approx([-TURN - 1.0, TURN + 1.0], abs=0.0)


def test_a_curve_that_only_touches_the_limits_leaves_one_configuration():
    """The third joint is bent most where the first one is at 0, and may not be bent less."""
    place, start = [2.0, 0.0, 0.0], elbows((1.0, 0.8, 0.6), 2.0, 0.0)[0]
    text = planar((1.0, 0.8, 0.6)).urdf
    assert start[2] == pytest.approx(math.pi / 2.0)
    head, joint, tail = text.partition('name="j3"')
    limits = f'lower="{float(start[2])!r}" upper="3.0"'
    robot = load_quietly(head + joint + tail.replace('lower="-50.0" upper="50.0"', limits, 1))
    motion = pinik.self_motion(robot, "tip", start, position=place)
    assert motion.dimension == 1
    assert len(motion) == 1
    assert motion.length == 0.0
    assert len(motion.arcs) == 1
    assert np.allclose(motion.q[0], start, atol=1e-9)
    assert motion.arcs[0].ends[0].limits == {"j3": "lower"}


def slides(limit):
    """Two slides in line, along x."""
    joints = (
        f'<joint name="s{k}" type="prismatic"><parent link="l{k - 1}"/><child link="l{k}"/><origin xyz="0.5 0 0"/>'
        f'<axis xyz="1 0 0"/><limit lower="{-limit}" upper="{limit}" effort="1" velocity="1"/></joint>'
        for k in (1, 2)
    )
    return load_quietly(f'<robot name="s"><link name="l0"/><link name="l1"/><link name="l2"/>{"".join(joints)}</robot>')


def test_a_curve_that_never_closes_is_given_up_and_its_arc_is_found_all_the_same():
    robot = slides(1.0)
    target = Target("l2", position=[1.3, 0.0, 0.0])
    motion = pinik.self_motion(robot, target, [0.2, 0.1], points=31)
    metres = pinik.Kinematics(robot, target).problem.size_of_chain
    assert motion.length == pytest.approx(1.7 * math.sqrt(2.0) / metres)
    assert not motion.complete
    assert not motion.closed
    assert np.allclose(sorted(motion.q[[0, -1]].tolist()), [[-0.7, 1.0], [1.0, -0.7]])
    assert sorted((end.why, *end.limits.items()) for end in motion.arcs[0].ends) == [
        ("limit", ("s1", "upper")),
        ("limit", ("s2", "upper")),
    ]
    free = pinik.self_motion(robot, target, [0.2, 0.1], limits=False)
    assert [end.why for end in free.arcs[0].ends] == ["long", "long"]
    assert str(free).count("given up") == 2
    assert free.turns == {}


def test_curves_that_cross_at_singular_places_are_one_family_cut_there():
    """A parallelogram can become an antiparallelogram where it is flat."""
    robot, place = planar((1.0, 0.8, 1.0)), [0.8, 0.0, 0.0]
    start = np.array([1.0, -1.0, -math.pi + 1.0])
    motion = pinik.self_motion(robot, "tip", start, position=place, limits=False)
    assert motion.complete
    assert len(motion.arcs) == 4
    assert motion.length == pytest.approx(math.sqrt(3.0) * math.pi, abs=1e-5)
    lengths = sorted(arc.length for arc in motion.arcs)
    assert lengths[:2] == pytest.approx([math.sqrt(3.0) * math.pi] * 2, abs=1e-5)
    assert lengths[2] == pytest.approx(lengths[3], abs=1e-5)
    for arc in motion.arcs:
        assert {end.why for end in arc.ends} == {"singular"}
        for end in (arc.q[0], arc.q[-1]):
            assert np.abs(np.sin(end)).max() < 1e-4  # flat
        assert_certified(robot, Target("tip", position=place), arc.q, limits=False)
    assert str(motion).count("a singular place") == 2
    assert repr(motion.arcs[0]).startswith("Arc(an arc of 5.44 rad from a singular place")
    for first in (0.3, 1.0, 2.0, -2.5):
        assert all(motion.contains(one) for one in elbows((1.0, 0.8, 1.0), 0.8, first))
    apart = pinik.self_motion(
        robot, "tip", elbows((1.0, 0.8, 1.0), 0.7, 1.0)[0], position=[0.7, 0.0, 0.0], limits=False
    )
    assert apart.closed
    assert not apart.contains(elbows((1.0, 0.8, 1.0), 0.7, 1.0)[1])


def test_it_starts_at_a_singular_place_too():
    robot, place = planar((1.0, 0.8, 1.0)), [0.8, 0.0, 0.0]
    motion, again = (
        pinik.self_motion(robot, "tip", [0.0, 0.0, math.pi], position=place, limits=False) for _ in range(2)
    )
    np.testing.assert_array_equal(again.q, motion.q)
    assert motion.dimension == 1
    assert sorted(arc.length for arc in motion.arcs)[:2] == pytest.approx([math.sqrt(3.0) * math.pi] * 2, abs=1e-5)
    assert motion.contains([0.0, 0.0, math.pi])
    assert motion.contains(elbows((1.0, 0.8, 1.0), 0.8, 1.0)[0])
    assert motion.contains(elbows((1.0, 0.8, 1.0), 0.8, 1.0)[1])


def test_metres_count_per_length_of_the_chain():
    """A slide along x with two links: the tip's height fixes all but one, and the slide follows."""
    text = (
        '<robot name="p"><link name="a"/><link name="b"/><joint name="s" type="prismatic"><parent link="a"/>'
        '<child link="b"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>'
        '<link name="c"/><joint name="u" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>'
        '<limit lower="-50" upper="50" effort="1" velocity="1"/></joint>'
        '<link name="d"/><joint name="v" type="revolute"><parent link="c"/><child link="d"/><origin xyz="0.5 0 0"/>'
        '<axis xyz="0 0 1"/><limit lower="-50" upper="50" effort="1" velocity="1"/></joint>'
        '<link name="tip"/><joint name="t" type="fixed"><parent link="d"/><child link="tip"/>'
        '<origin xyz="0.9 0 0"/></joint></robot>'
    )
    robot = load_quietly(text)
    target = Target("tip", position=[0.2, 0.3, None])

    def configuration(first):
        second = math.asin((0.3 - 0.5 * math.sin(first)) / 0.9)
        return [0.2 - 0.5 * math.cos(first) - 0.9 * math.cos(second), first, second - first]

    whole = np.array([configuration(first) for first in np.linspace(0.0, TURN, 5000, endpoint=False)])
    robot_length = pinik.Kinematics(robot, target).problem.size_of_chain
    motion = pinik.self_motion(robot, target, whole[0], limits=False, points=400)
    assert motion.closed
    assert set(motion.turns) == {"u", "v"}
    closed = np.vstack((whole, configuration(TURN)))
    assert motion.length == pytest.approx(polyline(closed / [robot_length, 1.0, 1.0]), rel=1e-5)
    steps = np.linalg.norm(np.diff(motion.q, axis=0) / [robot_length, 1.0, 1.0], axis=1)
    assert steps.max() / steps.min() < 1.001


# --- the Panda, by the judge and numpy --------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(8))
def test_the_pandas_curve_is_exact_even_and_ends_where_it_says(panda, seed):
    q = panda.random(seed)
    motion = panda.self_motion(TIP, q, points=150)
    target = Target(TIP, placement=panda.placement(TIP, q))
    assert motion.dimension == 1
    assert motion.complete
    assert motion.contains(q)
    for arc in motion.arcs:
        assert_certified(panda, target, arc.q)
        assert len(arc) == 150
        steps = np.linalg.norm(np.diff(arc.q, axis=0), axis=1)
        assert steps.max() <= arc.length / 149 * (1.0 + 1e-3)
        assert steps.sum() == pytest.approx(arc.length, rel=2e-3)
        tangents = (arc.q[2:] - arc.q[:-2])[:, :7]
        for k in range(0, 148, 7):
            kernel = np.linalg.svd(panda.jacobian(TIP, arc.q[k + 1])[:, :7])[2][-1]
            assert abs(kernel @ tangents[k]) >= (1.0 - 5e-3) * np.linalg.norm(tangents[k])
        for end, at, inner in zip(arc.ends, (arc.q[0], arc.q[-1]), (arc.q[1], arc.q[-2]), strict=True):
            for name, side in end.limits.items():
                k = panda.joint(name).idx_q
                assert at[k] == (panda.upper_q if side == "upper" else panda.lower_q)[k]
                assert (at[k] - inner[k]) * (1 if side == "upper" else -1) > 0.0  # further on it would be outside
        assert str(arc).count("limit") == 2
    assert motion.position_error.max() <= 1e-8
    assert motion.orientation_error.max() <= 1e-8
    own = motion.arcs[0]
    assert np.array_equal(motion.q, own.q)
    assert np.linalg.norm(own.q - q, axis=1).min() <= own.length / 149  # it leads through q


def test_the_same_arcs_are_found_from_any_point_of_them(panda):
    q = panda.random(9)
    motion = panda.self_motion(TIP, q)
    target = Target(TIP, placement=panda.placement(TIP, q))
    lengths = sorted(arc.length for arc in motion.arcs)
    assert len(lengths) > 1
    for arc in motion.arcs:
        again = panda.self_motion(target, arc.q[60])
        assert again.length == pytest.approx(arc.length, abs=1e-4)
        assert sorted(other.length for other in again.arcs) == pytest.approx(lengths, abs=1e-4)
        assert again.contains(q)


def test_a_locked_joint_takes_the_freedom_away(panda):
    q = panda.random(3)
    motion = panda.self_motion(TIP, q, locked=["panda_joint3"])
    assert motion.dimension == 0
    assert len(motion) == 1
    assert not motion.closed
    assert np.allclose(motion.q, q, atol=1e-9)
    assert "isolated" in str(motion)
    assert motion.contains(q)
    assert not motion.contains(panda.random(4))


def test_a_solution_that_is_only_within_tolerance_is_made_exact(panda):
    solution = panda.solve(TIP, position=[0.4, 0.1, 0.5], rpy=[math.pi, 0.0, 0.3], polish=False)
    target = Target(TIP, position=[0.4, 0.1, 0.5], rpy=[math.pi, 0.0, 0.3])
    motion = pinik.self_motion(panda, target, solution)
    assert not judge(panda, target, solution.q).are_within(EXACT)
    assert_certified(panda, target, motion.q)
    again = pinik.self_motion(panda, TIP, solution.angles, position=[0.4, 0.1, 0.5], rpy=[math.pi, 0.0, 0.3])
    assert np.allclose(again.q, motion.q, atol=1e-6)


# --- other dimensions -------------------------------------------------------------------------------------------------


def test_a_six_joint_arm_is_isolated_unless_its_wrist_is_stretched(ur5):
    q = np.array([0.1, -1.0, 1.0, 0.3, 0.5, 0.4])
    assert pinik.self_motion(ur5, "tool0", q).dimension == 0
    q[4] = 0.0  # four parallel axes
    motion = pinik.self_motion(ur5, "tool0", q)
    assert motion.dimension == 1
    assert motion.length > 1.0
    assert np.abs(motion.q[:, 4]).max() < 1e-6
    assert_certified(ur5, Target("tool0", placement=ur5.placement("tool0", q)), motion.q)


def test_the_whole_turns_of_an_arc_are_those_of_its_start():
    """Wrists 1 and 3 turn against each other; from 0 they meet their limits of ±360° together, a turn each way."""
    robot = load_quietly("ur5")
    q = np.array([0.0, -1.0, 1.0, 0.0, 0.0, 0.0])
    whole = pinik.self_motion(robot, "tool0", q, limits=False)
    assert {name: abs(count) for name, count in whole.turns.items()} == {"wrist_1_joint": 1, "wrist_3_joint": 1}
    for start in (q, whole.q[3], whole.q[-3]):
        (arc,) = pinik.self_motion(robot, "tool0", start).arcs
        assert arc.length == pytest.approx(2.0 * whole.length, rel=1e-6)
        assert sorted(abs(arc.q[[0, -1], 3])) == pytest.approx([TURN, TURN], abs=1e-6)


def test_a_free_spin_between_limits_of_a_turn_each_way_is_two_turns_long(ur5):
    q = np.array([0.1, -1.0, 1.0, 0.3, 0.5, 0.4])
    place = ur5.placement("tool0", q)
    target = Target("tool0", position=place.translation, axis="z", direction=place.rotation[:, 2])
    motion = pinik.self_motion(ur5, target, q, points=33)
    assert motion.dimension == 1
    assert motion.length == pytest.approx(2.0 * TURN)
    assert motion.turns in ({"wrist_3_joint": 1}, {"wrist_3_joint": -1})
    assert np.abs(motion.q[:, :5] - q[:5]).max() < 1e-8
    assert motion.angles.shape == (33, 6)


def test_a_surface_is_covered_as_far_as_the_gap_says():
    """Four links in a plane: other answers, found by solving, lie no farther from the nearest one than the gap."""
    robot = planar((0.7, 0.6, 0.5, 0.4), limit=2.5)
    target = Target("tip", position=[0.9, 0.4, 0.0])
    start = robot.solve(target, q0=[0.2, 0.3, 0.4, 0.5])
    motion = pinik.self_motion(robot, target, start, points=150)
    assert motion.dimension == 2
    assert not motion.complete
    assert motion.arcs == ()
    assert len(motion) == 150
    assert_certified(robot, target, motion.q)
    apart = np.linalg.norm(motion.q[:, np.newaxis] - motion.q, axis=2) + 9.0 * np.eye(150)
    assert apart.min() > 0.3 * motion.gap
    rng = np.random.default_rng(5)
    others = [robot.solve(target, q0=robot.random(rng), restarts=0) for _ in range(150)]
    others = [other.q for other in others if other]
    assert len(others) > 50
    away = [np.linalg.norm(motion.q - other, axis=1).min() for other in others]
    assert np.mean(np.array(away) <= 2.0 * motion.gap) > 0.95
    assert np.mean([motion.contains(other) for other in others]) > 0.8
    assert not motion.contains([0.2, 0.3, 0.4, 0.5])  # it misses the target
    again = pinik.self_motion(robot, target, start, points=150)
    assert np.array_equal(again.q, motion.q)


@pytest.mark.parametrize("seed", [1, 3])
def test_a_spinning_hand_is_spread_over_the_pandas_arc_and_all_its_spins(panda, seed):
    """The hand's axis is that of the last joint, so that the set is the arc for one spin, times the joint's range."""
    q = panda.random(seed)
    place = panda.placement(TIP, q)
    target = Target(TIP, position=place.translation, axis="z", direction=place.rotation[:, 2])
    motion = panda.self_motion(target, q)
    assert motion.dimension == 2
    assert_certified(panda, target, motion.q)
    others = panda.self_motion(TIP, q).q[::8]
    others[:, 6] = np.random.default_rng(seed).uniform(panda.lower[6], panda.upper[6], len(others))
    assert_certified(panda, target, others)
    assert all(motion.contains(other) for other in others)
    away = np.array([np.linalg.norm(motion.q - other, axis=1).min() for other in others])
    assert away.max() <= 2.0 * motion.gap


def test_a_joint_that_follows_another_is_no_freedom():
    text = planar((0.7, 0.6, 0.5, 0.4)).urdf
    tag = 'name="j4" type="revolute">'
    robot = load_quietly(text.replace(tag, f'{tag}<mimic joint="j3" multiplier="-0.5"/>'))
    q = robot.configuration({"j1": 0.4, "j2": 0.9, "j3": -0.8})
    target = Target("tip", position=robot.placement("tip", q).translation)
    motion = pinik.self_motion(robot, target, q, limits=False)
    assert motion.dimension == 1
    assert_certified(robot, target, motion.q, limits=False)


def test_a_joint_whose_limits_leave_one_value_is_no_freedom():
    text = planar((1.0, 0.8, 0.6)).urdf
    robot = load_quietly(text.replace('upper="50.0"', 'upper="-50.0"', 1))
    q = robot.configuration({"j1": -50.0, "j2": 0.9, "j3": -0.8})
    target = Target("tip", position=robot.placement("tip", q).translation)
    assert pinik.self_motion(robot, target, q).dimension == 0
    assert pinik.self_motion(robot, target, q, limits=False).dimension == 1


def test_several_targets_leave_what_they_leave():
    robot = planar((0.7, 0.6, 0.5, 0.4), limit=2.5)
    q = np.array([0.4, 0.9, -0.8, 0.6])
    elbow, tip = (Target(frame, position=robot.placement(frame, q).translation) for frame in ("l3", "tip"))
    assert pinik.self_motion(robot, [elbow, tip], q).dimension == 0
    alone = pinik.self_motion(robot, elbow, q)
    assert alone.dimension == 1  # the last joint that moves the frame turns it about its origin
    assert alone.length == pytest.approx(5.0)
    half = Target("l3", position=[float(elbow.position[0]), None, None])
    motion = pinik.self_motion(robot, [half, tip], q)
    assert motion.dimension == 1
    assert_certified(robot, [half, tip], motion.q)


# --- use --------------------------------------------------------------------------------------------------------------


def test_what_does_not_reach_the_targets_is_refused(panda):
    q = panda.random(1)
    with pytest.raises(InputError, match=r"misses them by .* m"):
        pinik.self_motion(panda, TIP, q, position=[0.4, 0.0, 0.5])
    outside = q.copy()
    outside[3] = 0.5
    with pytest.raises(InputError, match="inside the limits"):
        pinik.self_motion(panda, Target(TIP, placement=panda.placement(TIP, outside)), outside)
    assert pinik.self_motion(panda, Target(TIP, placement=panda.placement(TIP, outside)), outside, limits=False).closed
    outside[1] = -2.0
    with pytest.raises(InputError) as caught:
        pinik.self_motion(panda, TIP, outside)
    assert "panda_joint2 at -2 is beyond its lower limit of -1.763 rad" in str(caught.value)
    assert "panda_joint4 at 0.5 is beyond its upper limit of -0.0698 rad" in str(caught.value)
    assert "panda_joint1" not in str(caught.value)


def test_a_hinge_a_whole_turn_beyond_its_limit_is_not_blamed():
    robot = load_quietly("ur5")
    q = np.array([0.3, -1.0, 1.2, 0.4, 0.6, 0.5])
    turned = q + np.array([2.0 * TURN, 0, 0, 0, 0, 0])
    assert pinik.self_motion(robot, "tool0", turned).start == pytest.approx(q)
    with pytest.raises(InputError) as caught:
        pinik.self_motion(robot, "tool0", turned, position=[0.1, 0.2, 0.3])
    assert "beyond" not in str(caught.value)


def test_misuse_is_named(panda):
    q = panda.random(1)
    with pytest.raises(UnknownNameError, match="frame"):
        pinik.self_motion(panda, "nose", q)
    with pytest.raises(UnknownNameError, match="joint"):
        pinik.self_motion(panda, TIP, q, locked=["nose"])
    with pytest.raises(InputError, match="points"):
        pinik.self_motion(panda, TIP, q, points=1)
    with pytest.raises(InputError, match="q must be"):
        pinik.self_motion(panda, TIP, None)
    with pytest.raises(InputError, match=r"^q must be .* got 'nearest'"):
        pinik.self_motion(panda, TIP, "nearest")
    with pytest.raises(InputError, match=r"^q must be 8 finite numbers"):
        pinik.self_motion(panda, TIP, np.full(8, np.nan))
    with pytest.raises(InputError, match=r"^q must be within"):
        pinik.self_motion(panda, TIP, np.full(8, 1e20))
    with pytest.raises(InputError, match="robot must be"):
        pinik.self_motion("panda", TIP, q)
    with pytest.raises(InputError, match="within"):
        pinik.self_motion(panda, TIP, q).contains(q, within=0.0)


def test_the_robots_method_takes_what_the_function_takes():
    method = list(inspect.signature(pinik.Robot.self_motion).parameters.values())[1:]
    function = list(inspect.signature(pinik.self_motion).parameters.values())[1:]
    assert [(p.name, p.kind, p.default) for p in method] == [(p.name, p.kind, p.default) for p in function]


def test_its_arcs_can_be_read_from_many_threads(panda):
    q = panda.random(9)
    wanted = [arc.q for arc in panda.self_motion(TIP, q, points=60).arcs]
    motion = panda.self_motion(TIP, q, points=60)
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda k: motion.arcs[k % len(wanted)].q, range(8 * len(wanted))))
    assert all(np.array_equal(one, wanted[k % len(wanted)]) for k, one in enumerate(found))


def test_it_survives_a_pickle(panda):
    motion = panda.self_motion(TIP, panda.random(2), points=20)
    copy = pickle.loads(pickle.dumps(motion))
    assert str(copy) == str(motion)
    assert np.array_equal(copy.q, motion.q)
    assert copy.contains(motion.q[3])


def test_the_dictionary_has_arcs_on_the_target_with_their_ends_at_the_limits(panda):
    """Checked by plain Pinocchio, the URDF's limits and the sum of chords; the text is plain JSON."""
    default = panda.poses["default"]
    motion = panda.self_motion(TIP, default)
    told = json.loads(json.dumps(motion.to_dict(), allow_nan=False))
    assert (told["schema"], told["robot"], told["dimension"], told["complete"]) == (1, "panda", 1, True)
    assert told["message"] == str(motion)
    assert (told["angles"], told["gap"], told["turns"]) == ([], None, motion.turns)
    names, (arc,) = told["joint_names"], told["arcs"]
    data, wanted = panda.model.createData(), panda.placement(TIP, default)
    rows = [panda.configuration(dict(zip(names, row, strict=True))) for row in arc["angles"]]
    for q in rows:
        pinocchio.framesForwardKinematics(panda.model, data, q)
        there = data.oMf[panda.model.getFrameId(TIP)]
        assert there.isApprox(wanted, 1e-7)
    assert polyline(np.array(arc["angles"])) == pytest.approx(arc["length"], rel=1e-3)
    assert not arc["closed"]
    for row, end in zip((arc["angles"][0], arc["angles"][-1]), arc["ends"], strict=True):
        (name,) = end["limits"]
        side = {"lower": panda.lower_q, "upper": panda.upper_q}[end["limits"][name]]
        assert end["why"] == "limit"
        assert row[names.index(name)] == pytest.approx(side[panda.joint(name).idx_q], abs=1e-9)


def test_the_dictionary_of_more_dimensions_has_configurations_and_no_arcs(panda):
    default = panda.poses["default"]
    place = panda.placement(TIP, default).translation
    motion = panda.self_motion(TIP, default, position=place, points=20)
    told = motion.to_dict()
    assert (told["dimension"], told["complete"], told["arcs"], len(told["angles"])) == (4, False, [], 20)
    assert told["gap"] > 0.0
    for row in told["angles"]:
        q = panda.configuration(dict(zip(told["joint_names"], row, strict=True)))
        assert np.linalg.norm(panda.placement(TIP, q).translation - place) < 1e-7


@pytest.mark.parametrize("q", [[0.0] * 6, [0.1, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1e-6, 0.0, 0.0, 0.0, 0.0]])
def test_a_limit_at_the_seam_of_a_closed_curve_is_no_obstacle(q):
    """The stretched ur5 turns about its parallel wrist axes; the curve begins where a joint passes a limit."""
    robot = load_quietly("ur5")
    target = Target("tool0", placement=robot.placement("tool0", q))
    motion = robot.self_motion([target], q)
    assert motion.dimension == 1
    assert len(motion) > 10
    assert_certified(robot, [target], motion.q[::10])
