"""The grid in a picture nobody knows anything about."""

import numpy as np
import pytest

from bench_hw.vision.markers import GridError, Layout, detect_grid


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
