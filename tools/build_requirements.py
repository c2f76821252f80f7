"""Print what has to be installed to build pinik without pip's isolated environment.

Outside that environment CMake keeps what it has compiled in build/, so that a change of one file compiles that file
again, and the tests build the wheel in seconds. With --with-tools also CMake and Ninja where the machine has none; ask
for these once the others are installed.
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def build_requirements() -> list[str]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["build-system"]["requires"]


def missing_tools() -> list[str]:
    from scikit_build_core.build import get_requires_for_build_wheel

    return get_requires_for_build_wheel()


if __name__ == "__main__":
    print(*build_requirements(), *(missing_tools() if "--with-tools" in sys.argv else []), sep="\n")
