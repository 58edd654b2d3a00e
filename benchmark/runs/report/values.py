"""A run at the report's border: numbers in mm and N, None where there is nothing, and its fit in one sentence."""

from __future__ import annotations

import numpy as np

from benchmark.comparison import profile_error
from benchmark.identification import SessionFit, SheetFit
from benchmark.identification.pooling import counted_trials
from benchmark.models import Array, ModelResult
from benchmark.runs.record import RunRecord, whole
from benchmark.runs.trials.measured import MeasuredComparison
from benchmark.side_by_side import Speedup
from reports.figures.style import Pair
from reports.formatting import counted, format_number

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
    return whole(values, steps)


def profile_mm(result: ModelResult | None) -> Array | None:
    """(L, m) mm at peak load."""
    return None if result is None else MM * result.profile


HELD = 1.0 - 1e-9
"""Steps at this share of the peak load and more are at peak load: a hold has many."""


def peak_errors(record: RunRecord) -> dict[str, float]:
    """Percent error of wave against FEM at peak load by layer, where both have a value; in a hold the largest.

    Where the depth is prescribed that of the force comes first.
    """
    size = np.abs(record.load)
    held = size >= HELD * size.max()
    errors = {name: _errors(fem, wave, fem)[held] for name, (fem, wave) in record.answers.items()}
    return {name: float(each[np.nanargmax(np.abs(each))]) for name, each in errors.items() if not np.isnan(each).all()}


def largest_errors(record: RunRecord) -> dict[str, float]:
    """Largest difference of the models over all steps, % of the FEM's largest value, by layer; the force as above."""
    errors = {
        name: _errors(fem, wave, np.full(fem.size, np.nanmax(np.abs(fem), initial=0.0)))
        for name, (fem, wave) in record.answers.items()
    }
    return {name: float(np.nanmax(np.abs(each))) for name, each in errors.items() if not np.isnan(each).all()}


def profile_errors(record: RunRecord) -> dict[str, float]:
    """Largest difference of the profiles at peak load, % of the FEM's largest there, by layer that both have."""
    fem, wave = record.pair.fem.result, record.pair.wave.result
    if fem is None or wave is None or not (fem.time.size and wave.time.size) or fem.peak_step != wave.peak_step:
        return {}
    pairs = {name: (fem.profile[k], wave.profile[k]) for k, name in enumerate(record.layers)}
    told = {name: pair for name, pair in pairs.items() if np.isfinite(sum(pair)).any() and np.any(pair[0])}
    return {name: profile_error(*pair).maximum_percent for name, pair in told.items()}


def _errors(fem: Array, wave: Array, size: Array) -> Array:
    """(n,) difference in % of `size`; NaN where that is zero or a model has no value."""
    return np.asarray(np.divide(100.0 * (wave - fem), size, out=np.full(fem.size, np.nan), where=size != 0.0))


def speedup_words(ratio: Speedup) -> str:
    """A speed-up with what its interval is."""
    low, high = map(times_words, ratio.ci95)
    return f"{times_words(ratio.median)} ({ratio.spread} {low} to {high}, {ratio.repeats} interleaved pairs)"


def times_words(ratio: float) -> str:
    """A ratio of times to three digits, without an exponent."""
    return format_number(ratio, 3, trim=True)


def setup_words(ratio: Speedup, wave: str) -> str:
    """What is left of it with the set-up, and from how many load histories on it pays."""
    first = f"with the set-up before it, one load history is {times_words(ratio.with_setup)} times as fast"
    if ratio.pays_from is None:
        return f"{first}; the {wave} is never ahead"
    many = "already in the first" if ratio.pays_from == 1 else f"from {ratio.pays_from} load histories of one set-up on"
    return f"{first}; the {wave} is ahead {many}"


def fit_headline(fit: SessionFit) -> str:
    """Return the fit in one sentence."""
    found, count = fit.stiffness, len(fit.trials)
    rms = float(np.median([trial.residual_percent for trial in fit.trials]))
    moduli = [each for each in fit.parameters if each.name.endswith(".youngs_modulus") and each.value is not None]
    what = (
        f"the specimen is {found.value:.4g} times as stiff as told (95 % {found.ci95_low:.4g} to {found.ci95_high:.4g}"
        f"{_with_setup(fit, found.value)})"
    )
    if len(moduli) == 1 and moduli[0].ci95_low is not None and moduli[0].ci95_high is not None:
        (one,) = moduli
        what = (
            f"Young's modulus is {one.value:.4g} {one.unit} (95 % {one.ci95_low:.4g} to {one.ci95_high:.4g}"
            f"{_with_setup(fit, one.value)}), {found.value:.4g} times the value before the fit"
        )
    fold = fit.conditions_fold
    apart = "" if fold is None else f"; its conditions differ {fold:.3g}-fold, which one stiffness does not follow"
    return (
        f"fitted to {counted(count, 'trial')}: {what}; the elastic law leaves {rms:.2g} % of the "
        f"peak force (median over trials, each by its own stiffness, of the root mean square){apart}"
    )


def _with_setup(fit: SessionFit, value: float | None) -> str:
    """The interval of a value where the set-up may be other than told; nothing where that was not worked out."""
    wide = fit.with_setup
    if wide is None or value is None:
        return ""
    unit = value / fit.stiffness.value
    low, high = (f"{unit * end:.4g}" for end in (wide.ci95_low, wide.ci95_high))
    return (
        f" by the trials' scatter and the model's own error, {low} to {high} with the uncertainty of the set-up as told"
    )


def sentence(text: str) -> str:
    """Return a clause as a sentence of its own."""
    return f"{text[0].upper()}{text[1:]}."


def sheet_headline(sheet: SheetFit) -> str:
    """Return the fit of force and markers in one sentence."""
    found = sheet.stiffness
    text = (
        f"force and markers of {counted_trials(found.trials)} together: the specimen is {found.value:.4g} times as "
        f"stiff as told (95 % {found.low:.4g} to {found.high:.4g})"
    )
    if sheet.relaxation.share > 0.0 and sheet.share is not None:
        text += (
            f"; its force relaxes by {100 * sheet.relaxation.share:.3g} % (95 % {100 * sheet.share.low:.3g} to "
            f"{100 * sheet.share.high:.3g}) within some {sheet.relaxation.tau:.3g} s"
        )
    return text


def measured_headline(comparison: MeasuredComparison) -> str:
    """Return the fit behind a run in one sentence: of force and markers where there are markers."""
    sheet = None if comparison.filmed is None else comparison.filmed.sheet
    return fit_headline(comparison.fit) if sheet is None else sheet_headline(sheet)
