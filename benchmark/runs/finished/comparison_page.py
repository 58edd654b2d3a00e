"""Finished runs set side by side: parameters and results that differ, figures over each other."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from benchmark.files import Scenario
from benchmark.models import ModelResult
from benchmark.runs.finished.saved_run import SavedRun
from benchmark.runs.record import FORCE, RunRecord
from benchmark.runs.report.run_page import run_verdict
from benchmark.runs.report.values import MM, peak_errors
from reports import Block, Column, Download, Fact, Notice, Page, Paragraph, Section, Table, Verdict
from reports.figures.studies import overlay

Columns: TypeAlias = Mapping[str, Sequence[Any]]


def parameters(scenario: Scenario) -> dict[str, str]:
    """Every value of a scenario by its key as `--set` takes it, a layer's by the layer's name."""
    return dict(_flat(tomllib.loads(scenario.to_toml()), ""))


def _flat(value: Any, path: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _flat(item, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and value and all(isinstance(item, dict) and "name" in item for item in value):
        yield path.removeprefix("tissue."), ", ".join(str(item["name"]) for item in value)
        for item in value:
            yield from _flat({key: cell for key, cell in item.items() if key != "name"}, str(item["name"]))
    elif isinstance(value, list):
        yield path, ", ".join(str(item) for item in value) or "none"
    else:
        yield path, str(value)


def changed_parameters(scenarios: Mapping[str, Scenario]) -> Columns:
    """Columns of `parameters.csv`: a row for each key that is not the same in all runs, None where a run lacks it."""
    told = {name: parameters(scenario) for name, scenario in scenarios.items()}
    keys = dict.fromkeys(key for each in told.values() for key in each)
    different = [key for key in keys if len({each.get(key) for each in told.values()}) > 1]
    return {"parameter": different, **{name: [each.get(key) for key in different] for name, each in told.items()}}


def result_columns(runs: Mapping[str, SavedRun]) -> Columns:
    """Columns of `runs.csv`: one row a run and layer."""
    rows = [row for name, run in runs.items() for row in _rows(name, run)]
    return {key: [row[key] for row in rows] for key in rows[0]}


def _rows(name: str, run: SavedRun) -> Iterator[dict[str, Any]]:
    record = run.record
    errors, comparisons = peak_errors(record), {each.layer: each for each in record.comparisons}
    fem, wave = record.pair.fem, record.pair.wave
    largest = [MM * record.max_deformation(each.result) for each in (fem, wave)]
    for place, layer in enumerate(record.layers):
        found = comparisons.get(layer)
        statistics = None if found is None else found.statistics
        yield {
            "run": name,
            "layer": layer,
            "fem_max_mm": float(largest[0][place]),
            "wave_max_mm": float(largest[1][place]),
            "error_at_peak_percent": errors.get(layer),
            "error_mean_percent": None if found is None else found.percent.mean,
            "error_max_percent": None if found is None else found.percent.maximum,
            "tost_p": None if statistics is None else statistics.equivalence.p_value,
            "equivalent": None if statistics is None else statistics.equivalence.equivalent,
            "fem_unknowns": None if fem.result is None else fem.result.unknowns,
            "wave_unknowns": None if wave.result is None else wave.result.unknowns,
            "fem_wall_s": None if fem.seconds is None else fem.seconds.wall,
            "wave_wall_s": None if wave.seconds is None else wave.seconds.wall,
            "speedup": None if record.pair.speedup is None else record.pair.speedup.median,
            "complete": record.complete,
            FORCE_ERROR: errors.get(FORCE),
        }


FORCE_ERROR = "force_error_at_peak_percent"
"""Of runs by depth, the same in each of a run's rows; None of the others."""
RESULTS = (
    ("fem_max_mm", Column("FEM maximum", "mm")),
    ("wave_max_mm", Column("wave maximum", "mm")),
    ("error_at_peak_percent", Column("error at peak", "%", 3)),
    ("error_mean_percent", Column("mean |error|", "%", 3)),
    ("error_max_percent", Column("max |error|", "%", 3)),
    ("tost_p", Column("TOST p", digits=3)),
    ("equivalent", Column("equivalent")),
)


