import json

import numpy as np
import pytest

from benchmark.comparison import ComparisonError, compare_layer, comparison_summary


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
