"""The packages that a URDF can name: near its file, in given folders, and installed ones."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from .manifests import is_package, manifest_name, names_in, packages_in
from .shares import entries, example_robot_data, installed_places, installed_roots

__all__ = ["PackageSearch", "is_below"]

# So many folders above a URDF's own are searched for packages beside it.
_LEVELS = 5
# The folders of a package that hold its URDF files; a robot without a package.xml has its meshes beside them.
_URDF_FOLDERS = {
    "config", "description", "descriptions", "model", "models", "robot", "robots", "sdf", "urdf", "urdfs", "xacro",
}  # fmt: skip


class PackageSearch:
    """Searches packages for one URDF; it remembers what it found, so it should not outlive a change of the files.

    A package is known by the name of its folder or by the name in its package.xml. The file system's root, the user's
    home folder and the folders above that are no packages and hold none, unless a package.xml says so.

    Attributes:
        roots: Folders, with symbolic links resolved, below which the URDF may open files: the folder of the URDF, its
            package, `package_dirs`, and installed packages.
    """

    def __init__(self, urdf_path: Path | None, package_dirs: Sequence[os.PathLike[str] | str]) -> None:
        self._given = [Path(folder) for folder in package_dirs]
        starts = [Path.cwd()] if urdf_path is None else _folders_of(urdf_path)
        # For a URDF given as text nothing near the working directory is known to belong to it.
        self._above = [] if urdf_path is None else [_chain(start)[: _LEVELS + 1] for start in starts]
        own = [*starts] if urdf_path is None else [home for start in starts for home in _homes(start)]
        self._own = list(dict.fromkeys(own))
        roots = [*self._own, *self._given, *installed_roots()]
        self.roots = tuple(dict.fromkeys(os.path.realpath(folder) for folder in roots))
        self._by_folder_name: dict[str, list[Path]] = {}
        self._by_manifest: dict[str, list[Path]] | None = None
        self._by_folded_name: dict[str, set[str]] | None = None

    def places(self, name: str) -> Iterator[Path]:
        """The folders that may be a package of this name: given ones, those near the URDF, installed ones."""
        if name not in self._by_folder_name:
            self._by_folder_name[name] = [place for place in dict.fromkeys(self._named(name)) if os.path.isdir(place)]
        yield from self._by_folder_name[name]
        if self._by_manifest is None:
            self._by_manifest = self._named_by_manifests()
        yield from self._by_manifest.get(name, ())

    def other_case(self, name: str) -> str | None:
        """The name of a package that differs from this one only in upper and lower case, or None."""
        if self._by_folded_name is None:
            self._by_folded_name = {}
            for known in self._names_nearby():
                self._by_folded_name.setdefault(known.casefold(), set()).add(known)
        others = sorted(self._by_folded_name.get(name.casefold(), set()) - {name})
        return next((other for other in others if next(self.places(other), None) is not None), None)

    def belongs(self, file: str, package: str | None) -> bool:
        """Whether a file, with symbolic links resolved, lies in the package, or in any that can be found by name."""
        for folder in Path(file).parents:
            if is_package(folder):
                name = manifest_name(folder)
                if name is None:
                    return False
                real = os.path.realpath
                return name == package or any(real(place) == str(folder) for place in self.places(name))
        return False

    def _named(self, name: str) -> Iterator[Path]:
        for folder in self._given:
            yield folder / name
            if folder.name == name or manifest_name(folder) == name:
                yield folder
        for chain in self._above:
            for folder in chain:
                shared = _is_shared(folder)
                if not shared or manifest_name(folder / name) == name:
                    yield folder / name
                if (folder.name == name and not shared and len(folder.parts) > 2) or manifest_name(folder) == name:
                    yield folder
        for home in self._own:
            if home.name == name:
                yield home
        yield from installed_places(name)

    def _names_nearby(self) -> Iterator[str]:
        """The names of folders that may be packages, and those in the package.xml files of packages."""
        if self._by_manifest is None:
            self._by_manifest = self._named_by_manifests()
        yield from self._by_manifest
        near = [folder for chain in self._above for folder in chain if folder != folder.parent]
        for folder in dict.fromkeys([*self._given, *near]):
            yield folder.name
            yield from names_in(folder)
        yield from (home.name for home in self._own)
        for root in (*installed_roots(), example_robot_data()):
            yield from [] if root is None else names_in(root)

    def _named_by_manifests(self) -> dict[str, list[Path]]:
        """Name in package.xml → folders, for packages whose folders have other names."""
        found: dict[str, list[Path]] = {}
        near = [folder for chain in self._above for folder in chain if folder != folder.parent]
        for folder in dict.fromkeys([*self._given, *near, *entries("ROS_PACKAGE_PATH")]):
            for name, places in packages_in(folder).items():
                found.setdefault(name, []).extend(places)
        return found


def is_below(file: str, folder: str) -> bool:
    """Whether a file lies in a folder or deeper; both with symbolic links resolved."""
    return file.startswith(folder.rstrip(os.sep) + os.sep)


def _folders_of(urdf_path: Path) -> list[Path]:
    """The folder of a URDF file as it is written, and the one of the file that a symbolic link leads to."""
    return list(dict.fromkeys([urdf_path.absolute().parent, Path(os.path.realpath(urdf_path)).parent]))


def _chain(folder: Path) -> list[Path]:
    return [folder, *folder.parents]


def _homes(folder: Path) -> Iterator[Path]:
    """The folders that a URDF in this folder calls its own: the folder itself, and its package.

    Without a package.xml the package is taken to be the folder above one that is called "urdf", "robots" or the like.
    """
    yield folder
    chain = _chain(folder)
    package = next((above for above in chain if is_package(above)), None)
    if package is None:
        names = (above.parent for above in chain[:3] if above.name.lower() in _URDF_FOLDERS)
        package = next(names, None)
    if package is not None and not _is_shared(package):
        yield package


def _is_shared(folder: Path) -> bool:
    """Whether a folder is the root, the user's home folder, or one above that: it belongs to no robot."""
    try:
        home = Path.home()
    except RuntimeError:
        return folder == folder.parent
    return folder == folder.parent or folder == home or folder in home.parents
