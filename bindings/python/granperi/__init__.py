"""granperi: dry granular flow in two dimensions, from first slip to full arrest.

The Python package of the C library granperi. Start with help(granperi.Simulation); pictures are in granperi.plot.
"""
from ._compare import Difference, compare
from ._enums import Density, Field, Fluidity, InitialPressure, Preset, StepLimit, Stress, Wall
from ._errors import (ArgumentError, ArgumentTypeError, DivergedError, Error, FileError, GranperiWarning, InternalError,
                      OutOfMemoryError, StateError, UnsupportedError, VersionError)
from ._library import has_feature
from ._library import lib as _lib
from ._library import text_of as _text_of
from ._objects import Column, Config, Material
from ._output import Output
from ._plate import Plate
from ._probe import Probe
from ._report import report
from ._report_result import Recommendation, Report, Row
from ._result import Result
from ._scene import Run, Scene, SceneError
from ._settings import Settings, settings
from ._simulation import Simulation
from ._snapshot import Snapshot
from ._state import Clock, History, Load, Plan, PlanEntry, State
from ._sweep import Sweep, sweep
from ._views import FieldView, Particles, View

#: Version of the C library that runs, which is that of the package, too.
__version__ = _text_of(_lib.gp_version_string())


load = Simulation.load

__all__ = [
    "ArgumentError", "ArgumentTypeError", "Clock", "Column", "Config", "Density", "Difference", "DivergedError", "Error",
    "Field", "FieldView", "FileError", "Fluidity", "GranperiWarning", "History", "InitialPressure", "InternalError",
    "Load", "Material", "OutOfMemoryError", "Output", "Particles", "Plan", "PlanEntry", "Plate", "Preset", "Probe", "Recommendation", "Report",
    "Result", "Row", "Run",
    "Scene", "SceneError", "Settings", "Simulation", "Snapshot", "State", "StateError", "StepLimit", "Stress", "Sweep",
    "UnsupportedError", "VersionError", "View", "Wall", "compare", "has_feature", "load", "report",
    "settings", "sweep",
]
