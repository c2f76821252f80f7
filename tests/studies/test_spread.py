from __future__ import annotations

import numpy as np
import pytest

import pinik
from pinik.studies.accuracy import Problem
from pinik.studies.chain import TIP, planar_chain
from pinik.studies.spread import drags, firmer_towards_the_tip, spread

CHAIN = planar_chain()
DRAGS = drags(CHAIN, 40)


def test_drags_move_the_tip_a_fifth_of_the_length_and_stay_within_reach():
    assert len(DRAGS) == 40
    for problem in DRAGS:
        tip = CHAIN.placement(TIP, problem.start).translation
        assert np.linalg.norm(problem.place - tip) == pytest.approx(0.2)
        assert np.linalg.norm(problem.place) <= 0.9


def test_shares_of_a_motion_that_is_known():
    """A chain of two: the target is a turn of the last joint alone, which CCD tries first."""
    two = planar_chain(2)
    start = np.array([0.2, 0.3])
    place = two.placement(TIP, np.array([0.2, 0.9])).translation
    own = spread(two, pinik.CCD(), [Problem("drag", start, place)], {})
    assert own.shares == pytest.approx([0.0, 1.0], abs=1e-6)
    assert own.moving_joints == pytest.approx(1.0, abs=1e-6)
    assert own.turned == pytest.approx(0.6, abs=1e-3)


def test_ccd_prefers_distal_joints_the_transpose_spreads_and_weights_counter_it():
    """Welman, §4.3."""
    firm = firmer_towards_the_tip(CHAIN)
    assert list(firm) == list(CHAIN.joint_names)
    assert (firm["joint1"], firm["joint7"]) == pytest.approx((1.0, 0.1))
    ccd, jt = spread(CHAIN, pinik.CCD(), DRAGS, {}), spread(CHAIN, pinik.JacobianTranspose(), DRAGS, {})
    assert ccd.shares[-3:].sum() > 2.0 * ccd.shares[:3].sum()
    assert ccd.moving_joints < jt.moving_joints - 1.0
    for method in pinik.SOLVERS.values():
        free, weighted = spread(CHAIN, method(), DRAGS, {}), spread(CHAIN, method(), DRAGS, firm)
        assert free.solved == weighted.solved == 1.0
        assert sum(weighted.shares) == pytest.approx(1.0)
        assert weighted.shares[-3:].sum() < free.shares[-3:].sum()
    assert spread(CHAIN, pinik.CCD(), DRAGS, firm).moving_joints > ccd.moving_joints
