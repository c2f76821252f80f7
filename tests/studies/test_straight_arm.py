from __future__ import annotations

import numpy as np
import pytest

import pinik
from pinik.studies.chain import TIP, planar_chain
from pinik.studies.straight_arm import pull_inwards


@pytest.mark.parametrize("joints", [3, 7])
def test_jacobian_methods_stay_and_ccd_does_unless_the_target_is_on_the_last_bone(joints):
    """Welman, fig. 4.2; between the last joint and the tip CCD is stuck as well."""
    chain = planar_chain(joints)
    jacobian = chain.jacobian(TIP, chain.neutral())[:3]
    pulls = pull_inwards(chain, {name: solver() for name, solver in pinik.SOLVERS.items()})
    halfway, last = pulls[:4], pulls[4:]
    for pull in pulls:
        pulled = np.array([pull.place - 1.0, 0.0, 0.0])
        assert np.abs(jacobian.T @ pulled).max() < 1e-12
        assert pull.restarted.success
        wanted = [pull.place, 0.0, 0.0]
        assert chain.placement(TIP, pull.restarted.q).translation == pytest.approx(wanted, abs=1e-4)
    assert {pull.method: pull.alone.success for pull in halfway} == {
        "ccd": True,
        "jt": False,
        "pinv": False,
        "dls": False,
    }
    assert not any(pull.alone.success for pull in last)
    for pull in (*halfway[1:], *last):
        assert np.abs(pull.alone.q).max() < 1e-6, "it did not stay straight"
        assert pull.alone.position_error == pytest.approx(1.0 - pull.place, abs=1e-9)
    assert last[0].place > 1.0 - 1.0 / joints
