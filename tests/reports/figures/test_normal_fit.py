import numpy as np
import pytest

from reports.figures import Normal, normal_fit

GENERATOR = np.random.default_rng(5)
FEM = GENERATOR.normal([1.0, 0.5], [0.2, 0.1], size=(100, 2))
FITS = [Normal(1.0, 0.2), Normal(0.5, 0.1)]


def test_the_density_is_a_normal_one():
    x = np.linspace(-1, 3, 4001)
    density = Normal(1.0, 0.2).density(x)
    step = x[1] - x[0]
    assert density.sum() * step == pytest.approx(1, abs=1e-9)
    assert (density * x).sum() * step == pytest.approx(1.0, abs=1e-9)
    assert (density * (x - 1) ** 2).sum() * step == pytest.approx(0.04, abs=1e-9)


def test_each_panel_draws_both_normals(lines):
    waves = [Normal(1.1, 0.25), Normal(0.45, 0.05)]
    figure = normal_fit(["skin", "fat"], FEM, FITS, FEM + 0.1, waves)
    for fem_fit, wave_fit, panel in zip(FITS, waves, figure.panels, strict=True):
        fem, wave = (max(lines(panel.svg, colour), key=len) for colour in ("fem", "wave"))
        apart = wave[wave[:, 1].argmin(), 0] - fem[fem[:, 1].argmin(), 0]
        assert np.sign(apart) == np.sign(wave_fit.mean - fem_fit.mean)
        assert np.ptp(fem[:, 1]) / np.ptp(wave[:, 1]) == pytest.approx(wave_fit.std / fem_fit.std, rel=0.03)


def test_the_peak_of_a_normal_stands_at_its_mean(lines):
    svg = normal_fit(["a"], [[0.0], [2.0]], [Normal(1.0, 0.5)]).panels[0].svg
    line = max(lines(svg, "fem"), key=len)
    assert line[line[:, 1].argmin(), 0] == pytest.approx(line[[0, -1], 0].mean(), abs=0.5)


def test_words_tell_the_fits():
    alt = normal_fit(["skin", "fat"], FEM, FITS).panels[1].alt
    assert alt == "fat: FEM mean 0.5000 mm, standard deviation 0.1000 mm, n = 100."


def test_observations_that_are_missing_do_not_count():
    values = FEM.copy()
    values[:40, 0] = np.nan
    assert "n = 60" in normal_fit(["skin", "fat"], values, FITS).panels[0].alt


@pytest.mark.parametrize("values", [np.zeros((5, 1)), np.full((5, 1), np.nan), np.empty((0, 1))])
def test_without_spread_it_says_so(values, texts):
    assert "no spread to draw" in texts(normal_fit(["skin"], values, [Normal(0.0, 0.0)]).panels[0].svg)


def test_a_fit_too_few_is_refused():
    with pytest.raises(ValueError, match="1 normal fits of the FEM for 2 layers"):
        normal_fit(["skin", "fat"], FEM, FITS[:1])
