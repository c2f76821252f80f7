from __future__ import annotations

import math
from xml.etree import ElementTree

import numpy as np
import pinocchio
import pytest
from hypothesis import assume, given

import pinik
from by_hand import ZOO, axis, chains, limit, mimic
from pinik.description import reader as urdf
from pinik.model.build import build_model
from robots import load_quietly
from urdf_texts import joint, link, robot

CONTINUOUS_LEADER = robot(
    *map(link, ("base", "wheel", "pointer")),
    joint("turn", "base", "wheel", axis(0, 0, 1), kind="continuous", limit='<limit effort="7" velocity="3"/>'),
    joint("z_follow", "base", "pointer", axis(0, 0, 1), mimic("turn", -0.25, 0.1), limit=limit(-0.5, 0.5)),
)


def pair(words: str, leader: tuple[float, float], follower: tuple[float, float]) -> str:
    """A hinge "lead" and a hinge "tail" that mimics it, with these limits."""
    return robot(
        *map(link, "abc"),
        joint("lead", "a", "b", limit=limit(*leader)),
        joint("tail", "b", "c", words, limit=limit(*follower)),
    )


def drawn(model: pinocchio.Model, count: int = 300) -> np.ndarray:
    """Pinocchio's own random configurations (count, nq)."""
    pinocchio.seed(5)
    return np.array([pinocchio.randomConfiguration(model) for _ in range(count)])


class TestTheModelsLimits:
    @pytest.mark.parametrize(
        ("words", "leader", "follower", "expected"),
        [
            (mimic("lead", 2.0), (-2, 2), (-1.0, 1.2), (-0.5, 0.6)),
            (mimic("lead", -2.0), (-2, 2), (-1.0, 1.2), (-0.6, 0.5)),
            (mimic("lead", -1.0, 0.5), (-2, 2), (-1.0, 1.2), (-0.7, 1.5)),
            (mimic("lead", 0.0, 0.3), (-2, 2), (-1.0, 0.1), (-2.0, 2.0)),
        ],
    )
    def test_are_cut_by_followers_and_pinocchio_draws_from_all_of_the_rest(self, words, leader, follower, expected):
        model = load_quietly(pair(words, leader, follower)).model
        assert (model.lowerPositionLimit[0], model.upperPositionLimit[0]) == pytest.approx(expected)
        q = drawn(model)
        low, high = expected
        assert low <= q.min() < low + 0.05 * (high - low)
        assert high - 0.05 * (high - low) < q.max() <= high

    def test_of_a_continuous_leader_are_its_followers(self):
        """−0.25 turn + 0.1 lies in [−0.5, 0.5] for turn in [−1.6, 2.4]."""
        model = load_quietly(CONTINUOUS_LEADER).model
        assert (model.lowerPositionLimit[0], model.upperPositionLimit[0]) == pytest.approx((-1.6, 2.4))
        q = drawn(model)
        assert -1.6 <= q.min() < -1.4
        assert 2.2 < q.max() <= 2.4

    def test_of_a_continuous_leader_are_infinite_where_no_follower_cuts_them(self):
        free = CONTINUOUS_LEADER.replace('type="revolute"', 'type="continuous"')
        model = load_quietly(free).model
        assert model.nq == 1
        assert (model.lowerPositionLimit[0], model.upperPositionLimit[0]) == (-math.inf, math.inf)
        with pytest.raises(RuntimeError, match="non bounded limit"):
            pinocchio.randomConfiguration(model)

    def test_of_effort_and_velocity_stay_a_continuous_leaders_own(self):
        model = load_quietly(CONTINUOUS_LEADER).model
        assert (model.upperEffortLimit[0], model.upperVelocityLimit[0]) == (7.0, 3.0)
        silent = load_quietly(CONTINUOUS_LEADER.replace('<limit effort="7" velocity="3"/>', "")).model
        assert silent.upperEffortLimit[0] > 1e300
        assert silent.upperVelocityLimit[0] > 1e300

    def test_are_the_followers_own_when_mimic_joints_are_free(self):
        model, warnings = build_model(urdf.read(pair(mimic("lead", -1.0), (0, 1), (0, 1))), mimic=False)
        assert warnings == ()
        assert model.lowerPositionLimit.tolist() == [0.0, 0.0]
        assert model.upperPositionLimit.tolist() == [1.0, 1.0]

    def test_exclude_no_turn_of_a_continuous_joint_and_no_orientation(self):
        loaded = load_quietly(ZOO, root="free_flyer")
        entries = [entry for j in loaded.joints if j.nq > 1 for entry in range(j.idx_q, j.idx_q + j.nq)]
        assert len(entries) == 7 + 7 + 2 + 4
        assert (loaded.model.lowerPositionLimit[entries] <= -1.0).all()
        assert (loaded.model.upperPositionLimit[entries] >= 1.0).all()

    @pytest.mark.parametrize(("root", "count"), [("free_flyer", 3), ("planar", 2)])
    def test_of_a_free_translation_are_infinite_so_that_pinocchio_draws_no_infinite_position(self, root, count):
        model = load_quietly("arm", root=root).model
        assert model.lowerPositionLimit[:count].tolist() == [-math.inf] * count
        assert model.upperPositionLimit[:count].tolist() == [math.inf] * count
        with pytest.raises(RuntimeError, match="non bounded limit"):
            pinocchio.randomConfiguration(model)

    @given(text=chains(kinds=("revolute", "prismatic", "fixed")))
    def test_keep_every_joint_inside_the_limits_of_the_file_when_pinocchio_draws(self, text):
        loaded = load_quietly(text)
        assume(loaded.warnings == ())  # no follower whose limits are ignored
        tags = ElementTree.fromstring(text).findall("joint")
        for q in drawn(loaded.model, 5):
            angles = loaded.angles(q)
            for tag in tags:
                if tag.attrib["type"] != "fixed":
                    said = tag.find("limit").attrib
                    angle = angles[tag.attrib["name"]]
                    assert float(said["lower"]) - 1e-9 <= angle <= float(said["upper"]) + 1e-9

    @pytest.mark.parametrize("name", ["arm", "panda", "pr2", "tiago_pro", "baxter", "romeo", "kinova"])
    def test_are_those_of_the_robot(self, name):
        loaded = load_quietly(name)
        places = {j.name: j for j in loaded.joints}
        for joint_name, low, high in zip(loaded.joint_names, loaded.lower, loaded.upper, strict=True):
            place = places[joint_name]
            if place.nq == 1:
                for limits, expected in (
                    (loaded.model.lowerPositionLimit, low),
                    (loaded.model.upperPositionLimit, high),
                    (loaded.lower_q, low),
                    (loaded.upper_q, high),
                ):
                    assert limits[place.idx_q] == expected
            else:
                assert (low, high) == (-math.inf, math.inf)


