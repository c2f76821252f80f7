"""pinik: any URDF into Pinocchio, and answers to two questions about it.

Where are its frames (`Robot.placement`, `Robot.jacobian`), and which joint values put them where I want them
(`Robot.solve`, `solve`, `iterate`).
"""

from .closed_form import TwoBoneAnswers, two_bone
from .errors import (
    EngineError,
    InputError,
    PinikError,
    RobotLoadError,
    SolveError,
    UnknownNameError,
    UrdfWarning,
)
from .joint import Joint
from .kinematics import Kinematics, Linearization
from .loading import load
from .loop import iterate, solve
from .many import Solutions, solve_many
from .picture import Picture, draw
from .prepared import Prepared, prepare
from .robot import Robot
from .robot_catalog import catalog
from .solution import Solution
from .solvers import (
    CCD,
    CLOSED_FORMS,
    SOLVERS,
    DampedLeastSquares,
    JacobianSolver,
    JacobianTranspose,
    Patience,
    PseudoInverse,
    Solver,
    SweepingSolver,
    TwoBoneSolver,
    parameter,
)
from .state import State, Status
from .targets import Target, TargetError, Tolerance
from .two_bone_robot import TwoBone, TwoBoneConfigurations
from .viewer import live

__version__ = "0.1.0"

__all__ = [
    "CCD",
    "CLOSED_FORMS",
    "SOLVERS",
    "DampedLeastSquares",
    "EngineError",
    "InputError",
    "JacobianSolver",
    "JacobianTranspose",
    "Joint",
    "Kinematics",
    "Linearization",
    "Patience",
    "Picture",
    "PinikError",
    "Prepared",
    "PseudoInverse",
    "Robot",
    "RobotLoadError",
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
    "TwoBone",
    "TwoBoneAnswers",
    "TwoBoneConfigurations",
    "TwoBoneSolver",
    "UnknownNameError",
    "UrdfWarning",
    "catalog",
    "draw",
    "iterate",
    "live",
    "load",
    "parameter",
    "prepare",
    "solve",
    "solve_many",
    "two_bone",
]
