import numpy as np
import pytest

from reports.figures.markers import Ring, circle_radius, marker_circle, marker_motion

TIME = np.linspace(0.0, 4.0, 50)
MOVED = np.sin(TIME)[:, None, None] * np.linspace(-0.3, 0.3, 6)[:, None] * np.array([1.0, 0.5])


def test_motion_has_a_panel_an_axis_and_says_how_far() -> None:
    figure = marker_motion("press_01", TIME, MOVED)
    assert [panel.title for panel in figure.panels] == ["along x", "along y"]
    assert "0.3" in figure.panels[0].alt
    assert "6 markers of press_01" in figure.caption


def test_motion_of_another_shape_is_refused() -> None:
    with pytest.raises(ValueError, match="moved_mm"):
        marker_motion("a", TIME, MOVED[:, :, 0])


def test_the_circle_grows_over_its_resting_radius() -> None:
    nine = np.r_[np.nan, 9.2 + 0.1 * np.sin(TIME[1:]) ** 2]
    figure = circle_radius("press_01", TIME, nine, nine + 0.6, depth_mm=TIME)
    assert "all nine grow by 0.099" in figure.panels[0].alt
    assert "below, the depth" in figure.caption


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
