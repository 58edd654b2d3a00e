"""Table 2 of the article, number by number: from its other numbers, and from FEM and wave model run here."""

from __future__ import annotations

import numpy as np
import scipy

from benchmark.comparison import TwoSampleT, pooled_t_test
from benchmark.models import Array
from benchmark.reproduce import printed
from benchmark.reproduce.item import RUN, Item, compare
from benchmark.runs.record import RunRecord
from wavemodel import PublishedWave

MM = 1e3
MOST = 10_000
DEGREES = 2 * int(printed.OBSERVATIONS) - 2


def table_two_items(record: RunRecord) -> tuple[Item, ...]:
    """Return the items, with the surface of the scenario `paper` where a model is needed."""
    test = surface_test(record)
    return (*_moments(test, _surface(record)[0]), *observation_items(), *test_numbers(), *_predicted(test))


def surface_test(record: RunRecord) -> TwoSampleT:
    """Return the test of Table 2 on the surface of a run, in mm, down negative as there."""
    return pooled_t_test(*_surface(record))


def _surface(record: RunRecord) -> tuple[Array, Array]:
    """FEM and wave model, (n,) mm each, down negative."""
    fem, wave = (-MM * record.deflections(run.result)[:, 0] for run in (record.pair.fem, record.pair.wave))
    return fem, wave


def _moments(test: TwoSampleT, fem: Array) -> list[Item]:
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
    triangle = "variance of a triangle over {:g} observations with the printed mean: it goes with the mean squared"
    triangle = triangle.format(printed.OBSERVATIONS)
    return [
        compare("Table 2: mean, FEA", printed.MEAN_FEM, test.fem.mean, scaled, "mm", RUN),
        compare("Table 2: mean, wave equation, predicted", printed.MEAN_WAVE, test.wave.mean, predicted, "mm", RUN),
        compare(
            "Table 2: mean, wave equation, fed (circular)", printed.MEAN_WAVE, _replayed(fem).mean(), fed, "mm", RUN
        ),
        compare("Table 2: variance, FEA", printed.VARIANCE_FEM, test.fem.variance, "of the same FEM run", "mm²", RUN),
        compare(
            "Table 2: variance, FEA, of a load triangle",
            printed.VARIANCE_FEM,
            variance_of_triangle(printed.MEAN_FEM),
            triangle,
            "mm²",
        ),
        compare(
            "Table 2: variance, wave equation, predicted",
            printed.VARIANCE_WAVE,
            test.wave.variance,
            "of the same prediction; a variance goes with the square, so it is off by twice the per cent of the mean",
            "mm²",
            RUN,
        ),
        compare(
            "Table 2: variance, wave equation, of a load triangle",
            printed.VARIANCE_WAVE,
            variance_of_triangle(printed.MEAN_WAVE),
            triangle,
            "mm²",
        ),
    ]


def variance_of_triangle(mean: float) -> float:
    """Variance (n - 1) of a load triangle over the printed observations that has this mean."""
    half = 0.5 * printed.OBSERVATIONS
    shape = 1.0 - np.abs(np.arange(1.0, printed.OBSERVATIONS + 1.0) / half - 1.0)
    return float(np.var(shape, ddof=1) * (mean / shape.mean()) ** 2)


def _replayed(deflection_mm: Array) -> Array:
    """Deflections, down negative, fed to eq. (8) and read off eq. (7), the amplitude put in."""
    wave = PublishedWave("corrected")
    middle = 0.5 * wave.side
    return np.asarray(-MM * wave.replay(-deflection_mm / MM, middle, middle))


def observation_items() -> list[Item]:
    """Observations of each model, from the printed t critical."""
    degrees = np.arange(2, MOST)
    found = int(degrees[np.abs(scipy.stats.t.ppf(0.975, degrees) - printed.T_CRITICAL).argmin()])
    reason = f"the printed t critical belongs to {found} degrees of freedom, two fewer than the observations"
    return [
        compare(f"Table 2: observations, {name}", printed.OBSERVATIONS, found / 2.0 + 1.0, reason)
        for name in ("FEA", "wave equation")
    ]


def test_numbers() -> list[Item]:
    """The test's numbers, each from the other printed ones."""
    error = np.sqrt((printed.VARIANCE_FEM + printed.VARIANCE_WAVE) / printed.OBSERVATIONS)
    difference = printed.MEAN_FEM - printed.MEAN_WAVE
    needed = printed.T * error
    why_t = (
        f"with the printed variances; the printed t needs a difference of means of {1e5 * needed:.3f} × 10⁻⁵ mm, "
        "inside the rounding of the means (0 to 2 × 10⁻⁵ mm)"
    )
    chosen = "a choice: it is what makes this the test of equal means"
    p_value = 2.0 * scipy.stats.t.sf(printed.T, DEGREES)
    critical = scipy.stats.t.ppf(0.975, DEGREES)
    return [
        compare("Table 2: hypothesized mean difference", printed.HYPOTHESISED_DIFFERENCE, 0.0, chosen, "mm"),
        compare(
            "Table 2: P(T<=t) two-tail",
            printed.P_VALUE,
            p_value,
            f"from the printed t, with {DEGREES} degrees of freedom",
        ),
        compare(
            "Table 2: t Stat, from the printed p",
            printed.T,
            scipy.stats.t.isf(0.5 * printed.P_VALUE, DEGREES),
            f"from the printed p, with {DEGREES} degrees of freedom",
        ),
        compare("Table 2: t Stat, from the printed means", printed.T, difference / error, why_t),
        compare(
            "Table 2: t Critical two-tail", printed.T_CRITICAL, critical, f"at 5 % and {DEGREES} degrees of freedom"
        ),
    ]


def _predicted(test: TwoSampleT) -> list[Item]:
    reason = "FEM against a wave that predicts; that the test does not reject shows no agreement"
    return [
        compare("Table 2: t Stat, predicted", printed.T, test.t, reason, basis=RUN),
        compare("Table 2: P(T<=t) two-tail, predicted", printed.P_VALUE, test.p_value, reason, basis=RUN),
    ]
