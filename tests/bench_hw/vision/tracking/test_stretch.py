"""Markers that stretch into ellipses within a few pictures are kept, to hundredths of a pixel. Synthetic."""

import numpy as np
import pytest

from bench_hw.vision.camera import read_camera
from tests.performance import tracking


@pytest.mark.parametrize("name", ["ellipses 1.6 in nine pictures", "local bulge 1.4"])
def test_true_sightings_are_kept_in_a_quick_press(tmp_path, name):
    kit = tracking.rendering()
    path = tmp_path / "camera.toml"
    path.write_text(kit.Scene(focal=640.0, distortion=kit.PAPER_DISTORTION).camera_toml())
    film = next(each for each in tracking.films() if each.name == name)
    quick = np.interp(np.arange(16), [0, 1, 10, 12, 16], [0, 0, 1, 1, 0.6])
    film = tracking.Film(film.name, film.move, quick)
    score = tracking.judged("subpixel", film, 301, read_camera(path), kit)
    assert score.kept >= 0.995 * score.true
    assert score.wrong == 0
    assert score.rms <= 0.03
