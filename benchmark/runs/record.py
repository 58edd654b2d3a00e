"""Everything a run found, before it becomes tables, JSON and a page."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from benchmark.comparison import ComparisonError, LayerComparison, compare_layer, compare_samples
from benchmark.files import Scenario, scenario_notes
from benchmark.model_file import RepairedModel
from benchmark.models import Array, ModelResult
from benchmark.runs.fields import LAST
from benchmark.runs.refinement import Level
from benchmark.runs.trials.measured import MeasuredComparison
from benchmark.side_by_side import SideBySide
from benchmark.side_by_side.parameter_bands import DifferenceBeside, ParameterBands, beside

FORCE = "force"
"""What `statistics.csv` and the report call the comparison of forces."""


@dataclass(frozen=True)
class RunRecord:
    """A run of one scenario, with the trials it was fitted to where there are any.

    Attributes
    ----------
    name
        Of the scenario or the session.
    scenario
        Fully resolved.
    time, load
        (n,) s and N or m, the prescribed history.
    pair
        Both models' results and timings.
    comparisons
        One a layer.
    measured
        Trials, fit and predictions; None without trials.
    warnings
        What the reader must know, one sentence each.
    seed
        Of every random draw.
    repair
        The model file whose effects are switched on; None without, and in a run that was read back.
    effects
        Their slugs.
    levels
        Coarser and finer runs; empty where none were asked for.
    exported
        Input files for other codes: endings and texts.
    bands
        What stated uncertainties leave of both models; None where none are stated.
    """

    name: str
    scenario: Scenario
    time: Array
    load: Array
    pair: SideBySide
    comparisons: tuple[LayerComparison, ...]
    measured: MeasuredComparison | None
    warnings: tuple[str, ...]
    seed: int
    repair: RepairedModel | None = None
    effects: tuple[str, ...] = ()
    levels: tuple[Level, ...] = ()
    exported: tuple[tuple[str, str], ...] = ()
    bands: ParameterBands | None = None

    @property
    def layers(self) -> tuple[str, ...]:
        """Layer names from the surface down."""
        return self.scenario.tissue.layer_names

    @property
    def results(self) -> tuple[ModelResult, ...]:
        """The results there are."""
        return tuple(run.result for run in (self.pair.fem, self.pair.wave) if run.result is not None)

    @property
    def complete(self) -> bool:
        """False where a solver stopped before the end of its load history."""
        return all(result.complete for result in self.results)

    @property
    def answers(self) -> dict[str, tuple[Array, Array]]:
        """What the models answered, (n,) each and NaN where there is no value: force N where the depth is prescribed.

        Then each layer's deflection, m. Empty where a model has no result.
        """
        told, other = self.pair.fem.result, self.pair.wave.result
        if told is None or other is None:
            return {}
        force = (whole(told.force, self.time.size), whole(other.force, self.time.size))
        fem, wave = self.deflections(told), self.deflections(other)
        layers = {name: (fem[:, k], wave[:, k]) for k, name in enumerate(self.layers)}
        return {FORCE: force, **layers} if self.scenario.load.control == "depth" else layers

    @cached_property
    def force_comparison(self) -> LayerComparison | None:
        """The models' forces, N, where the depth is prescribed, so that the force is what they answer; else None."""
        if FORCE not in self.answers:
            return None
        try:
            margin = self.scenario.comparison.equivalence_margin
            return compare_samples(FORCE, *self.answers[FORCE], self.load, margin)
        except ComparisonError:
            return None

    @property
    def judged(self) -> tuple[LayerComparison, ...]:
        """Every layer's deformation, and the force where the depth is prescribed."""
        return (*self.comparisons, *(() if self.force_comparison is None else (self.force_comparison,)))

    @property
    def beside(self) -> tuple[DifferenceBeside, ...]:
        """The models' difference at peak load beside what uncertain parameters leave, layer by layer."""
        if self.bands is None:
            return ()
        fem, wave = (self.deflections(run.result) for run in (self.pair.fem, self.pair.wave))
        return tuple(beside(self.bands, self.layers, fem, wave, int(np.abs(self.load).argmax())))

    def max_deformation(self, result: ModelResult | None) -> Array:
        """(L,) m: each layer's deflection of largest magnitude over the steps that all models reached; NaN of none."""
        if result is None:
            return np.full(len(self.layers), np.nan)
        reached = min((each.time.size for each in self.results if each.time.size), default=0)
        return np.asarray(replace(result, top_deflection=result.top_deflection[:reached]).max_deformation())

    def deflections(self, result: ModelResult | None) -> Array:
        """(n, L) m of one model over all steps; NaN where there is no value."""
        return deflections(result, self.time.size, len(self.layers))

    def force(self) -> Array:
        """(n,) N: the prescribed force, or under depth control the FEM's (the wave's without FEM)."""
        if self.scenario.load.control == "force":
            return self.load
        return whole(self.results[0].force if self.results else np.zeros(0), self.time.size)


