"""Files of lines, in chunks of a fixed number of lines, which may be read in any order."""

from __future__ import annotations

import codecs
from dataclasses import dataclass
from pathlib import Path

import numpy as np

__all__ = ["Line", "LinesFile", "RawLines", "not_utf8"]

_PIECE = 1 << 22  # [bytes]

Line = tuple[int, str]
"""The number of a line, from 1, and its text without the line break."""


def not_utf8(error: UnicodeDecodeError) -> str:
    """The reason why a line cannot be read."""
    return f"not UTF-8: {error.reason} at byte {error.start} of the line"


@dataclass(frozen=True)
class RawLines:
    """Neighbouring lines of a file.

    Attributes:
        first: The number of the first line, from 1.
        content: Their bytes.
    """

    first: int
    content: bytes

    def text(self) -> str | None:
        """All lines as one text without its last line break; None if it is not UTF-8 or needs a closer look."""
        try:
            text = self.content.decode()
        except UnicodeDecodeError:
            return None
        if "\r" in text:
            text = text.replace("\r\n", "\n")
        text = text.removesuffix("\n")
        return None if "\n\n" in text or text.startswith("\n") or "\r" in text or not text.strip() else text

    def lines(self) -> list[tuple[int, str | UnicodeDecodeError]]:
        """Each line that is not blank, with its number; or the error, if it is not UTF-8."""
        found: list[tuple[int, str | UnicodeDecodeError]] = []
        for number, line in enumerate(self.content.split(b"\n"), start=self.first):
            try:
                text = line.decode().strip("\r")
            except UnicodeDecodeError as error:
                found.append((number, error))
                continue
            if text.strip():
                found.append((number, text))
        return found


class LinesFile:
    """A file of lines.

    Attributes:
        header: The first line that is not blank, if there is to be a header, with its number.
        chunks: The number of chunks after the header.
    """

    def __init__(self, path: Path, rows: int, *, has_header: bool) -> None:
        """Find the lines.

        Args:
            path: The file.
            rows: The number of lines in a chunk.
            has_header: Whether the first line that is not blank is a header.

        Raises:
            OSError: The file cannot be read.
            UnicodeDecodeError: The header is not UTF-8.
        """
        self._file = path.open("rb")
        self.header: Line | None = None
        try:
            self._first, self._rows = self._read_header(has_header), rows
            self._starts = self._find_starts()
        except BaseException:
            self.close()
            raise

    def _read_header(self, has_header: bool) -> int:
        """Read the header, and return the number of the line after it."""
        mark = self._file.read(3)
        self._file.seek(0 if mark != codecs.BOM_UTF8 else 3)
        line = 1
        while has_header and self.header is None and (raw := self._file.readline()):
            text = raw.decode().strip("\r\n")
            if text.strip():
                self.header = line, text
            line += 1
        return line

    def _find_starts(self) -> list[int]:
        """Where each chunk begins, and where the last one ends [bytes]."""
        begin = self._file.tell()
        starts, lines, at = [begin], 0, begin
        while piece := self._file.read(_PIECE):
            breaks = np.flatnonzero(np.frombuffer(piece, dtype=np.uint8) == 10)
            starts += (at + breaks[self._rows - 1 - lines % self._rows :: self._rows] + 1).tolist()
            lines += len(breaks)
            at += len(piece)
        return starts if starts[-1] == at else [*starts, at]

    @property
    def chunks(self) -> int:
        """The number of chunks."""
        return len(self._starts) - 1

    def raw(self, number: int) -> RawLines:
        """One chunk."""
        begin, end = self._starts[number : number + 2]
        self._file.seek(begin)
        return RawLines(self._first + number * self._rows, self._file.read(end - begin))

    def close(self) -> None:
        """Close the file."""
        self._file.close()
