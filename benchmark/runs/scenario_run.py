"""One scenario: both models side by side, compared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmark.comparison import ComparisonError
from benchmark.errors import TissuebenchError
from benchmark.exchange import export_text
from benchmark.files import Scenario, Tool
from benchmark.models import NOTHING, Array, Drive, ModelResult, Own, StepProgress, UncoveredError, scenario_drive
from benchmark.models.own_models import FAR_APART
from benchmark.models.prepare import small_strain_deflection, took_finite_strain
from benchmark.runs.options import Listener, RunOptions
from benchmark.runs.record import RunRecord, compare_layers, deflections, gather_warnings
from benchmark.runs.refinement import refine
from benchmark.runs.trials.measured import MeasuredComparison
from benchmark.side_by_side import NAMES, SideBySide, run_side_by_side
from benchmark.side_by_side.parameter_bands import ParameterBands, parameter_bands

ROUND = 0.25
"""Edge radius over tool radius from which a flat end is another tool on a base."""
SHARP = 0.05
"""The same over a hole, where a tenth is told of by its size."""
ROUND_OVER_HOLE = (
    "; over a hole its force was 8 to 24 % above theirs with an edge of a tenth of the radius, 30 to 54 % with one of "
    "half of it, and 39 to 114 % with a sphere"
)
SMALL_STRAIN = "small strain"
"""The note of a wave result on what small strain would have said."""


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
    said += (
        []
        if own.wave is not None or scenario.fem.kinematics == "linear"
        else flat_wave(scenario.tool, hole=scenario.support.kind == "hole")
    )
    if own.wave is not None or own.reference is not None:
        said += _far_apart(scenario, pair, own, fem, wave)
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


def flat_wave(tool: Tool, *, hole: bool = False) -> tuple[str, ...]:
    """Say that the wave model has a flat end where the tool's edge is a good part of its radius, and its error."""
    edge = tool.edge_radius or 0.0
    if edge < (SHARP if hole else ROUND) * tool.radius:
        return ()
    text = f"the wave model has a flat end: the tool's edge of {1e3 * edge:.3g} mm is in the finite elements alone"
    return (f"{text}{ROUND_OVER_HOLE if hole else ''}",)


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


def _far_apart(scenario: Scenario, pair: SideBySide, own: Own, fem: Array, wave: Array) -> list[str]:
    """What deflections (n, L), m, and forces of two models look like whose units differ, one of them not ours.

    A layer that hardly moves in both is passed over.
    """
    table = None if own.reference is None else f"{own.reference.path}, column"
    least, said = 1e-2 * max(_largest(fem), _largest(wave)), []
    layers = [(name, _largest(fem[:, k]), _largest(wave[:, k])) for k, name in enumerate(scenario.tissue.layer_names)]
    apart = [each for each in layers if max(each[1:]) > least and _is_apart(*each[1:])]
    if apart:
        _, told, other = max(apart, key=lambda each: max(each[1:]))
        names = "" if len(apart) == len(layers) else f" of {', '.join(name for name, *_ in apart)}"
        units = "fem_mm of a table is in mm, what a model file returns in m"
        said.append(_apart(f"deflections{names}", "mm", 1e3 * told, 1e3 * other, units, table and f"{table} fem_mm"))
    if scenario.load.control == "depth" and pair.fem.result is not None and pair.wave.result is not None:
        told, other = (_largest(run.result.force) for run in (pair.fem, pair.wave) if run.result is not None)
        if _is_apart(told, other):
            said.append(_apart("forces", "N", told, other, "forces are in N", table and f"{table} force_N"))
    return said


def _largest(values: Array) -> float:
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _is_apart(one: float, other: float) -> bool:
    return 0.0 < FAR_APART * min(one, other) < max(one, other)


def _apart(what: str, unit: str, told: float, other: float, units: str, place: str | None) -> str:
    """The warning of the FEM's largest value `told` and the wave's, with the file and column of the first, if any."""
    times = max(told, other) / min(told, other)
    table = "" if place is None else f". {place}: the largest value is {told:.3g}, expected is about {other:.3g} {unit}"
    return (
        f"the largest {what} of the two models, {told:.3g} {unit} and {other:.3g} {unit}, are {times:.0f} times apart: "
        f"see whether one is in another unit ({units}){table}"
    )


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
            every_field=options.every_field,
            on_progress=on_progress,
            on_remark=listener.say,
            own=own,
            keep=options.keep,
        )


def beside_small_strain(scenario: Scenario, pair: SideBySide, drive: Drive) -> SideBySide:
    """Return the pair with a note on how far the wave of small strain is off at peak load, layer by layer.

    Without one where small strain does not cover the tool, as under friction, where the depth is told, which is then
    the same, and under a pull, which the wave follows in small strain.
    """
    fem, wave = pair.fem.result, pair.wave.result
    if fem is None or wave is None or wave.model != "wave" or not took_finite_strain(scenario, wave):
        return pair
    peak = int(np.abs(drive.value).argmax())
    if peak >= len(fem.top_deflection) or scenario.load.control == "depth" or drive.value[peak] < 0.0:
        return pair
    try:
        linear = small_strain_deflection(scenario, drive)[peak]
    except UncoveredError:
        return pair
    expected = fem.top_deflection[peak]
    errors = 100.0 * (linear / expected - 1.0)
    told = ", ".join(f"{layer} {error:+.1f} %" for layer, error in zip(wave.layers, errors, strict=True))
    result = replace(
        wave, notes={**wave.notes, SMALL_STRAIN: f"the wave of small strain would be off by {told} at peak load"}
    )
    return replace(pair, wave=replace(pair.wave, result=result))
