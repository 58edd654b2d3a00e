"""Figures of a report, a subject a file: plain arrays in the units of the border (mm, N, s) to inline SVG.

Every function returns a `reports.blocks.Figure` with caption and a description in words; `moving_surface` a GIF.
"""

from reports.figures.fitted_parameters import FittedParameter, fitted_parameters
from reports.figures.force_depth import force_depth
from reports.figures.gap_bars import Gap, gap_bars
from reports.figures.layer_stack import layer_stack
from reports.figures.load_history import load_history
from reports.figures.markers import circle_radius, marker_motion
from reports.figures.max_deformation import max_deformation
from reports.figures.measured import measured
from reports.figures.moving_surface import moving_surface
from reports.figures.normal_fit import Normal, normal_fit
from reports.figures.pair import Pair
from reports.figures.profile import profile
from reports.figures.ranking import RankedCandidate, ranking
from reports.figures.repaired import RepairedTrace, repaired
from reports.figures.section import StackLayer
from reports.figures.timing import timing
from reports.figures.trials import TrialCurve
from reports.figures.where_map import Disagreement, where_map

__all__ = [
    "Disagreement",
    "FittedParameter",
    "Gap",
    "Normal",
    "Pair",
    "RankedCandidate",
    "RepairedTrace",
    "StackLayer",
    "TrialCurve",
    "circle_radius",
    "fitted_parameters",
    "force_depth",
    "gap_bars",
    "layer_stack",
    "load_history",
    "marker_motion",
    "max_deformation",
    "measured",
    "moving_surface",
    "normal_fit",
    "profile",
    "ranking",
    "repaired",
    "timing",
    "where_map",
]
