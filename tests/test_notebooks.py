"""The notebooks run from top to bottom, and what is committed is what they showed when they did."""

from __future__ import annotations

import base64
import getpass
import re
import struct
from pathlib import Path

import nbformat
import pytest
import run_notebooks

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
LARGEST = 1_000_000  # bytes, so that they open quickly and git stays small
AGAINST_THE_CLOCK = ("07_live_view",)  # what its robots have reached when a cell looks is not always the same
OF_A_MACHINE = re.compile(
    r"/home/|/root\b|/tmp/|/Users/|/usr/|[A-Z]:\\\\|site-packages|https?://(?:[\w.-]*pypi|files\.pyth)"
)

each_notebook = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def read(path):
    return nbformat.read(path, as_version=4)


def code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def outputs(notebook):
    return [output for cell in code_cells(notebook) for output in cell.outputs]


def pictures(notebook):
    """The PNGs that a notebook shows."""
    found = [output.get("data", {}).get("image/png") for output in outputs(notebook)]
    return [base64.b64decode(png) for png in found if png]


def texts(notebook):
    """Everything readable: sources and outputs, without the pictures' own bytes."""
    for cell in notebook.cells:
        yield cell.source
    for output in outputs(notebook):
        yield output.get("text", "")
        for kind, data in output.get("data", {}).items():
            if not kind.startswith("image/") or kind == "image/svg+xml":
                yield re.sub(r"data:image/\w+;base64,[\w+/=\s]+", "", str(data))


def masked(text):
    """Its words: numbers, which end differently on other machines, and their units are alike, and columns closed up."""
    text = re.sub(r"(?<![\w.])[-−]?\d+(?:,\d{3})*\.?\d*(?:e[-+]?\d+)?(?:\s*(?:[nµmc]?m|[nµm]?s)\b)?", "#", text)
    return re.sub(r"(?<=\[) | (?=\])", "", re.sub(r"\s+", " ", text)).strip()


def shown(output, told):
    """Of what kind an output is, and its words."""
    if output.output_type == "stream":
        return output.name, masked(output.text) if told else ""
    data = output.get("data", {})
    return output.output_type, sorted(data), masked(data.get("text/plain", ""))


def test_there_are_notebooks_and_their_numbers_are_in_order():
    assert [path.stem.split("_")[0] for path in NOTEBOOKS] == ["01", "02", "03", "04", "05", "06", "07", "08", "09"]


@each_notebook
def test_it_runs_in_a_fresh_kernel_and_shows_what_is_committed(path):
    fresh, committed = run_notebooks.run(path, with_solutions=True), read(path)
    for output in outputs(fresh):
        assert output.output_type != "error"
        assert output.get("name") != "stderr", output.text
    told = path.stem not in AGAINST_THE_CLOCK
    solutions = run_notebooks.solutions(committed)
    shown_cells, solved_cells = code_cells(fresh)[: -len(solutions)], code_cells(fresh)[-len(solutions) :]
    assert [cell.source for cell in solved_cells] == solutions
    for cell, before in zip(shown_cells, code_cells(committed), strict=True):
        assert [shown(one, told) for one in cell.outputs] == [shown(one, told) for one in before.outputs], cell.source


def test_what_is_compared_are_words_and_not_digits_units_or_columns():
    one = "[ 0.5   -0.   1.2e-09]  in joint1: 0.49 µm off, 1,000 ms, 2.5, 3"
    other = "[0.4999 0. 1]  in joint1: 1.2 mm off, 3 s, 2, 3"
    assert masked(one) == masked(other) == "[# # #] in joint1: # off, #, #, #"
    for one, other in (("joint1", "joint2"), ("converged", "stalled"), ("True", "False"), ("3 4", "3")):
        assert masked(one) != masked(other)


@each_notebook
def test_it_ends_with_exercises_and_each_solution_checks_itself(path):
    notebook = read(path)
    sources = [cell.source for cell in notebook.cells]
    begin = next(k for k, source in enumerate(sources) if source.startswith("## Exercises"))
    exercises = sources[begin + 1 :]
    assert len(exercises) >= 2
    for number, exercise in enumerate(exercises, start=1):
        assert exercise.startswith(f"**{number}.** ")
        question, _, solution = exercise.partition("<details>\n<summary>Solution</summary>\n\n```python\n")
        assert question.strip()
        assert "assert " in solution
        assert solution.endswith("\n\n</details>")
    assert len(run_notebooks.solutions(notebook)) == len(exercises)


@pytest.mark.parametrize("names", [["99"], ["01", "two"]])
def test_a_name_of_no_notebook_is_an_error_and_nothing_is_run(names, monkeypatch, capsys):
    monkeypatch.setattr(run_notebooks, "run", lambda path: pytest.fail("it ran"))
    with pytest.raises(SystemExit):
        run_notebooks.main(names)
    assert f"no notebook's name starts with {names[-1]!r}; there are: 01_your_urdf" in capsys.readouterr().err


@each_notebook
def test_it_was_run_from_top_to_bottom_before_it_was_committed(path):
    counts = [cell.execution_count for cell in code_cells(read(path))]
    assert counts == list(range(1, len(counts) + 1))


@each_notebook
def test_it_shows_pictures_and_neither_errors_nor_warnings(path):
    notebook = read(path)
    kinds = {output.output_type for output in outputs(notebook)}
    assert kinds <= {"stream", "display_data", "execute_result"}
    assert [output.text for output in outputs(notebook) if output.get("name") == "stderr"] == []
    sizes = [struct.unpack(">II", png[16:24]) for png in pictures(notebook)]
    assert sizes, "a notebook without a picture"
    assert all(min(size) >= 100 for size in sizes)


@each_notebook
def test_it_begins_with_its_title(path):
    first, *others = read(path).cells
    assert first.cell_type == "markdown"
    assert first.source.startswith("# ")
    assert not any(cell.cell_type == "markdown" and cell.source.startswith("# ") for cell in others)


@each_notebook
def test_it_is_small_and_knows_nothing_of_a_machine(path):
    assert path.stat().st_size < LARGEST
    found = [match.group() for text in texts(read(path)) for match in OF_A_MACHINE.finditer(text)]
    assert found == []
    user = getpass.getuser()
    assert user == "root" or not any(re.search(rf"\b{re.escape(user)}\b", text) for text in texts(read(path)))


@each_notebook
def test_its_file_is_as_the_tool_writes_it(path):
    """No hour, no Python's version, no ids by chance: running it again changes what changed and nothing else."""
    assert nbformat.writes(run_notebooks.tidy(read(path))) + "\n" == path.read_text("utf-8")
