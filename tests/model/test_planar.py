"""Planar joints move in the plane across the axis that the file names, and everything else stays where it is."""

from __future__ import annotations

import math
import pickle
import warnings

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import axis, homogeneous, joint_axes, limit, link_placements, origin, random_placement, rotation_about
from pinik.errors import InputError
from urdf_texts import joint, link, robot

INERTIA = (
    '<inertial><origin xyz="0.1 0.2 0.3"/><mass value="2"/>'
    '<inertia ixx="1" ixy="0.1" ixz="0.2" iyy="2" iyz="0.3" izz="2.5"/></inertial>'
)
AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1), (-1, 0, 0), (1, 2, -3), (1e-9, 0, -1)]


def cart(*plane: str, kind: str = "planar") -> str:
    """field ═ cart ─ mast, with a lamp fixed to the cart."""
    return robot(
        link("field"), link("cart", INERTIA), link("mast", INERTIA), link("lamp", INERTIA),
        joint("drive", "field", "cart", origin((0.3, -0.1, 0.5), (0.2, 0.4, -0.6)), *plane, kind=kind, limit=""),
        joint("lamp_joint", "cart", "lamp", origin((0, 0.2, 0.1), (0.3, 0, 0)), kind="fixed", limit=""),
        joint("lift", "cart", "mast", origin((0.1, 0, 0), (0, 0.5, 0)), axis(0, 1, 1), limit=limit(-1, 1)),
    )  # fmt: skip


@pytest.mark.parametrize("normal", AXES)
def test_links_and_joint_frames_are_where_matrices_by_hand_put_them(normal):
    text = cart(axis(*normal))
    loaded = pinik.load(text)
    rng = np.random.default_rng(1)
    for place in (np.eye(4), random_placement(rng, "planar", joint_axes(text)["drive"])):
        q = loaded.configuration({"lift": 0.7}, {"drive": place})
        expected = link_placements(text, {"lift": 0.7}, {"drive": place})
        for name, placement in expected.items():
            np.testing.assert_allclose(loaded.placement(name, q).homogeneous, placement, atol=1e-12)
        np.testing.assert_allclose(loaded.placement("drive", q).homogeneous, expected["cart"], atol=1e-12)
        np.testing.assert_allclose(loaded.joint_placements(q)["drive"].homogeneous, place, atol=1e-12)


@pytest.mark.parametrize("normal", AXES)
def test_every_configuration_lies_in_the_plane_and_turns_about_the_axis(normal):
    text = cart(axis(*normal))
    loaded, across = pinik.load(text), joint_axes(text)["drive"]
    for seed in range(5):
        q = loaded.random(seed)
        place = loaded.joint_placements(q)["drive"]
        assert place.translation @ across == pytest.approx(0.0, abs=1e-9)
        np.testing.assert_allclose(place.rotation @ across, across, atol=1e-9)
        assert np.linalg.norm(place.translation) > 1e-3
        again = loaded.configuration(loaded.angles(q), loaded.joint_placements(q))
        np.testing.assert_allclose(again, q, atol=1e-9)


def test_without_an_axis_it_is_x_as_urdf_says_with_a_warning():
    with pytest.warns(pinik.UrdfWarning, match="drive.*no <axis>, for which URDF's default is x"):
        loaded = pinik.load(cart())
    turned = homogeneous(rotation_about(np.array([1.0, 0, 0]), 0.5), (0, 0.2, 0.3))
    q = loaded.configuration({}, {"drive": turned})
    np.testing.assert_allclose(
        loaded.placement("cart", q).homogeneous, link_placements(cart(), {}, {"drive": turned})["cart"], atol=1e-12
    )


@pytest.mark.parametrize("out", [homogeneous(np.eye(3), (0.1, 0, 0)), homogeneous(np.diag([1.0, -1, -1]), (0, 0, 0))])
def test_a_placement_outside_the_plane_is_refused_with_the_axis(out):
    loaded = pinik.load(cart(axis(1, 1, 0)))
    with pytest.raises(
        InputError, match=r"planar joint 'drive' moves only in its plane across \(0.707107, 0.707107, 0"
    ):
        loaded.configuration({}, {"drive": out})


@pytest.mark.parametrize("normal", AXES)
def test_masses_stay_where_they_were(normal):
    """The inertia of cart and lamp about the field, against that of the same robot with a fixed joint."""
    moving, fixed = pinik.load(cart(axis(*normal))), pinik.load(cart(kind="fixed"))
    still = fixed.model.inertias[0]
    assert still.mass > 0.0
    carried = moving.model.jointPlacements[1].act(moving.model.inertias[1])
    np.testing.assert_allclose(carried.lever, still.lever, atol=1e-12)
    np.testing.assert_allclose(carried.inertia, still.inertia, atol=1e-12)


@pytest.mark.parametrize("engine", ["python", "native"])
@pytest.mark.parametrize("normal", [(1, 0, 0), (1, 2, -3)])
def test_a_solve_reaches_a_place_across_the_axis_in_both_engines(normal, engine):
    text = cart(axis(*normal))
    loaded = pinik.load(text)
    place = random_placement(np.random.default_rng(3), "planar", joint_axes(text)["drive"])
    goal = link_placements(text, {"lift": 0.4}, {"drive": place})["mast"]
    found = loaded.solve("mast", placement=goal, engine=engine)
    assert found.success
    by_hand = link_placements(text, found.angles, {n: m.homogeneous for n, m in found.joint_placements.items()})["mast"]
    assert np.linalg.norm(by_hand[:3, 3] - goal[:3, 3]) <= 1e-4
    turn = by_hand[:3, :3].T @ goal[:3, :3]
    assert math.acos(min(1.0, (np.trace(turn) - 1.0) / 2.0)) <= 1e-3


def test_jacobians_are_the_derivatives_of_placements():
    loaded = pinik.load(cart(axis(1, 2, -3)))
    q = loaded.random(5)
    J = loaded.jacobian("mast", q)
    step = 1e-6
    for k in range(loaded.model.nv):
        ahead, behind = (
            loaded.placement("mast", pinocchio.integrate(loaded.model, q, np.eye(loaded.model.nv)[k] * h))
            for h in (step, -step)
        )
        np.testing.assert_allclose((ahead.translation - behind.translation) / (2 * step), J[:3, k], atol=1e-7)
        turn = pinocchio.log3(ahead.rotation @ behind.rotation.T) / (2 * step)
        np.testing.assert_allclose(turn, J[3:, k], atol=1e-7)


def test_a_pickled_robot_and_one_with_another_root_keep_the_plane():
    text = cart(axis(0, 1, 0))
    loaded = pinik.load(text)
    place = homogeneous(rotation_about(np.array([0.0, 1, 0]), 0.3), (0.1, 0, 0.4))
    expected = link_placements(text, {}, {"drive": place})["mast"]
    for other in (pickle.loads(pickle.dumps(loaded)), loaded.with_root("planar")):
        q = other.configuration({}, {"drive": place})
        np.testing.assert_allclose(other.placement("mast", q).homogeneous, expected, atol=1e-12)


def test_a_floating_joint_says_that_it_ignores_its_limits():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        pinik.load(robot(link("a"), link("b"), joint("j", "a", "b", kind="floating")))
    assert [str(w.message) for w in caught] == [
        "r: joint 'j': a floating joint has no limits here; its <limit> is ignored (line 1)"
    ]
