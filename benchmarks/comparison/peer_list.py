"""Who is compared: each peer's packages, adapter and options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

__all__ = ["PEERS", "REFERENCES", "Peer", "pinik_rows"]


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
    options: dict[str, object] = field(default_factory=dict)
    batch: bool = False
    not_on_path: str = ""


def pinik_rows(method: str, suffix: str = "") -> list[Peer]:
    """pinik's rows by one method; the suffix tells other methods from the default one."""

    def row(key: str, label: str, adapter: str, **rest: object) -> Peer:
        options = {"method": method, **rest.pop("options", {})}  # type: ignore[dict-item]
        tail = f" ({method})" if suffix else ""
        return Peer(key + suffix, label + tail, ("pinik_itself.py", adapter), ("pinik", "pin"), options=options, **rest)  # type: ignore[arg-type]

    many = {"batch": True, "not_on_path": "a batch knows no last answer to start from"}
    return [
        row("pinik", "pinik solve", "Solve"),
        row("pinik-prepared", "pinik prepared", "SolvePrepared"),
        row("pinik-own-starts", "pinik solve, own starts", "SolveFromOwnStarts", not_on_path="it takes no start"),
        row("pinik-many-1", "pinik solve_many, 1 thread", "SolveMany", options={"threads": 1}, **many),
        row("pinik-many-2", "pinik solve_many, 2 threads", "SolveMany", options={"threads": 2}, **many),
    ]


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
        "ikpy (JAX)",
        ("ikpy_jax.py", "Ikpy"),
        ("ikpy", "jax", "scipy"),
        ("ikpy[jax]==4.2.1", "jax==0.10.2", "jaxlib==0.10.2"),
    ),
    Peer("drake", "Drake (SNOPT)", ("drake_snopt.py", "Drake"), ("drake",), ("drake==1.51.1",)),
    Peer("pinocchio", "Pinocchio's example", ("pinocchio_example.py", "PinocchioExample"), ("pin",)),
]

# What every row is compared with: short name and key.
REFERENCES: Sequence[tuple[str, str]] = (("RTB", "rtb"), ("TRAC", "tracik"))
