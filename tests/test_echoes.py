"""What messages quote is shortened in one way: it loses its middle, and keeps its beginning and its end."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from pinik.cli.reports.flaw_json import flaw_fields
from pinik.description.flaw import Flaw
from pinik.description.lint.front import lint
from pinik.description.reader import read
from pinik.echoes import shortened
from urdf_texts import LIMIT, joint, link, pair, robot

LONG = "first" + "x" * 4990 + "final"


@given(st.text(max_size=40), st.integers(4, 50))
def test_a_shortened_text_is_bounded_and_a_short_one_stays(words, most):
    short = shortened(words, most)
    assert len(short) <= most
    assert short == words or ("…" in short and words.startswith(short.partition("…")[0]))


def fault(text: str) -> str:
    with pytest.raises(pinik.RobotLoadError) as caught:
        read(text)
    return str(caught.value)


def flaw(given: str | bytes, code: str) -> str:
    document = given.encode() if isinstance(given, str) else given
    return next(str(one) for one in (*read(document).warnings, *lint(document)) if one.code == code)


QUOTES = {
    "a number": lambda: fault(pair(f'<origin xyz="{LONG} 0 0"/>')),
    "a xacro expression": lambda: fault(robot(link("first${x}" + LONG))),
    "a path": lambda: fault(f"/{LONG}"),
    "an unknown attribute": lambda: flaw(pair(f'<origin {LONG}="1"/>'), "unknown-name"),
    "an unknown element": lambda: flaw(pair(f"<origin><{LONG}/></origin>"), "unknown-name"),
    "a name that the lint says": lambda: flaw(
        robot(link("a"), link("b"), joint(LONG, "a", "b", limit=LIMIT.replace('"3"', '"-3"'))), "no-travel"
    ),
    "text": lambda: flaw(pair(f"<origin>{LONG}</origin>"), "stray-text"),
    "an encoding": lambda: flaw(
        f'<?xml version="1.0" encoding="{LONG[:200]}final"?>{robot(link("ä"))}'.encode(), "encoding"
    ),
    "an entry of a report": lambda: flaw_fields(Flaw("link 'a'", "a cause", code="other", mend=LONG))["mend"],
}


@pytest.mark.parametrize("quote", QUOTES.values(), ids=QUOTES)
def test_what_is_quoted_keeps_its_beginning_and_its_end(quote):
    message = quote()
    assert "first" in message
    assert "x…x" in message
    assert "final" in message
    assert len(message) < 1200
