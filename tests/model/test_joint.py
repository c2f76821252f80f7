from __future__ import annotations

import math

import numpy as np
import pytest

from by_hand import ZOO, axis, limit, mimic
from pinik import InputError
from robots import load_quietly
from urdf_texts import joint, link, robot


def pair(multiplier: float, offset: float, kind: str = "revolute") -> str:
    """A hinge "lead", and "tail" that follows it; "beside" does not."""
    return robot(
        *map(link, ("base", "one", "two", "three")),
        joint("beside", "base", "one", axis(0, 0, 1)),
        joint("lead", "one", "two", axis(0, 0, 1), kind=kind, limit=limit(-3, 3) if kind == "revolute" else ""),
        joint("tail", "two", "three", axis(0, 0, 1), mimic("lead", multiplier, offset), limit=limit(-9, 9)),
    )


class TestSetAngle:
    @pytest.mark.parametrize("kind", ["revolute", "continuous"])
    def test_of_a_follower_puts_the_leader_where_the_follower_gets_its_angle(self, kind):
        """2 · 0.2 + 0.1 = 0.5."""
        loaded = load_quietly(pair(2.0, 0.1, kind))
        q = loaded.configuration({"beside": 0.7})
        loaded.joint("tail").set_angle(q, 0.5)
        assert q == pytest.approx([0.7, 0.2])
        assert loaded.angles(q) == pytest.approx({"beside": 0.7, "lead": 0.2, "tail": 0.5})

    @pytest.mark.parametrize("multiplier", [0.0, -0.0, 1e-320])
    def test_of_a_follower_that_its_leader_does_not_move_is_refused(self, multiplier):
        loaded = load_quietly(pair(multiplier, 0.3))
        q = loaded.neutral()
        with pytest.raises(InputError, match=r"'tail' cannot be set: it mimics 'lead' .* stays at 0\.3"):
            loaded.joint("tail").set_angle(q, 0.5)
        np.testing.assert_array_equal(q, loaded.neutral())


class TestAngleRange:
    @pytest.mark.parametrize(
        ("multiplier", "offset", "entry", "expected"),
        [
            (2.0, 0.1, (-1.0, 3.0), (-1.9, 6.1)),
            (-2.0, 0.1, (-1.0, 3.0), (-5.9, 2.1)),
            (0.0, 0.3, (-1.0, 3.0), (0.3, 0.3)),
            (0.0, 0.3, (-math.inf, math.inf), (0.3, 0.3)),
            (-0.5, 0.3, (-math.inf, 2.0), (-0.7, math.inf)),
        ],
    )
    def test_of_a_follower_is_its_leaders_seen_through_the_multiplier(self, multiplier, offset, entry, expected):
        tail = load_quietly(pair(multiplier, offset)).joint("tail")
        assert tail.angle_range(*entry) == pytest.approx(expected)

    def test_of_other_joints_is_that_of_their_entry(self):
        for name in ("k_turn", "l_hinge", "m_slide"):
            assert load_quietly(ZOO).joint(name).angle_range(-0.1, math.inf) == (-0.1, math.inf)
