from __future__ import annotations

import cmath

import pytest

from pinik.studies.chain import TIP, length_of, planar_chain


@pytest.mark.parametrize(("joints", "length"), [(2, 1.0), (7, 1.0), (7, 2.5), (30, 1.0)])
def test_its_tip_is_where_complex_numbers_put_it(joints, length):
    chain = planar_chain(joints, length)
    q = chain.random(3)
    turned, tip = 1.0 + 0.0j, 0.0j
    for angle in q:
        turned *= cmath.exp(1j * angle)
        tip += turned * length / joints
    assert chain.placement(TIP, q).translation == pytest.approx([tip.real, tip.imag, 0.0], abs=1e-12)
    assert length_of(chain) == pytest.approx(length)
    assert chain.joint_names == tuple(f"joint{number}" for number in range(1, joints + 1))
