from __future__ import annotations

import dataclasses
import itertools
import re
import shlex
import subprocess
import sys

import pytest

import pinik

COMMANDS = ("solve", "solve-all", "track", "batch", "fk", "jacobian", "info", "check", "robots", "compare")


def examples(text: str) -> list[str]:
    """The example command lines in a help text."""
    lines = [line.strip() for line in text.splitlines()]
    return [line for line in lines if line.startswith(("pinik ", "echo "))]


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_every_example_in_the_help_works(run, environment, command):
    shown = run(*filter(None, [command]), "--help")
    assert shown.status == 0
    found = examples(shown.out)
    assert found
    for example in found:
        if "|" not in example:
            assert run(*shlex.split(example)[1:]).status == 0, example
            continue
        script = f'pinik() {{ {shlex.quote(sys.executable)} -m pinik "$@"; }}; {example}'
        done = subprocess.run(["bash", "-c", script], env=environment, capture_output=True, timeout=30, check=False)
        assert done.returncode == 0, done.stderr.decode()


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_lines_of_a_paragraph_end_only_where_the_next_word_has_no_room(run, command, monkeypatch):
    monkeypatch.setenv("COLUMNS", "70")
    monkeypatch.setenv("TERMINAL_WIDTH", "70")
    lines = run(*filter(None, [command]), "--help").out.partition("\u256d")[0].splitlines()[2:]
    for line, after in itertools.pairwise(lines):
        if line.strip() and after.strip() and not line.startswith("   ") and not after.startswith("   "):
            assert len(line.strip()) + len(after.split()[0]) >= 66, line


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_examples_keep_their_indent(run, command):
    lines = run(*filter(None, [command]), "--help").out.splitlines()
    title = next(line for line in lines if line.strip() in ("Example:", "Examples:"))
    shown = [line for line in lines if line.strip().startswith(("pinik ", "echo "))]
    indent = len(title) - len(title.lstrip()) + 2
    assert all(line.startswith(" " * indent) for line in shown)


def test_no_hyphen_in_a_text_is_painted(environment):
    done = subprocess.run(
        [sys.executable, "-m", "pinik", "solve", "--help"],
        env=environment | {"FORCE_COLOR": "1", "TERM": "xterm-256color", "COLUMNS": "200"},
        capture_output=True,
        timeout=30,
        check=True,
    )
    text = done.stdout.decode()
    assert "\x1b[1;36m--frame" in text
    assert "-0.3 0.2 0.5 --rpy 180" in text
    assert "(-x, -y, -z too)" in text


def test_the_front_page_lists_every_command(run):
    text = run("--help").out
    assert all(command in text for command in COMMANDS)


def test_the_help_of_solve_explains_every_method_and_parameter(run):
    text = run("solve", "--help").out
    for name, solver in pinik.SOLVERS.items():
        assert f"{name}:" in text
        for field in dataclasses.fields(solver):
            assert re.search(rf"\b{field.name}( \[[^\]]+\])?: ", text)


def test_the_help_says_which_units_json_has(run):
    text = " ".join(run("solve", "--help").out.replace("│", " ").split())
    assert "always in metres and radians" in text
