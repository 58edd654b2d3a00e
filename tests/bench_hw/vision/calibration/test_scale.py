"""The scale of the marker plane, from a board and from a ruler."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.calibration.fit import fit_similarity
from bench_hw.vision.calibration.scale import measure_plane, measure_ruler


@pytest.fixture
def save(tmp_path):
    def write(picture: np.ndarray):
        path = tmp_path / "plane.png"
        cv2.imwrite(str(path), picture)
        return path

    return write


def test_a_board_gives_the_scale_to_a_thousandth(boards, lens, board, true_camera, save):
    picture = boards.board(lens, boards.Pose((0, 0, 0.1), (3.0, -2.0, 90.0)), np.random.default_rng(0))
    found = measure_plane(save(picture), board, true_camera, 1e-3)
    assert found.scale == pytest.approx(90e-3 / 620, rel=2e-4)
    assert 0 < found.scale_std < 1e-3 * found.scale
    assert found.middle == pytest.approx((326 + 3 * 620 / 90, 233 - 2 * 618 / 90), abs=0.3)
    assert (found.kind, found.warnings) == ("board", ())


def test_a_tilted_board_is_warned_of_and_less_certain(boards, lens, board, true_camera, save):
    picture = boards.board(lens, boards.Pose((0.1, 0.0, 0.0), (0.0, 0.0, 90.0)), np.random.default_rng(0))
    found = measure_plane(save(picture), board, true_camera, 1e-3)
    assert "tilted by 5.7 degrees" in found.warnings[0]
    assert abs(found.scale / (90e-3 / 620) - 1) < 2 * found.scale_std / found.scale


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.2, 2.5])
@pytest.mark.parametrize("distance", [60.0, 90.0])
def test_a_ruler_gives_the_scale_to_a_thousandth(boards, lens, board, true_camera, turn, distance):
    picture = boards.ruler(lens, boards.Pose((0, 0, turn), (2.0, 1.0, distance)), np.random.default_rng(0))
    found = measure_ruler(picture, true_camera, 1e-3)
    assert found.scale == pytest.approx(distance * 1e-3 / 620, rel=5e-4)
    assert abs(found.scale / (distance * 1e-3 / 620) - 1) < 3 * found.scale_std / found.scale


def test_where_a_ruler_lies_is_told_in_pixels_that_are_not_square(boards, lens, true_camera):
    """A camera whose pixels are a tenth less high sees the ruler's middle in the same direction."""
    middles = []
    for height in (620.0, 560.0):
        camera = replace(true_camera, focal=(620.0, height))
        seen = replace(lens, focal=camera.focal)
        picture = boards.ruler(seen, boards.Pose((0, 0, 0.1), (2.0, 20.0, 90.0)), np.random.default_rng(0))
        middles.append(camera.to_normalised(np.array(measure_ruler(picture, camera, 1e-3).middle)))
    assert middles[0] == pytest.approx(middles[1], abs=2.0 / 620.0)


def test_the_ruler_is_found_where_there_is_no_board(boards, lens, board, true_camera, save):
    picture = boards.ruler(lens, boards.Pose((0, 0, 0.1), (2.0, 1.0, 90.0)), np.random.default_rng(0))
    found = measure_plane(save(picture), board, true_camera, 1e-3)
    assert found.kind == "ruler"
    half = measure_plane(save(picture), board, true_camera, 0.5e-3)
    assert half.scale == pytest.approx(found.scale / 2)


def test_markers_paper_and_another_size_are_no_plane(rendering, board, true_camera, save):
    random = np.random.default_rng(0)
    markers = rendering.Renderer(rendering.Scene(), rendering.sheet(random), random).frame()
    for picture in (markers, np.full((480, 640), 200, np.uint8)):
        with pytest.raises(InputError, match=r"neither a board with 9x6 inner corners .* nor a ruler"):
            measure_plane(save(picture), board, true_camera, 1e-3)
    with pytest.raises(InputError, match="640 x 400 pixels; allowed: 640 x 480"):
        measure_plane(save(markers[:400]), board, true_camera, 1e-3)


def test_a_similarity_is_found_again_also_mirrored():
    random = np.random.default_rng(0)
    points = random.normal(size=(40, 2))
    turn = np.array([[np.cos(0.4), -np.sin(0.4)], [np.sin(0.4), np.cos(0.4)]])
    for mirrored in (False, True):
        flipped = points * [1, -1] if mirrored else points
        fit = fit_similarity(points, 3.0 * flipped @ turn.T + [5, 6])
        assert fit.scale == pytest.approx(3.0)
        assert fit.mirrored == mirrored
        assert np.abs(fit.residuals).max() < 1e-12
    scales = [fit_similarity(points, 3.0 * points + random.normal(0, 0.1, points.shape)) for _ in range(200)]
    assert np.std([fit.scale for fit in scales]) == pytest.approx(np.mean([fit.scale_std for fit in scales]), rel=0.2)
