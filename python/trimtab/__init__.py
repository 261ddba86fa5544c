"""Fit an interpretable ship manoeuvring model (3-DoF: surge, sway, yaw) to recordings by exact gradients, and find what it lacks.

    import trimtab

    study = trimtab.Study.load("mine/study.toml")
    fit = study.fit()
    print(fit.report())
    print(study.diagnose(model=fit.model).headline)

Units are SI and radians. Earth frame: x north, y east, psi clockwise from north, not wrapped. Body frame: u forward, v and r to
starboard, over ground; a positive rudder angle delta turns the ship to starboard; the propeller rate n is in revolutions per second.
Arrays are numpy arrays of float64. Errors say what, where and what to do next, and all are a `TrimtabError` (a `ValueError`).
Warnings about recordings go to the logger "trimtab".
"""

from ._logs import example, import_log
from ._trimtab import (
    Constraints,
    Diagnosis,
    DiagnosisError,
    Estimate,
    Evaluation,
    Fit,
    FitError,
    FitProgress,
    ManeuverError,
    Model,
    ModelError,
    Objective,
    Parameter,
    RecordingsError,
    Ship,
    ShipError,
    Study,
    StudyError,
    Term,
    Trajectory,
    Trial,
    TrimtabError,
    Window,
    __version__,
    set_threads,
    terms,
)

__all__ = [
    "Constraints",
    "Diagnosis",
    "DiagnosisError",
    "Estimate",
    "Evaluation",
    "Fit",
    "FitError",
    "FitProgress",
    "ManeuverError",
    "Model",
    "ModelError",
    "Objective",
    "Parameter",
    "RecordingsError",
    "Ship",
    "ShipError",
    "Study",
    "StudyError",
    "Term",
    "Trajectory",
    "Trial",
    "TrimtabError",
    "Window",
    "__version__",
    "example",
    "import_log",
    "set_threads",
    "terms",
]
