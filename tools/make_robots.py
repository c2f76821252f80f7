"""Write pinik's own robots to urdf/, where they are committed: `python tools/make_robots.py [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path

from makers import arm, lion, two_link


def files() -> dict[str, bytes]:
    """Every file of urdf/, by path."""
    made: dict[str, bytes] = {}
    for module in (arm, lion, two_link):
        robot = module.build()
        made[f"{robot.name}.urdf"] = robot.urdf().encode()
        made[f"{robot.name}.srdf"] = robot.srdf().encode()
        made |= robot.files
    return made


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1] / "urdf"
    for path, content in files().items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)


if __name__ == "__main__":
    main()
