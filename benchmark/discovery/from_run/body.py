"""The wave model's elastic body as a run shows it, and what becomes of it with effects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmark.discovery.from_run.reading import Array, FinishedRun
from benchmark.models.scenario_effects import specimen_layers
from benchmark.physics import Effect, TrialContext
from wavemodel.physics import Physics, QuasiStaticPress
from wavemodel.physics.force_driven import drive_by_force

NOTHING = Physics()


@dataclass(frozen=True, eq=False)
class Body:
    """Force over depth of the wave model's elastic body, and the layers' deflections over its elastic force.

    Attributes
    ----------
    depth, force : (m,) array
        From zero up, rising; beyond the last the law goes on with its last slope.
    layers : (m, L) array
        Deflection of each layer's top face, m.
    around : TrialContext
    """

    depth: Array
    force: Array
    layers: Array
    around: TrialContext

    def law(self, depth: Array) -> Array:
        """(n,) N at depths (n,) in m of 0 and more."""
        return _extended(np.asarray(depth, dtype=np.float64), self.depth, self.force)

    def pressed(self, time: Array, depth: Array, physics: Physics = NOTHING) -> Array:
        """(n,) N of a tool moved through depths (n,)."""
        return QuasiStaticPress(self.law, physics).force(time, depth)

    def deflections(self, time: Array, force: Array, physics: Physics = NOTHING) -> Array:
        """(n, L) m under a history of force; as the wave model answers with options of its body."""
        press = QuasiStaticPress(self.law, physics)
        trace = drive_by_force(press, time, force, float(self.depth[-1]))
        elastic = self.law(np.maximum(trace.surface, 0.0))
        return np.column_stack([_extended(elastic, self.force, column) for column in self.layers.T])


def body_of(run: FinishedRun) -> Body:
    """The body of a run's wave model, from its rows while the load rises."""
    rising = run.force > np.concatenate(([0.0], np.maximum.accumulate(run.force)[:-1]))
    layers = np.vstack([np.zeros((1, run.wave.shape[1])), run.wave[rising]])
    stack = [layer.thickness for layer in run.scenario.tissue.layers if np.isfinite(layer.thickness)]
    around = TrialContext(
        tool_radius=run.scenario.tool.radius,
        thickness=float(sum(stack)),
        peak_depth=float(run.reference[:, 0].max()),
        peak_force=float(run.force.max()),
        duration=float(run.time[-1]),
        layers=specimen_layers(run.scenario.tissue.layers),
        contact=run.scenario.tool.contact,
    )
    return Body(layers[:, 0], np.concatenate(([0.0], run.force[rising])), layers, around)


def physics_of(effect: Effect, values: Mapping[str, float], around: TrialContext) -> Physics:
    """The options of the body with one effect switched on."""
    return NOTHING if effect.body is None else Physics(**effect.body(values, around))


def _extended(x: Array, xs: Array, ys: Array) -> Array:
    """Linear between the points, and on beyond the last with the last slope."""
    slope = (ys[-1] - ys[-2]) / (xs[-1] - xs[-2])
    return np.asarray(np.interp(x, xs, ys) + slope * np.maximum(x - xs[-1], 0.0))
