"""Errors and warnings know their parts, survive pickling, and suggest names."""

from __future__ import annotations

import copy
import pickle

import pytest

import pinik
from pinik.checks import as_count, as_point, as_positive_number
from pinik.description.flaw import Edit, Flaw
from pinik.errors import near_names
from urdf_texts import joint, link, robot

KEYWORDS = ("max_step", "max_residual", "max_iterations", "position", "rotation", "restarts", "damping")

ERRORS = {
    "a file": pinik.RobotLoadError("no root: there are two", source="a: b.urdf", element="joint 'c: d'"),
    "a whole file": pinik.RobotLoadError("empty"),
    "an argument": pinik.InputError("must be positive; got -1", argument="time_limit"),
    "no argument": pinik.InputError("give a target"),
    "a name": pinik.UnknownNameError("frame", "tpi", ["tip"], "a hint"),
    "an engine": pinik.EngineError("not built"),
}


@pytest.mark.parametrize("case", ERRORS)
def test_an_error_is_the_same_after_pickling_and_copying(case):
    error = ERRORS[case]
    for other in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert (type(other), str(other), vars(other)) == (type(error), str(error), vars(error))


def test_a_load_error_keeps_those_of_other_joints_after_pickling():
    error = pinik.RobotLoadError("no type", element="joint 'a'", others=[ERRORS["a file"]])
    (other,) = pickle.loads(pickle.dumps(error)).others
    assert vars(other) == vars(ERRORS["a file"])


def test_a_load_error_knows_its_cause():
    error = ERRORS["a file"]
    assert (error.source, error.element, error.cause) == ("a: b.urdf", "joint 'c: d'", "no root: there are two")
    assert str(error) == "a: b.urdf: joint 'c: d': no root: there are two"


@pytest.mark.parametrize(
    ("check", "argument", "requirement"),
    [
        (lambda: as_count(-1, "restarts", least=0), "restarts", "must be a whole number of at least 0; got -1"),
        (lambda: as_count(9, "joints", most=5), "joints", "must be a whole number from 1 to 5; got 9"),
        (lambda: as_count(True, "n"), "n", "must be a whole number of at least 1; got True"),
        (lambda: as_positive_number(0, "t", "seconds"), "t", "must be a positive number of seconds; got 0"),
        (lambda: as_point([0, 1], "at"), "at", "must be 3 finite numbers; got an array of shape (2,)"),
    ],
)
def test_a_check_names_the_argument_and_says_what_it_must_be(check, argument, requirement):
    with pytest.raises(pinik.InputError) as caught:
        check()
    assert (caught.value.argument, caught.value.requirement) == (argument, requirement)
    assert str(caught.value) == f"{argument} {requirement}"


@pytest.mark.parametrize(
    ("word", "likeliest"),
    [
        ("max_iter", "max_iterations"),  # by letters alone "max_step" is nearer
        ("positon", "position"),
        ("damp", "damping"),
        ("restart", "restarts"),
        ("Rotation", "rotation"),
        ("dampings_of_all_joints", "damping"),
    ],
)
def test_the_likeliest_name_comes_first(word, likeliest):
    assert near_names(word, KEYWORDS)[0] == likeliest


def test_a_typo_in_a_long_name_is_nearer_than_the_beginning_of_it():
    assert near_names("hand_tpc", ["hand", "hand_tcp", "hand_joint"])[0] == "hand_tcp"


def test_nothing_is_suggested_where_nothing_is_near():
    assert near_names("quux", KEYWORDS) == near_names("", KEYWORDS) == near_names("x", []) == ()


@pytest.mark.parametrize(
    ("valid", "words"),
    [
        (["tool0"], "no frame 'tool'; did you mean 'tool0'?"),
        (["tool_link", "tool0"], "no frame 'tool'; did you mean 'tool0' or 'tool_link'?"),
        (["tool1", "tool2", "tool3", "x"], "no frame 'tool'; did you mean 'tool1', 'tool2' or 'tool3'?"),
        (["base"], "no frame 'tool'; available: 'base'"),
        (list("abcdefghijklmn"), f"no frame 'tool'; available: {', '.join(map(repr, 'abcdefghijkl'))} and 2 more"),
        ([], "no frame 'tool'; there are none"),
    ],
)  # fmt: skip
def test_an_unknown_name_comes_with_advice(valid, words):
    assert str(pinik.UnknownNameError("frame", "tool", valid)) == words
    assert str(pinik.UnknownNameError("frame", "tool", valid, "of arm")) == f"{words} (of arm)"


def test_a_flaw_is_a_sentence_that_knows_its_parts():
    edit = Edit(3, 4, "d")
    flaw = Flaw(
        "link 'a: b'", "there is no mesh 'c'", code="missing-mesh", line=7, common="a mesh is missing",
        why="it cannot be drawn", mend="give its address", edits=[edit], mesh="c",
    )  # fmt: skip
    for one in (flaw, pickle.loads(pickle.dumps(flaw)), copy.deepcopy(flaw)):
        assert one == "link 'a: b': there is no mesh 'c' (line 7)"
        assert (one.element, one.cause, one.code, one.line) == (
            "link 'a: b'",
            "there is no mesh 'c'",
            "missing-mesh",
            7,
        )
        assert (one.common, one.mesh) == ("a mesh is missing", "c")
        assert (one.why, one.mend, one.edits) == ("it cannot be drawn", "give its address", (edit,))
    assert Flaw("link 'a'", "why", code="odd").common == "why"


def test_warnings_of_a_robot_are_sentences_with_elements():
    text = robot(link("a"), link("b"), joint("j", "a", "b", '<mimic joint="k"/>'))
    with pytest.warns(pinik.UrdfWarning, match="joint 'j': it mimics 'k', which does not exist"):
        (flaw,) = pinik.load(text).warnings
    assert isinstance(flaw, str)
    assert flaw.element == "joint 'j'"
