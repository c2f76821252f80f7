"""Run notebooks from top to bottom and save them with their outputs.

The outputs stay as the cells made them, with times, ports, ids and this machine's last digits; metadata about the
kernel and the time of day is removed.

python tools/run_notebooks.py             # all of notebooks/
python tools/run_notebooks.py 05 06       # those whose names start with 05 or 06
"""

from __future__ import annotations

import argparse
import re
import time
from collections.abc import Sequence
from pathlib import Path

import nbformat
from nbclient import NotebookClient

FOLDER = Path(__file__).parents[1] / "notebooks"
LONGEST = 120  # the most time for one cell [s]
_SOLUTION = re.compile(r"<summary>Solution</summary>.*?^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def solutions(notebook: nbformat.NotebookNode) -> list[str]:
    """The code in the folded solutions of a notebook's exercises."""
    return [code for cell in notebook.cells if cell.cell_type == "markdown" for code in _SOLUTION.findall(cell.source)]


def run(path: Path, *, with_solutions: bool = False) -> nbformat.NotebookNode:
    """Execute a notebook in a fresh kernel in its own folder, without changing the file.

    With `with_solutions` the code of its solutions is run after its own cells, as cells at its end.

    Raises:
        nbclient.exceptions.CellExecutionError: A cell raised an exception; the message shows it.
    """
    notebook = nbformat.read(path, as_version=4)
    if with_solutions:
        notebook.cells += [nbformat.v4.new_code_cell(code) for code in solutions(notebook)]
    client = NotebookClient(
        notebook,
        timeout=LONGEST,
        kernel_name="python3",
        extra_arguments=["--log-level=ERROR"],  # silences a warning about unencrypted connections
        record_timing=False,
        coalesce_streams=True,
        resources={"metadata": {"path": str(path.parent)}},
    )
    client.execute()
    return tidy(notebook)


def tidy(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """Remove metadata about the machine's Python and the time of day; the outputs themselves are unchanged."""
    notebook.metadata = nbformat.from_dict(
        {
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"},
        }
    )
    for number, cell in enumerate(notebook.cells):
        cell.metadata = nbformat.from_dict({})
        cell.id = f"cell-{number}"
        for output in cell.get("outputs", ()):
            if "metadata" in output:
                output.metadata = nbformat.from_dict({})
    return notebook


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "names", nargs="*", default=[""], help="the first characters of the notebooks' names; all notebooks by default"
    )
    names = parser.parse_args(arguments).names
    paths = sorted(FOLDER.glob("*.ipynb"))
    for name in names:
        if not any(path.name.startswith(name) for path in paths):
            parser.error(
                f"no notebook's name starts with {name!r}; there are: {', '.join(path.stem for path in paths)}"
            )
    for path in paths:
        if path.name.startswith(tuple(names)):
            began = time.perf_counter()
            nbformat.write(run(path), path)
            print(f"{path.name}: {time.perf_counter() - began:.1f} s, {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
