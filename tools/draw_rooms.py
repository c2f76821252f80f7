"""Draw docs/images/rooms.svg: the rooms of src/pinik in their order, and which room imports from which.

The order and the words are those of the list in docs/architecture.md, the imports are read from the source, so run this
when a test says that the picture is out of date: `python tools/draw_rooms.py`.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from svg import BLUE, FAINT, GREEN, GREY, ORANGE, PINK, RED, Drawing, tint

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "pinik"
PICTURE = ROOT / "docs" / "images" / "rooms.svg"

GROUND = "ground floor"
COLORS = {
    **dict.fromkeys(("description", "model", "shapes"), BLUE),
    **dict.fromkeys(("problem", "closed_form", "solvers", "solving"), GREEN),
    **dict.fromkeys(("picture", "motion", "studies", "scale", "workspace", "viewer"), ORANGE),
    "cli": PINK,
}
ROW, CELL, LEFT, NAMES, TOP = 30, 26, 24, 590, 92
LONGEST = 66


@dataclass(frozen=True)
class Listed:
    """A line of the list in docs/architecture.md: a folder, or a module."""

    path: tuple[str, ...]
    is_folder: bool
    words: str


def listed() -> list[Listed]:
    text = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    block = re.search(r"```text\n(_native.*?)```", text, re.DOTALL)
    found: list[Listed] = []
    folders: list[str] = []
    for line in block[1].splitlines():
        indent, name, words = re.match(r"( *)(\S+) *(.*)", line).groups()
        folders = folders[: len(indent) // 2]
        found.append(Listed((*folders, name.rstrip("/")), name.endswith("/"), words))
        if name.endswith("/"):
            folders.append(name.rstrip("/"))
    return found


def rooms() -> tuple[dict[str, str], dict[str, str]]:
    """Each room's words, from the ground up, and the room of each module.

    A room is a folder with all that is in it. A folder that holds more folders than modules is divided: those are the
    rooms, and a module beside them is one by itself.
    The modules before the first folder are the ground floor; the package's own front stands below the command line.
    """
    lines = listed()
    inside = Counter((line.path[:-1], line.is_folder) for line in lines)
    divided = {line.path for line in lines if inside[line.path, True] > inside[line.path, False]}
    words = {"/".join(line.path): line.words for line in lines}
    found: dict[str, str] = {GROUND: ""}
    room_of: dict[str, str] = {}
    for line in lines:
        if line.is_folder:
            if line.path == ("cli",):
                found["pinik"] = "every public name"
            continue
        if len(found) == 1 and len(line.path) == 1:
            room = GROUND
        else:
            room = "/".join(line.path[: 2 if line.path[:1] in divided else 1])
            found.setdefault(room, words[room])
        room_of[".".join(line.path)] = room
    ground = [name for name, room in room_of.items() if room == GROUND]
    found[GROUND] = ", ".join(name for name in ground if name != "_native") + "; the compiled engine"
    return found, {**room_of, "": "pinik", "cli": "cli/app"}


def imports(modules: set[str]) -> Iterator[tuple[str, str]]:
    """Module and imported module, of every import in src/pinik, those for type checkers included."""
    for path in sorted(SOURCE.rglob("*.py")):
        folder = path.relative_to(SOURCE).parts[:-1]
        name = ".".join([*folder, path.stem]).removesuffix("__init__").rstrip(".")
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.level:
                base = [*folder[: len(folder) - node.level + 1], *(node.module or "").split(".")]
                for alias in node.names:
                    whole = ".".join(part for part in [*base, alias.name] if part)
                    imported = whole if whole in modules else ".".join(part for part in base if part)
                    if name in modules and imported in modules:
                        yield name, imported


def drawing() -> Drawing:
    words, room_of = rooms()
    names = list(words)
    pairs = {(room_of[a], room_of[b]) for a, b in imports(set(room_of))}
    edges = {(names.index(a), names.index(b)) for a, b in pairs if a != b}
    count = len(names)
    bottom = TOP + count * ROW
    width = NAMES + count * CELL + 40
    picture = Drawing(width, bottom + 112, "The rooms of pinik in their order, and which room imports from which")
    picture.text(LEFT, 36, "The rooms of src/pinik, from the ground up", size=18, bold=True)
    picture.text(LEFT, 58, "A dot: the room of this row imports from the room of this column.", size=13, color=FAINT)
    picture.text(
        LEFT,
        75,
        "Every dot stands left of the diagonal, as a room imports only from those below it.",
        size=13,
        color=FAINT,
    )
    for row, name in enumerate(names):
        y, color = bottom - (row + 1) * ROW, color_of(name)
        picture.box(LEFT, y + 2, NAMES - LEFT - 16, ROW - 4, fill=tint(color, 0.13))
        picture.box(LEFT, y + 2, 5, ROW - 4, fill=color, round_=2)
        picture.text(LEFT + 16, y + 19.5, name, size=13, bold=True)
        picture.text(LEFT + 166, y + 19, shortened(words[name]), size=11, color=FAINT)
        for column in range(row + 1):
            x = NAMES + column * CELL
            own = column == row
            picture.box(x + 1, y + 2, CELL - 2, ROW - 4, fill=color if own else tint(GREY, 0.07), round_=3)
        for column in range(count):
            if (row, column) in edges:
                wrong = column > row
                picture.dot(NAMES + (column + 0.5) * CELL, y + ROW / 2, 5, RED if wrong else color)
    for column, name in enumerate(names):
        picture.text(NAMES + (column + 0.7) * CELL, bottom + 14, name, size=11, anchor="end", turned=-55)
    return picture


def color_of(room: str) -> str:
    return COLORS.get(room.split("/")[0], GREY)


def shortened(words: str) -> str:
    """What stands before the first colon or semicolon, or before the first comma where that is too long."""
    words = re.sub(r"^`\w+`: ", "", words).replace("`", "")  # a function's name in front says no more than the module's
    first = re.split(r"[:;] ", words)[0]
    return first if len(first) <= LONGEST else first.split(",")[0]


if __name__ == "__main__":
    PICTURE.write_text(str(drawing()), "utf-8")
