"""Who is compared, with which versions and settings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .peer import ONE_BY_ONE, WITH_TOLERANCE, Peer

__all__ = ["PEERS", "REFERENCES", "pinik_by"]

PINIK, PINIK_PACKAGES = "pinik_itself.py", ("pinik", "pin")
RTB, RTB_REQUIREMENTS = ("roboticstoolbox-python",), ("roboticstoolbox-python==1.5.0",)
EAIK, EAIK_REQUIREMENTS = ("EAIK",), ("EAIK==1.2.2", "urchin==0.0.30")
EAIK_ARMS = "at most 6 revolute joints, of known families"
FRANKIK, FRANKIK_REQUIREMENTS = ("frankik",), ("frankik==1.0.1",)
OPTIK, OPTIK_REQUIREMENTS = ("optik-py",), ("optik-py==0.5.0", "numpy")
ONE_START = "one start"


def _pinik(key: str, label: str, adapter: str, tasks: tuple[str, ...], **rest: Any) -> Peer:
    return Peer(f"pinik{key}", f"pinik {label}", (PINIK, adapter), PINIK_PACKAGES, tasks=tasks, **rest)


def pinik_by(method: str) -> Peer:
    """The row "pinik solve" by another method than the default."""
    return _pinik(f"-{method}", f"solve ({method})", "SolveWithOptions", ONE_BY_ONE, options={"method": method})


PINIK_ROWS = [
    _pinik("", "solve", "Solve", ONE_BY_ONE),
    _pinik("-tolerance", "solve", "SolveWithOptions", ("tolerance",)),
    _pinik("-prepared", "prepared", "SolvePrepared", WITH_TOLERANCE),
    _pinik("-own-starts", "solve, own starts", "SolveFromOwnStarts", ("poses",)),
    _pinik("-track", "track, whole path", "Track", ("path",), batch=True),
    *(
        _pinik(
            f"-many-{threads}",
            f"solve_many, {threads} thread{'s' if threads > 1 else ''}",
            "SolveMany",
            ("batch",),
            options={"threads": threads},
            batch=True,
            threads=threads,
        )
        for threads in (1, 2)
    ),
    _pinik("-placement", "placement", "Placement", ("forward",)),
    _pinik("-placements", "placements", "Placements", ("forward",), batch=True, threads=2),
]

ITERATIVE = [
    Peer(
        "rtb",
        "Robotics Toolbox ik_LM",
        ("robotics_toolbox.py", "RoboticsToolbox"),
        RTB,
        RTB_REQUIREMENTS,
        tasks=WITH_TOLERANCE,
        lacks="one chain",
    ),
    Peer(
        "tracik",
        "TRAC-IK (pytracik)",
        ("tracik.py", "Tracik"),
        ("pytracik",),
        ("pytracik==0.0.3",),
        tasks=WITH_TOLERANCE,
        lacks="one chain; uses two threads",
        threads=2,
    ),
    Peer(
        "cartan",
        "cartan solve_ik_speed",
        ("cartan_speed.py", "Cartan"),
        ("cartan-bindings",),
        ("cartan-bindings==0.4.2", "numpy"),
        tasks=WITH_TOLERANCE,
        lacks="a URDF with one leaf, no mimic joints, no links without mass",
    ),
    *(
        Peer(
            "optik" if threads == 1 else f"optik-{threads}",
            f"OptIK, {threads} thread{'s' if threads > 1 else ''}",
            ("optik_slsqp.py", "Optik"),
            OPTIK,
            OPTIK_REQUIREMENTS,
            options={"threads": threads},
            tasks=WITH_TOLERANCE if threads == 1 else ONE_BY_ONE,
            lacks="one chain, whole poses",
            threads=threads,
        )
        for threads in (1, 2)
    ),
    Peer("placo", "PlaCo", ("placo_qp.py", "Placo"), ("placo", "pin"), ("placo==0.10.2",), lacks=ONE_START),
    Peer(
        "pink",
        "Pink",
        ("pink_qp.py", "Pink"),
        ("pin-pink", "pin", "daqp"),
        ("pin-pink==4.4.0", "pin==4.1.0", "qpsolvers==4.13.0", "daqp==0.11.0"),
        lacks=ONE_START,
    ),
    Peer("ikpy", "ikpy", ("ikpy_scipy.py", "Ikpy"), ("ikpy", "scipy"), ("ikpy==4.2.1",), lacks=ONE_START),
    Peer("drake", "Drake (SNOPT)", ("drake_snopt.py", "Drake"), ("drake",), ("drake==1.51.1",), lacks=ONE_START),
    Peer(
        "pinocchio",
        "Pinocchio's example",
        ("pinocchio_example.py", "PinocchioExample"),
        ("pin",),
        lacks=f"no limits; {ONE_START}",
    ),
]

CLOSED_FORMS = [
    Peer(
        "eaik",
        "EAIK, first answer",
        ("eaik_closed.py", "First"),
        EAIK,
        EAIK_REQUIREMENTS,
        lacks=f"no limits, no start; {EAIK_ARMS}",
    ),
    Peer(
        "eaik-nearest",
        "EAIK, limits and nearest",
        ("eaik_closed.py", "Nearest"),
        EAIK,
        EAIK_REQUIREMENTS,
        lacks=f"limits and choice in numpy around it; {EAIK_ARMS}",
    ),
    *(
        Peer(
            f"eaik-many-{threads}",
            f"EAIK IK_batched, {threads} thread{'s' if threads > 1 else ''}",
            ("eaik_closed.py", "Many"),
            EAIK,
            EAIK_REQUIREMENTS,
            options={"threads": threads},
            tasks=("batch",),
            lacks=f"no limits, no starts; {EAIK_ARMS}",
            batch=True,
            threads=threads,
        )
        for threads in (1, 2)
    ),
    Peer(
        "frankik",
        "frankik",
        ("franka_analytic.py", "Frankik"),
        FRANKIK,
        FRANKIK_REQUIREMENTS,
        lacks="Franka arms alone; tries q7 within 20° of its start",
    ),
    Peer(
        "frankik-fine",
        "frankik, every q7",
        ("franka_analytic.py", "Frankik"),
        FRANKIK,
        FRANKIK_REQUIREMENTS,
        options={"q7_sample_interval": 332, "q7_sample_size": 60, "global_solution": True},
        lacks="Franka arms alone; tries 60 values of q7",
    ),
    Peer(
        "ssik",
        "ssik",
        ("ssik_analytic.py", "Ssik"),
        ("ssik",),
        ("ssik[urdf]==8.2.0",),
        lacks="6 or 7 revolute joints; a module built for each arm",
    ),
]

FORWARD = [
    Peer(
        "rtb-forward",
        "Robotics Toolbox ETS.eval",
        ("robotics_toolbox.py", "Forward"),
        RTB,
        RTB_REQUIREMENTS,
        tasks=("forward",),
        batch=True,
    ),
    Peer(
        "pinocchio-forward",
        "Pinocchio, a call each",
        ("pinocchio_example.py", "Forward"),
        ("pin",),
        tasks=("forward",),
    ),
]

PEERS: Sequence[Peer] = [*PINIK_ROWS, *ITERATIVE, *CLOSED_FORMS, *FORWARD]

# What pinik's rows are compared with: short name and key.
REFERENCES: Sequence[tuple[str, str]] = (
    ("Robotics Toolbox ik_LM", "rtb"),
    ("TRAC-IK", "tracik"),
    ("cartan", "cartan"),
    ("EAIK, first answer", "eaik"),
)
