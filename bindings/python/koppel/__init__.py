"""koppel: mechanisms with closed loops, from Python. See README.md beside the package for a first example.

Units are SI, angles radians. A Mechanism never changes and may be used by many threads; a State by one at a time.
"""

from .engine import Engine, Scene, load
from .equilibrium import Equilibrium
from .error import Error, Finding
from .linearisation import Eigenmode, Linearisation, Matrix
from .mechanism import Mechanism
from .modes import Mode, Modes
from .run import run
from .simulation import Crossing, Simulation, Summary, simulate
from .state import Analysis, Freedoms, Reactions, Report, State
from .stream import Statistics, Stream
from .tree import Momentum, Tree

__all__ = ["Analysis", "Crossing", "Eigenmode", "Engine", "Equilibrium", "Error", "Finding", "Freedoms",
           "Linearisation", "Matrix", "Mechanism", "Mode", "Modes", "Momentum", "Reactions", "Report", "Scene",
           "Simulation", "State", "Statistics", "Stream", "Summary", "Tree", "load", "run", "simulate"]
