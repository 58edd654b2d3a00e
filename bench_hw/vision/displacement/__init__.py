"""Tracks to displacements, fits, circles and the article's Table 1: pure functions on arrays, SI units."""

from bench_hw.vision.displacement.block import Block, inner_nine
from bench_hw.vision.displacement.circle import Circles, fit_circles
from bench_hw.vision.displacement.maximum import MaximumRadius, largest_sample, maximum_radius
from bench_hw.vision.displacement.parabola import ParabolaFits, fit_parabolas
from bench_hw.vision.displacement.published import PublishedVariables, published_variables
from bench_hw.vision.displacement.smoothing import moving_average
from bench_hw.vision.displacement.sound import SoundVariables, side_by_side, sound_variables
from bench_hw.vision.displacement.tracks import Tracks, deformation_window, displacements, tracks_of

__all__ = [
    "Block",
    "Circles",
    "MaximumRadius",
    "ParabolaFits",
    "PublishedVariables",
    "SoundVariables",
    "Tracks",
    "deformation_window",
    "displacements",
    "fit_circles",
    "fit_parabolas",
    "inner_nine",
    "largest_sample",
    "maximum_radius",
    "moving_average",
    "published_variables",
    "side_by_side",
    "sound_variables",
    "tracks_of",
]
