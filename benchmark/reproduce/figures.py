"""The article's Figures 7, 8, 10, 11, 12 and 13 redrawn, by their numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from bench_hw.vision.displacement import fit_circles, largest_sample, moving_average
from benchmark.reproduce.evidence import Chain, Evidence
from benchmark.runs.record import RunRecord
from benchmark.runs.report.deformation_section import layer_deformations
from benchmark.runs.report.published_section import LABELS, published_animation
from benchmark.runs.report.statistics_section import normal_fits
from reports import Figure
from reports.figures.marker_circle import Ring, marker_circle
from reports.figures.markers import circle_radius, marker_motion

MM = 1e3
PREDICTED = "Skin under 5 N (scenario skin-5N); the wave model predicts, nothing of the FEM is fed in."
FILTER = "A moving average over the last ten frames was taken, as in the article."


def redrawn(evidence: Evidence) -> Mapping[int, tuple[Figure, ...]]:
    """Return the figures by the article's number."""
    chain = evidence.chain
    return {
        7: (_motion(chain),),
        8: (*_still(chain), _overlay(chain)),
        10: (_growth(chain),),
        11: tuple(_titled(published_animation(variant), f"Eq. (7), {label}") for variant, label in LABELS.items()),
        12: (_titled(layer_deformations(evidence.press), "Maximum displacements", PREDICTED),),
        13: _normals(evidence.press),
    }


def _titled(figure: Figure, title: str, more: str = "") -> Figure:
    return replace(figure, title=title, caption=f"{figure.caption} {more}".rstrip())


def _name(chain: Chain) -> str:
    return f"{chain.shown.trial} (synthetic)" if chain.synthetic else chain.shown.trial


def _motion(chain: Chain) -> Figure:
    moved = moving_average(chain.shown.moved, mode="causal")
    return _titled(marker_motion(_name(chain), chain.shown.time, MM * moved), "Displacement of each marker", FILTER)


def _still(chain: Chain) -> tuple[Figure, ...]:
    if chain.tracked is None or chain.tracked.still is None:
        return ()
    caption = f"{_name(chain)} as the camera sees it at its farthest motion, with the markers that were found."
    alt = "The picture of the markers with circles around each."
    return (Figure.of_picture(chain.tracked.still, caption, alt, "The markers found"),)


def _overlay(chain: Chain) -> Figure:
    block, shown = chain.shown.block, chain.shown
    assert block is not None  # the shipped session's grid has one
    circles = fit_circles(chain.places[:, block.nine])
    largest = largest_sample(shown.time, shown.radius_nine).frame
    first = int(np.isfinite(shown.radius_nine).argmax())
    rings = [
        Ring(name, *(float(MM * each[frame]) for each in (*circles.centre.T, circles.radius)))
        for name, frame in (("at rest", first), ("at its largest", largest))
    ]
    nine, places = [int(number) for number in block.nine], MM * chain.places[largest]
    return _titled(marker_circle(_name(chain), places, nine, block.centre, *rings), "The circle around the tool")


def _growth(chain: Chain) -> Figure:
    shown = chain.shown
    radii = (MM * shown.radius_nine, MM * shown.radius_ring)
    return _titled(circle_radius(_name(chain), shown.time, *radii, MM * chain.depth), "The circle over the press")


def _normals(record: RunRecord) -> tuple[Figure, ...]:
    figure = normal_fits(record)
    return () if figure is None else (_titled(figure, "Normal distributions", PREDICTED),)
