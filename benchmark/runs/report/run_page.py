"""The page of a run, section after section, with the verdict that its statistics allow first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from benchmark.models import ModelResult
from benchmark.runs.record import FORCE, RunRecord
from benchmark.runs.report.deformation_section import bands_section, deformation_section
from benchmark.runs.report.film_section import film_section
from benchmark.runs.report.scenario_section import method_section, scenario_section
from benchmark.runs.report.statistics_section import Columns, growth_section, statistics_section, validation_section
from benchmark.runs.report.timing_section import timing_section
from benchmark.runs.report.trials_section import TrialsPart, fit_section, measured_section, session_notices
from benchmark.runs.report.values import (
    MM,
    largest_errors,
    pair_names,
    peak_errors,
    profile_errors,
    sentence,
    setup_words,
    speedup_words,
    times_words,
)
from benchmark.runs.scenario_run import SMALL_STRAIN
from benchmark.runs.validation import furthest_off
from reports import Block, Download, Fact, KeyFigure, Notice, Page, Section, Verdict


def run_verdict(
    record: RunRecord, fit: str | None = None, columns: Mapping[str, Columns] = MappingProxyType({})
) -> Verdict:
    """Return the verdict of a run; `fit` is what its trials told, in one sentence, `columns` its tables'."""
    if not record.complete:
        stops = [str(result.failure) for result in record.results if result.failure is not None]
        return Verdict("incomplete", "A solver stopped before the end of the load history.", stops)
    if record.pair.fem.result is None or record.pair.wave.result is None:
        return _one_sided(record, fit)
    return _agreement(record, fit, columns)


def _one_sided(record: RunRecord, fit: str | None) -> Verdict:
    """A model has no values: nothing to compare it with, but the trials may still have told something."""
    missing = [run for run in (record.pair.fem, record.pair.wave) if run.result is None]
    names = " and ".join(run.name for run in missing)
    nothing = f"No comparison of the models: the {names} has no values here"
    points = [f"{nothing}, because {run.declined}" for run in missing]
    if fit is None:
        return Verdict("finding", f"{nothing}.", [str(run.declined) for run in missing])
    return Verdict("finding", sentence(fit), points)


def _agreement(record: RunRecord, fit: str | None, columns: Mapping[str, Columns]) -> Verdict:
    """Whether equivalence is shown, where both models have values."""
    errors = peak_errors(record)
    wave, fem = record.pair.wave.name, record.pair.fem.name
    points = [f"{name}: {wave} against {fem} {error:+.2f} % at peak load" for name, error in errors.items()]
    if record.pair.speedup is not None:
        ratio = record.pair.speedup
        points.append(
            f"speed-up of the load history alone, {fem} over {wave}, one thread each: {speedup_words(ratio)}; "
            f"{setup_words(ratio, wave)}"
        )
    result = record.pair.wave.result
    points.extend([result.notes[SMALL_STRAIN]] if result is not None and SMALL_STRAIN in result.notes else [])
    points.extend([] if fit is None else [fit])
    points.extend(one.text for one in record.beside)
    return _equivalence(record, errors, points, columns)


def _equivalence(
    record: RunRecord, errors: Mapping[str, float], points: Sequence[str], columns: Mapping[str, Columns]
) -> Verdict:
    """What is equivalent, on average and, by `errors` at peak load and the largest of any step, throughout."""
    share = 100 * record.scenario.comparison.equivalence_margin
    margin, wave = f"{share:g} % of the FEM's mean", record.pair.wave.name
    worst = max(errors.values(), key=abs, default=float("nan"))
    stray = max(largest_errors(record).items(), key=lambda item: item[1], default=("", 0.0))
    failed = [c.layer for c in record.judged if c.statistics is None or not c.statistics.equivalence.on_average]
    if all(c.statistics is None for c in record.judged):
        why = record.judged[0].note if record.judged else "the layers are not compared, as the warnings say"
        return Verdict("finding", f"Equivalence is not tested: {why}.", points)
    if failed:
        layers = [name for name in failed if name != FORCE]
        parts = ["the force"] if FORCE in failed else []
        parts += [f"{len(layers)} of {len(record.comparisons)} layers"] if layers else []
        off = f"the {wave} is off by up to {worst:+.1f} % at peak load"
        if not abs(worst) > share and stray[1] > abs(worst):
            off = f"in single steps the {wave} is off by up to {stray[1]:.3g} % of the largest value ({stray[0]})"
        return Verdict("finding", f"Equivalence within {margin} is not shown in {' and '.join(parts)}; {off}.", points)
    what = "every layer's maximum deformation" if record.force_comparison is None else "force and maximum deformations"
    headline = f"{wave} and {record.pair.fem.name} are equivalent within {margin} in {what}"
    aside = _aside(record, worst, stray, columns)
    return Verdict("finding" if aside else "good", sentence(f"{headline}{aside}"), points)