class TestAFollower:
    @pytest.mark.parametrize(
        ("words", "leader", "follower", "room"),
        [
            (mimic("lead", -1.0), (0, 0.548), (0, 0.548), "only the value 0"),
            (mimic("lead", 1.0), (-1, 1), (1, 2), "only the value 1"),
            (mimic("lead", 2.0, 0.5), (-1, 1), (0.5, 0.5), "only the value 0"),
            (mimic("lead", 0.5, 0.25), (-1, 1), (0.75, 3), "only the value 1"),
            (mimic("lead"), (-1, 1), (2, 3), "no room"),
        ],
    )
    def test_that_would_stop_its_leader_does_not_cut_it_and_is_named(self, words, leader, follower, room):
        with pytest.warns(pinik.UrdfWarning) as caught:
            loaded = pinik.load(pair(words, leader, follower))
        assert (loaded.lower.tolist(), loaded.upper.tolist()) == ([leader[0]], [leader[1]])
        (message,) = (str(w.message) for w in caught)
        limits = f"{follower[0]:g}…{follower[1]:g}"
        assert f"joint 'tail': its limits {limits} are ignored" in message
        assert f"would leave 'lead', which it mimics, {room}" in message

    def test_of_a_leader_that_has_a_single_value_itself_needs_no_words(self):
        loaded = pinik.load(pair(mimic("lead"), (0.5, 0.5), (0, 1)))
        assert (loaded.lower.tolist(), loaded.upper.tolist()) == ([0.5], [0.5])
        assert loaded.warnings == ()

    def test_that_is_ignored_leaves_the_others_their_say(self):
        text = robot(
            *map(link, "abcd"),
            joint("lead", "a", "b", limit=limit(0, 2)),
            joint("tail1", "b", "c", mimic("lead", -1.0), limit=limit(0, 2)),
            joint("tail2", "c", "d", mimic("lead", 2.0), limit=limit(-3, 3)),
        )
        loaded = load_quietly(text)
        assert (loaded.lower.tolist(), loaded.upper.tolist()) == ([0.0], [1.5])
        assert [words.partition(":")[0] for words in loaded.warnings] == ["joint 'tail1'"]

    def test_of_the_pr2_leaves_its_grippers_the_range_of_the_file(self):
        loaded = load_quietly("pr2")
        for side in "lr":
            k = loaded.joint_names.index(f"{side}_gripper_l_finger_joint")
            assert (loaded.lower[k], loaded.upper[k]) == (0.0, 0.548)
            assert any(f"'{side}_gripper_r_parallel_root_joint'" in words for words in loaded.warnings)


class TestVelocityLimits:
    def test_are_those_of_the_file_and_infinite_where_it_gives_none_or_zero(self):
        model = pinik.load(
            robot(
                *map(link, "abcd"),
                joint("fast", "a", "b", limit='<limit lower="-1" upper="1" effort="1" velocity="2.5"/>'),
                joint("zero", "b", "c", limit='<limit lower="-1" upper="1" effort="1" velocity="0"/>'),
                joint("none", "c", "d", axis(0, 0, 1), kind="continuous", limit=""),
            )
        )
        assert dict(zip(model.joint_names, model.velocity_limits, strict=True)) == {
            "fast": 2.5,
            "zero": math.inf,
            "none": math.inf,
        }

    @pytest.mark.parametrize(("multiplier", "expected"), [(2.0, 1.5), (-4.0, 0.75), (0.5, 2.0), (0.0, 2.0)])
    def test_keep_followers_within_theirs(self, multiplier, expected):
        model = pinik.load(
            robot(
                *map(link, "abc"),
                joint("lead", "a", "b", limit='<limit lower="-1" upper="1" effort="1" velocity="2"/>'),
                joint(
                    "tail",
                    "b",
                    "c",
                    mimic("lead", multiplier),
                    limit='<limit lower="-9" upper="9" effort="1" velocity="3"/>',
                ),
            )
        )
        assert model.velocity_limits == pytest.approx([expected])

    def test_cannot_be_changed(self, panda):
        with pytest.raises(ValueError, match="read-only"):
            panda.velocity_limits[0] = 9.0
