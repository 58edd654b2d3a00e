"""Fitting force-depth trials with the elastic curve of a model: one stiffness, the trial as the unit.

Nothing here runs a model, reads or writes a file. SciPy is loaded when first needed.
"""

from benchmark.identification.fitted_parameters import FittedParameter, LayerLike, parameter_columns
from benchmark.identification.pooling import JointFit, PooledStiffness
from benchmark.identification.session_fit import Excluded, SessionFit, fit_session, held_out_stiffness, predict
from benchmark.identification.sheet_model import Film, FilmedTrial, filmed_trial, sheet_force, sheet_markers
from benchmark.identification.sheet_session import SheetFit, fit_sheet, held_out_state
from benchmark.identification.trial_data import FittingError, NoContactError, TrialData
from benchmark.identification.trial_features import required_depth
from benchmark.identification.trial_fit import TrialFit, fit_trial

__all__ = [
    "Excluded",
    "Film",
    "FilmedTrial",
    "FittedParameter",
    "FittingError",
    "JointFit",
    "LayerLike",
    "NoContactError",
    "PooledStiffness",
    "SessionFit",
    "SheetFit",
    "TrialData",
    "TrialFit",
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
