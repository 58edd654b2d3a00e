import numpy as np
import pytest

from reports.figures.marker_circle import Ring, marker_circle

PLACES = np.stack(np.meshgrid(np.arange(6.0) * 8, np.arange(3.0) * 8), axis=-1).reshape(-1, 2)
REST, LARGEST = Ring("at rest", 8.0, 8.0, 9.24), Ring("at its largest", 8.0, 8.0, 9.62)


def test_circles_and_markers_are_named() -> None:
    figure = marker_circle("press_01", PLACES, range(9), 4, REST, LARGEST)
    assert "18 markers of press_01" in figure.caption
    assert "9.240 mm at rest and 9.620 mm at its largest" in figure.caption
    for label in ("other markers", "markers of the circle", "at its largest"):
        assert label in figure.panels[0].svg


def test_a_marker_that_was_not_seen_is_left_out() -> None:
    places = PLACES.copy()
    places[3] = np.nan
    assert marker_circle("press_01", places, range(9), 4, REST, LARGEST).panels


def test_another_shape_is_refused() -> None:
    with pytest.raises(ValueError, match="places_mm"):
        marker_circle("press_01", PLACES.T[:, None], range(9), 4, REST, LARGEST)
