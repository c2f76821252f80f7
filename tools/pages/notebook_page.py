"""A notebook as a page of the site: its texts, code and outputs as Markdown, and its pictures as files."""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from pathlib import Path

import nbformat


def title_of(path: Path) -> str:
    first = nbformat.read(path, as_version=4).cells[0].source
    return first.splitlines()[0].removeprefix("# ")


def notebooks_page(paths: Sequence[Path]) -> str:
    """The page that lists all notebooks."""
    introduction = (
        "# Notebooks\n\nInverse kinematics explained with pictures, from a URDF to every answer there is. Read them "
        "here, or run them with `pip install 'pinik[notebooks]'` and `jupyter lab notebooks`. Each ends with exercises "
        "and their solutions.\n\n"
    )
    return introduction + "".join(f"* [{title_of(path)}]({path.stem}.ipynb)\n" for path in paths)


def notebook_page(path: Path) -> tuple[str, dict[str, bytes]]:
    """The Markdown of a notebook, and its pictures by their file names."""
    parts: list[str] = []
    pictures: dict[str, bytes] = {}
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "markdown":
            parts.append(cell.source.replace("<details>", '<details markdown="1">'))
            continue
        parts.append(_fenced(cell.source, "python"))
        for output in cell.outputs:
            data = output.get("data", {})
            if "image/png" in data:
                name = f"{path.stem}-{len(pictures) + 1}.png"
                pictures[name] = base64.b64decode(data["image/png"])
                parts.append(f"![What the code above draws]({name}){{ .output }}")
            elif text := output.get("text") or data.get("text/plain"):
                parts.append(_fenced(text.rstrip(), "text title=''"))
    parts[0] = parts[0].replace("\n", f'\n\n<a href="{path.name}" download>Download this notebook</a>\n', 1)
    text = re.sub(r"^\$\$(.+?)\$\$", r"\n$$\1$$\n", "\n\n".join(parts), flags=re.MULTILINE | re.DOTALL)
    return text + "\n", pictures


def _fenced(text: str, language: str) -> str:
    return f"```{language}\n{text}\n```"
