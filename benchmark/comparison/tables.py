"""The comparison tables as columns for a CSV writer: `statistics.csv` and `normal_fits.csv`."""

from collections.abc import Sequence
from typing import Any

from benchmark.comparison.layer import LayerComparison
from benchmark.comparison.result import plain

STATISTICS = ("layer", "test", "quantity", "fem", "wave", "value")
NORMAL_FITS = ("layer", "model", "mean_mm", "std_mm", "n", "anderson_darling", "p_value")


def statistics_columns(layers: Sequence[LayerComparison]) -> dict[str, list[Any]]:
    """Columns of `statistics.csv`; deformations in mm, variances in mm^2, None where a cell is empty."""
    lines = [(layer.layer, test, *row) for layer in layers for test, rows in layer.tests().items() for row in rows]
    return _columns(STATISTICS, lines)


def normal_fit_columns(
    layers: Sequence[LayerComparison], models: tuple[str, str] = ("fem", "wave")
) -> dict[str, list[Any]]:
    """Columns of `normal_fits.csv`, one line per layer and model; a model without values has no line.

    `models` are the names of the two in the column `model`.
    """
    lines = [
        (layer.layer, model, fit.mean, fit.std, fit.n, fit.anderson_darling, fit.p_value)
        for layer in layers
        for model, fit in zip(models, (layer.fem_fit, layer.wave_fit), strict=True)
        if fit is not None
    ]
    return _columns(NORMAL_FITS, lines)


def comparison_summary(layers: Sequence[LayerComparison]) -> dict[str, dict[str, Any]]:
    """`comparison` of results.json: one entry per layer."""
    return {layer.layer: layer.summary() for layer in layers}


def _columns(names: Sequence[str], lines: Sequence[Sequence[Any]]) -> dict[str, list[Any]]:
    return {name: [plain(line[column]) for line in lines] for column, name in enumerate(names)}
