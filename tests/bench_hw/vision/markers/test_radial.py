"""Markers measured where they are about."""

import cv2
import numpy as np
import pytest

from bench_hw.vision.camera import to_plane
from bench_hw.vision.markers import MarkerEdges, detect_grid
from bench_hw.vision.markers.radial import confidence_left

EVERYONE = np.arange(18)


@pytest.fixture
def set_up(rendering, scene, camera_of):
    """A sheet, its renderer, its camera and what measures it."""
    random = np.random.default_rng(5)
    renderer = rendering.Renderer(scene, rendering.sheet(random), random)
    grey, camera = renderer.frame(), camera_of(scene)
    grid = detect_grid(grey)
    return renderer, camera, grid, MarkerEdges(grey, grid, camera)


def errors(sighting, camera, renderer, moved=None) -> np.ndarray:
    """Distance from the truth in undistorted pixels."""
    return (
        np.hypot(*(to_plane(camera, sighting.points) * 1e3 - renderer.sheet.truth(moved)).T) / renderer.scene.mm_per_px
    )


def test_the_truth_is_found_to_two_hundredths_of_a_pixel(set_up):
    renderer, camera, grid, edges = set_up
    sighting = edges.look(renderer.frame(), grid.centres, EVERYONE)
    assert sighting.seen.all()
    assert np.sqrt((errors(sighting, camera, renderer) ** 2).mean()) < 0.02
    assert sighting.confidence.min() > 0.9
    assert sighting.radius == pytest.approx(1.2 / renderer.scene.mm_per_px, rel=0.08)


def test_the_error_that_is_stated_is_the_error(set_up):
    renderer, camera, grid, edges = set_up
    ratios = []
    for _ in range(12):
        sighting = edges.look(renderer.frame(), grid.centres, EVERYONE)
        ratios.append(errors(sighting, camera, renderer) ** 2 / (2.0 * sighting.error**2))
    assert 0.8 < np.sqrt(np.mean(ratios)) < 1.25  # nothing in the statement was fitted to errors


@pytest.mark.parametrize("off", [0.5, 1.5, 3.0, 4.0])
def test_where_it_begins_makes_no_difference(set_up, off):
    renderer, camera, grid, edges = set_up
    clean = renderer.noisy(renderer.clean(), 0.0)
    sighting = edges.look(clean, grid.centres + off * np.array([0.6, -0.8]), EVERYONE)
    assert sighting.seen.all()
    assert errors(sighting, camera, renderer).max() < 0.015


def test_a_part_of_the_markers_can_be_asked_for(set_up):
    renderer, _, grid, edges = set_up
    grey = renderer.frame()
    whole = edges.look(grey, grid.centres, EVERYONE)
    part = edges.look(grey, grid.centres[[3, 11]], np.array([3, 11]))
    assert np.abs(part.pixels - whole.pixels[[3, 11]]).max() < 0.01


@pytest.mark.parametrize("level", [30, 100, 150, 205])
def test_a_marker_half_covered_is_not_seen_and_a_grazed_one_is_right_or_not_seen(set_up, level):
    renderer, camera, grid, edges = set_up
    grey = renderer.frame()
    x, y = grid.centres[8]
    half, grazed = grey.copy(), grey.copy()
    half[:, round(x) : round(x) + 40] = level
    assert not edges.look(half, grid.centres, EVERYONE).seen[8]
    grazed[round(y) + 9 : round(y) + 30, round(x) - 30 : round(x) + 30] = level
    error = errors(edges.look(grazed, grid.centres, EVERYONE), camera, renderer)[8]
    assert np.isnan(error) or error < 0.15


def test_a_shadow_does_not_shift_a_marker(set_up):
    renderer, camera, grid, edges = set_up
    for _ in range(5):
        edges.look(renderer.frame(), grid.centres, EVERYONE)
    shade = 1.0 - 0.3 / (1.0 + np.exp((np.arange(640) - grid.centres[8, 0]) / 15.0))
    shaded = renderer.noisy(renderer.clean() * shade.astype(np.float32))
    error = errors(edges.look(shaded, grid.centres, EVERYONE), camera, renderer)
    assert not error[8] > 0.06


def test_light_of_a_shadow_that_has_gone_is_soon_forgotten(set_up):
    renderer, camera, grid, edges = set_up
    clean, off = renderer.clean(), []
    for _ in range(20):
        edges.look(renderer.noisy(clean), grid.centres, EVERYONE)
    for place in (-40.0, -20.0, 0.0, 20.0, 40.0, *([1000.0] * 5)):  # of its edge, from the ninth marker
        shade = 0.55 + 0.45 / (1.0 + np.exp(-(np.arange(640) - grid.centres[8, 0] - place) / 12.0))
        sighting = edges.look(renderer.noisy(clean * shade.astype(np.float32)), grid.centres, EVERYONE)
        off.append(errors(sighting, camera, renderer)[8])
    assert max(off[-5:]) < 0.04
    assert np.mean(off[-5:]) < 0.03


