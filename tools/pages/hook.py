"""What MkDocs is told while it builds the site: more pages, links that lead out of docs/, and formulas as MathML."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from api_names import check_public_names
from formulas import set_formulas_of, with_formulas
from links import with_links_of_the_site
from lists import with_wide_lists
from live_pictures import PLAYED, filmed, with_animations
from messages_found import as_list_again, with_messages_as_sections
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from notebook_page import notebook_page, notebooks_page, title_of

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """The navigation, with notebooks and pages that mkdocs.yml does not name."""
    check_public_names(ROOT)
    parts = {name: part for entry in config.nav for name, part in entry.items()}
    parts["Notebooks"].append("notebooks/index.md")
    parts["Notebooks"].extend({title_of(path): f"notebooks/{path.stem}.md"} for path in NOTEBOOKS)
    named = set(_paths(config.nav))
    parts["Guide"].extend(path.name for path in sorted(Path(config.docs_dir).glob("*.md")) if path.name not in named)
    parts["About"].extend([{"Contributing": "contributing.md"}, {"Changelog": "changelog.md"}])
    return config


def _paths(nav: Any) -> list[str]:
    if isinstance(nav, str):
        return [nav]
    parts = nav.values() if isinstance(nav, dict) else nav
    return [path for part in parts for path in _paths(part)]


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Pages and pictures that are made from files outside docs/."""
    made: dict[str, str | bytes] = {
        "changelog.md": (ROOT / "CHANGELOG.md").read_text("utf-8"),
        "contributing.md": (ROOT / "CONTRIBUTING.md").read_text("utf-8"),
        "notebooks/index.md": notebooks_page(NOTEBOOKS),
    }
    made.update({f"live/{name}.html": filmed(play).animation() for name, play in PLAYED.items()})
    for path in NOTEBOOKS:
        made[f"notebooks/{path.stem}.md"], pictures = notebook_page(path)
        made.update({f"notebooks/{name}": content for name, content in pictures.items()})
        made[f"notebooks/{path.name}"] = path.read_bytes()
    for place, content in made.items():
        files.append(File.generated(config, place, content=content))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    if page.file.src_uri.startswith("howto/"):
        page.meta["search"] = {"boost": 2}  # answers to questions come before other pages
    text = with_links_of_the_site(markdown, page.file.src_uri, lambda place: place in files.src_uris)
    return with_wide_lists(text)


def on_page_content(html: str, page: Page, **_: Any) -> str:
    if page.file.src_uri == "errors.md":
        html = with_messages_as_sections(html)
    set_formulas_of(page.toc)
    return with_animations(with_formulas(html))


def on_post_page(output: str, page: Page, **_: Any) -> str:
    return as_list_again(output) if page.file.src_uri == "errors.md" else output
