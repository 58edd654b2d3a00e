"""The finite-element solver as the base under repair: its force over depth in the place of the wave's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.discovery.base_law import MARGIN, BaseLaw, BaseLaws, base_law
from benchmark.errors import InputError
from benchmark.files import Session, Support, Tissue, Tool
from benchmark.models import Drive, UncoveredError, prepare
from benchmark.runs.base_curve import setup_scenario

STEPS = 24
LEAST_REACH = 0.5
"""A ramp that the solver followed at least this far of the trials' depth serves; beyond it goes on like the wave."""


def fem_base(session: Session) -> BaseLaws:
    """The base of each set-up of a session, by one depth ramp each.

    Markers on the lower face, and what a wider tool changes, stay the wave model's, scaled with the force.
    """

    def law(tissue: Tissue, tool: Tool, support: Support, depth: float) -> BaseLaw:
        wave = base_law(tissue, tool, support, depth)
        fractions = np.arange(1, STEPS + 1) / STEPS
        deepest = MARGIN * depth
        try:
            ramp = prepare("fem", setup_scenario(session, tissue, (tool, support))).run(
                Drive("depth", fractions, deepest * fractions)
            )
        except UncoveredError as error:
            raise InputError(f"--model fem: the finite elements do not cover {session.name}: {error}.") from None
        if not ramp.depth.size or ramp.depth[-1] < LEAST_REACH * depth:
            reached = 1e3 * float(ramp.depth[-1]) if ramp.depth.size else 0.0
            raise InputError(
                f"--model fem: the finite elements of {session.name} stop at {reached:.3g} mm of {1e3 * depth:.3g} mm; "
                "--model wave goes deeper."
            )
        return _with_force(wave, np.append(0.0, ramp.depth), np.append(0.0, ramp.force))

    return law


def _with_force(wave: BaseLaw, depth: np.ndarray, force: np.ndarray) -> BaseLaw:
    """The wave's tables with another force; beyond the last depth it grows like the wave's."""
    from scipy.interpolate import PchipInterpolator

    inside = wave.depth <= depth[-1]
    ratio = np.ones_like(wave.force)
    curve = PchipInterpolator(depth, force)(np.minimum(wave.depth, depth[-1]))
    np.divide(curve, wave.force, out=ratio, where=inside & (wave.force > 0.0))
    ratio[~inside] = ratio[inside][-1]
    return replace(wave, force=ratio * wave.force, force_by_radius=ratio * wave.force_by_radius)
