"""What `pinik check` prints in a terminal: the flaws of a file by sort, with a few of each."""

from __future__ import annotations

import shutil
import sys
import textwrap
from collections.abc import Iterable, Sequence

from ...description.flaw import Flaw
from ...description.lint.front import NOTES
from ...echoes import shortened
from ..terminal import output
from ..terminal.units import counted
from .inspection import Inspection

__all__ = ["emit_flaws", "emit_inspection"]

_MOST_NAMED = 6
_MOST_FAULTS = 20
_LONGEST_NAME = 80
_LONGEST_CAUSE = 400


def emit_inspection(found: Inspection) -> None:
    """Print an inspection: the verdict, the faults, the flaws by sort, the second opinion, and the counts."""
    verdict = "loads" if found.loads else "cannot be loaded"
    sorts = {flaw.code for flaw in found.warnings}
    amount = f", with {counted(len(found.warnings), 'warning')}" if found.warnings else ""
    kinds = f" of {len(sorts)} sorts" if len(sorts) > 1 else ""
    color = "red" if not found.loads else "yellow" if found.warnings else "green"
    output.emit(output.painted(f"{found.file}: {verdict}{amount}{kinds}", color))
    for fault in found.faults[:_MOST_FAULTS]:
        where = f"{shortened(fault.element, _LONGEST_NAME)}: " if fault.element else ""
        output.emit(output.painted("fault: ", "red") + where + shortened(fault.message, _LONGEST_CAUSE))
    if len(found.faults) > _MOST_FAULTS:
        output.emit(f"and {len(found.faults) - _MOST_FAULTS:,} more faults")
    if found.expanded and found.flaws:
        output.emit("the lines below are those of the URDF that xacro makes of the file")
    emit_flaws(found.flaws)
    opinion = found.second_opinion
    if opinion is not None:
        words = shortened(str(opinion), _LONGEST_CAUSE)
        output.emit(words if opinion.agrees else f"{output.painted('warning:', 'yellow')} {words}")
    if found.loads:
        counts = {"link": found.links, "joint": found.joints, "mesh": found.meshes, "shape": found.shapes}
        output.emit(", ".join(counted(count, noun) for noun, count in counts.items()))


def emit_flaws(flaws: Iterable[Flaw]) -> None:
    """Print flaws by their codes, warnings first, with one entry for all that have the same cause."""
    by_code: dict[str, dict[str, list[Flaw]]] = {}
    for flaw in flaws:
        by_code.setdefault(flaw.code, {}).setdefault(flaw.common, []).append(flaw)
    for code in sorted(by_code, key=lambda code: code in NOTES):
        groups = list(by_code[code].values())
        count = sum(map(len, groups))
        word, color = ("note", "cyan") if code in NOTES else ("warning", "yellow")
        times = f", {count:,} times" if count > 1 else ""
        output.emit(output.painted(f"{word}: {code}{times}", color))
        for group in groups[:_MOST_NAMED]:
            _emit_group(group)
        if len(groups) > _MOST_NAMED:
            _emit_line(f"and {len(groups) - _MOST_NAMED:,} others")
        _emit_remark("why", [group[0].why for group in groups])
        _emit_remark("mend", [_mend(flaw) for group in groups for flaw in group])


def _emit_group(flaws: Sequence[Flaw]) -> None:
    """One flaw, or several that have the same cause."""
    first = flaws[0]
    if len(flaws) == 1:
        _emit_line(f"{_place(first)}: {shortened(first.cause, _LONGEST_CAUSE)}")
        return
    places = list(dict.fromkeys(map(_place, flaws)))
    more = f" and {len(places) - _MOST_NAMED:,} more" if len(places) > _MOST_NAMED else ""
    _emit_line(f"{', '.join(places[:_MOST_NAMED])}{more}: {shortened(first.common, _LONGEST_CAUSE)}")


def _emit_remark(title: str, remarks: Iterable[str]) -> None:
    """Each different remark once, but only the first few."""
    each = [remark for remark in dict.fromkeys(remarks) if remark]
    for remark in each[:_MOST_NAMED]:
        _emit_line(f"{title}: {shortened(remark, _LONGEST_CAUSE)}")
    if len(each) > _MOST_NAMED:
        _emit_line(f"{title}: and {len(each) - _MOST_NAMED:,} more like these")


def _mend(flaw: Flaw) -> str:
    return f"{flaw.mend} (--fix does it)" if flaw.edits else flaw.mend


def _place(flaw: Flaw) -> str:
    """The element of a flaw with its line."""
    element = shortened(flaw.element, _LONGEST_NAME)
    return f"{element} (line {flaw.line})" if flaw.line else element


def _emit_line(text: str) -> None:
    """A line below a heading; broken at the width of a terminal, but not in files."""
    if not output.is_terminal(sys.stdout):
        output.emit(f"  {text}")
        return
    width = max(40, shutil.get_terminal_size().columns)
    output.emit(textwrap.fill(text, width, initial_indent="  ", subsequent_indent="    ", break_on_hyphens=False))
