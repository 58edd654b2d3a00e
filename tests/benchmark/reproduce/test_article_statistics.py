"""Table 2 against computations by hand."""

import math
import statistics

import numpy as np
import pytest
from scipy.special import betainc

from benchmark.reproduce.article_statistics import table_two_items, text_items
from benchmark.reproduce.items import RUN

TRIANGLE = [min(k, 100 - k) / 50 for k in range(1, 101)]


@pytest.fixture(scope="module")
def table(evidence):
    return {item.item.removeprefix("Table 2: "): item for item in table_two_items(evidence.table_2)}


def test_every_printed_number_is_there(table) -> None:
    printed = {item.printed for item in table.values()}
    assert printed == {-0.05508, -0.05509, 0.001022, 0.001023, 100.0, 0.0, 0.997171, 0.00355, 1.972017}
    assert all(item.reason for item in table.values())


def test_variances_are_those_of_a_triangle(table) -> None:
    for name, mean, printed in (("FEA", 0.05508, 0.0010223), ("wave equation", 0.05509, 0.0010227)):
        item = table[f"variance, {name}, of a load triangle"]
        assert item.recomputed == pytest.approx(statistics.variance([2 * mean * each for each in TRIANGLE]), rel=1e-9)
        assert item.recomputed == pytest.approx(printed, abs=5e-8)
        assert item.agrees


def test_numbers_of_the_test(table) -> None:
    tail = betainc(99.0, 0.5, 198.0 / (198.0 + 0.00355**2))
    assert table["P(T<=t) two-tail"].recomputed == pytest.approx(tail, rel=1e-9)
    assert table["t Stat, from the printed p"].recomputed == pytest.approx(0.00355, abs=5e-7)
    critical = table["t Critical two-tail"].recomputed
    assert betainc(99.0, 0.5, 198.0 / (198.0 + critical**2)) == pytest.approx(0.05, rel=1e-9)
    for name in ("P(T<=t) two-tail", "t Stat, from the printed p", "t Critical two-tail", "observations, FEA"):
        assert table[name].agrees
    by_means = table["t Stat, from the printed means"]
    assert by_means.recomputed == pytest.approx(1e-5 / math.sqrt(2.045e-5), rel=1e-6)
    assert not by_means.agrees
    assert "1.605" in by_means.reason


def test_observations_follow_from_t_critical(table) -> None:
    assert [table[f"observations, {name}"].recomputed for name in ("FEA", "wave equation")] == [100.0, 100.0]


def test_the_models_of_a_run(table, evidence) -> None:
    record = evidence.table_2
    fem, wave = (-1e3 * run.result.top_deflection[:, 0] for run in (record.pair.fem, record.pair.wave))
    assert table["mean, FEA"].recomputed == pytest.approx(statistics.fmean(fem), rel=1e-12)
    assert table["mean, FEA"].recomputed == pytest.approx(-0.05508, rel=5e-3)  # a coarse mesh
    assert table["mean, wave equation, predicted"].recomputed == pytest.approx(statistics.fmean(wave), rel=1e-12)
    assert table["mean, wave equation, predicted"].recomputed == pytest.approx(-0.05512, abs=5e-6)
    assert not table["mean, wave equation, predicted"].agrees
    assert table["variance, wave equation, predicted"].recomputed == pytest.approx(statistics.variance(wave), rel=1e-9)
    spread = math.sqrt((statistics.variance(fem) + statistics.variance(wave)) / len(fem))
    expected = (statistics.fmean(fem) - statistics.fmean(wave)) / spread
    assert table["t Stat, predicted"].recomputed == pytest.approx(expected, rel=1e-9)


def test_the_articles_protocol_returns_what_it_is_fed(table) -> None:
    fed = table["mean, wave equation, fed (circular)"]
    assert fed.recomputed == pytest.approx(table["mean, FEA"].recomputed, rel=1e-9)
    assert fed.basis == RUN


def test_numbers_of_the_text(evidence) -> None:
    average, largest, smallest, error = text_items(evidence)
    assert [item.printed for item in (average, largest, smallest, error)] == [0.89, 0.956, 0.555, 0.089]
    assert smallest.recomputed < average.recomputed < largest.recomputed < 1.0
    assert average.recomputed == pytest.approx(0.89, abs=0.03)
    assert evidence.chain.r2.shape == (2 * 18 * 2,)
    fem, wave = (run.result.top_deflection[:-1] for run in (evidence.press.pair.fem, evidence.press.pair.wave))
    assert error.recomputed == pytest.approx(100.0 * np.abs(wave / fem - 1.0).mean(), rel=1e-9)
