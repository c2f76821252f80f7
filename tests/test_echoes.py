"""What messages quote is shortened in one way: it loses its middle, and keeps its beginning and its end."""

from __future__ import annotations

import ast
import json
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from pinik.cli.inputs.targets import targets_from_file
from pinik.cli.reports.flaw_json import flaw_fields
from pinik.cli.terminal.exits import CommandError
from pinik.description.flaw import Flaw
from pinik.description.lint.front import lint
from pinik.description.reader import read
from pinik.echoes import shortened
from pinik.shapes.mesh_checks import MeshError, checked
from pinik.viewer.protocol.messages import text as message_text
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


def refusal(kind: type[Exception], ask: Callable[..., object], *given: object) -> str:
    with pytest.raises(kind) as caught:
        ask(*given)
    return str(caught.value)


def refused_targets(text: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "targets.json")
        file.write_text(text, "utf-8")
        return refusal(CommandError, targets_from_file, str(file))


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
    "a file of targets": lambda: refused_targets(json.dumps(LONG)),
    "a count in a mesh": lambda: refusal(
        MeshError, checked, b"ply\nelement %s many\nend_header" % LONG.encode(), "ply"
    ),
    "a message of the page": lambda: refusal(pinik.InputError, message_text, "name", LONG),
    "an entry of a report": lambda: flaw_fields(Flaw("link 'a'", "a cause", code="other", mend=LONG))["mend"],
}


@pytest.mark.parametrize("quote", QUOTES.values(), ids=QUOTES)
def test_what_is_quoted_keeps_its_beginning_and_its_end(quote):
    message = quote()
    assert "first" in message
    assert "x…x" in message
    assert "final" in message
    assert len(message) < 1200


def cuts(source: str) -> list[int]:
    """The lines on which a message quotes a long beginning of something, as `name[:60]` does, and drops its end."""
    return [
        part.lineno
        for text in ast.walk(ast.parse(source))
        if isinstance(text, ast.JoinedStr)
        for part in ast.walk(text)
        if isinstance(part, ast.Slice)
        and part.lower is None
        and isinstance(part.upper, ast.Constant)
        and part.upper.value > 20
    ]


def test_no_message_cuts_what_it_quotes_in_a_way_of_its_own():
    assert cuts('f"{name[:60]!r}"') == [1]
    root = Path(pinik.__file__).parent
    found = {str(path.relative_to(root)): cuts(path.read_text("utf-8")) for path in root.rglob("*.py")}
    assert {name: lines for name, lines in found.items() if lines} == {}
