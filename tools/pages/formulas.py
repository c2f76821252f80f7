"""LaTeX in pages becomes MathML while the site is built, so that browsers need no script for it."""

from __future__ import annotations

import html as entities
import re
from collections.abc import Iterable

from latex2mathml.converter import convert
from mkdocs.structure.toc import AnchorLink

FORMULA = re.compile(
    r'<(?P<tag>span|div) class="arithmatex">\\(?P<open>[(\[])(?P<tex>.*?)\\[)\]]</(?P=tag)>', re.DOTALL
)


def with_formulas(html: str) -> str:
    return FORMULA.sub(_formula, html)


def set_formulas_of(entries: Iterable[AnchorLink]) -> None:
    """Give the entries of a table of contents, which hold the LaTeX of their headings, formulas as well."""
    for entry in entries:
        entry.title = re.sub(r"\\\((.*?)\\\)", lambda tex: convert(entities.unescape(tex[1])), entry.title)
        set_formulas_of(entry.children)


def _formula(match: re.Match[str]) -> str:
    wide = match["open"] == "["
    maths = convert(entities.unescape(match["tex"]).strip(), display="block" if wide else "inline")
    return f'<div class="formula">{maths}</div>' if wide else maths
