from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from by_hand import axis, chains, limit, mimic
from pinik import InputError
from robots import load_quietly
from urdf_texts import joint, link, robot

WITH_MIMICS = [name for name in pinik.catalog() if name != "ur3_empty" and load_quietly(name).mimics]

# b = 2 a + 0.1, c = −0.5 a, d stays at 0.3.
FOLLOWERS = robot(
    *map(link, ("base", "one", "two", "three", "four")),
    joint("a", "base", "one", axis(0, 0, 1), limit=limit(-2, 2)),
    joint("b", "one", "two", axis(0, 0, 1), mimic("a", 2.0, 0.1), limit=limit(-9, 9)),
    joint("c", "two", "three", axis(0, 0, 1), mimic("a", -0.5), kind="prismatic", limit=limit(-9, 9)),
    joint("d", "three", "four", axis(0, 0, 1), mimic("a", 0.0, 0.3), limit=limit(-9, 9)),
)


class TestAConfiguration:
    @pytest.mark.parametrize("name", WITH_MIMICS)
    @given(seed=st.integers(0, 2**32 - 1), spread=st.sampled_from([0.01, 1.0, 30.0]))
    def test_comes_back_from_its_angles_on_every_robot_with_mimics(self, name, seed, spread):
        loaded = load_quietly(name)
        q = loaded.random(seed)
        for joint_ in loaded.joints:
            if joint_.nq == 1:
                q[joint_.idx_q] *= spread
        again = loaded.configuration(loaded.angles(q), loaded.joint_placements(q))
        np.testing.assert_allclose(again, q, rtol=0, atol=1e-12)

    @given(text=chains(), seed=st.integers(0, 2**32 - 1))
    def test_comes_back_from_its_angles_on_random_chains(self, text, seed):
        loaded = load_quietly(text)
        q = loaded.random(seed)
        np.testing.assert_allclose(loaded.configuration(loaded.angles(q)), q, rtol=0, atol=1e-12)

    @pytest.mark.parametrize(
        ("angles", "a"),
        [
            ({"a": 0.7}, 0.7),
            ({"b": 1.1}, 0.5),
            ({"c": 0.25}, -0.5),
            ({"d": 0.3}, 0.0),
            ({"d": 0.3, "c": 0.25}, -0.5),
            ({"c": 0.25, "b": -0.9}, -0.5),
            ({"b": 1.1, "a": 0.5, "c": -0.25, "d": 0.3}, 0.5),
            ({"b": 1.1 + 1e-12, "a": 0.5}, 0.5),
        ],
    )
    def test_is_set_by_followers_that_agree(self, angles, a):
        loaded = load_quietly(FOLLOWERS)
        q = loaded.configuration(angles)
        assert q == pytest.approx([a], abs=1e-11)
        expected = {"a": a, "b": 2.0 * a + 0.1, "c": -0.5 * a, "d": 0.3}
        assert loaded.angles(q) == pytest.approx(expected, abs=1e-11)

    @pytest.mark.parametrize(
        ("angles", "words"),
        [
            ({"a": 0.5, "b": 1.2}, "'b' cannot be at 1.2: it mimics 'a' and is at 1.1 when 'a' is at 0.5"),
            ({"b": 1.2, "a": 0.5}, "'b' cannot be at 1.2: it mimics 'a' and is at 1.1 when 'a' is at 0.5"),
            ({"b": 1.1 + 1e-6, "a": 0.5}, "'b' cannot be at 1.100001: it mimics 'a' and is at 1.1 when"),
            ({"c": 0.2, "b": 1.1}, "'c' cannot be at 0.2: it mimics 'a' and is at -0.25 when 'b' is at 1.1"),
            ({"d": 0.4}, "'d' cannot be at 0.4: it mimics 'a' with multiplier 0 and stays at 0.3"),
            ({"a": 0.4, "d": 0.4}, "'d' cannot be at 0.4: it mimics 'a' with multiplier 0 and stays at 0.3"),
        ],
    )
    def test_is_refused_where_a_follower_disagrees_and_both_are_named(self, angles, words):
        with pytest.raises(InputError) as caught:
            load_quietly(FOLLOWERS).configuration(angles)
        assert words in str(caught.value)

    def test_of_the_panda_takes_either_finger(self, panda):
        one = panda.configuration({"panda_finger_joint1": 0.03})
        np.testing.assert_array_equal(panda.configuration({"panda_finger_joint2": 0.03}), one)
        assert math.isclose(one[7], 0.03)
