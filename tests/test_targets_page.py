"""docs/targets.md: its three ways ask for the same, its answers are good, and each kind has its picture."""

from __future__ import annotations

import json
import re
import shlex

import draw_targets
import numpy as np
import pytest
from PIL import Image

import pinik
from judge import assert_good
from pinik.cli import main

SECTIONS = {
    re.search(r"\(images/targets/(\w+)\.png\)", section)[1]: section
    for section in re.split(r"^## ", draw_targets.PAGE.read_text("utf-8"), flags=re.MULTILINE)[1:]
}
LARGEST = 120_000  # bytes of a picture


@pytest.fixture(scope="module")
def answers():
    return draw_targets.answers()


def first_block(name: str, language: str) -> str:
    return re.search(rf"^```{language}\n(.*?)^```$", SECTIONS[name], re.MULTILINE | re.DOTALL)[1]


def test_each_kind_has_one_picture():
    names = {path.stem for path in draw_targets.FOLDER.iterdir()}
    assert names == set(SECTIONS) == set(draw_targets.VIEWS)


@pytest.mark.parametrize("name", SECTIONS)
def test_a_picture_shows_what_the_page_asks_for_today(name, answers):
    file = draw_targets.FOLDER / f"{name}.png"
    assert file.stat().st_size <= LARGEST
    with Image.open(file) as picture:
        assert picture.size == draw_targets.SIZE
        shown = picture.text["Description"]
    assert shown == draw_targets.description(name, answers[name][0]), "python tools/draw_targets.py draws it anew"


@pytest.mark.parametrize("name", SECTIONS)
def test_the_answer_in_a_picture_is_within_tolerance(name, answers):
    assert_good(answers[name][0])


@pytest.mark.parametrize("name", SECTIONS)
def test_the_json_of_a_kind_asks_for_what_its_python_asks_for(name, answers):
    fields = json.loads(first_block(name, "json"))
    assert tuple(pinik.Target.from_dict(target) for target in fields) == answers[name][0].targets


@pytest.mark.parametrize("name", SECTIONS)
def test_the_command_of_a_kind_gives_the_answer_of_its_python(name, answers, capfd, monkeypatch):
    monkeypatch.chdir(draw_targets.ROOT)
    line = first_block(name, "console").replace("\\\n", " ").split("\n")[0]
    words = shlex.split(line.removeprefix("$ pinik "))
    capfd.readouterr()
    assert main([*words, "--json"]) == 0
    solution = answers[name][0]
    np.testing.assert_allclose(json.loads(capfd.readouterr().out)["q"], solution.q, atol=1e-6)
