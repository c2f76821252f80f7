"""Each message on the page of errors is a section for the search, which leads to it; readers see a list."""

from __future__ import annotations

import html as entities
import re

from pymdownx.slugs import slugify

MESSAGE = re.compile(r"<li>(<code>(?P<message>.*?)</code>)</li>")
_LONGEST = 60


def with_messages_as_sections(html: str) -> str:
    """Headings in place of the messages, as the search takes headings and what follows them for sections."""
    taken: dict[str, int] = {}

    def heading(match: re.Match[str]) -> str:
        words = re.sub(r"[\W_]+", " ", entities.unescape(match["message"]))
        name = slugify(case="lower")(words.strip(), "-")[:_LONGEST].strip("-")
        taken[name] = taken.get(name, 0) + 1
        place = name if taken[name] == 1 else f"{name}_{taken[name]}"
        return f'<li><h6 class="message" id="message-{place}">{match[1]}</h6></li>'

    return MESSAGE.sub(heading, html)


def as_list_again(html: str) -> str:
    return re.sub(r'<h6 class="message"(.*?)</h6>', r'<span class="message"\1</span>', html)