def _aside(record: RunRecord, worst: float, stray: tuple[str, float], columns: Mapping[str, Columns]) -> str:
    """What speaks against models that are equivalent in the mean; empty where nothing does."""
    share, wave = 100 * record.scenario.comparison.equivalence_margin, record.pair.wave.name
    average, largest = " on average over the load history, but", "of the largest value"
    if abs(worst) > share:
        return f"{average} at peak load the {wave} is off by up to {worst:+.1f} %"
    if stray[1] > share:
        return f"{average} in single steps the {wave} is off by up to {stray[1]:.1f} % {largest} ({stray[0]})"
    shape = max(profile_errors(record).items(), key=lambda item: item[1], default=("", 0.0))
    if shape[1] > PROFILE_SHARES * share:
        return f", but beside the axis the {wave}'s profile is off by up to {shape[1]:.1f} % of its peak ({shape[0]})"
    return _beside_trials(columns, 0.01 * share) if CONDITIONS in columns else ""


def _beside_trials(columns: Mapping[str, Columns], margin: float) -> str:
    """What trials say against both models; empty where they do not."""
    off = furthest_off(columns[CONDITIONS], margin, columns.get(VALIDATION))
    if off is None:
        return ""
    miss = f"the peak force of {off[0]} is {100.0 * off[1]:+.1f} % off"
    if off[2] is None:
        return f", but beside the trials {miss}, and no replicate tells how surely"
    return f", but the trials speak against both: {miss}, {off[2]:.2g} times its uncertainty"


PROFILE_SHARES = 2.0
"""Margins by which a profile may be off, of its peak: twice a maximum's, as the wave's own bars are 1 and 2 %."""
VALIDATION, CONDITIONS, REFINEMENT = "validation.csv", "validation_conditions.csv", "refinement.csv"
NO_COLUMNS: Mapping[str, Columns] = MappingProxyType({})
LARGEST_COPY = 600_000
"""Characters of a table that is still copied into the page."""

DESCRIPTIONS = {
    "max_deformation.csv": "deflection of each layer at every step",
    "force_depth.csv": "force and depth of both models at every step",
    "profile.csv": "deflection over the radius at peak load",
    "statistics.csv": "all tests of every layer",
    "normal_fits.csv": "normal fits with goodness",
    "parameter_bands.csv": "both models with the bands that uncertain parameters leave",
    "timing.csv": "every timed repeat",
    "mesh_error.csv": "estimated discretisation error of the finite elements, and the load at which it is told",
    "fitted_parameters.csv": "fitted and fixed parameters with intervals",
    "measured.csv": "every trial beside both models",
    VALIDATION: "errors beside their uncertainties",
    CONDITIONS: "the same of each condition's peak force",
    REFINEMENT: "coarser and finer runs, their values and their cost",
    "marker_fits.csv": "a parabola over time for each marker and axis",
    "circle.csv": "the circle around the tool in every frame",
    "held_out.csv": "each trial predicted by the others",
}


