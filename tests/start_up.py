"""Commands in processes of their own, and the modules that they imported."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping

SOLVE = ["solve", "arm", "--frame", "tip", "--position", "0.3", "0.1", "0.8"]


def unmeasured(environment: Mapping[str, str]) -> dict[str, str]:
    """For a process in which coverage would be in the way, because it imports modules and writes a file."""
    return {name: value for name, value in environment.items() if not name.startswith("COVERAGE_")}


def modules_after(environment: dict[str, str], arguments: list[str]) -> set[str]:
    script = (
        "import sys\nfrom pinik.cli import main\n"
        f"status = main({arguments!r})\n"
        "sys.stderr.write('\\n'.join(sys.modules))\nsys.exit(status)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, timeout=120, check=True
    )
    return set(done.stderr.split())
