"""Tables: formatted by rich in a terminal, aligned plain text everywhere else."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Collection, Iterable, Sequence

from .output import emit, is_terminal

__all__ = ["emit_names", "emit_table"]


def emit_table(
    titles: Sequence[str],
    rows: Iterable[Sequence[str]],
    *,
    numeric: Collection[str] = (),
    marked: Collection[int] = (),
) -> None:
    """Write a table to stdout.

    Args:
        titles: The column titles.
        rows: One text for each column.
        numeric: The titles of right-aligned columns.
        marked: The indices of the rows to highlight.
    """
    cells = [list(row) for row in rows]
    if is_terminal(sys.stdout):
        _emit_rich(titles, cells, numeric, marked)
    else:
        _emit_plain(titles, cells, numeric)


def emit_names(names: Sequence[str]) -> None:
    """Write many names: in columns in a terminal, otherwise one per line."""
    if not is_terminal(sys.stdout):
        emit("\n".join(names))
        return
    width = max(map(len, names), default=0) + 2
    columns = max(1, shutil.get_terminal_size().columns // width)
    height = -(-len(names) // columns)
    lines = ("".join(name.ljust(width) for name in names[i::height]).rstrip() for i in range(height))
    emit("\n".join(lines))


def _emit_plain(titles: Sequence[str], cells: list[list[str]], numeric: Collection[str]) -> None:
    lines = [list(titles), *cells]
    widths = [max(len(line[i]) for line in lines) for i in range(len(titles))]
    for line in lines:
        padded = (
            cell.rjust(width) if title in numeric else cell.ljust(width)
            for cell, width, title in zip(line, widths, titles, strict=True)
        )
        emit("  ".join(padded).rstrip())


def _emit_rich(
    titles: Sequence[str], cells: list[list[str]], numeric: Collection[str], marked: Collection[int]
) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, header_style="bold")
    for title in titles:
        table.add_column(Text(title), justify="right" if title in numeric else "left", overflow="fold")
    for index, row in enumerate(cells):
        table.add_row(*map(Text, row), style="yellow" if index in marked else None)
    console = Console()
    with console.capture() as drawn:
        console.print(table, end="")
    emit(drawn.get().rstrip("\n"))
