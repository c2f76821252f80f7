"""Lists as Python-Markdown reads them: what belongs to an item is indented by four blanks instead of two."""

from __future__ import annotations

import re
from collections.abc import Callable

CODE = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)


def outside_code(markdown: str, change: Callable[[str], str]) -> str:
    """Change what stands outside blocks of code; every second part is one."""
    parts = CODE.split(markdown)
    parts[::2] = [change(part) for part in parts[::2]]
    return "".join(parts)


def with_wide_lists(markdown: str) -> str:
    return outside_code(markdown, _widened)


def _widened(text: str) -> str:
    wide = re.sub(r"^ {2,3}(?=\S)", "    ", text, flags=re.MULTILINE)
    # After a second paragraph of an item, the next item begins behind an empty line.
    return re.sub(r"(\n\n {4}\S[^\n]*(?:\n {4}[^\n]+)*)\n(?=\* |\d+\. )", r"\1\n\n", wide)
