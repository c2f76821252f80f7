"""The package as others get it: built, installed elsewhere, and used there; and what pyproject.toml promises."""

from __future__ import annotations

import importlib.metadata
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pinocchio
import pytest
from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import pinik

ROOT = Path(__file__).parents[1]
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
REQUIREMENTS = {canonicalize_name(r.name): r for r in map(Requirement, PROJECT["dependencies"])}
EXTRAS = [Requirement(line) for lines in PROJECT["optional-dependencies"].values() for line in lines]

USE_IT = """
import json, pathlib, sys
import pinik
answers = {"package": pinik.__file__, "version": pinik.__version__}
for name, frame in [("arm", "tip"), ("lion", "left_fore_paw")]:
    robot = pinik.load(name)
    target = robot.placement(frame, robot.random(1)).translation
    solution = robot.solve(frame, position=target)
    answers[name] = {
        "source": robot.description.source,
        "poses": sorted(robot.poses),
        "success": solution.success,
        "meshes": sorted(str(path) for path in pathlib.Path(robot.description.source).parent.rglob("*.obj")),
    }
print(json.dumps(answers))
"""


# Without .pth files, for these put the checkout in front of everything; what else is installed is named one by one.
ELSEWHERE = (sys.executable, "-S")


def paths(installed: Path) -> str:
    return os.pathsep.join([str(installed), *(path for path in sys.path if "site-packages" in path)])


