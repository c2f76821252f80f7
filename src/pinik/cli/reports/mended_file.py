"""The mended copy of a URDF that `pinik check --fix` writes, and what it says about it."""

from __future__ import annotations

import contextlib
import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...description.flaw import Flaw
from ...description.lint.front import NOTES
from ...description.lint.mending import Mending, mended
from ...description.xml import DocumentError, parse
from ...echoes import shortened
from ..inputs.files import check_file, write_file
from ..terminal import output
from ..terminal.exits import CommandError
from ..terminal.units import counted
from .flaw_json import MOST_LISTED
from .inspection import Inspection

__all__ = ["MendedFile", "check_target", "write_mended"]

_MOST_NAMED = 6
_LONGEST = 200
_STDOUT = ("-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1")


@dataclass(frozen=True)
class MendedFile:
    """What became of --fix.

    Attributes:
        file: The file that was to be written.
        mending: What was mended and what was left; None if the document is no XML.
        fault: Why nothing was written; empty if the file was written.
        moved: Whether the file is in another folder than the original one, whose relative addresses it has.
        expanded: Whether it is the URDF that xacro made of the original file.
    """

    file: Path
    mending: Mending | None
    fault: str = ""
    moved: bool = False
    expanded: bool = False

    def to_dict(self) -> dict[str, Any]:
        """The JSON form; docs/json.md explains the fields."""
        done = () if self.mending is None else self.mending.done
        left = () if self.mending is None else self.mending.left
        return {
            "file": str(self.file),
            "written": not self.fault,
            "expanded": self.expanded,
            "fault": shortened(self.fault) or None,
            "mended": [_fields(flaw) for flaw in done[:MOST_LISTED]],
            "left": [_fields(one.flaw) | {"because": shortened(one.why)} for one in left[:MOST_LISTED]],
        }

    @property
    def _folder(self) -> str:
        return shortened(str(self.file.parent), _LONGEST)

    def emit(self) -> None:
        """Print what was mended, what is left and why."""
        if self.fault or self.mending is None:
            output.emit(output.painted(f"{self.file}: not written: {shortened(self.fault, _LONGEST)}", "red"))
            return
        left = [one for one in self.mending.left if one.flaw.code not in NOTES]
        rest = f"; {_are(len(left))} left to you" if left else ""
        output.emit(output.painted(f"{self.file}: written; {_are(len(self.mending.done))} mended{rest}", "green"))
        for code, flaws in _by_code(self.mending.done).items():
            output.emit(f"  mended {code}: {_named(flaws)}")
        reasons = Counter((one.flaw.code, one.why) for one in left)
        for (code, why), count in reasons.items():
            output.emit(f"  left {code}{f', {count:,} times' if count > 1 else ''}: {shortened(why, _LONGEST)}")
        if self.expanded:
            output.emit("  it is the URDF that xacro made of the file, without its macros and arguments")
        if self.moved:
            output.emit(f"  it is not beside the original: relative addresses of meshes begin at {self._folder}")


def check_target(target: Path, source: str) -> None:
    """Check where --fix is to write, before any work.

    Raises:
        CommandError: It is stdout or the file itself, or a file cannot be written there.
    """
    if str(target) in _STDOUT:
        raise CommandError(f"--fix must be the name of a file, as stdout is for the report; got {target}")
    _keep(Path(source), target)
    check_file(target, "--fix")


def write_mended(found: Inspection, target: Path) -> MendedFile:
    """Mend an inspected file and write the result whole, if it can be loaded.

    Raises:
        CommandError: The file cannot be written, or is the one that was inspected, such as the catalogue's own.
    """
    if found.path is not None:
        _keep(found.path, target)
    if found.document is None:
        return MendedFile(target, None, "there is no document to mend")
    try:
        mending = mended(found.document, found.path)
        parse(mending.document)
    except DocumentError as error:
        return MendedFile(target, None, str(error))
    if mending.fault:
        return MendedFile(target, mending, f"it cannot be loaded after the mends either: {mending.fault}")
    write_file(target, mending.document, "--fix")
    original = found.path or Path("stdin")  # addresses in a URDF from stdin begin at the working directory
    moved = target.absolute().parent.resolve() != original.absolute().parent.resolve()
    moved = moved and _has_relative_addresses(mending.document)
    return MendedFile(target, mending, moved=moved, expanded=found.expanded)


def _keep(file: Path, target: Path) -> None:
    """Refuse to write over the file that is mended."""
    with contextlib.suppress(OSError):
        if os.path.samefile(target, file.expanduser()):
            raise CommandError(f"--fix {target}: this is the file itself; name another one, so that it is kept")


def _has_relative_addresses(document: bytes) -> bool:
    addresses = (element.attributes.get("filename", "") for element in parse(document).walk() if element.tag == "mesh")
    return any(address and "://" not in address and not address.startswith("/") for address in addresses)


def _fields(flaw: Flaw) -> dict[str, Any]:
    return {"code": flaw.code, "element": shortened(flaw.element), "line": flaw.line}


def _by_code(flaws: Sequence[Flaw]) -> dict[str, list[Flaw]]:
    groups: dict[str, list[Flaw]] = {}
    for flaw in flaws:
        groups.setdefault(flaw.code, []).append(flaw)
    return groups


def _named(flaws: Sequence[Flaw]) -> str:
    lines = [f" (line {flaw.line})" if flaw.line else "" for flaw in flaws[:_MOST_NAMED]]
    places = [shortened(f"{flaw.element}{line}", _LONGEST) for flaw, line in zip(flaws, lines, strict=False)]
    more = f" and {len(flaws) - _MOST_NAMED:,} more" if len(flaws) > _MOST_NAMED else ""
    return f"{', '.join(places)}{more}"


def _are(count: int) -> str:
    if count == 0:
        return "no flaw is"
    return f"{counted(count, 'flaw')} {'is' if count == 1 else 'are'}"
