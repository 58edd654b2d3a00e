"""Tracks to displacements, fits, circles and the article's Table 1: pure functions on arrays, SI units."""

from bench_hw.vision.displacement.fits import (
    Circles,
    MaximumRadius,
    ParabolaFits,
    fit_circles,
    fit_parabolas,
    largest_sample,
    maximum_radius,
)
from bench_hw.vision.displacement.table_1 import (
    PublishedVariables,
    SoundVariables,
    published_variables,
    side_by_side,
    sound_variables,
)
from bench_hw.vision.displacement.tracks import (
    MarkerBlock,
    Tracks,
    deformation_window,
    displacements,
    inner_nine,
    moving_average,
    tracks_of,
)

__all__ = [
    "Circles",
    "MarkerBlock",
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
