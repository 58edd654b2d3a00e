"""Compute time over unknowns."""

import numpy as np
import pytest

from reports.figures import timing
from reports.figures.timing import growth


def test_median_and_repeats_are_told(texts):
    figure = timing({"fem": [3.0, 4.0, 8.0], "wave": [0.02]})
    assert {"4.00 s", "0.0200 s", "FEM", "Wave"} <= set(texts(figure.panels[0].svg))
    assert figure.panels[0].alt.startswith("FEM: median 4.00 s of 3 repeats, from 3.00 to 8.00 s.")


def test_the_axis_is_logarithmic_in_plain_numbers(texts, lines):
    svg = timing({"fem": [3.0], "wave": [0.02]}).panels[0].svg
    assert {"0.01", "0.1", "1", "10"} <= set(texts(svg))
    grid = sorted(line[0, 0] for line in lines(svg, "grid"))
    assert np.ptp(np.diff(grid)) < 0.05


def test_printed_times_have_rows_of_their_own(texts):
    figure = timing({"fem": [3.0]}, {"fem": 1.0}, {"article": 240.0})
    assert {"article", "240 s as printed"} <= set(texts(figure.panels[0].svg))
    assert "set-up" in figure.caption
    assert "other machines" in figure.caption


def test_another_model_keeps_its_name(texts):
    assert "my_model" in texts(timing({"my_model": [1.0]}).panels[0].svg)


@pytest.mark.parametrize(
    ("walls", "message"),
    [({}, "at least one model"), ({"fem": []}, "wall time of fem"), ({"fem": [1.0, 0.0]}, "all above 0 s")],
)
def test_times_that_are_none_are_refused(walls, message):
    with pytest.raises(ValueError, match=message):
        timing(walls)


def test_every_model_is_named_with_its_span() -> None:
    figure = growth({"fem": ([500, 1300], [12.0, 30.0]), "wave": ([3000, 900], [0.04, 0.03])})
    alt = figure.panels[0].alt
    assert "FEM: 12.0 to 30.0 ms a step from 500 to 1300 unknowns." in alt
    assert "wave model: 0.0300 to 0.0400 ms a step from 900 to 3000 unknowns." in alt


@pytest.mark.parametrize("runs", [{}, {"fem": ([0], [1.0])}, {"fem": ([10], [-1.0])}, {"fem": ([], [])}])
def test_what_has_no_place_on_logarithmic_axes_is_refused(runs: dict) -> None:
    with pytest.raises(ValueError, match=r"at least one|above zero"):
        growth(runs)
