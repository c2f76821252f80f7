"""pinik: any URDF into Pinocchio, and answers to two questions about it.

Where are its frames (`Robot.placement`, `Robot.jacobian`), and which joint values put them where I want them
(`Robot.solve`, `solve`, `iterate`).
"""

from . import early_signals as early_signals  # before the others, whose loading takes most of a short command's time

# isort: split
import typing as _typing

from .closed_form.robot_bones import TwoBone, TwoBoneConfigurations
from .closed_form.two_bone import TwoBoneAnswers, two_bone
from .description.catalog import catalog
from .errors import (
    EngineError,
    InputError,
    InputWarning,
    PinikError,
    RobotLoadError,
    SolveError,
    UnknownNameError,
    UrdfWarning,
)
from .extras import MissingExtraError
from .loading import load
from .model.joint import Joint
from .picture.draw import draw
from .picture.picture import Picture
from .problem.kinematics import Kinematics, Linearization
from .problem.targets import Target
from .problem.tolerance import TargetError, Tolerance
from .robot import Robot
from .shapes.collisions import Clearance, Collision
from .shapes.world import World
from .solvers.base import JacobianSolver, Patience, Solver, SweepingSolver
from .solvers.ccd import CCD
from .solvers.damped_least_squares import DampedLeastSquares
from .solvers.parameter import parameter
from .solvers.pseudo_inverse import PseudoInverse
from .solvers.registry import CLOSED_FORMS, SOLVERS
from .solvers.transpose import JacobianTranspose
from .solvers.two_bone import TwoBoneSolver
from .solving.branches import Branches
from .solving.front import iterate, prepare, solve
from .solving.many import Solutions, solve_many
from .solving.options import Options
from .solving.prepared import Prepared
from .solving.self_motion import SelfMotion, self_motion
from .solving.solution import Solution
from .solving.solve_all import solve_all
from .solving.state import State, Status
from .solving.track import Track, track
from .solving.tracker import Tracker, TrackerStatus
from .version import __version__ as __version__
from .viewer.live import live

if _typing.TYPE_CHECKING:
    from . import batch as batch
    from .workspace.front import reach
    from .workspace.reach_map import ReachMap
else:

    def __getattr__(name: str) -> object:
        """`pinik.batch`, `pinik.reach` and `ReachMap`, which few programs need, are loaded when they are asked for."""
        if name == "batch":
            import importlib

            found = importlib.import_module(".batch", __name__)  # `from . import` would ask here again
        elif name == "reach":
            from .workspace.front import reach as found
        elif name == "ReachMap":
            from .workspace import reach_map

            found = reach_map.ReachMap
        else:
            raise AttributeError(f"module 'pinik' has no attribute {name!r}")
        globals()[name] = found
        return found


__all__ = [
    "CCD",
    "CLOSED_FORMS",
    "SOLVERS",
    "Branches",
    "Clearance",
    "Collision",
    "DampedLeastSquares",
    "EngineError",
    "InputError",
    "InputWarning",
    "JacobianSolver",
    "JacobianTranspose",
    "Joint",
    "Kinematics",
    "Linearization",
    "MissingExtraError",
    "Options",
    "Patience",
    "Picture",
    "PinikError",
    "Prepared",
    "PseudoInverse",
    "ReachMap",
    "Robot",
    "RobotLoadError",
    "SelfMotion",
    "Solution",
    "Solutions",
    "SolveError",
    "Solver",
    "State",
    "Status",
    "SweepingSolver",
    "Target",
    "TargetError",
    "Tolerance",
    "Track",
    "Tracker",
    "TrackerStatus",
    "TwoBone",
    "TwoBoneAnswers",
    "TwoBoneConfigurations",
    "TwoBoneSolver",
    "UnknownNameError",
    "UrdfWarning",
    "World",
    "catalog",
    "draw",
    "iterate",
    "live",
    "load",
    "parameter",
    "prepare",
    "reach",
    "self_motion",
    "solve",
    "solve_all",
    "solve_many",
    "track",
    "two_bone",
]
