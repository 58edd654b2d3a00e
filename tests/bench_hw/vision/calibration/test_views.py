"""Views that cannot determine a camera."""

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.calibration.board import BoardView
from bench_hw.vision.calibration.fit import CameraFit, MapError, fit_camera
from bench_hw.vision.calibration.views import (
    check_fit,
    check_map,
    check_number,
    check_variety,
    coverage_warnings,
    explain,
)


@pytest.fixture(scope="module")
def good(boards, seen_corners):
    return seen_corners(boards.poses(np.random.default_rng(1), 22))


def test_too_few_views_are_refused_with_the_reasons(good, board):
    views = [BoardView(f"{n}.png", corners) for n, corners in enumerate(good[:12])]
    views += [BoardView(f"b{n}.png", None, "blurred (edges 12.0 px wide)") for n in range(9)]
    views += [BoardView("other.png", None, "a board with 8x5 inner corners")]
    with pytest.raises(InputError) as refused:
        check_number(views, board)
    for part in ("12 of 22 pictures", "at least 20", "blurred in 9, such as b0.png (edges 12.0 px wide)", "8x5 inner"):
        assert part in str(refused.value)
    assert len(explain(views)) == 2
    assert len(check_number([BoardView("a", corners) for corners in good], board)) == 22


def test_the_same_view_again_and_again_is_refused(good, seen_corners, lens):
    check_variety(good, lens.size)
    random = np.random.default_rng(0)
    alike = [good[0] + random.normal(0, 2, 2) for _ in range(11)] + [
        good[1][::-1] + random.normal(0, 2, 2) for _ in range(11)
    ]
    with pytest.raises(InputError, match="too alike: of 22 only 2 differ"):
        check_variety(alike, lens.size)


def test_a_board_that_is_never_tilted_is_refused(boards, seen_corners, board, lens):
    random = np.random.default_rng(2)
    flat = [boards.Pose((0, 0, random.uniform(-0.3, 0.3)), (*random.uniform(-15, 15, 2), 120.0)) for _ in range(22)]
    with pytest.raises(InputError, match="always tilted the same way"):
        check_fit(fit_camera(seen_corners(flat), board, lens.size))


def test_parameters_that_stay_open_are_refused(good, board, lens):
    fit = fit_camera(good, board, lens.size)
    check_fit(fit)
    deviations = fit.deviations.copy()
    deviations[2] = 5.0
    with pytest.raises(InputError, match=r"the camera's cx: 32\d\.\d \+- 5\.0 px; allowed: \+- 3\.1 px"):
        check_fit(CameraFit(fit.camera, deviations, fit.reprojection_rms, fit.normals))


def test_a_map_that_held_out_views_contradict_is_refused():
    check_map(MapError(0.04, 0.01, 0.3))
    for error in (MapError(0.3, 0.0, 0.3), MapError(0.1, 0.3, 0.1), MapError(0.04, 0.0, 3.7), MapError(np.nan, 0, 0)):
        with pytest.raises(InputError, match="do not determine the distortion"):
            check_map(error)


def test_what_is_left_to_be_wished_for_is_said(good, lens):
    assert coverage_warnings(good, lens.size, MapError(0.02, 0.0, 0.05)) == []
    middle = [view * 0.2 + np.array([256, 192]) for view in good]
    warnings = coverage_warnings(middle, lens.size, MapError(0.1, 0.0, 0.7))
    assert "% of the picture" in warnings[0]
    assert "0.1 px rms; good is 0.05" in warnings[1]
    assert "0.7 px rms" in warnings[2]