@pytest.mark.parametrize(("level", "width", "away"), [(50.0, 12.0, 14.0), (110.0, 22.0, 22.0), (220.0, 40.0, 40.0)])
def test_beside_a_soft_reflection_a_marker_is_where_it_is_and_its_doubt_is_stated(set_up, level, width, away):
    renderer, camera, grid, edges = set_up
    for _ in range(5):
        edges.look(renderer.frame(), grid.centres, EVERYONE)
    y, x = np.mgrid[0:480, 0:640]
    square = (x - grid.centres[8, 0] - away) ** 2 + (y - grid.centres[8, 1]) ** 2
    lit = np.minimum(renderer.clean() + level * np.exp(-0.5 * square / width**2).astype(np.float32), 255.0)
    sighting = edges.look(renderer.noisy(lit), grid.centres, EVERYONE)
    error = errors(sighting, camera, renderer)[8]
    assert error < 0.15  # taken by the middle level it is 0.2 to 0.6 px
    assert error < 4.0 * sighting.error[8]
    assert sighting.confidence[8] < 0.8
    assert sighting.confidence[0] > 0.9


def test_a_part_cut_off_in_the_colour_of_the_paper_is_told(set_up):
    renderer, camera, grid, edges = set_up
    for _ in range(5):
        edges.look(renderer.frame(), grid.centres, EVERYONE)
    left, top = np.round(grid.centres[8]).astype(int) - (20, -12)
    for moved in range(5):  # the cover creeps on
        clean = renderer.clean()
        clean[top - round(0.7 * moved) : top + 30, left : left + 40] = 205.0
        grey = renderer.noisy(cv2.GaussianBlur(clean, (0, 0), 0.8))
        sighting = edges.look(grey, grid.centres[[8]], EVERYONE[[8]], searched=True)
        off = np.hypot(*(to_plane(camera, sighting.points) * 1e3 - renderer.sheet.truth()[[8]])[0])
        off /= renderer.scene.mm_per_px
        assert np.isnan(off) or off < 0.15 or off < 4.0 * sighting.error[0]  # was 0.77 px at 0.010, confidence 0.995
        assert off < 0.15 or not sighting.confidence[0] > 0.8


def test_paper_that_is_white_to_the_last_does_not_make_an_error_of_nothing(set_up):
    renderer, camera, grid, _ = set_up
    white = [renderer.noisy(1.6 * renderer.clean()) for _ in range(8)]
    edges = MarkerEdges(white[0], grid, camera)
    sightings = [edges.look(grey, grid.centres, EVERYONE) for grey in white]
    ratios = [errors(each, camera, renderer) ** 2 / (2.0 * each.error**2) for each in sightings]
    assert np.sqrt(np.nanmean(ratios)) < 2.5  # the light is uneven, and its tilt unseen; it was beyond 100


def test_markers_at_the_border_and_outside_are_not_seen(set_up, rendering):
    renderer, _, grid, edges = set_up
    grey = renderer.frame()
    starts = grid.centres.copy()
    starts[0], starts[1], starts[2] = (-50.0, 100.0), (3.0, 3.0), (700.0, 500.0)
    sighting = edges.look(grey, starts, EVERYONE)
    assert sighting.seen.tolist() == [False] * 3 + [True] * 15
    assert np.isnan(sighting.points[:3]).all()
    assert np.isnan(sighting.radius[:3]).all()


def test_sightings_can_be_hidden_and_joined(set_up):
    renderer, _, grid, edges = set_up
    sighting = edges.look(renderer.frame(), grid.centres, EVERYONE)
    hidden = sighting.kept(EVERYONE != 4)
    assert hidden.seen.sum() == 17
    assert np.isnan(hidden.points[4]).all()
    again = edges.look(renderer.frame(), grid.centres[[4]], np.array([4]))
    assert hidden.merged(again, np.array([4])).seen.all()
    assert not hidden.seen[4]


def test_what_may_be_off_by_more_than_a_twentieth_of_the_radius_is_not_seen():
    left = confidence_left(np.array([0.0, 0.3, 0.5, 0.51]), np.full(4, 10.0))
    np.testing.assert_allclose(left, [1.0, np.exp(-1.0), np.exp(-5 / 3), 0.0])
