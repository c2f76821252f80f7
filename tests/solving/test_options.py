"""One set of options: every front takes it, spelled out, and checks it; and a mistyped word is told apart."""

from __future__ import annotations

import dataclasses
import inspect

import numpy as np
import pytest

import pinik
from pinik import InputError, Target, Tolerance, UnknownNameError
from pinik.solving.options import OPTION_NAMES, Options

PLACE = inspect.signature(Target).parameters
OF_A_TARGET = [name for name in PLACE if name != "frame"]
FRONTS = {
    "solve": (pinik.solve, OPTION_NAMES, OF_A_TARGET),
    "Robot.solve": (pinik.Robot.solve, OPTION_NAMES, OF_A_TARGET),
    "prepare": (pinik.prepare, OPTION_NAMES, OF_A_TARGET),
    "iterate": (pinik.iterate, ("limits", "locked", "max_iterations", "tolerance", "polish"), OF_A_TARGET),
    "solve_many": (
        pinik.solve_many,
        tuple(name for name in OPTION_NAMES if name != "trace"),
        ["tool", "relative_to", "tolerance"],
    ),
}


@pytest.mark.parametrize("front", FRONTS)
def test_a_front_spells_out_every_option_and_every_keyword_of_a_target(front):
    function, options, of_a_target = FRONTS[front]
    parameters = inspect.signature(function).parameters
    assert [name for name in parameters if name in OPTION_NAMES] == list(options)
    assert [name for name in parameters if name in OF_A_TARGET] == list(of_a_target)
    for name in of_a_target:
        assert parameters[name].default == PLACE[name].default, name
        assert parameters[name].annotation == PLACE[name].annotation, name
    kept = {field.name: field for field in dataclasses.fields(Options)}
    for name in options:
        said = parameters[name].default
        assert Options(**{name: said}) == Options(), name
        assert said in (None, kept[name].default), name
    assert parameters["method"].default == Options().method.name


WRONG = {
    "limits": "off",
    "locked": "joint1",
    "restarts": -1,
    "seed": 1.5,
    "max_iterations": 0,
    "tolerance": (1.0,),
    "time_limit": 0.0,
    "engine": "gpu",
    "trace": 1,
    "polish": "fine",
    "choose": "best",
    "choose_weights": 2.0,
    "avoid": "others",
}


@pytest.mark.parametrize("front", FRONTS)
def test_every_front_checks_every_option(front, arm):
    assert set(WRONG) == set(OPTION_NAMES)
    function, options, _ = FRONTS[front]
    places = np.zeros((2, 3))
    for name in options:
        arguments = ("tip", places) if front == "solve_many" else ("tip",)
        keywords = {} if front == "solve_many" else {"position": [0.2, 0.1, 0.9]}
        with pytest.raises((InputError, UnknownNameError), match=rf"{name}|no engine 'gpu'|no choice 'best'"):
            function(arm, *arguments, **keywords, **{name: WRONG[name]})


@pytest.mark.parametrize("front", [name for name in FRONTS if name != "solve_many"])
@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("positon", "position"),
        ("max_iter", "max_iterations"),
        ("rotations", "rotation"),
        ("dampning", "damping"),
        ("tolerence", "tolerance"),
        ("lock", "locked"),
    ],
)
def test_a_mistyped_word_is_told_apart_by_what_it_resembles(front, word, meant, arm):
    function, options, of_a_target = FRONTS[front]
    if meant not in (*options, *of_a_target, "damping"):
        pytest.fail(f"{front} has no {meant}")
    with pytest.raises(UnknownNameError, match=rf"no keyword '{word}'; did you mean '{meant}'") as raised:
        function(arm, "tip", **{word: [0.1, 0.2, 0.9]})
    assert raised.value.name == word


@pytest.mark.parametrize(
    "method", ["dls", pinik.DampedLeastSquares, pinik.DampedLeastSquares()], ids=["name", "class", "solver"]
)
def test_a_mistyped_parameter_is_told_apart_however_the_method_is_given(method, arm):
    with pytest.raises(UnknownNameError, match=r"did you mean 'damping'.*the method is 'dls'"):
        pinik.solve(arm, "tip", position=[0.1, 0.2, 0.9], method=method, dampning=0.1)


@pytest.mark.parametrize("front", FRONTS)
def test_every_front_takes_a_frames_name_and_targets_alike(front, arm):
    function, _, _ = FRONTS[front]
    place = [0.2, 0.1, 0.9]
    if front == "solve_many":
        by_name = function(arm, "tip", np.array([place])).q[0]
        by_target = function(arm, [Target("tip", place)]).q[0]
    else:
        by_name, by_target = function(arm, "tip", position=place), function(arm, Target("tip", place))
        if front == "iterate":
            by_name, by_target = list(by_name)[-1], list(by_target)[-1]
        if front == "prepare":
            by_name, by_target = by_name(), by_target()
        by_name, by_target = by_name.q, by_target.q
    np.testing.assert_array_equal(by_name, by_target)
    assert np.linalg.norm(arm.placement("tip", by_name).translation - place) <= 1e-4


def test_a_targets_keywords_do_not_go_with_target_objects(arm):
    for front in (pinik.solve, pinik.prepare, pinik.iterate, pinik.Robot.solve):
        with pytest.raises(InputError, match="position= needs the name of a frame"):
            front(arm, Target("tip", [0, 0, 1]), position=[0.0, 0.0, 1.0])


def test_the_old_word_for_iterates_method_still_works_and_warns(arm):
    with pytest.warns(DeprecationWarning, match="method="):
        states = pinik.iterate(arm, Target("tip", [0.2, 0.1, 0.9]), solver="ccd")
    assert max(state.joint_updates for state in states) > 0


def test_options_say_the_same_however_they_are_written():
    ways = [
        Options.of("dls"),
        Options.of(pinik.DampedLeastSquares, tolerance=[1e-4, 1e-3]),
        Options.of(pinik.DampedLeastSquares(), tolerance=np.array([1e-4, 1e-3]), locked=[]),
        Options.of("dls", {"damping": np.sqrt(0.5)}, tolerance=Tolerance(), time_limit=None, limits=np.True_),
    ]
    assert len(set(ways)) == 1
    assert len({Options.of("ccd", {"stiffness": way}) for way in ({"a": 0.5, "b": 1}, {"b": 1.0, "a": 0.5})}) == 1


def test_options_are_immutable():
    options = Options.of("ccd", {"stiffness": {"a": 0.5}}, locked=["b"])
    with pytest.raises(dataclasses.FrozenInstanceError):
        options.seed = 3
    with pytest.raises(TypeError):
        options.method.stiffness["a"] = -3.0
    assert options.locked == ("b",)


def test_a_word_of_another_method_and_the_old_word_are_named(arm):
    with pytest.raises(pinik.UnknownNameError, match="relaxation belongs to 'ccd'"):
        arm.solve("tip", [0.3, 0.2, 0.9], relaxation=1.0)
    with pytest.raises(pinik.UnknownNameError, match="given as method="):
        arm.solve("tip", [0.3, 0.2, 0.9], solver="ccd")
    with pytest.raises(pinik.InputError, match="the method must be given once"):
        pinik.iterate(arm, "tip", method="jt", position=[0.3, 0.2, 0.9], solver="ccd")
