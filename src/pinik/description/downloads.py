"""Robots that the package robot_descriptions has downloaded: found in its cache, and never downloaded by pinik."""

from __future__ import annotations

import builtins
import importlib.util
import os
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ..errors import RobotLoadError

__all__ = ["ENDING", "INSTALL", "Download", "downloadable", "find_download"]

ENDING = "_description"
INSTALL = "pip install 'pinik[descriptions]'"
_PACKAGE = "robot_descriptions"


@dataclass(frozen=True)
class Download:
    """A robot in the cache of robot_descriptions.

    Attributes:
        name: Its name, such as "ur10e_description".
        file: Its URDF or xacro file.
        srdf: Its SRDF file, if there is one that needs no xacro.
        package_dirs: The folders of its packages.
        arguments: The arguments of its xacro file.
    """

    name: str
    file: Path
    srdf: Path | None
    package_dirs: tuple[Path, ...]
    arguments: Mapping[str, str]


class _NotCachedError(Exception):
    """A repository is not in the cache; the message is its name."""


def downloadable() -> list[str]:
    """The names of the robots that robot_descriptions has as URDF or xacro, sorted; empty if it is not installed."""
    if importlib.util.find_spec(_PACKAGE) is None:
        return []
    from robot_descriptions._descriptions import DESCRIPTIONS

    return sorted(name for name, description in DESCRIPTIONS.items() if description.has_urdf)


def find_download(name: str) -> Download:
    """A robot in the cache of robot_descriptions.

    Args:
        name: One of `downloadable()`.

    Raises:
        RobotLoadError: It is not in the cache; the message says how to download it.
    """
    try:
        module = _description(name)
    except _NotCachedError as missing:
        cause = (
            f"{missing} is not in the cache of robot_descriptions ({_cache()}), and pinik downloads nothing; "
            f"this command does: python -m robot_descriptions pull {name}"
        )
        raise RobotLoadError(cause, source=name) from None
    file = module.get("URDF_PATH") or module.get("XACRO_PATH")
    if not isinstance(file, str):
        raise RobotLoadError("robot_descriptions has neither a URDF nor a xacro file of it", source=name)
    folders = [*module.get("XACRO_PACKAGE_PATHS", {}).values(), module["PACKAGE_PATH"], module["REPOSITORY_PATH"]]
    folders += [os.path.dirname(folder) for folder in folders[-2:]]
    srdf = module.get("SRDF_PATH")
    arguments = {} if "URDF_PATH" in module else module.get("XACRO_ARGS", {})
    return Download(
        name=name,
        file=Path(file),
        srdf=None if srdf is None else Path(srdf),
        package_dirs=tuple(dict.fromkeys(map(Path, folders))),
        arguments=dict(arguments),
    )


def _description(name: str) -> dict[str, Any]:
    """The variables of a module of robot_descriptions: the paths of a robot's files.

    An import of such a module downloads the robot. So its code runs here with another `clone_to_cache`, which only
    looks into the cache.
    """
    from robot_descriptions._repositories import REPOSITORIES

    def cached(repository: str, commit: str | None = None) -> str:
        folder = REPOSITORIES[repository].cache_path
        place = _cache() / (folder if commit is None else f"{folder}-{commit}/{folder}")
        if not place.is_dir():
            raise _NotCachedError(repository)
        return str(place)

    def imported(module: str, names: Any = None, local: Any = None, wanted: Any = (), level: int = 0) -> Any:
        if module == "_cache" and level == 1:
            return SimpleNamespace(clone_to_cache=cached)
        if module == "warnings":  # that some names will mean another robot one day
            return SimpleNamespace(warn=lambda *_, **__: None)
        return __import__(module, names, local, wanted, level)

    full = f"{_PACKAGE}.{name}"
    spec: ModuleSpec | None = importlib.util.find_spec(full)
    code = None if spec is None or spec.loader is None else spec.loader.get_code(full)  # type: ignore[attr-defined]
    if code is None:
        raise RobotLoadError("robot_descriptions has no module of this name", source=name)
    variables: dict[str, Any] = {
        "__builtins__": {**vars(builtins), "__import__": imported},
        "__name__": full,
        "__package__": _PACKAGE,
    }
    try:
        exec(code, variables)
    except _NotCachedError:
        raise
    except Exception as error:  # some modules read the files that they expect in the cache
        raise RobotLoadError(f"robot_descriptions cannot find its files: {error}", source=name) from None
    return variables


def _cache() -> Path:
    folder = os.environ.get("ROBOT_DESCRIPTIONS_CACHE", "~/.cache/robot_descriptions")
    return Path(os.path.expanduser(folder))
