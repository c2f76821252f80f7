"""Slips of the keyboard: which known name was meant, found without a search where one look is enough."""

from __future__ import annotations

import difflib
from itertools import product
from string import ascii_lowercase

import pytest

import pinik
from pinik.description import reader
from pinik.description.lint.front import lint
from pinik.description.slips import is_sure, meant
from pinik.description.vocabulary import URDF
from urdf_texts import joint, link, pair, robot

LIMIT = URDF["limit"].attributes
ORIGIN = URDF["origin"].attributes


@pytest.mark.parametrize(
    ("name", "known", "near"),
    [
        ("uper", LIMIT, "upper"),
        ("upperr", LIMIT, "upper"),
        ("uppir", LIMIT, "upper"),
        ("UPPER", LIMIT, "upper"),
        ("uppre", LIMIT, "upper"),
        ("xzy", ORIGIN, "xyz"),
        ("xyzz", ORIGIN, "xyz"),
        ("aceleration", LIMIT, "acceleration"),
        ("zyx", ORIGIN, None),  # the same letters in another order alone are no slip
        ("pur", LIMIT, None),
        ("speed", LIMIT, None),
        ("upper" * 20, LIMIT, None),
    ],
)
def test_a_slip_of_one_letter_or_two_is_the_known_name(name, known, near):
    assert meant(name, known) == near


def test_a_name_that_is_given_too_is_meant_by_a_near_one_only():
    assert meant("uper", LIMIT, ["upper"]) == "upper"
    assert meant("lowext", LIMIT) == "lower"
    assert meant("lowext", LIMIT, ["lower"]) is None


def test_only_one_answer_is_sure():
    assert is_sure("uper", LIMIT)
    assert not is_sure("ixxy", URDF["inertia"].attributes)


def test_a_slip_that_comes_again_or_of_one_letter_needs_no_search(monkeypatch):
    """Files of thousands of slips were read slowly, as each slip was compared with all names, several times."""
    searches = []
    search = difflib.SequenceMatcher.get_matching_blocks
    monkeypatch.setattr(
        difflib.SequenceMatcher, "get_matching_blocks", lambda self: searches.append(self) or search(self)
    )
    links = [link(f"l{i}") for i in range(201)]
    slips = '<orgin xyz="0 0 1"/><dynamics dampinng="1" friktian="1"/>'
    text = robot(*links, *(joint(f"j{i}", f"l{i}", f"l{i + 1}", slips) for i in range(200)))
    with pytest.warns(pinik.UrdfWarning):
        description = pinik.load(text).description
    found = lint(text.encode(), description)
    assert sum(flaw.code.startswith("unknown-") for flaw in found) == 3 * 200
    assert len(searches) < 50


def test_thousands_of_different_slips_are_compared_once_by_reader_and_lint_together(monkeypatch):
    searches = []
    search = difflib.SequenceMatcher.get_matching_blocks
    monkeypatch.setattr(
        difflib.SequenceMatcher, "get_matching_blocks", lambda self: searches.append(self) or search(self)
    )
    slips = [f"mul{first}ti{second}pl{third}er" for first, second, third in product(ascii_lowercase[:14], repeat=3)]
    attributes = " ".join(f'{slip}="1"' for slip in slips)
    text = pair(f'<mimic joint="k" {attributes}/>')
    lint(text.encode(), reader.read(text))
    assert len(searches) <= 1.1 * len(slips)