def whole(values: Array, steps: int) -> Array:
    """`values` (k,) of a run that may have stopped early, as (steps,) with NaN for what it did not reach."""
    filled = np.full(steps, np.nan)
    filled[: values.size] = values
    return filled


def deflections(result: ModelResult | None, steps: int, layers: int) -> Array:
    """(n, L) m of one model over all `steps`; NaN where it has no value."""
    whole = np.full((steps, layers), np.nan)
    if result is not None:
        whole[: len(result.top_deflection)] = result.top_deflection
    return whole


def compare_layers(scenario: Scenario, load: Array, fem: Array, wave: Array) -> tuple[LayerComparison, ...]:
    """Compare each layer of `fem` and `wave`, (n, L) m; empty where there is no FEM value to compare with.

    Raises
    ------
    ComparisonError
        The FEM's mean is zero, so that a margin in its per cent says nothing.
    """
    if np.isnan(fem).all():
        return ()
    margin = scenario.comparison.equivalence_margin
    return tuple(
        compare_layer(name, fem[:, column], wave[:, column], load, margin)
        for column, name in enumerate(scenario.tissue.layer_names)
    )


def gather_warnings(scenario: Scenario, pair: SideBySide, more: Sequence[str]) -> tuple[str, ...]:
    """Every warning of the inputs, of both models, and of what is missing, each once."""
    found = [*more, *scenario_notes(scenario)]
    limit = scenario.tissue.max_force
    if limit is not None and scenario.load.control == "force" and abs(scenario.load.peak) > limit:
        found.append(
            f"the press of {abs(scenario.load.peak):g} N is beyond max_force = {limit:g} N, the largest press that the "
            f"sources of tissue {scenario.tissue.name} cover"
        )
    for run in (pair.fem, pair.wave):
        if run.declined is not None:
            found.append(f"the {run.name} does not cover this scenario, its columns are empty: {run.declined}")
        elif run.result is not None:
            found.extend(f"{run.name}: {warning}" for warning in run.result.warnings)
            if run.result.resumed is not None:
                found.append(
                    f"{run.name} {run.result.resumed}; the times in this report are of whole runs without them"
                )
            if run.result.failure is not None:
                found.append(f"{run.name} stopped early at {run.result.failure}; results up to there are kept")
                found.extend(_beyond(scenario, run.name, run.result))
    return tuple(dict.fromkeys(found))


def _beyond(scenario: Scenario, name: str, result: ModelResult) -> list[str]:
    """How far a run came that stopped early, and how soft the tissue is for its load."""
    said, layers = [], scenario.tissue.layers
    thickness = sum(layer.thickness for layer in layers if math.isfinite(layer.thickness))
    if result.last is not None:
        share = 100.0 * result.last.depth / thickness
        said.append(f"{name}: {result.last}, {share:.3g} % of the {1e3 * thickness:.4g} mm stack: fields/{LAST}")
    if scenario.load.control == "force":
        pressure = abs(scenario.load.peak or 0.0) / (math.pi * scenario.tool.radius**2)
        softest = min(layers, key=lambda layer: layer.youngs_modulus)
        said.append(
            f"the peak load is a mean pressure of {1e-3 * pressure:.3g} kPa under the tool, "
            f"{pressure / softest.youngs_modulus:.3g} times Young's modulus of the softest layer, {softest.name}"
        )
    return said
