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


def test_there_are_notebooks_and_their_numbers_are_in_order():
    numbers = [int(path.stem.split("_")[0]) for path in NOTEBOOKS]
    assert len(numbers) == len(set(numbers)) > 0


@each_notebook
def test_it_runs_in_a_fresh_kernel(path):
    for output in outputs(run_notebooks.run(path)):
        assert output.output_type != "error"
        assert output.get("name") != "stderr", output.text


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
