"""Rows of `fitted_parameters.csv` from force and markers together, with what the data cannot tell and what would."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmark.fitting.parameters import FittedParameter, LayerLike
from benchmark.fitting.sheet_session import Pooled, SheetFit, pool_values
from benchmark.fitting.sheet_trial import SheetTrial

CLEAR = 0.9
"""Correlation of stiffness and thickness from which their pair is said not to be told apart."""
PAIR = "log_stiffness, log_thickness"


def sheet_parameters(
    sheet: SheetFit, layers: Sequence[LayerLike], alone: Sequence[FittedParameter]
) -> tuple[FittedParameter, ...]:
    """Return the rows of a filmed session.

    Parameters
    ----------
    sheet : SheetFit
    layers : sequence
        Of the specimen.
    alone : sequence of FittedParameter
        Rows of the fit of the force alone: its stiffness stays as a row of its own, what is fixed stays as it is.
    """
    names = {f"{layer.name}.youngs_modulus": layer for layer in layers}
    kept = [replace(row, name=f"{row.name}.force_alone") for row in alone if row.name == "stiffness_factor"]
    fixed = [row for row in alone if row.name.endswith((".poisson_ratio", ".thickness")) or row.name == "force_zero"]
    source = f"force and markers of {_trials(sheet.stiffness)} together, at once after a step of depth"
    rows = [_row("stiffness_factor", "", sheet.stiffness, True, source)]
    rows += [_modulus(name, layer, sheet, len(layers)) for name, layer in names.items()]
    return (*rows, *_relaxation(sheet), *_thickness(sheet), *_nuisances(sheet.trials), *kept, *fixed)


def _row(name: str, unit: str, pooled: Pooled, identifiable: bool, source: str, scale: float = 1.0) -> FittedParameter:
    low, high = (scale * end if np.isfinite(end) else None for end in (pooled.low, pooled.high))
    return FittedParameter(name, scale * pooled.value, unit, low, high, identifiable, source)


def _trials(pooled: Pooled) -> str:
    return "1 trial" if pooled.trials == 1 else f"{pooled.trials} trials"


def _modulus(name: str, layer: LayerLike, sheet: SheetFit, layers: int) -> FittedParameter:
    kilopascal = 1e-3 * layer.youngs_modulus
    given = "given tool, support, thickness and Poisson's ratio"
    if layers > 1:
        given = "one stiffness for all layers: their ratios are the file's; a press of each layer alone would tell"
    source = f"stiffness_factor x {kilopascal:.6g} kPa of the specimen; {given}"
    return _row(name, "kPa", sheet.stiffness, layers == 1, source, kilopascal)


def _relaxation(sheet: SheetFit) -> list[FittedParameter]:
    """Share and time of the relaxation, or that no trial can tell them."""
    if sheet.share is None or sheet.tau is None:
        missing = "no trial holds its depth: a hold of a few seconds under load would tell"
        empty = FittedParameter("relaxation.g_1", None, "", None, None, False, missing)
        return [empty, replace(empty, name="relaxation.tau_1", unit="s")]
    seen = sheet.share.low > 0.0
    source = f"of {_trials(sheet.share)} with a hold; " + (
        "a clock of the force that is 2 ms off the depth's moves the time by a tenth"
        if seen
        else "not to be told from none: a longer hold, or trials of more speeds, would tell"
    )
    return [
        _row("relaxation.g_1", "", sheet.share, seen, source),
        _row("relaxation.tau_1", "s", sheet.tau, seen, source),
    ]


def _thickness(sheet: SheetFit) -> list[FittedParameter]:
    """Thickness fitted together with the stiffness, and how far the two can be told apart."""
    force, both = (_correlation(sheet.with_thickness, name) for name in ("force_correlations", "correlations"))
    source = (
        f"fitted together with the stiffness in {_trials(sheet.thickness)}; they correlate by {force:.3f} in the force "
        f"alone and by {both:.3f} with the markers"
    )
    clear = abs(both) < CLEAR
    if not clear:
        source += (
            ": the pair rests on the markers' outward motion; a gauge of the thickness, or a press of "
            "another tool radius, would tell them apart"
        )
    together = "the same fit: what the stiffness would be if nobody knew the thickness"
    return [
        _row("thickness_factor", "", sheet.thickness, clear, source),
        _row("stiffness_factor.thickness_free", "", sheet.stiffness_with_thickness, clear, together),
    ]


def _correlation(trials: Sequence[SheetTrial], which: str) -> float:
    found = [getattr(trial, which)[PAIR] for trial in trials if PAIR in getattr(trial, which)]
    return float(np.median(found)) if found else 1.0


def _nuisances(trials: Sequence[SheetTrial]) -> list[FittedParameter]:
    """Means over trials of what is each trial's own: contact and tool axis."""
    source = f"mean over {len(trials)} trials of each trial's own value, from its force and markers"
    rows = []
    for name, values, key in (
        ("contact_onset", [1e3 * trial.state.onset for trial in trials], "onset"),
        ("tool_axis_x", [1e3 * trial.state.axis[0] for trial in trials], "axis_x"),
        ("tool_axis_y", [1e3 * trial.state.axis[1] for trial in trials], "axis_y"),
    ):
        pooled = pool_values(values, trials[0].stderr.get(key, np.inf))
        rows.append(_row(name, "mm", pooled, bool(np.isfinite(pooled.low)), source))
    return rows
