"""The article's chain, with the trouble the article reports."""

import numpy as np

from bench_hw.vision.camera import to_plane
from bench_hw.vision.markers import detect_grid
from bench_hw.vision.tracking.methods import PaperTracker, average_overlapping, find_circles


def test_overlapping_circles_are_averaged_strongest_first():
    circles = np.array([[10.0, 10, 5], [30, 30, 6], [12, 10, 7], [30, 34, 6]])
    merged, counts = average_overlapping(circles, reach=5.0)
    assert np.allclose(merged[:-1], [[11, 10, 6], [30, 32, 6]])
    assert counts.tolist() == [2, 2, 1]
    assert np.isnan(average_overlapping(np.zeros((0, 3)), 5.0)[0]).all()


def test_several_circles_are_found_at_each_marker_and_the_average_is_off_by_most_of_a_pixel(
    rendering, scene, camera_of
):
    random = np.random.default_rng(3)
    renderer = rendering.Renderer(scene, rendering.sheet(random, out_of_round=0.12), random)
    grey, camera = renderer.frame(), camera_of(scene)
    grid = detect_grid(grey)
    tracker = PaperTracker(grey, grid, camera)
    assert len(find_circles(tracker.binary(grey), grid.radius)) > 2.5 * 18
    sighting = tracker.step(grey)
    assert sighting.seen.all()
    error = np.hypot(*(to_plane(camera, sighting.points) * 1e3 - renderer.sheet.truth()).T) / scene.mm_per_px
    assert 0.2 < np.sqrt((error**2).mean()) < 3.0
    assert sighting.confidence.max() <= 1.0
    assert np.median(sighting.confidence) <= 0.5


def test_a_black_picture_has_no_circles(rendering, scene, camera_of):
    random = np.random.default_rng(3)
    renderer = rendering.Renderer(scene, rendering.sheet(random), random)
    grey = renderer.frame()
    tracker = PaperTracker(grey, detect_grid(grey), camera_of(scene))
    assert not tracker.step(np.zeros_like(grey)).seen.any()
    assert tracker.step(grey).seen.all()
