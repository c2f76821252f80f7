"""The rules of docs/architecture.md about who may import whom, read from the source without running it."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

import pinik

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "pinik"

# Package → the modules and rooms that alone may import it.
ONLY_THERE = {
    "yourdfpy": {"shapes.second_opinion"},
    "coal": {"engine", "shapes.coal_checker"},
    "trimesh": {"shapes.mesh_files", "shapes.meshes", "shapes.neighbours", "shapes.simplified", "shapes.triangles"},
    "fast_simplification": {"shapes.simplified"},
    "robot_descriptions": {"description.downloads"},
    "xacro": {"description.xacro_process"},
    "xacrodoc": {"description.xacro_process"},
    "scipy": set(),
    "PIL": {"picture.picture", "export.plate"},
    "meshcat": set(),  # of meshcat the page takes the JavaScript; the Python package brings IPython and ZeroMQ
    "zmq": set(),
    "tornado": {
        f"viewer.web.{name}" for name in ("server", "tab", "door", "connection", "metronome", "later", "live_view")
    },
    "umsgpack": {"viewer.web.scene", "viewer.web.shape_cache"},
    "pyarrow": {"scale.tables.parquet"},
    "distributed": {"scale.jobs.cluster"},
    "cloudpickle": {"scale.jobs.cluster"},
    "dask": set(),
    "h5py": {"workspace.reuleaux"},
    "rerun": {"export.rerun"},
    "pandas": {f"solving.{name}" for name in ("data_frame", "many", "track", "self_motion", "branches")},
}
HEAVY = {
    "yourdfpy", "trimesh", "scipy", "PIL", "meshcat", "matplotlib", "typer", "rich", "tornado", "umsgpack",
    "pyarrow", "h5py", "pandas", "rerun", "dask", "distributed", "cloudpickle",
}  # fmt: skip


@dataclass(frozen=True)
class Import:
    """One import statement's target, seen from one module."""

    importer: str
    imported: str
    inside_function: bool
    line: int

    def __str__(self) -> str:
        return f"{self.importer} imports {self.imported} (line {self.line})"


def module_name(path: Path) -> str:
    """`solvers/ccd.py` → "solvers.ccd", `solvers/__init__.py` → "solvers", the front itself → "pinik"."""
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts) or "pinik"


# The compiled module is known by its stub.
FILES = {module_name(path): path for pattern in ("*.py", "*.pyi") for path in SOURCE.rglob(pattern)}


