"""A finished run read back from its folder: what its page was made of, and the page once more."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench_hw.storage.regular_file import DOCUMENT, read_regular
from benchmark.errors import InputError
from benchmark.files import Scenario, load_scenario
from benchmark.files.sessions.session_folder import result_of
from benchmark.models import Array, ModelResult, RunFailure, scenario_drive
from benchmark.runs.finished.saved_tables import FROM_MM, SavedTables, Table, saved_trials
from benchmark.runs.output.document import SCHEMA
from benchmark.runs.record import RunRecord, compare_layers
from benchmark.runs.report.run_page import CONDITIONS, REFINEMENT, VALIDATION
from benchmark.runs.report.trials_section import TrialsPart
from benchmark.side_by_side import NAMES, ModelRun, Seconds, SideBySide, speedup
from reports.manifest import said_of_changes

STOPPED = re.compile(
    r"step (?P<step>\d+) at (?P<time>\S+) s: the load (?P<target>\S+) (?P<unit>\S+) could not be reached, "
    r"the last converged load is (?P<reached>\S+) \S+ \((?P<reason>.*)\)$",
    re.DOTALL,
)


@dataclass(frozen=True)
class SavedRun:
    """A finished run.

    Attributes
    ----------
    folder
        Where it is.
    record
        What it found; without the trials behind it, which `trials` has.
    document, environment
        Content of `results.json`, with `changed` among its warnings, and `environment.json`.
    tables
        The text of each table by file name.
    trials
        Measured trials, where there were any.
    columns
        Of `validation.csv` and `refinement.csv`, where there are any.
    changed
        That files are not as they were written, by name; empty where all are.
    """

    folder: Path
    record: RunRecord
    document: dict[str, Any]
    environment: dict[str, Any]
    tables: dict[str, str]
    trials: TrialsPart | None
    columns: dict[str, dict[str, list[Any]]]
    changed: str


def read_run(folder: Path) -> SavedRun:
    """Read a result folder of `run`.

    Raises
    ------
    InputError
        A folder that is no result of `run`, one of another schema, or a file in it that cannot be used.
    """
    document, environment = (_document(folder, name) for name in ("results.json", "environment.json"))
    scenario = load_scenario(folder / "scenario.toml")
    tables, changed = SavedTables(folder), said_of_changes(folder)
    try:
        document |= {"warnings": [*document["warnings"], *filter(None, [changed])]}
        record = _record(scenario, document, tables, int(environment["seed"]))
        trials = saved_trials(document, tables, folder / "markers") if "trials" in document else None
    except (KeyError, ValueError, TypeError, OSError) as error:
        raise InputError(
            f"{folder}: its files do not belong together ({type(error).__name__}: {error}); needed: the untouched "
            "result of a run"
        ) from None
    columns = {name: tables.read(name).plain() for name in (VALIDATION, CONDITIONS, REFINEMENT) if tables.has(name)}
    return SavedRun(folder, record, document, environment, tables.texts(), trials, columns, changed)


def _document(folder: Path, name: str) -> dict[str, Any]:
    """A JSON file of the folder."""
    path = folder / name
    try:
        found = json.loads(read_regular(path, DOCUMENT).decode("utf-8-sig"))
    except (OSError, ValueError, RecursionError) as error:
        reason = getattr(error, "strerror", None) or error
        verb = result_of(folder)
        if verb not in ("", "run") and not path.exists():
            shown = f"its own page is {folder / 'report.html'}"
            raise InputError(
                f"{folder} is a result of `{verb}` ({shown}); needed: the result folder of a run"
            ) from None
        raise InputError(f"{path} cannot be read ({reason}); needed: the result folder of a run") from None
    if not isinstance(found, dict) or found.get("schema") != SCHEMA:
        schema = found.get("schema") if isinstance(found, dict) else None
        raise InputError(f"{path}: schema is {schema!r}; allowed: {SCHEMA}")
    if name == "results.json" and "models" not in found:
        raise InputError(f"{path} holds no models; needed: the result folder of one run, as results/NAME/TISSUE is")
    return found


def _record(scenario: Scenario, document: dict[str, Any], tables: SavedTables, seed: int) -> RunRecord:
    drive = scenario_drive(scenario)
    fem, wave = (_model_run(model, scenario, document["models"][model], tables) for model in NAMES)
    both = fem.repeats and wave.repeats
    pair = SideBySide(fem, wave, speedup(fem.repeats, wave.repeats) if both else None)
    bare = RunRecord(document["name"], scenario, drive.time, drive.value, pair, (), None, (), seed)
    compared = bool(document["comparison"])
    deflections = (bare.deflections(run.result) for run in (fem, wave))
    return RunRecord(
        name=document["name"],
        scenario=scenario,
        time=drive.time,
        load=drive.value,
        pair=pair,
        comparisons=compare_layers(scenario, drive.value, *deflections) if compared else (),
        measured=None,
        warnings=tuple(document["warnings"]),
        seed=seed,
        effects=tuple(document.get("effects", ())),
    )


def _model_run(model: str, scenario: Scenario, told: dict[str, Any], tables: SavedTables) -> ModelRun:
    own = None if told["name"] == NAMES[model] else str(told["name"])
    memory, picture = told.get("peak_memory_MB"), told.get("picture_us")
    result = _result(model, scenario, told, tables) if told["covers_scenario"] else None
    return ModelRun(
        model=model,
        result=result,
        declined=told["reason"],
        repeats=_repeats(tables.read("timing.csv"), own or model),
        own=own,
        peak_memory=None if memory is None else round(1e6 * memory),
        frame=None if picture is None else 1e-6 * picture,
    )


def _repeats(timing: Table, key: str) -> tuple[Seconds, ...]:
    """The timed repeats of the model that the column `model` calls `key`."""
    columns = [timing.numbers(name) for name in ("setup_s", "wall_s", "cpu_s")]
    rows = zip(timing.words("model"), *columns, strict=True)
    return tuple(Seconds(float(setup), float(wall), float(cpu)) for name, setup, wall, cpu in rows if name == key)


def _result(model: str, scenario: Scenario, told: dict[str, Any], tables: SavedTables) -> ModelResult:
    drive, names = scenario_drive(scenario), scenario.tissue.layer_names
    top = FROM_MM * tables.read("max_deformation.csv").numbers(f"{model}_mm").reshape(drive.time.size, len(names))
    curve = tables.read("force_depth.csv")
    reached = int(np.isfinite(top).all(axis=1).sum())
    radii, profile = _profile(model, len(names), tables.read("profile.csv"))
    return ModelResult(
        model=model,
        layers=names,
        time=drive.time[:reached],
        force=curve.numbers(f"{model}_force_N")[:reached],
        depth=FROM_MM * curve.numbers(f"{model}_depth_mm")[:reached],
        top_deflection=top[:reached],
        profile_radii=radii,
        profile=profile,
        peak_step=int(np.abs(drive.value[:reached]).argmax()) if reached else 0,
        unknowns=told["unknowns"],
        notes=dict(told["notes"]),
        failure=_failure(told["failure"]),
    )


def _profile(model: str, layers: int, table: Table) -> tuple[Array, Array]:
    """Radii (m,) and deflections (L, m), m."""
    deflection = FROM_MM * table.numbers(f"{model}_mm").reshape(layers, -1)
    return FROM_MM * table.numbers("r_mm")[: deflection.shape[1]], deflection


def _failure(text: str | None) -> RunFailure | None:
    """Where a solver stopped, from its sentence."""
    if text is None:
        return None
    found = STOPPED.match(text)
    if found is None:
        raise ValueError(f"the failure {text!r} is not in the words of a run")
    return RunFailure(
        step=int(found["step"]),
        time=float(found["time"]),
        reached=float(found["reached"]),
        target=float(found["target"]),
        unit=found["unit"],
        reason=found["reason"],
    )
