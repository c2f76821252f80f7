from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from by_hand import ZOO, axis, chains, limit, mimic, origin
from pinik.shapes.second_opinion import SecondOpinion, ask_yourdfpy
from robots import load_quietly
from urdf_texts import chain, joint, link, pair, robot


@pytest.fixture(scope="session")
def ask(tmp_path_factory):
    """The second opinion on a text, or on another text than the robot was loaded from."""

    def asked(text: str, other: str | bytes | None = None, **options: Any) -> SecondOpinion:
        file = tmp_path_factory.mktemp("robot") / "robot.urdf"
        document = text if other is None else other
        file.write_bytes(document if isinstance(document, bytes) else document.encode())
        return ask_yourdfpy(load_quietly(text, **options), file)

    return asked


def check_agrees(opinion: SecondOpinion, links: int) -> None:
    assert opinion.agrees, str(opinion)
    assert (opinion.links, opinion.configurations) == (links, 3)
    assert 0 <= opinion.position_difference_m < 1e-12
    assert 0 <= opinion.rotation_difference_rad < 1e-12


class TestAgreement:
    @pytest.mark.parametrize("name", ["arm", "kinova", "lion", "panda", "tiago", "two_link"])
    @pytest.mark.parametrize("root", ["fixed", "free_flyer"])
    def test_on_robots_of_the_catalogue(self, name, root):
        found = load_quietly(name, root=root)
        check_agrees(ask_yourdfpy(found, found.description.path), len(found.description.links))

    @pytest.mark.parametrize("name", ["romeo", "talos_full", "talos_full_box"])
    def test_on_followers_whose_leaders_come_later_by_name(self, name):
        found = load_quietly(name)
        check_agrees(ask_yourdfpy(found, found.description.path), len(found.description.links))

    def test_on_a_leader_that_hangs_from_its_follower(self, ask):
        text = robot(*map(link, "abc"), joint("one", "a", "b", mimic("two", -2.0, 0.1)), joint("two", "b", "c"))
        check_agrees(ask(text), 3)

    def test_on_every_kind_of_joint_but_the_motion_of_floating_and_planar_ones(self, ask):
        opinion = ask(ZOO)
        check_agrees(opinion, 11)
        assert opinion.unmoved == ("drift", "s_plane")
        assert "it cannot move 'drift', 's_plane'" in str(opinion)

    @settings(max_examples=25)
    @given(text=chains())
    def test_on_any_chain_with_mimics_of_any_kind(self, ask, text):
        assert ask(text).agrees

    def test_on_a_mimic_of_a_mimic(self, ask):
        text = robot(
            *map(link, "abcd"),
            joint("one", "a", "b"),
            joint("two", "b", "c", mimic("one", -2.0, 0.1), kind="prismatic"),
            joint("three", "c", "d", mimic("two", 0.5, 0.2)),
        )
        check_agrees(ask(text), 4)

    def test_on_a_joint_whose_leader_does_not_exist(self, ask):
        check_agrees(ask(pair(mimic("nobody"))), 2)

    @pytest.mark.parametrize("kind", ["revolute", "prismatic"])
    @pytest.mark.parametrize("length", [1e-200, 5.0, 1e200])
    def test_however_long_an_axis_is_written(self, ask, kind, length):
        check_agrees(ask(pair(axis(0, length, length), kind=kind, limit=limit(-1, 1))), 2)

    def test_on_a_robot_that_does_not_move(self, ask):
        check_agrees(ask(robot(link("a"))), 1)

    def test_far_from_the_root_the_tolerance_is_relative(self, ask):
        far = [joint(f"j{i}", f"l{i}", f"l{i + 1}", origin((3e8, 1e8, 2e8), (1, 2, 3))) for i in range(4)]
        opinion = ask(robot(*(link(f"l{i}") for i in range(5)), *far))
        assert opinion.position_difference_m > 1e-9
        assert opinion.agrees

    def test_on_thousands_of_links(self, ask):
        check_agrees(ask(chain(3000, "fixed")), 3001)

    def test_is_the_same_every_time(self, panda):
        first, second = (ask_yourdfpy(panda, panda.description.path) for _ in range(2))
        assert first == second


