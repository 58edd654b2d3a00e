"""Combinations of markers: what they keep of a pattern, and that each tells something of its own."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from benchmark.discovery.trials.marker_layout import grid, layout
from benchmark.files import Camera

RADII = np.array([0.0, 1.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0, 15.0, 17.0, 20.0]) * 1e-3
OUTWARD = CubicSpline(RADII, np.array([0.0, 22.0, 73.0, 144.0, 238.0, 334.0, 401.0, 431.0, 433.0, 416.0, 365.0]) * 1e-6)
SUNK = CubicSpline(
    RADII, np.array([2917.0, 2916.0, 2913.0, 2890.0, 2814.0, 2656.0, 2421.0, 2144.0, 1848.0, 1551.0, 1123.0]) * 1e-6
)
"""Lower face of a silicone sheet over a hole, pressed by 3 mm (finite elements), m."""


def markers(rows, columns):
    return grid(Camera(marker_rows=rows, marker_columns=columns, marker_spacing=6e-3))


def left(shapes, other):
    """Norm of a pattern (m, 2) and of what is left of it beside others, as far as shapes (k, 2 m) show them."""
    basis = np.linalg.svd(shapes, full_matrices=False)[2]
    pattern, *others = (basis @ each.ravel() for each in other)
    fitted = np.linalg.lstsq(np.array(others).T, pattern, rcond=None)[0]
    return np.linalg.norm(pattern - np.array(others).T @ fitted)


def moved_axis_beside_a_tilt(rest, axis):
    """How an axis beside the centre moves markers of a sheet over a hole, and how a tilted camera does."""
    step, radius = 1e-4, np.hypot(*rest.T)
    aside = step * np.eye(2)[axis]

    def moved(places):
        far = np.hypot(*places.T)
        return places / far[:, None] * OUTWARD(far)[:, None]

    tilts = [np.outer(SUNK(radius), each) for each in np.eye(2)]
    return (moved(rest - aside) - moved(rest + aside)) / (2.0 * step), *tilts


@pytest.mark.parametrize("axis", [0, 1])
def test_an_axis_beside_the_centre_is_told_from_a_tilted_camera_nearly_as_well_as_by_all_markers(axis):
    rest = markers(3, 6)
    found = layout(rest, 6e-3)
    shapes = found.weights.reshape(len(found.names), -1)
    patterns = moved_axis_beside_a_tilt(rest, axis)
    whole = left(np.eye(rest.size), patterns)
    assert left(shapes, patterns) > 0.7 * whole
    inner = [not name.startswith("outer") for name in found.names]
    assert left(shapes[inner], patterns) < 0.5 * whole


def test_each_weighted_combination_is_free_of_all_others():
    found = layout(markers(3, 6), 6e-3)
    shapes = found.weights.reshape(len(found.names), -1)
    sizes = np.linalg.norm(shapes, axis=1)
    for number, name in enumerate(found.names):
        if name.startswith("outer"):
            others = np.delete(np.arange(len(sizes)), number)
            assert (np.abs(shapes[others] @ shapes[number]) < 1e-12 * sizes[others] * sizes[number]).all()


@pytest.mark.parametrize(("rows", "columns", "told"), [(3, 6, 2), (5, 5, 2), (2, 3, 1), (2, 2, 0)])
def test_a_grid_of_too_few_radii_has_no_weighted_combination(rows, columns, told):
    found = layout(markers(rows, columns), 6e-3)
    assert sum(name.startswith("outer") for name in found.names) == told
    assert np.isfinite(found.weights).all()
