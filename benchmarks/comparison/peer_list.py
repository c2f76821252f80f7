"""Who is compared: each peer's packages, adapter and options."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

__all__ = ["PEERS", "REFERENCES", "Peer", "pinik_by"]


@dataclass(frozen=True)
class Peer:
    """One row of the tables.

    Attributes:
        key: Its name on the command line.
        label: Its name in the tables.
        adapter: File in `benchmarks/adapters/` and class in it.
        packages: The packages whose versions are reported.
        requirements: What its environment gets, pinned; none for what runs in pinik's own.
        options: Keyword arguments of the adapter.
        batch: Whether it gets all targets at once.
        not_on_path: Why it has no part in the task "path", if so.
    """

    key: str
    label: str
    adapter: tuple[str, str]
    packages: tuple[str, ...]
    requirements: tuple[str, ...] = ()
    options: Mapping[str, object] = field(default_factory=dict)
    batch: bool = False
    not_on_path: str = ""


def pinik_rows(method: str) -> list[Peer]:
    """pinik's rows by one method."""
    file, packages, options = "pinik_itself.py", ("pinik", "pin"), {"method": method}
    one_by_one = [
        Peer("pinik", "pinik solve", (file, "Solve"), packages, options=options),
        Peer("pinik-prepared", "pinik prepared", (file, "SolvePrepared"), packages, options=options),
        Peer(
            "pinik-own-starts",
            "pinik solve, own starts",
            (file, "SolveFromOwnStarts"),
            packages,
            options=options,
            not_on_path="it chooses its start",
        ),
    ]
    batches = [
        Peer(
            f"pinik-many-{threads}",
            f"pinik solve_many, {threads} thread{'s' if threads > 1 else ''}",
            (file, "SolveMany"),
            packages,
            options={**options, "threads": threads},
            batch=True,
            not_on_path="a batch knows no last answer to start from",
        )
        for threads in (1, 2)
    ]
    return [*one_by_one, *batches]


def pinik_by(method: str) -> Peer:
    """The row "pinik solve" by another method than the default."""
    row = pinik_rows(method)[0]
    return replace(row, key=f"{row.key}-{method}", label=f"{row.label} ({method})")


PEERS = [
    *pinik_rows("dls"),
    Peer(
        "rtb",
        "Robotics Toolbox ik_LM",
        ("robotics_toolbox.py", "RoboticsToolbox"),
        ("roboticstoolbox-python",),
        ("roboticstoolbox-python==1.5.0",),
    ),
    Peer("tracik", "TRAC-IK (pytracik)", ("tracik.py", "Tracik"), ("pytracik",), ("pytracik==0.0.3",)),
    Peer("placo", "PlaCo", ("placo_qp.py", "Placo"), ("placo", "pin"), ("placo==0.10.2",)),
    Peer(
        "pink",
        "Pink",
        ("pink_qp.py", "Pink"),
        ("pin-pink", "pin", "daqp"),
        ("pin-pink==4.4.0", "pin==4.1.0", "qpsolvers==4.13.0", "daqp==0.11.0"),
    ),
    Peer("ssik", "ssik", ("ssik_analytic.py", "Ssik"), ("ssik",), ("ssik[urdf]==8.2.0",)),
    Peer(
        "ikpy",
        "ikpy",
        ("ikpy_scipy.py", "Ikpy"),
        ("ikpy", "scipy"),
        ("ikpy==4.2.1",),
    ),
    Peer("drake", "Drake (SNOPT)", ("drake_snopt.py", "Drake"), ("drake",), ("drake==1.51.1",)),
    Peer("pinocchio", "Pinocchio's example", ("pinocchio_example.py", "PinocchioExample"), ("pin",)),
]

# What every row is compared with: short name and key.
REFERENCES: Sequence[tuple[str, str]] = (("pinik", "pinik"), ("RTB", "rtb"), ("TRAC", "tracik"))
