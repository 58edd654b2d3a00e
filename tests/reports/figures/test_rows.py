import numpy as np
import pytest

from reports.figures import ParameterRow, ShareRow, fitted_parameters, shares

MODULUS = ParameterRow("youngs_modulus", 45.2, "kPa", 44.1, 46.3)


def test_values_and_intervals_are_written(texts):
    found = texts(fitted_parameters([MODULUS]).panels[0].svg)
    assert {"youngs_modulus", "45.2 [44.1, 46.3] kPa", "value (kPa)"} <= set(found)


def test_the_interval_lies_around_the_dot(lines):
    svg = fitted_parameters([MODULUS]).panels[0].svg
    bars = [line for line in lines(svg, "fem") if len(line) == 2 and line[0, 1] == line[1, 1]]
    assert len(bars) == 1
    assert np.ptp(bars[0][:, 0]) > 50


def test_each_unit_has_an_axis_of_its_own(texts):
    found = texts(fitted_parameters([MODULUS, ParameterRow("onset", 0.1, "mm"), ParameterRow("g", 0.3)]).panels[0].svg)
    assert {"value (kPa)", "value (mm)", "value (without unit)"} <= set(found)


def test_what_is_not_identifiable_is_said(texts):
    figure = fitted_parameters([ParameterRow("e_2", 310.0, "kPa", identifiable=False)])
    assert "not identifiable" in texts(figure.panels[0].svg)
    assert "does not identify" in figure.caption


def test_what_is_not_identifiable_is_drawn_without_an_interval(texts):
    row = ParameterRow("e_2", 62.3, "kPa", 61.3, 63.3, identifiable=False)
    found = texts(fitted_parameters([row]).panels[0].svg)
    assert "62.3 kPa" in found
    assert not any("61.3" in text for text in found)


@pytest.mark.parametrize("ends", [(None, None), (1.0, None), (float("nan"), 2.0), (-np.inf, np.inf)])
def test_half_an_interval_is_none(ends):
    assert ParameterRow("a", 1.5, "", *ends).interval is None


def test_a_wide_span_of_positive_values_is_logarithmic(texts):
    wide = fitted_parameters([ParameterRow("a", 1.0, "kPa"), ParameterRow("b", 1000.0, "kPa")])
    assert "500" not in texts(wide.panels[0].svg)


def test_no_parameter_is_refused():
    with pytest.raises(ValueError, match="parameters is empty"):
        fitted_parameters([])


def test_a_share_shows_its_interval_and_its_bar(texts, lines):
    rows = [ShareRow("named first", 0.75, 0.5, 0.9, 12, 0.9, False), ShareRow("in the set", 1.0, 0.8, 1.0, 12)]
    figure = shares(rows, "Each share.", "Shares")
    assert {"named first", "75 % of 12", "100 % of 12", "cases (%)"} <= set(texts(figure.panels[0].svg))
    assert sum(len(line) == 2 and np.ptp(line[:, 1]) == 0 for line in lines(figure.panels[0].svg, "failed")) == 1
    assert any(np.ptp(line[:, 0]) == 0 and np.ptp(line[:, 1]) > 10 for line in lines(figure.panels[0].svg, "ink"))
    with pytest.raises(ValueError, match="at least one share"):
        shares([], "", "")
