"""All measures of a layer, its table columns, and what may be said of a test."""

import json
import re

import numpy as np
import pytest

from benchmark.comparison import (
    ComparisonError,
    compare_layer,
    comparison_summary,
    describe_equivalence,
    describe_t_test,
    history_equivalence,
    normal_fit_columns,
    paired_equivalence,
    passing_scale_errors,
    plain_percent,
    pooled_t_test,
    statistics_columns,
)


def test_table_2_in_millimetres_from_metres(triangle):
    layer = compare_layer("dermis", 1e-3 * triangle, 1e-3 * triangle, load=triangle)
    rows = {row[0]: row for row in layer.tests()["t_pooled"]}
    assert rows["mean"][1] == pytest.approx(0.05508)
    assert rows["variance"][2] == pytest.approx(0.0010223, abs=5e-9)
    assert rows["observations"][1:3] == (100, 100)


def test_summary_has_the_keys_of_the_results_file(triangle):
    layer = compare_layer("fat", 1e-3 * triangle, 1.1e-3 * triangle, load=triangle)
    summary = comparison_summary([layer])["fat"]
    assert list(summary) == [
        "percent_error_mean",
        "percent_error_max",
        "t_statistic",
        "p_value",
        "t_critical",
        "tost_p",
        "equivalent",
        "within_margin",
    ]
    assert summary["percent_error_mean"] == pytest.approx(10.0)
    assert summary["p_value"] > 0.05
    assert summary["equivalent"] is False
    json.dumps(summary, allow_nan=False)


def test_margin_is_passed_on(triangle):
    near = compare_layer("fat", triangle, 1.01 * triangle, margin_fraction=0.02)
    strict = compare_layer("fat", triangle, 1.01 * triangle, margin_fraction=0.005)
    assert near.summary()["equivalent"] is True
    assert strict.summary()["equivalent"] is False


def test_a_wave_that_does_not_cover_the_layer_leaves_empty_values(triangle):
    layer = compare_layer("fat", triangle, np.full(100, np.nan), load=triangle)
    assert layer.tests() == {}
    assert layer.wave_fit is None
    assert layer.fem_fit is not None
    assert set(layer.summary().values()) == {None}
    assert "nothing to compare" in layer.note


def test_steps_that_only_one_model_reached_are_left_out_of_the_tests(triangle):
    wave = np.where(np.arange(100) < 50, triangle, np.nan)
    layer = compare_layer("fat", triangle, wave)
    assert layer.statistics is not None
    assert layer.statistics.pooled.fem.observations == 50
    assert layer.statistics.overlap == 1.0  # of the common steps, though the whole fits differ
    assert layer.fem_fit is not None
    assert layer.fem_fit.n == 100


def test_identical_models_are_comparable(triangle):
    layer = compare_layer("fat", triangle, triangle)
    assert layer.summary()["equivalent"] is True
    assert json.loads(json.dumps(layer.to_dict(), allow_nan=False))["statistics"]["paired"]["t"] is None


def test_unusable_margins_are_refused(triangle):
    with pytest.raises(ComparisonError, match="margin"):
        compare_layer("fat", triangle, triangle, margin_fraction=0.0)


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


CLAIMS = re.compile(r"agree|similar|equivalen|the same|match|consistent|valid", re.IGNORECASE)


@pytest.mark.parametrize("factor", [1.0, 1.1, 1.5])
def test_a_t_test_is_never_called_agreement(triangle, factor):
    text = describe_t_test(pooled_t_test(triangle, factor * triangle), passing_scale_errors(triangle))
    assert not CLAIMS.search(text)
    assert "-15.0 % to +17.7 %" in text
    assert ("does not reject" in text) == (factor < 1.177)


def test_a_t_test_without_outcome_says_why():
    constant = np.ones(5)
    assert "not defined" in describe_t_test(pooled_t_test(constant, constant), passing_scale_errors(constant))


def test_a_test_that_passes_everything_says_so():
    sample = np.array([0.0, 1.0, 0.0])
    assert "any size" in describe_t_test(pooled_t_test(sample, 2 * sample), passing_scale_errors(sample))


def test_equivalence_names_its_margin(triangle):
    shown = describe_equivalence(paired_equivalence(triangle, 1.001 * triangle))
    not_shown = describe_equivalence(paired_equivalence(triangle, 1.1 * triangle))
    assert shown.startswith("Equivalent within 2 % of the FEM's mean")
    assert not_shown.startswith("Equivalence within 2 % of the FEM's mean is not shown")
    assert "+9.04 to +11 % of it" in not_shown


def test_a_percent_keeps_plain_digits():
    found = [plain_percent(value, sign=True) for value in (-200.0, 1234.0, 0.0123, -15.0)]
    assert found == ["-200 %", "+1200 %", "+0.012 %", "-15 %"]


def test_what_an_equivalence_over_a_history_says_does_not_lean_on_its_p(triangle):
    text = describe_equivalence(history_equivalence(triangle, -triangle))
    assert text.startswith(
        "Equivalence within 2 % of the FEM's mean is not shown: over the load the difference is -200 %"
    )
    assert "for independent samples" in text


def test_models_within_the_margin_are_equivalent_though_few_rows_leave_the_test_open():
    fem = np.arange(1, 9) / 8.0
    found = history_equivalence(fem, 1.017 * fem)
    told = {row[0]: row[-1] for row in found.rows()}
    assert not found.equivalent
    assert (told["equivalent"], told["within margin"]) == (0.0, 1.0)
    assert describe_equivalence(found).startswith("Equivalent within 2 % of the FEM's mean: over the load")
    summary = comparison_summary([compare_layer("skin", fem, 1.017 * fem)])["skin"]
    assert (summary["equivalent"], summary["within_margin"]) == (False, True)
