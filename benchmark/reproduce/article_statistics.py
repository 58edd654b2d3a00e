"""The article's statistics number by number: Table 2, r^2 of the parabolas and the average percent error.

Each from its other printed numbers, or from FEM and wave model run here.
"""

from __future__ import annotations

import numpy as np
import scipy

from benchmark.comparison import TwoSampleT, pooled_t_test
from benchmark.models import Array
from benchmark.reproduce.evidence import Evidence
from benchmark.reproduce.items import RUN, SESSION, Item, compare, rounding_span
from benchmark.runs.record import RunRecord
from wavemodel import PublishedWave

MEAN_FEM, MEAN_WAVE = -0.05508, -0.05509
"""Mean of the maximum deformations; no unit is printed, mm elsewhere. Down is negative."""
VARIANCE_FEM, VARIANCE_WAVE = 0.001022, 0.001023
OBSERVATIONS = 100.0
HYPOTHESISED_DIFFERENCE = 0.0
P_VALUE, T, T_CRITICAL = 0.997171, 0.00355, 1.972017
"""P(T<=t) two-tail, t Stat and t Critical two-tail."""
R2_MEAN, R2_LARGEST, R2_SMALLEST = 0.89, 0.956, 0.555
"""Section 3.2.5, of the parabolas (printed in mm, though r^2 has no unit)."""
PERCENT_ERROR = 0.089
"""Section 3.5, the average percent error between the two models."""

MM = 1e3
MOST = 10_000
DEGREES = 2 * int(OBSERVATIONS) - 2


def table_two_items(record: RunRecord) -> tuple[Item, ...]:
    """Return the items, with the surface of the scenario `paper` where a model is needed."""
    test = surface_test(record)
    return (
        *_means(test, _surface(record)[0]),
        *_variances(test),
        *observation_items(),
        *test_numbers(),
        *_predicted(test),
    )


def surface_test(record: RunRecord) -> TwoSampleT:
    """Return the test of Table 2 on the surface of a run, in mm, down negative as there."""
    return pooled_t_test(*_surface(record))


def _surface(record: RunRecord) -> tuple[Array, Array]:
    """FEM and wave model, (n,) mm each, down negative."""
    fem, wave = (-MM * record.deflections(run.result)[:, 0] for run in (record.pair.fem, record.pair.wave))
    return fem, wave


def _means(test: TwoSampleT, fem: Array) -> list[Item]:
    scaled = (
        f"the scenario paper by finite elements, whose moduli are scaled to a peak of {abs(fem).max():.5f} mm: that of "
        "a triangle with the printed mean, so the mean is circular"
    )
    away = 100.0 * (test.wave.mean / test.fem.mean - 1.0)
    predicted = (
        f"the layered wave predicts it with nothing of the FEM fed in, {away:+.2f} % from the FEM; the article fed the "
        "FEM's maximum in"
    )
    fed = "the article's protocol: eq. (8) is fed the FEM's maximum and eq. (7) returns it, so that both means are one"
    return [
        compare("Table 2: mean, FEA", MEAN_FEM, test.fem.mean, scaled, "mm", RUN),
        compare("Table 2: mean, wave equation, predicted", MEAN_WAVE, test.wave.mean, predicted, "mm", RUN),
        compare("Table 2: mean, wave equation, fed (circular)", MEAN_WAVE, _replayed(fem).mean(), fed, "mm", RUN),
    ]


def _variances(test: TwoSampleT) -> list[Item]:
    triangle = (
        f"variance of a triangle over {OBSERVATIONS:g} observations with the printed mean: it goes with the mean "
        "squared"
    )
    predicted = (
        "of the same prediction; a variance goes with the square, so it is off by twice the per cent of the mean"
    )
    of_triangle = [variance_of_triangle(mean) for mean in (MEAN_FEM, MEAN_WAVE)]
    return [
        compare("Table 2: variance, FEA", VARIANCE_FEM, test.fem.variance, "of the same FEM run", "mm²", RUN),
        compare("Table 2: variance, FEA, of a load triangle", VARIANCE_FEM, of_triangle[0], triangle, "mm²"),
        compare(
            "Table 2: variance, wave equation, predicted", VARIANCE_WAVE, test.wave.variance, predicted, "mm²", RUN
        ),
        compare("Table 2: variance, wave equation, of a load triangle", VARIANCE_WAVE, of_triangle[1], triangle, "mm²"),
    ]


def variance_of_triangle(mean: float) -> float:
    """Variance (n - 1) of a load triangle over the printed observations that has this mean."""
    half = 0.5 * OBSERVATIONS
    shape = 1.0 - np.abs(np.arange(1.0, OBSERVATIONS + 1.0) / half - 1.0)
    return float(np.var(shape, ddof=1) * (mean / shape.mean()) ** 2)