def run_page(
    record: RunRecord,
    environment: Mapping[str, Any],
    tables: Mapping[str, str],
    trials: TrialsPart | None = None,
    columns: Mapping[str, Columns] = NO_COLUMNS,
    picture: Block | None = None,
) -> Page:
    """Return the page of a run.

    Parameters
    ----------
    record
        What the run found.
    environment
        Content of `environment.json`.
    tables
        The text of each table in the result folder by file name.
    trials
        Measured trials, where there are any.
    columns
        Of `validation.csv` and `refinement.csv`, where there are any.
    picture
        Of the pressed tissue, or why there is none.
    """
    sections: list[Section] = []
    if trials is not None:
        sections.append(measured_section(trials.trials, trials.synthetic, record.pair))
        sections.append(fit_section(trials.parameters, trials.notes, "tables/fitted_parameters.csv"))
        sections += [] if trials.markers is None else [film_section(trials.markers)]
    sections += [scenario_section(record)]
    if record.results:
        sections += [deformation_section(record, picture)]
        sections += [] if record.bands is None else [bands_section(record, record.bands)]
        sections += [statistics_section(record)]
    if record.scenario.wave.model == "published":
        sections.append(_published())
    if VALIDATION in columns:
        sections.append(validation_section(columns[VALIDATION], columns.get(CONDITIONS)))
    sections.append(timing_section(record))
    if REFINEMENT in columns:
        sections.append(growth_section(columns[REFINEMENT], pair_names(record)))
    sections.append(method_section(record, environment))
    return Page(
        title=record.name,
        subtitle=_subtitle(record, trials),
        verdict=run_verdict(record, None if trials is None else trials.headline, columns),
        facts=_facts(environment),
        notices=_notices(record, trials),
        key_figures=_key_figures(record),
        sections=sections,
        downloads=_downloads(tables),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _published() -> Section:
    from benchmark.runs.report.published_section import published_section

    return published_section()


def _subtitle(record: RunRecord, trials: TrialsPart | None) -> str:
    models = f"{record.pair.fem.name} and {record.pair.wave.name}"
    if trials is None:
        return f"{models} side by side"
    return f"{len(trials.trials)} trials, fitted, beside {models}"


def _facts(environment: Mapping[str, Any]) -> tuple[Fact, ...]:
    machine = f"{environment['processor']}, {environment['usable_cores']} cores, one thread per model"
    return (
        Fact("Made", str(environment["made"])),
        Fact("On", machine),
        Fact("Seed", str(environment["seed"])),
    )


def _key_figures(record: RunRecord) -> tuple[KeyFigure, ...]:
    """What the press asked of both models, the error between them, and the speed-up."""
    by_depth = record.scenario.load.control == "depth"
    figures = [
        _largest_force(run.name, run.result) if by_depth else _deepest(run.name, record, run.result)
        for run in (record.pair.fem, record.pair.wave)
        if run.result is not None and run.result.time.size
    ]
    errors = peak_errors(record)
    if errors:
        layer, error = max(errors.items(), key=lambda item: abs(item[1]))
        label = f"{record.pair.wave.name} against {record.pair.fem.name}"
        worst = "the force at the peak depth" if layer == FORCE else f"{layer} at peak load, the worst layer"
        figures.append(KeyFigure(label, f"{error:+.3g}", "%", worst))
    if record.pair.speedup is not None:
        ratio = record.pair.speedup
        note = f"of the load history alone; {times_words(ratio.with_setup)} × with set-up"
        figures.append(KeyFigure("speed-up", times_words(ratio.median), "×", note))
    return tuple(figures)


def _deepest(name: str, record: RunRecord, result: ModelResult) -> KeyFigure:
    """Of a press by force: how deep it went."""
    return KeyFigure(name, MM * float(record.max_deformation(result)[0]), "mm", f"maximum of {record.layers[0]}")


def _largest_force(name: str, result: ModelResult) -> KeyFigure:
    """Of a press by depth: the force it took, pulling negative."""
    step = int(np.abs(result.force).argmax())
    return KeyFigure(name, float(result.force[step]), "N", f"largest force, at {MM * float(result.depth[step]):.4g} mm")


def _notices(record: RunRecord, trials: TrialsPart | None) -> tuple[Notice, ...]:
    """What must be known before any figure: origin of the data, circularity, warnings."""
    notices = [] if trials is None else list(session_notices(trials.synthetic))
    if record.effects:
        notices.append(Notice("assumption", _effects_words(record.effects)))
    if record.warnings:
        notices.append(Notice("warning", "Read these before you quote a figure.", record.warnings))
    return tuple(notices)


def _effects_words(effects: Sequence[str]) -> str:
    """Which effects of a model file are on."""
    names = ", ".join(slug.replace("_", " ") for slug in effects)
    return (
        f"Effects of model.toml are switched on: {names}. Under Method stands which model took which; warnings say "
        "what a model left out."
    )


def _downloads(tables: Mapping[str, str]) -> tuple[Download, ...]:
    """The files of the folder; a copy of each table is inside the page unless it would make it heavy."""
    files = [
        Download(f"tables/{name}", DESCRIPTIONS.get(name, ""), text if len(text) <= LARGEST_COPY else None)
        for name, text in tables.items()
    ]
    return (
        *files,
        Download("results.json", "the run for programs", media_type="application/json"),
        Download("scenario.toml", "the resolved scenario; runs again as it stands", media_type="application/toml"),
        Download("environment.json", "versions and machine", media_type="application/json"),
    )