def statements(node: ast.AST, inside_function: bool = False) -> Iterator[tuple[ast.Import | ast.ImportFrom, bool]]:
    """Every import, those for type checkers included, and whether it waits for a function to be called."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.Import, ast.ImportFrom)):
            yield child, inside_function
        else:
            function = isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda))
            yield from statements(child, inside_function or function)


def absolute_targets(statement: ast.Import | ast.ImportFrom, importer: str) -> Iterator[str]:
    """What the statement imports, in full: "pinik.solvers.ccd", "numpy.typing"."""
    if isinstance(statement, ast.Import):
        yield from (alias.name for alias in statement.names)
        return
    base = statement.module or ""
    if statement.level:
        package = ["pinik", *(importer.split(".") if importer != "pinik" else [])]
        if FILES[importer].name != "__init__.py":
            package.pop()
        package = package[: len(package) - statement.level + 1]
        base = ".".join([*package, base] if base else package)
    for alias in statement.names:
        name = f"{base}.{alias.name}"
        is_module = name.removeprefix("pinik.") in FILES and name.startswith("pinik.")
        yield name if is_module else base


def imports() -> list[Import]:
    """Every import of every module of pinik."""
    found = []
    for importer, path in FILES.items():
        for statement, inside in statements(ast.parse(path.read_text("utf-8"))):
            found += [
                Import(importer, name, inside, statement.lineno) for name in absolute_targets(statement, importer)
            ]
    return found


IMPORTS = imports()
OWN = [
    Import(i.importer, i.imported.removeprefix("pinik."), i.inside_function, i.line)
    for i in IMPORTS
    if i.imported.split(".")[0] == "pinik"
]


def declared_order() -> list[str]:
    """The modules as docs/architecture.md lists them, a room's own name before what is in it; the front comes last."""
    text = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    block = re.search(r"```text\n(_native.*?)```", text, re.DOTALL)
    assert block is not None
    order: list[str] = []
    rooms: list[str] = []
    for line in block.group(1).splitlines():
        indent, name = re.match(r"( *)(\S+)", line).groups()
        rooms = rooms[: len(indent) // 2]
        order.append(".".join([*rooms, name.rstrip("/")]))
        if name.endswith("/"):
            rooms.append(name.rstrip("/"))
    at = order.index("cli")
    return [*order[:at], "pinik", *order[at:]]


PLACE = {name: index for index, name in enumerate(declared_order())}


def test_every_module_has_its_one_place_in_the_architecture():
    order = declared_order()
    assert len(order) == len(set(order))
    assert set(order) == set(FILES), "docs/architecture.md lists the modules in order; add or remove the line"


def test_a_module_imports_only_from_those_before_it():
    """Also where the import is for type checkers, or waits inside a function."""
    wrong = [
        str(i)
        for i in OWN
        if PLACE[i.imported] >= PLACE[i.importer]
        and not i.importer.startswith(f"{i.imported}.")  # nothing but its docstring is in a room's own file
        and FILES[i.importer].name != "__init__.py"
    ]
    assert not wrong


def test_a_rooms_own_file_holds_nothing_but_what_the_room_is():
    """So that who imports from a room names the module, and the order of modules is seen in the imports."""
    for name, path in FILES.items():
        if path.name == "__init__.py" and name not in ("pinik", "cli"):
            body = ast.parse(path.read_text("utf-8")).body
            assert [type(node) for node in body] == [ast.Expr], name


def test_heavy_packages_are_imported_where_they_belong():
    wrong = [
        str(i)
        for i in IMPORTS
        if (package := i.imported.split(".")[0]) in ONLY_THERE and i.importer not in ONLY_THERE[package]
    ]
    assert not wrong


def test_yourdfpy_is_asked_by_check_alone_and_when_it_runs():
    askers = [i for i in OWN if i.imported == "shapes.second_opinion"]
    assert {i.importer for i in askers} == {"cli.reports.inspection"}


def test_shapes_are_loaded_for_nobody_who_did_not_ask():
    wrong = [
        str(i)
        for i in OWN
        if i.imported == "shapes.meshes"
        and not i.inside_function
        and not i.importer.startswith(("viewer.web.", "export.", "shapes.known"))  # the types alone, in the last two
    ]
    assert not wrong


def test_the_simulation_knows_no_socket_and_no_drawing():
    below = {"picture", "viewer.protocol", "viewer.web", "shapes.meshes", "shapes.mesh_files", "shapes.triangles"}
    wrong = [
        str(i)
        for i in OWN
        if i.importer.startswith("viewer.simulation.") and any(i.imported.startswith(room) for room in below)
    ]
    assert not wrong


def test_importing_pinik_imports_nothing_heavy():
    code = f"import sys, pinik; print(*sorted({HEAVY!r} & {{name.split('.')[0] for name in sys.modules}}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


@pytest.mark.parametrize("name", sorted(set(FILES) - {"__main__"}))
def test_every_name_in_all_exists(name):
    module = importlib.import_module("pinik" if name == "pinik" else f"pinik.{name}")
    names = getattr(module, "__all__", [])
    assert len(names) == len(set(names))
    assert [missing for missing in names if not hasattr(module, missing)] == []


def test_the_front_shows_every_public_name_on_one_screen():
    assert [name for name in pinik.__all__ if not hasattr(pinik, name)] == []  # some are loaded when they are asked for
    imported = {
        name
        for name, value in vars(pinik).items()
        if not name.startswith("_") and not (inspect.ismodule(value) and value.__name__.startswith("pinik."))
    }
    assert imported == set(pinik.__all__)
    assert len(pinik.__all__) <= 60


def test_every_public_name_says_what_it_is():
    undocumented = [
        name for name in pinik.__all__ if callable(getattr(pinik, name)) and not getattr(pinik, name).__doc__
    ]
    assert undocumented == []
