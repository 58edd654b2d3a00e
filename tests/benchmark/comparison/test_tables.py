import numpy as np
import pytest

from benchmark.comparison import compare_layer, normal_fit_columns, statistics_columns

TESTS = {"t_pooled", "t_welch", "paired", "tost", "bland_altman", "concordance"}


@pytest.fixture
def layers(triangle):
    return [compare_layer("dermis", 1e-3 * triangle, 1.01e-3 * triangle), compare_layer("fat", triangle, triangle)]


def test_statistics_has_its_columns_and_every_test_of_every_layer(layers):
    columns = statistics_columns(layers)
    assert list(columns) == ["layer", "test", "quantity", "fem", "wave", "value"]
    assert len({len(column) for column in columns.values()}) == 1
    for layer in ("dermis", "fat"):
        found = {test for name, test in zip(columns["layer"], columns["test"], strict=True) if name == layer}
        assert found >= TESTS


def test_no_cell_is_nan(layers):
    cells = [cell for column in statistics_columns(layers).values() for cell in column]
    assert not any(isinstance(cell, float) and not np.isfinite(cell) for cell in cells)


def test_each_row_has_one_kind_of_value(layers):
    columns = statistics_columns(layers)
    for fem, wave, value in zip(columns["fem"], columns["wave"], columns["value"], strict=True):
        assert (fem is None) == (wave is None)
        assert fem is None or value is None


def test_normal_fits_in_millimetres(layers, triangle):
    columns = normal_fit_columns(layers)
    assert list(columns) == ["layer", "model", "mean_mm", "std_mm", "n", "anderson_darling", "p_value"]
    assert columns["layer"] == ["dermis", "dermis", "fat", "fat"]
    assert columns["model"] == ["fem", "wave"] * 2
    assert columns["mean_mm"][:2] == [pytest.approx(triangle.mean()), pytest.approx(1.01 * triangle.mean())]


def test_a_layer_without_wave_has_only_the_fem_fit(triangle):
    uncovered = compare_layer("fat", triangle, np.full(100, np.nan))
    assert normal_fit_columns([uncovered])["model"] == ["fem"]
    assert statistics_columns([uncovered])["layer"] == []
