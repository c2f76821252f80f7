"""A command in a process of its own, and the modules that it imported."""

from __future__ import annotations

import subprocess
import sys

SOLVE = ["solve", "arm", "--frame", "tip", "--position", "0.3", "0.1", "0.8"]


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
