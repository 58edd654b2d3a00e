"""Figures of a report, a subject a file: plain arrays in the units of the border (mm, N, s) to inline SVG.

Every function returns a `reports.blocks.Figure` with caption and a description in words; `moving_surface` a GIF.
"""

from reports.figures.deflection import max_deformation, profile
from reports.figures.disagreement import Disagreement, RepairedTrace, repaired, where_map
from reports.figures.layer_stack import StackLayer, layer_stack
from reports.figures.load_curves import force_depth, load_history
from reports.figures.markers import circle_radius, marker_motion
from reports.figures.measured import TrialCurve, measured
from reports.figures.normal_fit import Normal, normal_fit
from reports.figures.pressed_layers import moving_surface
from reports.figures.rows import (
    GapRow,
    ParameterRow,
    RankedCandidate,
    ShareRow,
    fitted_parameters,
    gap_bars,
    ranking,
    shares,
)
from reports.figures.style import Pair
from reports.figures.timing import timing
from reports.figures.tool_outline import ToolShape

__all__ = [
    "Disagreement",
    "GapRow",
    "Normal",
    "Pair",
    "ParameterRow",
    "RankedCandidate",
    "RepairedTrace",
    "ShareRow",
    "StackLayer",
    "ToolShape",
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
    "shares",
    "timing",
    "where_map",
]
