"""Compute time over unknowns."""

import pytest

from reports.figures.growth import growth


def test_every_model_is_named_with_its_span() -> None:
    figure = growth({"fem": ([500, 1300], [12.0, 30.0]), "wave": ([3000, 900], [0.04, 0.03])})
    alt = figure.panels[0].alt
    assert "FEM: 12.0 to 30.0 ms a step from 500 to 1300 unknowns." in alt
    assert "wave model: 0.0300 to 0.0400 ms a step from 900 to 3000 unknowns." in alt


@pytest.mark.parametrize("runs", [{}, {"fem": ([0], [1.0])}, {"fem": ([10], [-1.0])}, {"fem": ([], [])}])
def test_what_has_no_place_on_logarithmic_axes_is_refused(runs: dict) -> None:
    with pytest.raises(ValueError, match=r"at least one|above zero"):
        growth(runs)
