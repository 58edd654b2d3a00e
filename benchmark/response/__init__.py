"""The response of a specimen to a press, once for every verb: its elastic table, the way of a trial, and the fit.

`ramp` presses any prepared model; its points become a `ForceCurve` and a `RampTable` (smooth, for the fit of a session)
or an `ElasticTable` (a fine grid, for discovery), with derivatives by set-up parameters. `pipeline` leads a trial
through drive, body and observation with effects; `least_squares` is the engine of every fit.
"""

from benchmark.response.elastic_table import ElasticTable, SeparableField, SetupDerivative, TableOf
from benchmark.response.force_curve import ForceCurve, ResponseError
from benchmark.response.pipeline import TrialPipeline, trial_force
from benchmark.response.ramp import Ramp, depth_ramp
from benchmark.response.ramp_table import CameraView, FaceField, Neighbour, RampTable

__all__ = [
    "CameraView",
    "ElasticTable",
    "FaceField",
    "ForceCurve",
    "Neighbour",
    "Ramp",
    "RampTable",
    "ResponseError",
    "SeparableField",
    "SetupDerivative",
    "TableOf",
    "TrialPipeline",
    "depth_ramp",
    "trial_force",
]
