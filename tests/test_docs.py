"""The documentation's own claims: its Python runs, its commands answer as printed, its links lead somewhere."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import types
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from draw_gallery import FOLDER as GALLERY
from draw_gallery import PAGE as GALLERY_PAGE
from PIL import Image

import pinik

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def page_id(page: Path) -> str:
    return str(page.relative_to(ROOT))


def blocks(page: Path, language: str) -> list[str]:
    return [text for found, text in FENCE.findall(page.read_text("utf-8")) if found == language]


@dataclass(frozen=True)
class Command:
    """A command of a console block: its line, the output printed below it, and the status it should exit with."""

    page: Path
    line: str
    output: str
    status: int

    def __str__(self) -> str:
        return f"{page_id(self.page)}: {self.line}"


def commands(page: Path) -> list[Command]:
    """Each `$ …` of the page's console blocks; `$ echo $?` and a number below it give the status, else it is 0."""
    found: list[Command] = []
    for block in blocks(page, "console"):
        parts = re.split(r"^\$ ", block.replace("\\\n", " "), flags=re.MULTILINE)
        assert not parts[0].strip(), f"{page_id(page)}: a console block starts with '$ '"
        for part in parts[1:]:
            line, _, output = part.partition("\n")
            if line == "echo $?":
                before = found.pop()
                found.append(Command(page, before.line, before.output, int(output)))
            else:
                found.append(Command(page, line, output, 0))
    return found


def as_pattern(output: str) -> str:
    """What the page prints, with … for anything and blanks of any length."""
    parts = (r"\s+".join(re.escape(word) for word in part.split()) for part in output.split("…"))
    return r"\s*.*?\s*".join(parts)


COMMANDS = [command for page in PAGES for command in commands(page)]


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "python")], ids=page_id)
def test_the_python_of_a_page_runs_from_top_to_bottom(page, monkeypatch, tmp_path):
    module = types.ModuleType(page.stem.lower().replace("-", "_"))
    monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.chdir(tmp_path)
    solvers = dict(pinik.SOLVERS)
    try:
        for number, code in enumerate(blocks(page, "python"), start=1):
            exec(compile(code, f"{page_id(page)}, Python block {number}", "exec"), vars(module))
    finally:
        pinik.SOLVERS.clear()
        pinik.SOLVERS.update(solvers)
    if page == GALLERY_PAGE:
        assert_drawn_as_committed(tmp_path)


def assert_drawn_as_committed(folder: Path) -> None:
    """The pictures that the gallery's lines drew are those in the repository, up to a palette of 256 colours."""
    assert {path.name for path in folder.glob("*.png")} == {path.name for path in GALLERY.iterdir()}
    for path in GALLERY.iterdir():
        with Image.open(path) as committed, Image.open(folder / path.name) as drawn:
            assert committed.size == drawn.size
            one, other = (np.asarray(picture.convert("RGB"), dtype=float) for picture in (committed, drawn))
        assert np.abs(one - other).mean() < 2.0, f"python tools/draw_gallery.py draws {path.name} anew"


@pytest.mark.parametrize("command", COMMANDS, ids=str)
def test_a_command_answers_as_its_page_says(command):
    name, *arguments = shlex.split(command.line)
    assert name == "pinik", "pages show pinik's own commands; anything else belongs into an sh block"
    done = subprocess.run(
        [sys.executable, "-m", "pinik", *arguments],
        cwd=ROOT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert done.returncode == command.status, done.stdout
    if command.output.strip():
        assert re.fullmatch(as_pattern(command.output) + r"\s*", done.stdout, re.DOTALL), done.stdout


def test_a_page_shows_every_command_that_prints_an_answer():
    shown = {shlex.split(command.line)[1] for command in COMMANDS if command.page.name == "start.md"}
    helped = subprocess.run([sys.executable, "-m", "pinik", "--help"], capture_output=True, text=True, check=True)
    assert {"solve", "fk", "jacobian", "info", "check", "robots"} <= shown
    assert [name for name in shown if not re.search(rf"\b{name}\b", helped.stdout)] == []


def test_the_methods_page_names_every_solver_its_class_and_only_parameters_that_it_has():
    rows = re.findall(
        r"^\| `(\w+)` \| `(\w+)` \|.*\| ([^|]+) \|$", (ROOT / "docs/methods.md").read_text("utf-8"), re.MULTILINE
    )
    assert {name for name, _, _ in rows} == set(pinik.SOLVERS)
    for name, class_name, parameters in rows:
        assert pinik.SOLVERS[name] is getattr(pinik, class_name)
        assert set(re.findall(r"`(\w+)`", parameters)) <= set(pinik.SOLVERS[name]().parameters)


def anchors(page: Path) -> set[str]:
    """The page's headings as GitHub writes their anchors."""
    text = FENCE.sub("", page.read_text("utf-8"))
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_links_inside_the_repository_lead_somewhere(page):
    for link in re.findall(r"\]\(([^)\s]+)\)", FENCE.sub("", page.read_text("utf-8"))):
        if re.match(r"\w+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), f"{page_id(page)} links to {link}"
        if anchor:
            assert anchor in anchors(target), f"{page_id(page)} links to {link}"


def test_the_files_that_pages_name_exist():
    folders = "src|tests|tools|docs|urdf|benchmarks|examples"
    for page in PAGES:
        for name in re.findall(rf"`((?:{folders})/[\w./-]*)`", page.read_text("utf-8")):
            assert (ROOT / name.replace("NAME", "arm")).exists(), f"{page_id(page)} names {name}"


def test_the_make_targets_that_pages_name_exist():
    targets = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
    named = {name for page in PAGES for name in re.findall(r"(?:`|^)make (\w+)", page.read_text("utf-8"), re.MULTILINE)}
    assert {"run", "test", "lint"} <= named <= targets
