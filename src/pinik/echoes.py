"""What messages echo, such as names from files: bounded in length, and on one line."""

from __future__ import annotations

import re

__all__ = ["QUOTED", "bounded", "one_line", "shortened"]

MOST = 2000
"""The most characters of a message."""
QUOTED = 60
"""The most characters of a name or value that a message quotes."""
MOST_REPORTED = 1000
"""The most characters of an entry in a report."""
MOST_UNBROKEN = 300
"""The most characters of a message without white space between them, such as a name or a path."""

# Control characters, and those that reverse the direction of text, would change what a terminal shows.
_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def bounded(words: str) -> str:
    """The message itself if it is short; otherwise long names in it, and the whole, lose their middle."""
    if len(words) <= MOST_UNBROKEN:
        return words
    return shortened(re.sub(r"\S+", lambda name: shortened(name.group(), MOST_UNBROKEN), words), MOST)


def one_line(words: str) -> str:
    """The message, bounded, with spaces instead of line breaks and with other control characters escaped."""
    joined = re.sub(r"\s*[\r\n]\s*", " ", bounded(words).strip())
    return _CONTROL.sub(lambda control: control.group().encode("unicode_escape").decode(), joined)


def shortened(words: str, most: int = MOST_REPORTED) -> str:
    """A text of at most `most` characters: a longer one loses its middle, with "…" in its place."""
    if len(words) <= most:
        return words
    end = most // 4
    return f"{words[: most - end - 1]}…{words[-end:]}"
