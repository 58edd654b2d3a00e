"""A finished run as a fit sees it: the wave model as a ramp, loads held out, where it misses, the gap in each layer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import Array, Contrast, Place
from benchmark.discovery.from_run.finished_run import FinishedRun
from benchmark.discovery.report.discovery_record import LayerGap
from benchmark.errors import InputError
from benchmark.models.scenario_effects import measured_height, open_radius, specimen_layers
from benchmark.physics import TrialContext
from benchmark.response import Ramp
from wavemodel.physics import Physics, QuasiStaticPress, drive_by_force

HALF = 0.5
CLASSES = 3
"""Classes of depth in which a disagreement is placed."""
NOTHING = Physics()


@dataclass(frozen=True, eq=False)
class RunCase:
    """A press of the reference beside the wave model.

    Attributes
    ----------
    run : FinishedRun
    ramp : Ramp
        The wave model's elastic answer.
    context : TrialContext
        What effects may know of the press.
    fitted, held : (n,) array of bool
        Rows that a fit sees, and rows on which it is judged.
    """

    run: FinishedRun
    ramp: Ramp
    context: TrialContext
    fitted: NDArray[np.bool_]
    held: NDArray[np.bool_]

    @property
    def depth(self) -> Array:
        """(n,) m of the reference's surface."""
        return self.run.reference[:, 0]

    def force(self, physics: Physics = NOTHING) -> Array:
        """(n,) N of the wave model with options of its body, moved through the reference's depths."""
        return QuasiStaticPress(self.ramp.force_at, physics).force(self.run.time, self.depth)

    def deflections(self, physics: Physics = NOTHING) -> Array:
        """(n, L) m of the wave model with options of its body under the run's force."""
        press = QuasiStaticPress(self.ramp.force_at, physics)
        trace = drive_by_force(press, self.run.time, self.run.force, float(self.ramp.depth[-1]))
        return self.ramp.layers_at(np.maximum(trace.surface, 0.0))


def split(run: FinishedRun, other: FinishedRun | None) -> tuple[RunCase, RunCase]:
    """The case that is fitted, and the case whose held-out rows count: the upper half of loads, or the other run.

    Raises
    ------
    InputError
        Too few loads to fit.
    """
    whole = np.ones(run.force.size, dtype=bool)
    fitted = whole if other is not None else run.force <= HALF * run.force.max() * (1.0 + 1e-9)
    if np.unique(run.force[fitted & (run.force > 0.0)]).size < criteria.LEAST_LEVELS or run.force.max() <= 0.0:
        raise InputError(
            f"run {run.name}: its load history has fewer than {criteria.LEAST_LEVELS} loads to fit; raise "
            "load.observations, or press instead of pulling"
        )
    first = _case(run, fitted, ~fitted)
    if other is None:
        return first, first
    return first, _case(other, np.ones(other.force.size, dtype=bool), np.ones(other.force.size, dtype=bool))


def _case(run: FinishedRun, fitted: NDArray[np.bool_], held: NDArray[np.bool_]) -> RunCase:
    """The wave model's ramp is read off the rows while the load rises."""
    rising = run.force > np.concatenate(([0.0], np.maximum.accumulate(run.force)[:-1]))
    layers = np.vstack([np.zeros((1, run.wave.shape[1])), run.wave[rising]])
    stack = [layer.thickness for layer in run.scenario.tissue.layers if np.isfinite(layer.thickness)]
    context = TrialContext(
        tool_radius=run.scenario.tool.radius,
        thickness=measured_height(float(sum(stack)), run.scenario.support, run.scenario.tool.radius),
        peak_depth=float(run.reference[:, 0].max()),
        peak_force=float(run.force.max()),
        duration=float(run.time[-1]),
        hole_radius=open_radius(run.scenario.support),
        layers=specimen_layers(run.scenario.tissue.layers),
        contact=run.scenario.tool.contact,
        edge_radius=run.scenario.tool.edge_radius or 0.0,
    )
    return RunCase(run, Ramp(layers[:, 0], np.append(0.0, run.force[rising]), layers), context, fitted, held)


def layer_gaps(case: RunCase, physics: Physics = NOTHING) -> tuple[LayerGap, ...]:
    """The gap of each layer under the run's force, before and with `physics`."""
    after = case.deflections(physics)
    return tuple(_layer_gap(name, case, column, after[:, column]) for column, name in enumerate(case.run.layers))


def _layer_gap(name: str, case: RunCase, column: int, after: Array) -> LayerGap:
    run = case.run
    reference, before = run.reference[:, column], run.wave[:, column]
    peak = int(np.abs(run.force).argmax())
    errors = [100.0 * float((each[peak] - reference[peak]) / reference[peak]) for each in (before, after)]
    sizes = [float(np.sqrt(np.mean((each - reference)[case.held] ** 2))) for each in (before, after)]
    return LayerGap(name, run.force, reference, before, after, *sizes, *errors)


def places(case: RunCase, smallest: float) -> tuple[Place, ...]:
    """Cells whose mean residual is beyond `smallest` (N), largest first; without p, for nothing here is random."""
    residual = case.run.force - case.force()
    depth, peak = case.depth, float(case.depth.max())
    phases = _phases(case)
    found = []
    for phase in ("load", "hold", "unload_high", "unload_low"):
        for part in range(CLASSES):
            low, high = part * peak / CLASSES, (part + 1) * peak / CLASSES
            rows = (phases == phase) & (depth >= low) & (depth <= high)
            size = float(residual[rows].mean()) if rows.any() else 0.0
            if abs(size) > smallest:
                percent = 100.0 * size / float(case.run.force.max())
                found.append(Place("force_z", phase, case.run.name, 1, (low, high), size, percent, math.nan))
    return tuple(sorted(found, key=lambda place: -abs(place.size)))


def contrasts(case: RunCase) -> tuple[Contrast, ...]:
    """Whether the reference has a memory: unload minus load at equal depth."""
    force, depth, phases = case.run.force, case.depth, _phases(case)
    load, unload = phases == "load", np.char.startswith(phases, "unload")
    if load.sum() < 2 or not unload.any():
        return ()
    at_depth = np.interp(depth[unload], depth[load], force[load])
    size = float(np.mean(force[unload] - at_depth))
    return (Contrast("Unload minus load at equal depth, in the reference", "force_z", size, math.nan),)


def _phases(case: RunCase) -> np.ndarray:
    """(n,) phase of each row: of one press, up to its peak, held near it, and back."""
    force, depth = case.run.force, case.depth
    last = int(np.flatnonzero(force >= force.max() * (1.0 - 1e-9))[-1])
    first = int(force.argmax())
    rows = np.arange(force.size)
    below = np.where(depth >= 0.5 * depth.max(), "unload_high", "unload_low")
    return np.where(rows <= first, "load", np.where(rows <= last, "hold", below))
