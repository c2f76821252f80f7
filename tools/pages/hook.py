"""What MkDocs is told while it builds the site: more pages, links that lead out of docs/, and formulas as MathML."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import Any

from api_names import check_public_names
from formulas import with_formulas
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from notebook_page import notebook_page, title_of

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
ELSEWHERE = {"CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md", "README.md": "index.md"}
LINK = re.compile(r"(?P<before>!?\[(?P<text>[^\]]*)\]\()(?P<address>\.\./[^)#\s]*)(?P<anchor>#[^)\s]*)?\)")


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    check_public_names(ROOT)
    parts = {name: part for entry in config.nav for name, part in entry.items()}
    parts["Notebooks"].append("notebooks/index.md")
    parts["Notebooks"].extend({title_of(path): f"notebooks/{path.stem}.md"} for path in NOTEBOOKS)
    parts["About"].extend([{"Contributing": "contributing.md"}, {"Changelog": "changelog.md"}])
    # A guide that was added to docs/ is found without a change here.
    named = set(_paths(config.nav))
    docs = Path(config.docs_dir)
    parts["Guide"].extend(path.name for path in sorted(docs.glob("*.md")) if path.name not in named)
    return config


def _paths(nav: Any) -> list[str]:
    if isinstance(nav, str):
        return [nav]
    parts = nav.values() if isinstance(nav, dict) else nav
    return [path for part in parts for path in _paths(part)]


def on_files(files: Files, config: MkDocsConfig) -> Files:
    for name, place in ELSEWHERE.items():
        if name != "README.md":
            files.append(File.generated(config, place, content=(ROOT / name).read_text("utf-8")))
    rows = []
    for path in NOTEBOOKS:
        text, pictures = notebook_page(path)
        files.append(File.generated(config, f"notebooks/{path.stem}.md", content=text))
        for name, content in pictures.items():
            files.append(File.generated(config, f"notebooks/{name}", content=content))
        rows.append(f"* [{title_of(path)}]({path.stem}.md)")
    introduction = (
        "# Notebooks\n\nInverse kinematics explained with pictures, from a URDF to every answer there is. Read them here, "
        "or run them with `pip install 'pinik[notebooks]'` and `jupyter lab notebooks`. Each ends with exercises and "
        "their solutions.\n\n"
    )
    files.append(File.generated(config, "notebooks/index.md", content=introduction + "\n".join(rows) + "\n"))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Links out of docs/ lead to the page that the site has in their place; a file that it has not is named without a link."""
    source = page.file.src_uri
    home = {"changelog.md": "", "contributing.md": ""}.get(source, posixpath.join("docs", posixpath.dirname(source)))
    if source.startswith("notebooks/"):
        home = "notebooks"

    def moved(match: re.Match[str]) -> str:
        before, text, address = match["before"], match["text"], match["address"]
        if re.match(r"\w+:|#", address):
            return match.group()
        target = posixpath.normpath(posixpath.join(home, address))
        place = _place(target)
        if place is None:
            return text if before.startswith("[") else match.group()
        if files.get_file_from_path(place) is None:
            return match.group()
        there = posixpath.relpath(place, posixpath.dirname(source) or ".")
        return f"{before}{there}{match['anchor'] or ''})"

    link = re.compile(LINK.pattern.replace(r"\.\./", "")) if home in ("", "notebooks") else LINK
    parts = re.split(r"(^```.*?^```$)", markdown, flags=re.MULTILINE | re.DOTALL)
    return "".join(part if part.startswith("```") else link.sub(moved, part) for part in parts)


def _place(target: str) -> str | None:
    """Where in the site a file of the repository is; None if it is not there."""
    if target in ELSEWHERE:
        return ELSEWHERE[target]
    if target == "notebooks":
        return "notebooks/index.md"
    if target.startswith("notebooks/"):
        return target.removesuffix(".ipynb") + ".md" if target.endswith(".ipynb") else target
    return target.removeprefix("docs/") if target.startswith("docs/") else None


def on_page_content(html: str, **_: Any) -> str:
    return with_formulas(html)
