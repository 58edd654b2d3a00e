"""Fitting force-depth trials with the elastic curve of a model: one stiffness, the trial as the unit.

Nothing here runs a model, reads or writes a file. SciPy's parts and lmfit are loaded when first needed.
"""

from benchmark.fitting.contact import required_depth
from benchmark.fitting.curve import ForceCurve
from benchmark.fitting.errors import FittingError, NoContactError
from benchmark.fitting.joint import JointFit
from benchmark.fitting.parameters import FittedParameter, LayerLike, parameter_columns
from benchmark.fitting.pooling import PooledStiffness
from benchmark.fitting.prediction import held_out_stiffness, predict
from benchmark.fitting.session import Excluded, SessionFit, fit_session
from benchmark.fitting.trial import TrialData
from benchmark.fitting.trial_fit import fit_trial
from benchmark.fitting.trial_result import TrialFit

__all__ = [
    "Excluded",
    "FittedParameter",
    "FittingError",
    "ForceCurve",
    "JointFit",
    "LayerLike",
    "NoContactError",
    "PooledStiffness",
    "SessionFit",
    "TrialData",
    "TrialFit",
    "fit_session",
    "fit_trial",
    "held_out_stiffness",
    "parameter_columns",
    "predict",
    "required_depth",
]
