"""The fitted and the fixed parameters of a specimen, their intervals, and whether the data can tell them.

What the data cannot tell has no interval: the scatter of a value between trials says nothing of how well it is known.
Only a prior that a person stated gives one, and is then named.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Protocol

import numpy as np

from benchmark.identification.pooling import PooledStiffness, counted_trials, mean_interval, shared
from benchmark.identification.sheet_session import Pooled, SheetFit, pool_values
from benchmark.identification.sheet_trial import SheetTrial
from benchmark.identification.trial_fit import TrialFit

COLUMNS = ("name", "value", "unit", "ci95_low", "ci95_high", "identifiable", "source")


class LayerLike(Protocol):
    """What is read of a layer: SI, an endless thickness is infinite."""

    @property
    def name(self) -> str:
        """Name of the layer."""

    @property
    def thickness(self) -> float:
        """Thickness in m."""

    @property
    def youngs_modulus(self) -> float:
        """Young's modulus in Pa."""

    @property
    def poisson_ratio(self) -> float:
        """Poisson's ratio."""


@dataclass(frozen=True)
class FittedParameter:
    """One row of `fitted_parameters.csv`; the value is in `unit`, None where there is none.

    Attributes
    ----------
    ci95_low, ci95_high : float or None
        None for what the data do not identify, unless a prior gives the interval.
    identifiable : bool
        Whether the data tell the value, without a prior.
    source : str
        How it was found, and why it is not identified where it is not.
    prior : str or None
        What was stated beforehand and its source.

    Raises
    ------
    ValueError
        An interval of what neither data nor prior tell.
    """

    name: str
    value: float | None
    unit: str
    ci95_low: float | None
    ci95_high: float | None
    identifiable: bool
    source: str
    prior: str | None = None

    def __post_init__(self) -> None:
        if self.ci95_low is not None and not self.identifiable and self.prior is None:
            raise ValueError(f"{self.name} is not identified and has no prior: it has no interval either")

    @property
    def text(self) -> str:
        """Name, value, and its interval or why there is none."""
        value = "no value" if self.value is None else f"{self.value:.5g} {self.unit}".strip()
        if self.ci95_low is None or self.ci95_high is None:
            return f"{self.name}: {value} ({self.source})"
        rests = "" if self.identifiable else ", on its prior alone"
        return f"{self.name}: {value} (95 % {self.ci95_low:.5g} to {self.ci95_high:.5g}{rests})"

    def unidentified(self, source: str) -> FittedParameter:
        """The same value without an interval, and why: `source` follows what is said of it."""
        return replace(self, ci95_low=None, ci95_high=None, identifiable=False, source=f"{self.source}{source}")

    def to_dict(self) -> dict[str, Any]:
        """Fields by name."""
        return asdict(self)


def parameter_columns(parameters: Sequence[FittedParameter]) -> dict[str, list[Any]]:
    """Columns of `fitted_parameters.csv`; `identifiable` as true or false."""
    rows = [parameter.to_dict() | {"identifiable": str(parameter.identifiable).lower()} for parameter in parameters]
    return {name: [row[name] for row in rows] for name in COLUMNS}


def fitted_parameters(
    pooled: PooledStiffness, trials: Sequence[TrialFit], layers: Sequence[LayerLike]
) -> tuple[FittedParameter, ...]:
    """Rows for the pooled stiffness, the layers of the specimen, and the trials' onsets and zeros."""
    count = counted_trials(pooled.trials)
    factor = FittedParameter(
        "stiffness_factor",
        pooled.value,
        "",
        pooled.ci95_low,
        pooled.ci95_high,
        True,
        f"fitted to force over depth of {count}; {pooled.method}",
    )
    rows = [factor]
    for layer in layers:
        rows += [_modulus(layer, pooled, len(layers)), *_fixed(layer)]
    bound = sum(trial.onset_at_bound for trial in trials)
    _, zeros, onsets = zip(*(trial.of_curve for trial in trials), strict=True)
    onset = _summary(
        "contact_onset", "mm", [1e3 * t.onset for t in trials], 1e3 * trials[0].onset_stderr, 1e3 * shared(onsets)
    )
    zero = _summary("force_zero", "N", [t.zero for t in trials], trials[0].zero_stderr, shared(zeros))
    if 2 * bound > len(trials):
        onset = onset.unidentified(f"; {bound} of {len(trials)} lie at an end of the range the data allow")
    return (*rows, onset, zero)


