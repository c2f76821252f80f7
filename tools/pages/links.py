"""Links of the repository's Markdown as they are in the site, where some pages stand elsewhere or are missing."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable

from lists import outside_code

ELSEWHERE = {
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "README.md": "index.md",
    "notebooks": "notebooks/index.md",
}
LINK = re.compile(r"(?P<before>!?\[(?P<text>[^\]]*)\]\()(?P<address>[^)#\s]+)(?P<anchor>#[^)\s]*)?\)")


def with_links_of_the_site(markdown: str, source: str, is_there: Callable[[str], bool]) -> str:
    """Links to pages as they are in the site; a file that is not there is named without a link.

    Args:
        markdown: The text of a page.
        source: Where the page is in the site.
        is_there: Whether the site has a file at a place.
    """
    folder = posixpath.dirname(_in_repository(source))

    def moved(link: re.Match[str]) -> str:
        if re.match(r"\w+:", link["address"]):
            return link.group()
        target = posixpath.normpath(posixpath.join(folder, link["address"]))
        place = _in_site(target)
        if not is_there(place):
            return link.group() if target.startswith("docs/") else link["text"]
        way = posixpath.relpath(place, posixpath.dirname(source) or ".")
        return f"{link['before']}{way}{link['anchor'] or ''})"

    return outside_code(markdown, lambda text: LINK.sub(moved, text))


def _in_repository(place: str) -> str:
    """The file of the repository from which a page is made."""
    outside = {there: file for file, there in ELSEWHERE.items() if there not in ("index.md", "notebooks/index.md")}
    return outside.get(place, place if place.startswith("notebooks/") else f"docs/{place}")


def _in_site(target: str) -> str:
    if target in ELSEWHERE:
        return ELSEWHERE[target]
    return re.sub(r"^(notebooks/.*)\.ipynb$", r"\1.md", target.removeprefix("docs/"))
