"""How wrong a map is: the estimate from held-out views against the truth."""

import numpy as np
import pytest

from bench_hw.vision.calibration.fit import all_pixels, covered_pixels, fit_camera, held_out_map_error, map_difference
from bench_hw.vision.camera import Camera


@pytest.fixture(scope="module")
def fitted(boards, seen_corners, board, lens):
    """Fit some views: the fit, the estimated error of its map, and the pixels the views cover."""

    def fit(seed: int, count: int = 24, free_k3: bool = False, tilt: float = 0.5):
        poses = boards.poses(np.random.default_rng(seed), count, tilt=tilt)
        corners = seen_corners(poses, seed)
        result = fit_camera(corners, board, lens.size, free_k3)
        covered = covered_pixels(corners, lens.size)
        return result, held_out_map_error(corners, board, result.camera, free_k3), covered

    return fit


@pytest.fixture(scope="module")
def everywhere(lens):
    return all_pixels(lens.size)


def test_the_same_map_turned_shifted_and_scaled_is_no_difference(true_camera, everywhere):
    other = Camera(true_camera.size, true_camera.focal, true_camera.centre, true_camera.distortion)
    assert map_difference(true_camera, other, everywhere) < 1e-9
    plain, longer = (Camera((640, 480), (f, f), (c, 240.0), (0.0,) * 5) for f, c in ((600.0, 320.0), (660.0, 300.0)))
    assert map_difference(plain, longer, everywhere) < 1e-9
    bent = Camera(true_camera.size, true_camera.focal, true_camera.centre, (0.08, *true_camera.distortion[1:]))
    assert map_difference(true_camera, bent, everywhere) > 0.1


def test_twenty_four_views_with_k3_fixed_meet_the_bar_and_the_estimate_is_honest(fitted, true_camera):
    ratios = []
    for seed in range(6):
        fit, estimate, covered = fitted(seed)
        truth = map_difference(fit.camera, true_camera, covered)
        assert truth <= 0.05
        assert estimate.total <= 0.05
        ratios.append(estimate.total / truth)
    assert 0.5 < np.median(ratios) < 2.0


def test_ten_views_with_k3_free_have_the_same_reprojection_error_and_a_worse_map(fitted, true_camera, everywhere):
    few = [fitted(seed, 10, free_k3=True, tilt=0.25) for seed in range(4)]
    many = [fitted(seed) for seed in range(4)]
    reprojection = [np.median([fit.reprojection_rms for fit, _, _ in fits]) for fits in (few, many)]
    assert reprojection[0] == pytest.approx(reprojection[1], rel=0.1)
    truth = [
        np.median([map_difference(fit.camera, true_camera, everywhere) for fit, _, _ in fits]) for fits in (few, many)
    ]
    estimate = [np.median([estimate.everywhere for _, estimate, _ in fits]) for fits in (few, many)]
    assert truth[0] > 3 * truth[1]
    assert estimate[0] > 3 * estimate[1]


def test_what_the_model_cannot_do_shows_as_misfit(boards, lens, board, seen_corners):
    """Corners bent by a wave that no lens makes: chance stays small, the residuals of held-out views last."""
    corners = seen_corners(boards.poses(np.random.default_rng(0), 24))
    bent = [view + 0.5 * np.sin(view[:, ::-1] / 60) for view in corners]
    for views, low, high in ((corners, 0.0, 0.02), (bent, 0.1, 0.6)):
        fit = fit_camera(views, board, lens.size)
        assert low <= held_out_map_error(views, board, fit.camera).misfit < high


def test_deviations_are_of_the_size_of_the_errors(fitted, true_camera):
    errors, deviations = [], []
    for seed in range(6):
        fit, _, _ = fitted(seed)
        values = np.array([*fit.camera.focal, *fit.camera.centre, *fit.camera.distortion])
        truth = np.array([*true_camera.focal, *true_camera.centre, *true_camera.distortion])
        errors.append(values - truth)
        deviations.append(fit.deviations)
    ratio = np.sqrt(np.mean(np.square(errors), axis=0))[:8] / np.mean(deviations, axis=0)[:8]
    assert np.all((ratio > 0.3) & (ratio < 3.0))
    assert np.all(np.array(deviations)[:, 8] == 0.0)
