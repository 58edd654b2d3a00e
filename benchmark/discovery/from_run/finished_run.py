"""A finished run as a measurement: the reference's deflections, and the wave model's at the same loads."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TableError
from bench_hw.tables.columns import numbers_of, read_source, text_columns
from benchmark.errors import InputError
from benchmark.files import Scenario, load_scenario
from benchmark.models import Drive, UncoveredError, read_reference
from benchmark.models.model_result import STRAINS
from benchmark.models.prepare import in_small_strain, small_strain_deflection
from reports.manifest import said_of_changes

Array = NDArray[np.float64]
TABLE = Path("tables") / "max_deformation.csv"


@dataclass(frozen=True, eq=False)
class FinishedRun:
    """A run read back.

    Attributes
    ----------
    name : str
    scenario : Scenario
        As it was resolved.
    time, force : (n,) array
        s and N.
    reference, wave : (n, L) array
        Deflection of each layer's top face on the tool axis, m.
    fingerprint : str
        SHA-256 over table and scenario.
    effects : tuple of str
        Effects that the run's wave model already had.
    large_press : str
        Its elastic law: "linear" or "corrected".
    restarted : bool
        Whether `wave` was computed anew, in small strain.
    changed : str
        That files of the run are not as they were written, by name; empty where all are.
    """

    name: str
    scenario: Scenario
    time: Array
    force: Array
    reference: Array
    wave: Array
    fingerprint: str
    effects: tuple[str, ...]
    large_press: str
    restarted: bool = False
    changed: str = ""

    @property
    def layers(self) -> tuple[str, ...]:
        """Names from the surface down."""
        return self.scenario.tissue.layer_names


def is_run(folder: Path) -> bool:
    """Whether a folder is the result of `run`."""
    return (folder / "results.json").is_file() and (folder / "scenario.toml").is_file()


def read_run(folder: Path) -> FinishedRun:
    """Read a result folder of `run`.

    Raises
    ------
    InputError
        Something is missing, the reference stopped early, or one of both models has no values.
    """
    table, scenario_file = folder / TABLE, folder / "scenario.toml"
    for path in (table, scenario_file):
        if not path.is_file():
            raise InputError(f"{path}: a result folder of run holds this file; it is missing")
    scenario = load_scenario(scenario_file)
    if scenario.load.control != "force":
        raise InputError(
            f"{scenario_file}: the load is controlled by {scenario.load.control}; a run can be taken as the "
            'measurement where it is controlled by "force", since its table has the force of one model only'
        )
    reference = read_reference(table, scenario).result
    wave = _wave(table, reference.top_deflection.shape)
    digest = hashlib.sha256(table.read_bytes() + scenario_file.read_bytes()).hexdigest()
    document = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    return FinishedRun(
        name=str(document.get("name", scenario.name)),
        scenario=scenario,
        time=reference.time,
        force=reference.force,
        reference=reference.top_deflection,
        wave=wave,
        fingerprint=digest,
        effects=tuple(document.get("effects", ())),
        large_press=_large_press(scenario, document),
        changed=said_of_changes(folder),
    )


def _large_press(scenario: Scenario, document: Mapping[str, Any]) -> str:
    """What the wave model took; under "auto" the run says it, older runs in their notes alone."""
    chosen = scenario.wave.large_press
    if chosen != "auto":
        return chosen
    wave = document.get("models", {}).get("wave", {})
    choices = wave.get("choices")
    if choices:
        return "linear" if choices["strain"] == "linear" else "corrected"
    return "corrected" if STRAINS["corrected"] in str(wave.get("notes", {})) else "linear"


def _wave(path: Path, shape: tuple[int, ...]) -> Array:
    """(n, L) m of the wave model; rows in the order of the table, which is the program's own."""
    try:
        source = read_source(path, ("wave_mm",))
        columns, lines = text_columns(source)
        cells = dict(zip(source.names, columns, strict=True))
        values = numbers_of(path, "wave_mm", cells["wave_mm"], np.array(lines, dtype=np.int64), empty=True)
    except TableError as error:
        raise InputError(f"{error}") from None
    if values.size != int(np.prod(shape)) or not np.isfinite(values).all():
        raise InputError(
            f"{path}: the column wave_mm is not filled in every row; a run in which the wave model has no answer, or "
            "stopped early, cannot be repaired"
        )
    return np.asarray(1e-3 * values.reshape(shape))


def at_small_strain(run: FinishedRun) -> FinishedRun:
    """Return the run with the small-strain wave at the same loads, where `large_press = "auto"` took finite strain.

    A wave whose large press was asked for, that has effects of a model file, or whose tool small strain does not cover,
    as one with friction, stays as it is.
    """
    if run.scenario.wave.large_press != "auto" or run.large_press != "corrected" or run.effects:
        return run
    try:
        wave = small_strain_deflection(run.scenario, Drive("force", run.time, run.force))
    except UncoveredError:
        return run
    return replace(run, wave=wave, scenario=in_small_strain(run.scenario), large_press="linear", restarted=True)
