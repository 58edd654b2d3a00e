"""One scenario: both models side by side, compared."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.comparison import ComparisonError
from benchmark.errors import TissuebenchError
from benchmark.exchange import export_text
from benchmark.files import Scenario
from benchmark.models import NOTHING, Array, ModelResult, Own, StepProgress, scenario_drive
from benchmark.runs.options import Listener, RunOptions
from benchmark.runs.record import RunRecord, compare_layers, deflections, gather_warnings
from benchmark.runs.refinement import refine
from benchmark.runs.small_strain import beside_small_strain
from benchmark.runs.trials.measured import MeasuredComparison
from benchmark.side_by_side import NAMES, SideBySide, run_side_by_side
from benchmark.side_by_side.parameter_bands import ParameterBands, parameter_bands

FAR_APART = 100.0
"""Models this many times apart are not in the same unit, rather than wrong: mm and m, or um and mm, are 1000."""


def run_scenario(
    scenario: Scenario,
    options: RunOptions,
    listener: Listener,
    *,
    name: str | None = None,
    measured: MeasuredComparison | None = None,
    warnings: Sequence[str] = (),
    own: Own = NOTHING,
) -> RunRecord:
    """Run FEM and wave model on a scenario and compare them.

    Parameters
    ----------
    scenario
        Resolved scenario.
    options
        Repeats, seed, fields.
    listener
        Told of progress.
    name
        Of the run; the scenario's by default.
    measured
        Trials behind the scenario's tissue, if any.
    warnings
        What is known before the run.
    own
        A user's own model or FEA in the place of ours.

    Raises
    ------
    InputError, SolverError
        See `run_side_by_side`.
    """
    exported = tuple((ending, export_text(scenario, ending)) for ending in options.export)
    drive = scenario_drive(scenario)
    pair = _side_by_side(scenario, options, listener, own)
    if own.wave is None and own.repair is None:
        pair = beside_small_strain(scenario, pair, drive)
    bands, unknown = _bands(scenario, own, listener)
    levels = refine(scenario, pair, listener) if options.refine else ()
    layers = len(scenario.tissue.layers)
    fem, wave = (deflections(run.result, drive.time.size, layers) for run in (pair.fem, pair.wave))
    said = [*warnings, *unknown, *_too_coarse(scenario, pair.fem.result)]
    if own.wave is not None or own.reference is not None:
        said += _far_apart(fem, wave)
    try:
        comparisons = compare_layers(scenario, drive.value, fem, wave)
    except ComparisonError as error:
        comparisons = ()
        said.append(f"the layers are not compared: {error}")
    return RunRecord(
        name=name or scenario.name,
        scenario=scenario,
        time=drive.time,
        load=drive.value,
        pair=pair,
        comparisons=comparisons,
        measured=measured,
        warnings=gather_warnings(scenario, pair, said),
        seed=options.seed,
        repair=own.repair,
        effects=() if own.repair is None else own.repair.slugs,
        levels=levels,
        exported=exported,
        bands=bands,
    )


def _too_coarse(scenario: Scenario, result: ModelResult | None) -> tuple[str, ...]:
    """That the finite elements are estimated to be farther from their own limit than the models may be apart."""
    found, margin = None if result is None else result.mesh_error, 100.0 * scenario.comparison.equivalence_margin
    if found is None or abs(found.percent) <= margin:
        return ()
    finer = "" if scenario.fem.mesh == "fine" else "; a finer mesh: --set fem.mesh=fine"
    return (
        f"the FEM's own mesh is estimated {abs(found.percent):.2g} % off, more than the {margin:g} % within which the "
        f"models are compared{finer}",
    )


def _far_apart(fem: Array, wave: Array) -> tuple[str, ...]:
    """What deflections (n, L), m, of two models look like whose units differ, one of them not ours."""
    largest = [float(np.abs(each[np.isfinite(each)]).max(initial=0.0)) for each in (fem, wave)]
    if 0.0 < FAR_APART * min(largest) < max(largest):
        told, other = (f"{1e3 * each:.3g} mm" for each in largest)
        times = max(largest) / min(largest)
        return (
            f"the largest deflections of the two models, {told} and {other}, are {times:.0f} times apart: "
            "see whether one is in another unit (fem_mm of a table is in mm, what a model file returns in m)",
        )
    return ()


def _bands(scenario: Scenario, own: Own, listener: Listener) -> tuple[ParameterBands | None, tuple[str, ...]]:
    """What stated uncertainties leave of our own two models, or why that is not known."""
    if own != NOTHING or not scenario.uncertainties:
        return None, ()
    listener.say(f"{scenario.name}: what the uncertainty of {len(scenario.uncertainties)} values leaves of both models")
    try:
        return parameter_bands(scenario, scenario_drive(scenario)), ()
    except TissuebenchError as error:
        return None, (f"what uncertain parameters leave of the results was not worked out: {error}",)


def _side_by_side(scenario: Scenario, options: RunOptions, listener: Listener, own: Own) -> SideBySide:
    """Both models' results and times, each step told as it is reached."""
    unit, scale = ("N", 1.0) if scenario.load.control == "force" else ("mm", 1e3)
    names = {model: own.name(model) or name for model, name in NAMES.items()}
    with listener.progress(f"{scenario.name}: {names['fem']} and {names['wave']} side by side") as advance:

        def on_progress(model: str, step: StepProgress) -> None:
            value = step.force if scenario.load.control == "force" else step.depth
            advance(names[model], step.step, step.total, f"{scale * value:.3g} {unit}")

        return run_side_by_side(
            scenario,
            repeats=options.repeats,
            seed=options.seed,
            every_field=options.every_field,
            on_progress=on_progress,
            on_remark=listener.say,
            own=own,
            keep=options.keep,
        )