def compare_page(
    runs: Mapping[str, SavedRun],
    changed: Columns,
    columns: Columns,
    environment: Mapping[str, Any],
    tables: Mapping[str, str],
) -> Page:
    """Return the page; the first of the `runs` is what the others are compared with.

    Parameters
    ----------
    runs
        By what the page calls them.
    changed, columns
        Of `parameters.csv` and `runs.csv`.
    environment
        Of making the page.
    tables
        The text of both tables by file name.
    """
    about = {"parameters.csv": "parameters that differ", "runs.csv": "results of every run and layer"}
    return Page(
        title=f"{len(runs)} runs side by side",
        subtitle=f"compared with {next(iter(runs))}",
        verdict=_verdict(runs, changed),
        facts=(Fact("Made", str(environment["made"])), *(Fact(name, _origin(run)) for name, run in runs.items())),
        notices=_notices(runs),
        sections=(
            Section("Parameters changed", (_parameters(changed),)),
            Section("Results changed", (_results(columns), _changes(columns), _timing(runs))),
            Section("Figures over each other", _figures(runs)),
        ),
        downloads=[Download(f"tables/{name}", about[name], text) for name, text in tables.items()],
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _origin(run: SavedRun) -> str:
    scenario = run.record.scenario
    return f"{scenario.name} on {scenario.tissue.name}, {_models(run)}, made {run.environment['made']}"


def _models(run: SavedRun) -> str:
    return f"{run.record.pair.fem.name} and {run.record.pair.wave.name}"


def _verdict(runs: Mapping[str, SavedRun], changed: Columns) -> Verdict:
    """How much differs, and what each run found by itself."""
    points = [
        f"{name}: {run_verdict(run.record, None if run.trials is None else run.trials.headline, run.columns).headline}"
        for name, run in runs.items()
    ]
    status = "finding" if all(run.record.complete for run in runs.values()) else "incomplete"
    return Verdict(status, _headline(runs, changed), points)


def _headline(runs: Mapping[str, SavedRun], changed: Columns) -> str:
    """What was not the same: parameters of the scenario, models in the places of FEM and wave."""
    count = sum(not key.endswith(("citation", "name")) for key in changed["parameter"])
    other_models = len({_models(run) for run in runs.values()}) > 1
    if not count:
        return "The scenarios are the same" + (", the models differ." if other_models else ".")
    scenarios = f"{count} parameter{'' if count == 1 else 's'} of the scenario {'differs' if count == 1 else 'differ'}"
    return scenarios + (", and the models do." if other_models else ".")


def _notices(runs: Mapping[str, SavedRun]) -> list[Notice]:
    said = [f"{name}: {warning}" for name, run in runs.items() for warning in run.record.warnings]
    machines = {(run.environment["processor"], run.environment["usable_cores"]) for run in runs.values()}
    if len(machines) > 1:
        said.append("the runs were made on different machines: their times cannot be compared")
    synthetic = [name for name, run in runs.items() if run.trials is not None and run.trials.synthetic]
    notices = [Notice("warning", "Read these before you quote a figure.", said)] if said else []
    if synthetic:
        notices.insert(0, Notice("synthetic", f"The trials of {', '.join(synthetic)} were computed, not measured."))
    return notices


def _parameters(changed: Columns) -> Block:
    if not changed["parameter"]:
        return Paragraph("No value of the scenarios differs.")
    return Table(
        "Values that are not the same in all runs, by their keys in scenario.toml (or the layer's name)",
        [str(name) for name in changed],
        list(zip(*changed.values(), strict=True)),
        download=Download("tables/parameters.csv"),
        folded=False,
    )


def _results(columns: Columns) -> Table:
    force = [(FORCE_ERROR, Column("force, error at peak", "%", 3))] if any(columns[FORCE_ERROR]) else []
    shown = (*RESULTS, *force)
    cells = [columns["run"], columns["layer"], *(columns[key] for key, _ in shown)]
    return Table(
        "Maximum deformation of each layer's top face on the tool axis; errors are those of the wave model's place "
        "against the FEM's",
        ["run", "layer", *(column for _, column in shown)],
        list(zip(*cells, strict=True)),
        download=Download("tables/runs.csv"),
        folded=False,
    )


def _changes(columns: Columns) -> Block:
    """Maxima against the first run's, for layers that both have."""
    rows = list(zip(*(columns[key] for key in ("run", "layer", "fem_max_mm", "wave_max_mm")), strict=True))
    first = {layer: (fem, wave) for run, layer, fem, wave in rows if run == rows[0][0]}
    table = [
        (run, layer, *(_percent(now, before) for now, before in zip((fem, wave), first[layer], strict=True)))
        for run, layer, fem, wave in rows
        if run != rows[0][0] and layer in first
    ]
    if not table:
        return Paragraph("No layer of the first run is in another one by name.")
    heads = ("run", "layer", Column("FEM maximum", "%", 3), Column("wave maximum", "%", 3))
    return Table(f"Change against {rows[0][0]}", heads, table, folded=False)


def _percent(now: float, before: float) -> float | None:
    """Change in %; None where one of them is missing or zero."""
    return float(100.0 * (now - before) / before) if np.isfinite(now * before) and before != 0.0 else None


def _timing(runs: Mapping[str, SavedRun]) -> Table:
    ratios = [run.record.pair.speedup for run in runs.values()]
    spreads = {ratio.spread for ratio in ratios if ratio is not None}
    spread = spreads.pop() if len(spreads) == 1 else "interval's"
    heads = (
        "run", "model", Column("unknowns"), Column("repeats"), Column("set-up", "s"), Column("wall", "s"),
        Column("CPU", "s"), Column("speed-up", "×", 3), Column(f"{spread} low", "×", 3),
        Column(f"{spread} high", "×", 3), "interval",
    )  # fmt: skip
    rows = []
    for name, run in runs.items():
        ratio = run.record.pair.speedup
        span = (None,) * 4 if ratio is None else (ratio.median, *ratio.ci95, ratio.spread)
        for model in (run.record.pair.fem, run.record.pair.wave):
            seconds = model.seconds
            times = (None, None, None) if seconds is None else (seconds.setup, seconds.wall, seconds.cpu)
            unknowns = None if model.result is None else model.result.unknowns
            rows.append((name, model.name, unknowns, len(model.repeats), *times, *span))
    return Table("Compute time, medians over the repeats, one thread each", heads, rows, folded=False)


def _figures(runs: Mapping[str, SavedRun]) -> list[Block]:
    """Deflection over the load history and the profile of each layer, a line a run and model; force over depth."""
    history: dict[str, dict[str, Any]] = {}
    profiles: dict[str, dict[str, Any]] = {}
    curves: dict[str, Any] = {}
    for name, run in runs.items():
        for label, result in _answers(name, run.record):
            curves[label] = MM * result.depth, result.force
            for place, layer in enumerate(result.layers):
                history.setdefault(layer, {})[label] = result.time, MM * result.top_deflection[:, place]
                profiles.setdefault(layer, {})[label] = MM * result.profile_radii, MM * result.profile[place]
    if not curves:
        return [Paragraph("No model of any run has values.")]
    radius, deflection = "distance from the tool axis (mm)", "deflection (mm)"
    over_time = "Deflection of each layer's top face on the tool axis over the load history, press positive."
    at_peak, pressing = "Deflection at peak load, press downwards.", "Force on the tool over its depth."
    single = {"force over depth": curves}
    return [
        overlay(history, "time (s)", deflection, over_time, "Maximum deformation of every run"),
        overlay(profiles, radius, deflection, at_peak, "Profiles of every run", downwards=True),
        overlay(single, "depth (mm)", "force (N)", pressing, "Force and depth"),
    ]


def _answers(name: str, record: RunRecord) -> list[tuple[str, ModelResult]]:
    """Each model's values with the label of its line."""
    models = (record.pair.fem, record.pair.wave)
    return [(f"{name}, {each.name}", each.result) for each in models if each.result is not None]
