"""Where the paper's distortion folds over."""

import numpy as np
import pytest

from bench_hw.vision.camera import Camera, survey_domain
from bench_hw.vision.camera.domain import invertible

PAPER = (0.07, -0.48, -0.01, -0.01, 0.0)


def camera(focal: float, distortion=PAPER) -> Camera:
    return Camera((640, 480), (focal, focal), (319.5, 239.5), distortion)


@pytest.mark.parametrize("focal", [540.0, 582.0, 610.0])
def test_the_papers_distortion_folds_over_in_the_corners_up_to_610_px(focal):
    domain = survey_domain(camera(focal))
    assert not domain.whole
    assert 0.95 < domain.fraction < 1.0
    assert 320 < domain.nearest < 400
    assert "no inverse" in str(domain)


def test_longer_lenses_and_no_distortion_have_the_whole_picture():
    for whole in (camera(640.0), camera(300.0, (0.0,) * 5), camera(582.0, (0.07, 0.0, 0.0, 0.0, 0.0))):
        domain = survey_domain(whole)
        assert (domain.whole, domain.nearest) == (True, np.inf)
        assert "whole picture" in str(domain)


def test_pixels_are_told_apart():
    pixels = np.array([[319.5, 239.5], [0.0, 0.0]])
    assert invertible(camera(560.0), pixels).tolist() == [True, False]
