import numpy as np
import pytest

from bench_hw.tables import TrialTable
from benchmark.files.specimen import assumed_specimen


def trial(depth, gap=None):
    depth = np.array(depth, dtype=float)
    extra = {} if gap is None else {"gap": np.array(gap, dtype=float)}
    return TrialTable(np.arange(len(depth), dtype=float), depth, np.zeros(len(depth)), extra)


def test_the_thickness_is_the_median_gap_at_zero_depth():
    trials = [
        trial([-1e-3, 0.0, 1e-3], [9e-3, 8e-3, 7e-3]),
        trial([0.2e-3, 1e-3], [9.8e-3, 9e-3]),
        trial([0.0, 1e-3], [15e-3, 14e-3]),
        trial([0.0, 1e-3]),
    ]
    tissue, warning = assumed_specimen(trials)
    assert tissue.thickness == pytest.approx(10e-3, rel=1e-12)
    assert "10 mm" in warning
    assert "trials: 3, 8 to 15 mm" in warning


@pytest.mark.parametrize("gap", [None, [0.0, -1e-3], [-5e-3, -6e-3]])
def test_without_a_usable_gap_it_is_ten_millimetres(gap):
    tissue, warning = assumed_specimen([trial([0.0, 1e-3], gap)])
    assert tissue.thickness == 10e-3
    assert "no trial has a usable gap_mm" in warning


def test_everything_assumed_is_said():
    tissue, warning = assumed_specimen([trial([0.0])])
    (layer,) = tissue.layers
    assert layer.youngs_modulus == 20e3
    assert f"{layer.poisson_ratio:g}" in warning
    assert "1000 kg/m^3" in warning
    assert "20 kPa before any fit" in warning
    assert "assumed" in tissue.citation
