"""The numbers of a run as the report's border wants them: mm, N, and None where there is nothing."""

from __future__ import annotations

import numpy as np

from benchmark.models import Array, ModelResult
from benchmark.runs.record import RunRecord
from reports.figures.pair import Pair

MM = 1e3


def pair_names(record: RunRecord) -> Pair:
    """What figures call the two models: their usual names, or the user's."""
    return Pair.named(record.pair.fem.own, record.pair.wave.own)


def fem_mm(record: RunRecord) -> Array:
    """(n, L) mm; NaN where the FEM has no value."""
    return MM * record.deflections(record.pair.fem.result)


def wave_mm(record: RunRecord) -> Array | None:
    """(n, L) mm, None where the wave model does not cover the scenario."""
    result = record.pair.wave.result
    return None if result is None else MM * record.deflections(result)


def padded(result: ModelResult | None, values: Array | None, steps: int) -> Array | None:
    """`values` (k,) of a run that may have stopped early, as (n,) with NaN for what it did not reach."""
    if result is None or values is None:
        return None
    whole = np.full(steps, np.nan)
    whole[: values.size] = values
    return whole


def profile_mm(result: ModelResult | None) -> Array | None:
    """(L, m) mm at peak load."""
    return None if result is None else MM * result.profile


def peak_errors(record: RunRecord) -> dict[str, float]:
    """Percent error of wave against FEM at peak load by layer, where both have a value."""
    wave = wave_mm(record)
    if wave is None:
        return {}
    step = int(np.abs(record.load).argmax())
    fem = fem_mm(record)[step]
    return {
        name: float(100.0 * (wave[step, column] - fem[column]) / fem[column])
        for column, name in enumerate(record.layers)
        if np.isfinite(fem[column]) and fem[column] != 0.0
    }
