"""What pinik can do where only some of its packages are installed, and how it asks for those that are missing."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

PROJECT = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text("utf-8"))["project"]
IMPORTED_AS = {
    "pillow": "PIL",
    "u-msgpack-python": "umsgpack",
    "pycollada": "collada",
    "rerun-sdk": "rerun",
    "fast-simplification": "fast_simplification",
}

REFUSE = """
import sys

class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {refused!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Refuse())
"""


def extra(name: str) -> set[str]:
    """The import names of the packages that an extra brings, those of the extras in it included."""
    found: set[str] = set()
    for requirement in map(Requirement, PROJECT["optional-dependencies"][name]):
        if requirement.name == "pinik":
            found |= set().union(*map(extra, requirement.extras))
        else:
            found.add(IMPORTED_AS.get(canonicalize_name(requirement.name), requirement.name))
    return found


def run_without(refused: set[str], code: str) -> subprocess.CompletedProcess[str]:
    """Run Python code in a process that cannot import some packages."""
    script = REFUSE.format(refused=sorted(refused)) + code
    return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60)


def error_without(refused: set[str], statement: str) -> str:
    """What the MissingExtraError says that a statement raises."""
    code = f"import pinik\ntry:\n    {statement}\nexcept pinik.MissingExtraError as error:\n    print(error)\n"
    done = run_without(refused, code)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def command_without(refused: set[str], *arguments: str) -> subprocess.CompletedProcess[str]:
    return run_without(refused, f"from pinik.cli import main\nsys.exit(main({list(arguments)!r}))")


def test_pinik_alone_loads_a_robot_and_solves():
    code = (
        "import pinik, numpy\n"
        "robot = pinik.load('panda')\n"
        "solution = robot.solve('panda_hand_tcp', position=[0.4, -0.3, 0.35])\n"
        "there = robot.placement('panda_hand_tcp', solution.q).translation\n"
        "again = [robot.placement('panda_hand_tcp', solution.q).homogeneous]\n"
        "many = pinik.solve_many(robot, 'panda_hand_tcp', again)\n"
        "print(float(numpy.abs(there - [0.4, -0.3, 0.35]).max()), many.success.all())"
    )
    done = run_without(extra("all"), code)
    assert done.returncode == 0, done.stderr
    off, solved = done.stdout.split()
    assert float(off) < 1e-4
    assert solved == "True"


@pytest.mark.parametrize(
    ("package", "name", "statement"),
    [
        ("tornado", "live", "pinik.live('arm', port=0)"),
        ("umsgpack", "live", "pinik.live('arm', port=0)"),
        ("trimesh", "pictures", "pinik.draw(pinik.load('arm'))"),
        ("PIL", "pictures", "pinik.draw(pinik.load('arm'), size=(16, 16)).png()"),
        ("PIL", "pictures", "pinik.draw(pinik.load('arm'), size=(16, 16)).save('no.png')"),
        ("pandas", "frames", "pinik.solve_many(pinik.load('arm'), []).to_frame()"),
        ("rerun", "rerun", "from pinik.export.rerun import save_rrd; save_rrd(pinik.load('arm'), '/nowhere/no.rrd')"),
    ],
)
def test_a_part_whose_package_is_missing_names_the_line_that_installs_it(package, name, statement):
    message = error_without({package}, statement)
    assert message.endswith(f"pip install 'pinik[{name}]'")
    assert package in extra(name)
    installed = {value: key for key, value in IMPORTED_AS.items()}.get(package, package)
    assert f" needs {installed}: " in message


@pytest.mark.parametrize(
    ("package", "name", "arguments"),
    [
        ("typer", "cli", ["info", "arm"]),
        ("yourdfpy", "check", ["check", "arm"]),
        ("trimesh", "check", ["check", "arm"]),
        ("tornado", "live", ["live", "arm", "--no-browser", "--port", "0"]),
    ],
)
def test_a_command_whose_package_is_missing_ends_with_the_line_that_installs_it(package, name, arguments):
    done = command_without({package}, *arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: ")
    assert line.endswith(f"needs {package}: pip install 'pinik[{name}]'")
    assert package in extra(name)


def test_the_command_line_needs_no_package_but_its_own_to_solve():
    done = command_without(
        extra("all") - extra("cli"), "solve", "arm", "--frame", "tip", "--position", "0.6", "0.3", "0.7"
    )
    assert done.returncode == 0, done.stderr
    assert "converged" in done.stdout


def test_a_picture_of_meshes_of_every_kind_needs_nothing_but_its_extra():
    code = (
        "import warnings\nwarnings.simplefilter('error')\n"
        "warnings.filterwarnings('ignore', 'Setting the shape', DeprecationWarning, 'collada')\n"  # under NumPy 2.5
        "import pinik\n"
        "for name in ('arm', 'panda', 'ur5', 'hyq'):\n"  # .obj, .dae and .stl
        "    pinik.draw(pinik.load(name), size=(32, 32)).png()\n"
    )
    by_way_of_others = {"networkx", "lxml", "xxhash", "rtree", "shapely", "charset_normalizer", "httpx", "jsonschema"}
    done = run_without(extra("all") - extra("pictures") | by_way_of_others, code)
    assert done.returncode == 0, done.stderr


def test_all_holds_every_extra_for_users():
    for name in ("cli", "pictures", "live", "check", "plots"):
        assert extra(name) <= extra("all")
    assert extra("all") <= extra("notebooks") & extra("dev")
