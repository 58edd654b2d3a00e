"""The figure of both models' layers under the press, drawn from their profiles at peak load."""

from __future__ import annotations

import numpy as np

from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import MM, pair_names
from reports import Block
from reports.figures.pressed_layers import pressed_layers

REACH = 4.0
"""Tool radii round its axis that are shown."""


def pressed_block(record: RunRecord) -> Block | None:
    """The layers as they lie at peak load; None where they are no body of revolution, or no model has a profile."""
    scenario = record.scenario
    results = (record.pair.fem.result, record.pair.wave.result)
    reference = next((each for each in results if each is not None and each.time.size), None)
    if reference is None or scenario.fem.geometry != "axisymmetric":
        return None
    near = reference.profile_radii <= REACH * scenario.tool.radius * (1.0 + 1e-9)
    fem, wave = (None if each is None else MM * each.profile[:, near] for each in results)
    thickness = [MM * layer.thickness for layer in scenario.tissue.layers]
    depths = np.concatenate([[0.0], np.cumsum(thickness)])
    return pressed_layers(
        record.layers,
        depths[:-1],
        float(depths[-1]) if scenario.support.kind == "bonded" else None,
        MM * reference.profile_radii[near],
        fem,
        wave,
        MM * scenario.tool.radius,
        pair_names(record),
    )
