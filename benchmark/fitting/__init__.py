"""Fitting force-depth trials with the elastic curve of a model: one stiffness, the trial as the unit.

Nothing here runs a model, reads or writes a file. SciPy's parts and lmfit are loaded when first needed.
"""

from benchmark.fitting.contact import required_depth
from benchmark.fitting.curve import ForceCurve
from benchmark.fitting.errors import FittingError, NoContactError
from benchmark.fitting.face import FaceField, View
from benchmark.fitting.film import Film, FilmedTrial, filmed_trial
from benchmark.fitting.joint import JointFit
from benchmark.fitting.parameters import FittedParameter, LayerLike, parameter_columns
from benchmark.fitting.pooling import PooledStiffness
from benchmark.fitting.prediction import held_out_stiffness, predict
from benchmark.fitting.session import Excluded, SessionFit, fit_session
from benchmark.fitting.sheet_law import Sheet, sheet_force, sheet_markers
from benchmark.fitting.sheet_session import SheetFit, fit_sheet, held_out_state
from benchmark.fitting.trial import TrialData
from benchmark.fitting.trial_fit import fit_trial
from benchmark.fitting.trial_result import TrialFit

__all__ = [
    "Excluded",
    "FaceField",
    "Film",
    "FilmedTrial",
    "FittedParameter",
    "FittingError",
    "ForceCurve",
    "JointFit",
    "LayerLike",
    "NoContactError",
    "PooledStiffness",
    "SessionFit",
    "Sheet",
    "SheetFit",
    "TrialData",
    "TrialFit",
    "View",
    "filmed_trial",
    "fit_session",
    "fit_sheet",
    "fit_trial",
    "held_out_state",
    "held_out_stiffness",
    "parameter_columns",
    "predict",
    "required_depth",
    "sheet_force",
    "sheet_markers",
]
