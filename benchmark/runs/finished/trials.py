"""The trials of a finished run, from its tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from benchmark.fitting import FittedParameter
from benchmark.runs.finished.tables import MM, SavedTables, Table
from benchmark.runs.measured import TrialPrediction
from benchmark.runs.report.film_part import read_film
from benchmark.runs.report.trials_part import TrialsPart

NUMBERS = ("value", "ci95_low", "ci95_high")


def saved_trials(document: dict[str, Any], tables: SavedTables, markers: Path) -> TrialsPart:
    """Return the trials of a run; the forces held out are in no table, so they are not there.

    Parameters
    ----------
    document
        Content of `results.json`.
    tables
        Of the run.
    markers
        The folder of what is shown of films, which need not be there.

    Raises
    ------
    InputError
        A table that is missing or cannot be read.
    """
    told = document["trials"]
    return TrialsPart(
        trials=_predictions(tables.read("measured.csv")),
        synthetic=bool(told["synthetic"]),
        headline=str(told["headline"]),
        parameters=_parameters(tables.read("fitted_parameters.csv")),
        notes=tuple(told["notes"]),
        markers=read_film(markers),
    )


def _predictions(table: Table) -> tuple[TrialPrediction, ...]:
    keys = list(zip(table.words("trial"), table.words("condition"), strict=True))
    time, depth, force, fem, wave = (
        table.numbers(name) for name in ("time_s", "depth_mm", "force_N", "fem_force_N", "wave_force_N")
    )
    found = []
    for key in dict.fromkeys(keys):
        rows = np.array([each == key for each in keys])
        answered = bool(np.isfinite(wave[rows]).any())
        found.append(
            TrialPrediction(
                trial=key[0],
                condition=key[1],
                time=time[rows],
                depth=MM * depth[rows],
                force=force[rows],
                fem_force=fem[rows],
                wave_force=wave[rows] if answered else None,
                held_out_force=None,
            )
        )
    return tuple(found)


def _parameters(table: Table) -> tuple[FittedParameter, ...]:
    numbers = [[None if np.isnan(value) else float(value) for value in table.numbers(name)] for name in NUMBERS]
    words = [table.words(name) for name in ("name", "unit", "identifiable", "source")]
    return tuple(
        FittedParameter(name, value, unit, low, high, told == "true", source)
        for name, unit, told, source, value, low, high in zip(*words, *numbers, strict=True)
    )