def _replayed(deflection_mm: Array) -> Array:
    """Deflections, down negative, fed to eq. (8) and read off eq. (7), the amplitude put in."""
    wave = PublishedWave("corrected")
    middle = 0.5 * wave.side
    return np.asarray(-MM * wave.replay(-deflection_mm / MM, middle, middle))


def observation_items() -> list[Item]:
    """Observations of each model, from the printed t critical."""
    degrees = np.arange(2, MOST)
    found = int(degrees[np.abs(scipy.stats.t.ppf(0.975, degrees) - T_CRITICAL).argmin()])
    reason = f"the printed t critical belongs to {found} degrees of freedom, two fewer than the observations"
    return [
        compare(f"Table 2: observations, {name}", OBSERVATIONS, found / 2.0 + 1.0, reason)
        for name in ("FEA", "wave equation")
    ]


def test_numbers() -> list[Item]:
    """The test's numbers, each from the other printed ones."""
    error = np.sqrt((VARIANCE_FEM + VARIANCE_WAVE) / OBSERVATIONS)
    needed = T * error
    span = rounding_span(_t_of_print, MEAN_FEM, MEAN_WAVE, VARIANCE_FEM, VARIANCE_WAVE)
    why_t = (
        f"with the printed variances; the printed t needs a difference of means of {1e5 * needed:.3f} × 10⁻⁵ mm, "
        "inside the rounding of the means (0 to 2 × 10⁻⁵ mm)"
    )
    chosen = "a choice: it is what makes this the test of equal means"
    p_value = 2.0 * scipy.stats.t.sf(T, DEGREES)
    critical = scipy.stats.t.ppf(0.975, DEGREES)
    return [
        compare("Table 2: hypothesized mean difference", HYPOTHESISED_DIFFERENCE, 0.0, chosen, "mm"),
        compare(
            "Table 2: P(T<=t) two-tail",
            P_VALUE,
            p_value,
            f"from the printed t, with {DEGREES} degrees of freedom",
        ),
        compare(
            "Table 2: t Stat, from the printed p",
            T,
            scipy.stats.t.isf(0.5 * P_VALUE, DEGREES),
            f"from the printed p, with {DEGREES} degrees of freedom",
        ),
        compare(
            "Table 2: t Stat, from the printed means",
            T,
            _t_of_print(MEAN_FEM, MEAN_WAVE, VARIANCE_FEM, VARIANCE_WAVE),
            why_t,
            span=span,
        ),
        compare("Table 2: t Critical two-tail", T_CRITICAL, critical, f"at 5 % and {DEGREES} degrees of freedom"),
    ]


def _t_of_print(mean_fem: float, mean_wave: float, variance_fem: float, variance_wave: float) -> float:
    return float((mean_fem - mean_wave) / np.sqrt((variance_fem + variance_wave) / OBSERVATIONS))


def _predicted(test: TwoSampleT) -> list[Item]:
    reason = "FEM against a wave that predicts; failing to reject does not show agreement"
    return [
        compare("Table 2: t Stat, predicted", T, test.t, reason, basis=RUN),
        compare("Table 2: P(T<=t) two-tail, predicted", P_VALUE, test.p_value, reason, basis=RUN),
    ]


def text_items(evidence: Evidence) -> tuple[Item, ...]:
    """Return r^2 of the parabolas and the average percent error."""
    r2, trials = evidence.chain.r2, evidence.chain.trials
    whose = "synthetic " if evidence.chain.synthetic else ""
    reason = (
        f"over {r2.size} parabolas of {trials} {whose}trials, after the same moving average: another specimen, with "
        "markers that hardly move along one axis; an agreement would be chance"
    )
    each = [comparison.percent.mean for comparison in evidence.press.comparisons if comparison.percent is not None]
    how = (
        "mean over the layers of skin, the layered wave against the FEM under 5 N; the article's wave was fed the "
        "FEM's maximum, so its error is one of reading off, ours one of prediction"
    )
    return (
        compare("Section 3.2.5: r² of the parabolas, average", R2_MEAN, float(np.nanmean(r2)), reason, "", SESSION),
        compare("Section 3.2.5: r², largest", R2_LARGEST, float(np.nanmax(r2)), reason, "", SESSION),
        compare("Section 3.2.5: r², smallest", R2_SMALLEST, float(np.nanmin(r2)), reason, "", SESSION),
        compare("Section 3.5: average percent error", PERCENT_ERROR, float(np.mean(each)), how, "%", RUN),
    )
