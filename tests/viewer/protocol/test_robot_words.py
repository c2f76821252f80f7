"""The words that name a robot in a command load the same robot again."""

from __future__ import annotations

import shlex

import pytest

import pinik
from pinik.viewer.protocol.robot_words import live_command, source_of
from robots import load_quietly
from urdf_texts import joint, link, robot

OWN = robot(link("base"), link("tip"), joint("turn", "base", "tip"))


def test_a_robot_of_the_catalogue_is_named():
    assert live_command(load_quietly("arm"), watched=False) == "pinik live arm"
    assert live_command(load_quietly("lion", root="free_flyer"), watched=False) == "pinik live lion --root free_flyer"


def test_a_file_is_named_by_its_path_as_it_was_given(tmp_path, monkeypatch):
    folder = tmp_path / "my robots"
    folder.mkdir()
    (folder / "arm.urdf").write_text(OWN.replace('name="r"', 'name="arm"', 1))  # named as one in the catalogue
    monkeypatch.chdir(tmp_path)
    given = "my robots/arm.urdf"
    machine = pinik.load(given, package_dirs=[folder], allow_outside=True)
    words = shlex.split(live_command(machine, watched=True) or "")
    assert words == ["pinik", "live", given, "--package-dir", str(folder), "--allow-outside", "--watch"]
    again = pinik.load(words[2])
    assert (source_of(machine), again.description.path) == (given, machine.description.path)


@pytest.mark.parametrize("watched", [True, False])
def test_a_robot_from_text_has_no_command(watched):
    assert live_command(pinik.load(OWN), watched) is None