def run(*command: object, cwd: Path, **environment: str) -> str:
    """Run a command; its words are the failure's message."""
    arguments = [str(part) for part in command]
    done = subprocess.run(
        arguments, cwd=cwd, env={**os.environ, **environment}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{' '.join(arguments)}\n{done.stdout}{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder into which pinik's wheel was installed, far from the checkout."""
    need_to_build("the wheel", "scikit-build-core", "hatch-fancy-pypi-readme")
    folder = tmp_path_factory.mktemp("installed")
    pip = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check")
    # The engine would take minutes to compile again; a pure wheel is what a machine without a compiler makes.
    pure = ("--config-settings", "wheel.cmake=false")
    run(*pip, "wheel", "--no-deps", "--no-build-isolation", *pure, "--wheel-dir", folder / "wheels", ROOT, cwd=folder)
    (wheel,) = (folder / "wheels").glob("*.whl")
    run(*pip, "install", "--no-deps", "--no-index", "--target", folder / "site", wheel, cwd=folder)
    return folder / "site"


def is_installed(requirement: Requirement) -> bool:
    try:
        return requirement.specifier.contains(importlib.metadata.version(requirement.name))
    except importlib.metadata.PackageNotFoundError:
        return False


def need_to_build(what: str, *names: str) -> None:
    """Skip the test, or fail where the engine is required, if one of these packages is missing; by default any."""
    listed = run(sys.executable, ROOT / "tools" / "build_requirements.py", "--with-tools", cwd=ROOT)
    missing = [r.name for r in map(Requirement, listed.splitlines()) if not is_installed(r)]
    missing = [name for name in missing if not names or name in names]
    if missing:
        reason = f"{what} cannot be built here, as these are not installed: {', '.join(missing)}"
        assert not os.environ.get("PINIK_REQUIRE_NATIVE"), reason
        pytest.skip(reason)


@pytest.fixture(scope="module")
def engine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The Python of a fresh environment into which pinik's wheel was installed with its compiled engine.

    What pinik needs is seen there from this environment, and pinik itself is not: its own folder comes first.
    """
    need_to_build("the engine")
    folder = tmp_path_factory.mktemp("engine")
    pip = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check")
    # What `make` has compiled in build/ is linked again; otherwise this takes a minute or two.
    compiled = ("--config-settings", f"build-dir={ROOT}/build/{{wheel_tag}}")
    run(
        *pip,
        "wheel",
        "--no-deps",
        "--no-build-isolation",
        *compiled,
        "--wheel-dir",
        folder / "wheels",
        ROOT,
        cwd=folder,
    )
    (wheel,) = (folder / "wheels").glob("*.whl")
    run(sys.executable, "-m", "venv", "--without-pip", folder / "venv", cwd=folder)
    python = folder / "venv" / "bin" / "python"
    (site,) = (folder / "venv" / "lib").glob("python*/site-packages")
    run(*pip, "install", "--no-deps", "--no-index", "--target", site, wheel, cwd=folder)
    (site / "needed.pth").write_text("\n".join(path for path in sys.path if "site-packages" in path), "utf-8")
    (prefix,) = (p for p in Path(pinocchio.__file__).parents if p.name == "cmeel.prefix")
    (site / "cmeel.prefix").symlink_to(prefix)
    return python


# In a process that has not imported Pinocchio, whose libraries would satisfy the engine wherever they are.
LOAD_THE_ENGINE = """
import importlib.util, pathlib, sys
found = pathlib.Path(sys.argv[1])
assert found.is_file()
spec = importlib.util.spec_from_file_location("pinik._native", found)
spec.loader.exec_module(importlib.util.module_from_spec(spec))
print("loaded")
"""

SOLVE_WITH_THE_ENGINE = """
import json
import pinik, pinik._native
robot = pinik.load("arm")
target = robot.placement("tip", robot.random(1)).translation
solution = robot.solve("tip", position=target, engine="native")
off = float(abs(robot.placement("tip", solution.q).translation - target).max())
print(json.dumps({"module": pinik._native.__file__, "engine": solution.engine, "off": off}))
"""


@pytest.mark.timeout(600)  # where nothing was compiled before
def test_the_wheels_engine_solves_outside_the_checkout(engine, tmp_path):
    answer = json.loads(run(engine, "-c", SOLVE_WITH_THE_ENGINE, cwd=tmp_path))
    assert Path(answer["module"]).is_relative_to(engine.parents[1])
    assert answer["engine"] == "native"
    assert answer["off"] < 1e-4


@pytest.mark.timeout(600)
def test_the_wheels_engine_finds_pinocchios_libraries_beside_it_by_its_own_rpath(engine, tmp_path):
    (module,) = engine.parents[1].glob("lib/python*/site-packages/pinik/_native*.so")
    environment = {name: value for name, value in os.environ.items() if name != "LD_LIBRARY_PATH"}

    def load(path: Path) -> subprocess.CompletedProcess[str]:
        command = [engine, "-I", "-c", LOAD_THE_ENGINE, path]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    assert load(module).stdout == "loaded\n", load(module).stderr
    elsewhere = tmp_path / "pinik" / module.name  # no libraries lie beside this place
    elsewhere.parent.mkdir()
    shutil.copy(module, elsewhere)
    assert "libpinocchio" in load(elsewhere).stderr


def test_building_writes_nothing_into_a_checkout_that_cannot_be_written(tmp_path):
    need_to_build("the wheel", "scikit-build-core", "hatch-fancy-pypi-readme", "cmake", "ninja")
    checkout = tmp_path / "checkout"
    for path in tracked_files():
        if path.name in ("pyproject.toml", "README.md", "LICENSE") or "src" in path.relative_to(ROOT).parts:
            copy = checkout / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)
    (checkout / "urdf").mkdir()
    # The engine would take minutes; CMake runs all the same, and leaves its files where it was told to.
    (checkout / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.20)\nproject(pinik LANGUAGES NONE)\n")
    before = sorted(checkout.rglob("*"))
    folders = [path for path in (checkout, *before) if path.is_dir()]
    for folder in folders:
        folder.chmod(0o555)
    wheels = tmp_path / "wheels"
    try:
        pip = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check")
        run(*pip, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", wheels, checkout, cwd=tmp_path)
    finally:
        for folder in folders:
            folder.chmod(0o755)
    (wheel,) = wheels.glob("*.whl")
    assert not wheel.stem.endswith("none-any")  # as it would without CMake
    assert sorted(checkout.rglob("*")) == before


def test_the_oldest_python_that_the_project_names_is_the_oldest_that_it_admits():
    named = [name.rpartition(" ")[2] for name in PROJECT["classifiers"] if ":: Python :: 3." in name]
    oldest, newest = (pick(named, key=lambda name: int(name.split(".")[1])) for pick in (min, max))
    assert PROJECT["requires-python"] == f">={oldest}"
    assert f"pinik runs on Python {oldest} to {newest}." in (ROOT / "docs" / "versions.md").read_text("utf-8")


def test_an_installed_pinik_loads_and_solves_its_own_robots_outside_the_checkout(installed, tmp_path):
    answers = json.loads(run(*ELSEWHERE, "-c", USE_IT, cwd=tmp_path, PYTHONPATH=paths(installed)))
    assert answers["version"] == pinik.__version__
    assert Path(answers["package"]).is_relative_to(installed)
    for name in ("arm", "lion"):
        assert answers[name]["success"]
        assert answers[name]["poses"]
        assert Path(answers[name]["source"]) == installed / "pinik" / "urdf" / f"{name}.urdf"
        assert any(f"/meshes/{name}/" in mesh for mesh in answers[name]["meshes"])


def test_an_installed_pinik_is_imported_within_a_few_times_of_what_it_imports(installed, tmp_path):
    """In processor time, in turns, each at its best of several; an installed package holds its bytecode."""

    def processor_time(statement: str) -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run(*ELSEWHERE, "-c", statement, cwd=tmp_path, PYTHONPATH=paths(installed))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    times = [(processor_time("import numpy, pinocchio"), processor_time("import pinik")) for _ in range(5)]
    needed, whole = map(min, zip(*times, strict=True))
    assert whole < 2.5 * needed  # about 1.7


def test_the_installed_package_holds_the_files_of_urdf_and_of_the_source_and_no_others(installed):
    pairs = [(ROOT / "urdf", installed / "pinik" / "urdf"), (ROOT / "src" / "pinik", installed / "pinik")]
    expected = {
        there / path.relative_to(here)
        for here, there in pairs
        for path in here.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and path.suffix != ".so"
    }
    found = {path for path in (installed / "pinik").rglob("*") if path.is_file() and path.suffix != ".pyc"}
    assert sorted(map(str, found ^ expected)) == []
    assert {installed / "pinik" / name for name in ("py.typed", "viewer/page/index.html", "urdf/arm.urdf")} <= found
    (information,) = installed.glob("pinik-*.dist-info")
    assert {path.name for path in installed.iterdir()} == {"bin", "pinik", information.name}
    assert (information / "licenses" / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()


def test_the_packages_page_on_an_index_has_no_link_or_command_that_needs_the_checkout(installed):
    (information,) = installed.glob("pinik-*.dist-info")
    page = importlib.metadata.PathDistribution(information).metadata.get_payload()
    assert page.startswith("# pinik\n")
    assert "pip install 'pinik[all]'" in page
    assert "import pinik\n" in page
    assert re.findall(r"\]\((?!https://)[^)]*\)", page) == []
    assert re.findall(r"\bmake \w+|pip install '?\.", page) == []


def test_the_installed_command_answers(installed, tmp_path):
    command = installed / "bin" / "pinik"
    assert run(*ELSEWHERE, command, "--version", cwd=tmp_path, PYTHONPATH=paths(installed)).split() == [
        "pinik",
        pinik.__version__,
    ]


def test_the_version_is_the_same_everywhere(installed):
    (metadata,) = installed.glob("pinik-*.dist-info")
    assert importlib.metadata.PathDistribution(metadata).version == pinik.__version__ == PROJECT["version"]
    assert f"## [{pinik.__version__}]" in (ROOT / "CHANGELOG.md").read_text("utf-8")


def needed_by(name: str, found: dict[str, list[Requirement]]) -> dict[str, list[Requirement]]:
    """Package → every requirement on it, for all that `name` pulls in, at any depth."""
    for line in importlib.metadata.requires(name) or []:
        requirement = Requirement(line)
        if requirement.marker and not requirement.marker.evaluate({**default_environment(), "extra": ""}):
            continue
        known = canonicalize_name(requirement.name)
        seen = known in found
        found.setdefault(known, []).append(requirement)
        if not seen:
            needed_by(known, found)
    return found


def is_capped(requirement: Requirement) -> bool:
    return any(part.operator in ("<", "<=", "==", "~=") for part in requirement.specifier)


def is_pinned(requirement: Requirement) -> bool:
    return any(part.operator == "==" and "*" not in part.version for part in requirement.specifier)


def test_a_new_release_of_a_compiled_package_cannot_break_a_fresh_install():
    assert str(REQUIREMENTS["pin"].specifier) == "==4.1.0"
    needed = needed_by("pin", {})
    compiled = {n for n in needed if n.startswith(("cmeel", "coal", "libcoal", "eigenpy", "libpinocchio"))}
    assert {"cmeel", "cmeel-boost", "coal", "libcoal", "eigenpy", "libpinocchio"} <= compiled
    own = {name for name in compiled if name in REQUIREMENTS and is_capped(REQUIREMENTS[name])}
    pinned_by_pin = {name for name in compiled if any(is_pinned(requirement) for requirement in needed[name])}
    assert sorted(compiled - own - pinned_by_pin) == []


def test_every_requirement_has_an_upper_end_and_admits_what_is_installed():
    asked = [*REQUIREMENTS.values(), *(r for r in EXTRAS if r.name != "pinik")]
    assert [r.name for r in asked if not is_capped(r)] == []
    installed = {canonicalize_name(found.name) for found in importlib.metadata.distributions()}
    here = [r for r in asked if canonicalize_name(r.name) in installed]  # Jupyter is for readers of the notebooks
    assert {r.name for r in asked} - {r.name for r in here} <= {"jupyterlab", "robot_descriptions", "xacrodoc"}
    assert [r.name for r in here if not r.specifier.contains(importlib.metadata.version(r.name))] == []


def tracked_files() -> list[Path]:
    """The files of the repository; of a copy without git, everything that has a plain name."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    if listed.returncode == 0:
        paths = [ROOT / name for name in listed.stdout.split("\0") if name]
    else:
        made = {".venv", "build", "dist", "__pycache__", ".mypy_cache", ".pytest_cache", ".ruff_cache", ".hypothesis"}
        paths = [p for p in ROOT.rglob("*") if not made & set(p.relative_to(ROOT).parts)]
    return [path for path in paths if path.is_file()]


def test_no_lock_file_and_no_download_address_is_kept():
    address = re.compile(rb"https?://\S+\.(whl|tar\.gz|zip)\b|--(extra-)?index-url|[/.]pypi\.org/simple")
    named = re.compile(r".*\.lock|.*-lock\.(json|ya?ml)|requirements.*\.txt|constraints.*\.txt")
    files = tracked_files()
    assert ROOT / "pyproject.toml" in files
    assert [path.name for path in files if named.fullmatch(path.name)] == []
    texts = [path for path in files if path.suffix not in (".png", ".obj") and path != Path(__file__)]
    assert [str(path.relative_to(ROOT)) for path in texts if address.search(path.read_bytes())] == []