class TestDisagreement:
    def test_of_one_joint_is_measured_and_names_the_links_beyond_it(self, ask):
        text = robot(*map(link, "abc"), joint("j", "a", "b"), joint("k", "b", "c", origin((0, 0, 0.3))))
        shifted = text.replace('xyz="0.0 0.0 0.3"', 'xyz="0.0 0.0 0.5"')
        opinion = ask(text, shifted)
        assert not opinion.agrees
        assert opinion.disagreeing == ("c",)
        assert opinion.position_difference_m == pytest.approx(0.2, abs=1e-12)
        assert opinion.rotation_difference_rad < 1e-12
        assert str(opinion).startswith("yourdfpy disagrees about 'c': 3 links at 3 configurations, at most 0.2 m")

    def test_of_links_that_only_one_reader_found_is_told_from_placements_that_differ(self, ask):
        text = robot(*map(link, "abc"), joint("j", "a", "b"), joint("k", "b", "c"))
        opinion = ask(text, text.replace("<robot", '<robot xmlns="http://example.org"'))
        assert opinion.unmatched == opinion.disagreeing == ("b", "c")
        words = (
            "yourdfpy disagrees about 'b', 'c': only one reader found 'b', 'c'; the other 1 link at 3 configurations, "
        )
        assert str(opinion).startswith(words)

    @pytest.mark.parametrize("angle", [1e-8, 1e-3, 1.0, math.pi])
    def test_in_orientation_is_measured_from_tiny_angles_to_half_turns(self, ask, angle):
        opinion = ask(pair(origin((1, 2, 3))), pair(origin((1, 2, 3), (0, 0, angle))))
        assert opinion.disagreeing == ("b",)
        assert opinion.rotation_difference_rad == pytest.approx(angle, rel=1e-6)
        assert opinion.position_difference_m < 1e-12

    def test_just_above_the_tolerance_is_one_and_just_below_is_none(self, ask):
        for offset, agrees in ((2e-9, False), (5e-10, True)):
            assert ask(pair(origin((0, 0, 0))), pair(origin((offset, 0, 0)))).agrees == agrees

    def test_about_a_mimic_is_found_at_the_random_configurations(self, ask):
        followed = {
            multiplier: robot(
                *map(link, "abc"), joint("j", "a", "b"), joint("k", "a", "c", mimic("j", multiplier), axis(0, 1, 0))
            )
            for multiplier in (0.5, 0.6)
        }
        assert ask(followed[0.5], followed[0.6]).disagreeing == ("c",)

    def test_about_a_follower_that_pinik_leaves_free(self, ask):
        text = robot(*map(link, "abc"), joint("one", "a", "b", mimic("two", 0.0, 0.1)), joint("two", "b", "c"))
        assert ask(text).disagreeing == ("b", "c")
        late = robot(*map(link, "abc"), joint("one", "a", "b", mimic("two", 0.5)), joint("two", "a", "c"))
        assert ask(late).agrees
        assert ask(late, mimic=False).disagreeing == ("b",)

    def test_about_what_links_there_are(self, ask):
        assert ask(pair(), pair().replace('"b"', '"other"')).disagreeing == ("b", "other")

    def test_where_yourdfpy_computes_no_number(self, ask):
        opinion = ask(pair(), pair('<origin xyz="nan 0 0"/>'))
        assert opinion.disagreeing == ("b",)
        assert math.isnan(opinion.position_difference_m)

    def test_about_many_links_names_some(self, ask):
        opinion = ask(chain(9, "fixed"), chain(9, "fixed").replace("<parent", '<origin xyz="1 0 0"/><parent'))
        assert len(opinion.disagreeing) == 9
        assert "'l6' and 3 more: " in str(opinion)


class TestUnread:
    @pytest.mark.parametrize(
        "document",
        [
            "",
            "no XML",
            b"\xff\xfe\x00",
            "<robot>",
            pair().replace(' name="r"', ""),
            pair().replace('<parent link="a"/>', ""),
            pair('<origin xyz="1 2"/>'),
            pair('<origin xyz="1 2 x"/>'),
            pair(mimic("j")).replace('"j"', '"k"'),
            pair().replace('<child link="b"/>', '<child link="nowhere"/>'),
        ],
    )
    def test_a_document_that_yourdfpy_stumbles_over_becomes_words(self, ask, document, caplog, capfd):
        opinion = ask(pair(), document)
        assert re.fullmatch(r"it could not read the file \(\w+: .*\)", opinion.unread)
        assert not opinion.agrees
        assert str(opinion) == f"yourdfpy gives no second opinion: {opinion.unread}"
        assert opinion == SecondOpinion(unread=opinion.unread)
        assert capfd.readouterr() == ("", "")
        assert caplog.records == []

    def test_a_file_that_has_gone_becomes_words(self, panda, tmp_path):
        assert "No such file" in ask_yourdfpy(panda, tmp_path / "gone.urdf").unread

    def test_a_long_fault_is_cut_short(self, ask):
        opinion = ask(pair(), pair(f'<origin xyz="{"x" * 10_000} 0 0"/>'))
        assert len(opinion.unread) < 300


def test_the_dictionary_has_plain_values_and_the_verdict(ask):
    answer = ask(pair()).to_dict()
    assert answer["agrees"] is True
    assert {type(answer[key]) for key in ("position_difference_m", "rotation_difference_rad")} == {float}
    assert not any(isinstance(value, np.generic) for value in answer.values())


def test_the_robot_is_left_as_it_was(panda):
    q = panda.random(5)
    before = panda.placement("panda_hand", q).homogeneous
    ask_yourdfpy(panda, panda.description.path)
    np.testing.assert_array_equal(panda.placement("panda_hand", q).homogeneous, before)
