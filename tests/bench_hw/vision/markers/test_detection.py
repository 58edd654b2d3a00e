"""Points to rows and columns."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.markers import GridError, Layout, detect_grid
from bench_hw.vision.markers.detection import arrange, neighbour_distance


def grid(rows: int, columns: int, spacing: float = 50.0) -> np.ndarray:
    y, x = np.mgrid[:rows, :columns]
    return np.stack([x.ravel(), y.ravel()], axis=1) * spacing


@given(
    st.integers(2, 5),
    st.integers(2, 7),
    st.floats(-0.6, 0.6),
    st.integers(0, 2**32 - 1),
)
def test_a_turned_shaken_shuffled_grid_is_put_in_order(rows, columns, turn, seed):
    random = np.random.default_rng(seed)
    turned = grid(rows, columns) @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    order = random.permutation(rows * columns)
    index = arrange((turned + random.uniform(-4, 4, turned.shape))[order])
    assert np.array_equal(index[np.argsort(order)], np.stack(np.divmod(np.arange(rows * columns), columns), axis=1))


def test_a_bent_grid_is_followed_from_neighbour_to_neighbour():
    points = grid(5, 9)
    middle = points.mean(axis=0)
    bent = middle + (points - middle) * (1 + 4e-6 * ((points - middle) ** 2).sum(axis=1, keepdims=True))
    bent[:, 1] += 1e-3 * (bent[:, 0] - middle[0]) ** 2
    assert np.array_equal(arrange(bent), np.stack(np.divmod(np.arange(45), 9), axis=1))


def test_strays_stay_outside_and_holes_stay_holes():
    points = grid(3, 6)
    index = arrange(np.vstack([points, [[-120.0, 75.0], [125.0, 25.0]]]))
    assert (index[-2:] == -1).all()
    assert len({tuple(place) for place in index[:-2].tolist()}) == 18
    kept = np.delete(np.arange(18), 8)
    assert np.array_equal(arrange(points[kept]), np.stack(np.divmod(kept, 6), axis=1))


def test_too_few_points_are_no_grid():
    assert arrange(np.zeros((0, 2))).shape == (0, 2)
    assert arrange(np.zeros((1, 2))).tolist() == [[-1, -1]]
    assert neighbour_distance(np.zeros((1, 2))) == np.inf
    assert neighbour_distance(grid(3, 6)) == pytest.approx(50.0)


def picture(rendering, seed: int = 3, noise: float = 4.0, keep=None, extra=None, **sheet):
    random = np.random.default_rng(seed)
    made = rendering.sheet(random, **sheet)
    middles, outlines = made.middles, made.outlines
    if keep is not None:
        middles, outlines = middles[keep], outlines[keep]
    if extra is not None:
        middles, outlines = np.vstack([middles, extra]), np.vstack([outlines, outlines[:1]])
    scene = rendering.Scene(noise=noise)
    renderer = rendering.Renderer(scene, rendering.Sheet(middles, outlines), random)
    return renderer.frame(), scene.project(renderer.sheet.truth())


@pytest.mark.parametrize("noise", [0.0, 8.0])
@pytest.mark.parametrize(
    "sheet",
    [
        {},
        {"radius": 0.6, "spacing": 5.0},
        {"radius": 2.8},
        {"turn": 0.3, "out_of_round": 0.12},
        {"rows": 6, "columns": 3, "spacing": 7.0},
    ],
)
def test_all_markers_are_found_in_their_order_and_nothing_else(rendering, noise, sheet):
    grey, truth = picture(rendering, noise=noise, **sheet)
    grid = detect_grid(grey)
    assert (grid.layout.rows, grid.layout.columns) == (sheet.get("rows", 3), sheet.get("columns", 6))
    assert np.hypot(*(grid.centres - truth).T).max() < 0.5
    assert grid.strays == 0
    assert grid.radius == pytest.approx(sheet.get("radius", 1.2) * 582 / 70, rel=0.15)
    assert grid.spacing == pytest.approx(sheet.get("spacing", 8.5) * 582 / 70, rel=0.02)


def test_another_grid_is_found_if_it_is_asked_for(rendering):
    grey, truth = picture(rendering, rows=4, columns=5)
    assert np.hypot(*(detect_grid(grey, Layout(4, 5)).centres - truth).T).max() < 0.5
    with pytest.raises(GridError, match="20 markers in 4 rows and 5 columns; allowed: the 18 markers"):
        detect_grid(grey)
    with pytest.raises(GridError, match=r"20 markers.*allowed: 20 markers, 5 x 4"):
        detect_grid(grey, Layout(5, 4))


def test_seventeen_markers_are_refused_and_the_hole_is_named(rendering):
    grey, _ = picture(rendering, keep=np.arange(18) != 7)
    with pytest.raises(GridError, match="17 markers in 3 rows and 6 columns, none at row and column 2, 2"):
        detect_grid(grey)


def test_nineteen_markers_are_refused_unless_one_lies_beside_the_grid(rendering):
    grey, _ = picture(rendering, extra=[[21.25 + 8.5, 8.5]])
    with pytest.raises(GridError, match="19 markers"):
        detect_grid(grey)
    grey, truth = picture(rendering, extra=[[21.25 + 8.0, 15.0]])
    grid = detect_grid(grey)
    assert grid.strays == 1
    assert np.hypot(*(grid.centres - truth[:18]).T).max() < 0.5


@pytest.mark.parametrize("level", [0, 128, 255])
def test_a_picture_without_contrast_has_no_markers(level):
    with pytest.raises(GridError, match="no markers: the contrast is 0 grey levels"):
        detect_grid(np.full((480, 640), level, np.uint8))


def test_noise_is_no_grid():
    noise = np.random.default_rng(0).normal(128, 40, (480, 640)).clip(0, 255).astype(np.uint8)
    with pytest.raises(GridError, match="allowed"):
        detect_grid(noise)


def test_markers_where_the_distortion_has_no_inverse_are_said(rendering):
    grey, _ = picture(rendering)

    def straight(pixels):
        return np.where(pixels[:, :1] > 450, np.nan, pixels)

    with pytest.raises(GridError, match="3 spots where the camera's distortion has no inverse"):
        detect_grid(grey, straight=straight)