def _modulus(layer: LayerLike, pooled: PooledStiffness, layers: int) -> FittedParameter:
    kilopascal = 1e-3 * layer.youngs_modulus
    row = FittedParameter(
        f"{layer.name}.youngs_modulus",
        pooled.value * kilopascal,
        "kPa",
        pooled.ci95_low * kilopascal,
        pooled.ci95_high * kilopascal,
        True,
        f"stiffness_factor x {kilopascal:.6g} kPa of the specimen",
    )
    if layers == 1:
        return replace(row, source=f"{row.source}; {GIVEN}")
    return row.unidentified(
        "; a force-depth curve gives one stiffness, not several: the ratios of the layers are the file's"
    )


def _fixed(layer: LayerLike) -> list[FittedParameter]:
    source = "fixed at the specimen's value, not fitted"
    thickness = 1e3 * layer.thickness if math.isfinite(layer.thickness) else None
    endless = "" if thickness is not None else "; endless"
    return [
        FittedParameter(f"{layer.name}.poisson_ratio", layer.poisson_ratio, "", None, None, False, source),
        FittedParameter(f"{layer.name}.thickness", thickness, "mm", None, None, False, source + endless),
    ]


def _summary(name: str, unit: str, values: list[float], stderr: float, alike: float) -> FittedParameter:
    """Mean over trials with its t interval and what is `alike` in all; a single trial has 1.96 of its own errors."""
    if len(values) == 1:
        half, mean, source = 1.96 * stderr, values[0], "of the single trial, from its own residual"
    else:
        mean, scattered, _ = mean_interval(values)
        half = math.hypot(scattered, alike)
        source = f"mean over {len(values)} trials of each trial's own value"
    return FittedParameter(name, mean, unit, mean - half, mean + half, True, source)


GIVEN = "given tool, support, thickness and Poisson's ratio"
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
    source = f"force and markers of {counted_trials(sheet.stiffness.trials)} together, at once after a step of depth"
    rows = [_row("stiffness_factor", "", sheet.stiffness, True, source)]
    rows += [_modulus_sheet_parameters(name, layer, sheet, len(layers)) for name, layer in names.items()]
    return (*rows, *_relaxation(sheet), *_thickness(sheet), *_nuisances(sheet.trials), *kept, *fixed)


def _row(name: str, unit: str, pooled: Pooled, identifiable: bool, source: str, scale: float = 1.0) -> FittedParameter:
    """Without an interval, and not identifiable, where the ends are not finite."""
    known = identifiable and bool(np.isfinite([pooled.low, pooled.high]).all())
    low, high = (scale * pooled.low, scale * pooled.high) if known else (None, None)
    return FittedParameter(name, scale * pooled.value, unit, low, high, known, source)


def _modulus_sheet_parameters(name: str, layer: LayerLike, sheet: SheetFit, layers: int) -> FittedParameter:
    kilopascal = 1e-3 * layer.youngs_modulus
    given = GIVEN
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
    most = f" (at most {sheet.share.high:.2g}, 95 %)" if np.isfinite(sheet.share.high) else ""
    source = f"of {counted_trials(sheet.share.trials)} with a hold; " + (
        "a clock of the force that is 2 ms off the depth's moves the time by a tenth"
        if seen
        else f"not to be told from none{most}: a longer hold, or trials of more speeds, would tell"
    )
    return [
        _row("relaxation.g_1", "", sheet.share, seen, source),
        _row("relaxation.tau_1", "s", sheet.tau, seen, source),
    ]


def _thickness(sheet: SheetFit) -> list[FittedParameter]:
    """Thickness fitted together with the stiffness, and how far the two can be told apart."""
    force, both = (_correlation(sheet.with_thickness, name) for name in ("force_correlations", "correlations"))
    source = (
        f"fitted together with the stiffness in {counted_trials(sheet.thickness.trials)}; they correlate by "
        f"{force:.3f} in the force alone and by {both:.3f} with the markers"
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
    source = f"mean over {counted_trials(len(trials))} of each trial's own value, from its force and markers"
    rows = []
    for name, values, key in (
        ("contact_onset", [1e3 * trial.state.onset for trial in trials], "onset"),
        ("tool_axis_x", [1e3 * trial.state.axis[0] for trial in trials], "axis_x"),
        ("tool_axis_y", [1e3 * trial.state.axis[1] for trial in trials], "axis_y"),
    ):
        pooled = pool_values(values, trials[0].stderr.get(key, np.inf))
        rows.append(_row(name, "mm", pooled, True, source))
    return rows
