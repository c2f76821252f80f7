"""What messages echo is bounded, in errors, in warnings and in the command."""

from __future__ import annotations

import pickle

import pytest

import pinik
from pinik.echoes import bounded, one_line
from urdf_texts import joint, link, robot

LONG = "n" * 5000
SPACED = "long name " * 500


def test_what_is_short_stays_as_it_is():
    for words in ("no frame 'tipp'; did you mean 'tip'?", "x" * 300, " ".join(["word"] * 400), ""):
        assert bounded(words) == words


@pytest.mark.parametrize("name", [LONG, SPACED, LONG + " " + SPACED])
def test_both_ends_of_a_long_message_stay(name):
    words = bounded(f"no frame {name!r}; did you mean 'tip'?")
    assert words.startswith("no frame '")
    assert words.endswith("; did you mean 'tip'?")
    assert "…" in words
    assert len(words) <= 2000
    assert bounded(words) == words


def test_a_line_is_one_line_without_control_characters():
    assert one_line("two\n  lines\r\n") == "two lines"
    assert one_line("\x1b[2J \x07 \u202e \x9b") == r"\x1b[2J \x07 \u202e \x9b"
    assert one_line("é λ 中 😀") == "é λ 中 😀"


def errors():
    arm = pinik.load("arm")
    text = robot(link("base"), link("tip"), joint("j", "base", "tip", kind="revolute"))
    yield lambda: arm.placement(LONG, arm.neutral())
    yield lambda: arm.configuration({LONG: 0.0})
    yield lambda: arm.solve("tip", position=[0, 0, 1], method=LONG)
    yield lambda: arm.solve("tip", position=LONG)
    yield lambda: pinik.load(LONG)
    yield lambda: pinik.load(f"/nowhere/{LONG}.urdf")
    yield lambda: pinik.load(robot(link(LONG), link(LONG)))
    yield lambda: pinik.load(text.replace('"j"', f'"{LONG}"').replace('type="revolute"', f'type="{LONG}"'))


@pytest.mark.parametrize("wrong", list(errors()))
def test_no_error_echoes_thousands_of_characters(wrong):
    with pytest.raises(pinik.PinikError) as caught:
        wrong()
    error = caught.value
    assert len(str(error)) <= 2000
    assert str(pickle.loads(pickle.dumps(error))) == str(error)
    if isinstance(error, pinik.RobotLoadError):
        assert len(error.cause) <= 2000
        assert len(error.element or "") <= 2000


def test_a_warning_does_not_either():
    mesh = f'<visual><geometry><mesh filename="{LONG}.stl"/></geometry></visual>'
    with pytest.warns(pinik.UrdfWarning) as given:
        pinik.load(robot(link(LONG, mesh)).replace('name="r"', f'name="{LONG}"'))
    assert [len(str(warning.message)) <= 2000 for warning in given] == [True] * len(given)
