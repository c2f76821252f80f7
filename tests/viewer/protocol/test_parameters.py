"""A solver's parameters as sliders and menus: whatever a solver is, its own fields say it."""

from __future__ import annotations

import dataclasses
import json
import math
from dataclasses import dataclass

import pytest

import pinik
from pinik.solvers.registry import make_solver
from pinik.viewer.protocol.parameters import changed_parameters, describe_parameters


def described(solver):
    return {one["name"]: one for one in describe_parameters(solver)}


@pytest.mark.parametrize("name", sorted(pinik.SOLVERS))
def test_every_parameter_is_described_with_its_own_range(name):
    solver = pinik.SOLVERS[name]()
    fields = {field.name: field for field in dataclasses.fields(solver)}
    about = described(solver)
    assert set(about) == set(fields)
    for parameter, one in about.items():
        own = fields[parameter].metadata["parameter"]
        assert (one["low"], one["high"], one["help"], one["unit"]) == (own.low, own.high, own.help, own.unit)
        assert one["value"] == one["default"]
        assert one["kind"] in ("number", "truth", "choice", "joints")
        assert (one["none"] is None) == (not own.optional and not own.unbounded)
    json.dumps(about, allow_nan=False)


@pytest.mark.parametrize("name", sorted(pinik.SOLVERS))
def test_sliders_offer_only_what_the_solver_takes(name):
    for parameter, one in described(pinik.SOLVERS[name]()).items():
        if one["kind"] == "number" and one["slider"]:
            low, high = one["slider"]
            assert low < high
            for value in (low, high):
                pinik.SOLVERS[name].make(**{parameter: int(value) if one["whole"] else value})
        if one["none"]:
            pinik.SOLVERS[name].make(**{parameter: None})
        for choice in one["choices"]:
            pinik.SOLVERS[name].make(**{parameter: choice})
        if one["logarithmic"]:
            assert 0 < one["slider"][0] <= one["slider"][1] / 100


@dataclass(frozen=True, kw_only=True)
class Every(pinik.CCD):
    """A parameter of each kind."""

    name = "every"

    count: int = pinik.parameter(3, "how many", low=1, high=5)
    truth: bool = pinik.parameter(False, "whether")
    word: str = pinik.parameter("a", "which", choices=("a", "b"))
    joints: dict = pinik.parameter({}, "joint by joint", low=0.0, high=1.0)  # noqa: RUF009
    endless: float = pinik.parameter(math.inf, "how far", unit="m", low=0.1, slider=(0.1, 20.0), unbounded=True)
    maybe: float | None = pinik.parameter(None, "if at all", low=0.0, high=1.0, optional=True)
    own: object = None


def test_kinds_and_empty_values():
    about = described(Every())
    assert "own" not in about  # a field that says nothing of itself is nothing for a page
    kinds = {name: about[name]["kind"] for name in ("count", "truth", "word", "joints", "endless", "maybe")}
    assert kinds == {
        "count": "number",
        "truth": "truth",
        "word": "choice",
        "joints": "joints",
        "endless": "number",
        "maybe": "number",
    }
    assert [name for name, one in about.items() if one["whole"]] == ["count"]
    assert (about["endless"]["none"], about["maybe"]["none"], about["count"]["none"]) == ("no limit", "automatic", None)
    assert (about["endless"]["value"], about["maybe"]["value"]) == (None, None)
    assert about["endless"]["logarithmic"]
    assert not about["count"]["logarithmic"]
    assert about["word"]["choices"] == ["a", "b"]
    assert about["truth"]["slider"] is None


def test_what_was_changed_is_told_and_nothing_else():
    assert changed_parameters(Every()) == {}
    changes = {"count": 4, "truth": True, "word": "b", "joints": {"x": 0.5}, "endless": 2.0, "maybe": 0.0}
    solver = Every(**changes)
    assert changed_parameters(solver) == changes
    assert changed_parameters(Every(maybe=None, endless=math.inf)) == {}
    again = make_solver(Every, **json.loads(json.dumps(changed_parameters(solver))))
    assert again == solver


def test_infinity_has_no_json():
    for given, told in ((math.inf, None), (None, None), (2.5, 2.5)):
        assert described(Every(endless=given))["endless"]["value"] == told
    joints = described(Every(joints={"a": 1.0}))["joints"]["value"]
    assert type(joints) is dict
    assert joints == {"a": 1.0}
