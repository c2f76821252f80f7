"""Where one address of a URDF leads, for tests that ask about single addresses."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from pinik.description.packages import Surroundings


def resolve(
    address: str,
    *,
    urdf_path: Path | None = None,
    package_dirs: Sequence[os.PathLike[str] | str] = (),
    allow_outside: bool = False,
) -> Path | None:
    """The file at an address, or None; looked up anew each time, so that a test may change the files."""
    return Surroundings(urdf_path, package_dirs, allow_outside).find(address).path
