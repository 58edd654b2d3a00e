import numpy as np
import pytest

from wavemodel.domains.domain import endless
from wavemodel.errors import WaveError


def test_inverts_known_hankel_pairs():
    """exp(-k^2 / 4) is the transform of a Gaussian: int exp(-k^2/4) J_0(k r) k dk / (2 pi) = exp(-r^2) / pi."""
    line = endless(14.0, 8.0)
    radius = np.linspace(0.0, 6.0, 13)
    field = line.at_radius(np.exp(-(line.wavenumber**2) / 4.0), radius)
    np.testing.assert_allclose(field, np.exp(-(radius**2)) / np.pi, atol=1e-9)


def test_weights_fill_the_disc_of_wavenumbers():
    line = endless(3.0, 100.0)
    np.testing.assert_allclose(line.weight.sum(), 9.0 / (4.0 * np.pi))


def test_a_quadrature_too_fine_for_any_memory_is_refused():
    assert endless(1e3, 300.0).wavenumber.size == 300_000
    with pytest.raises(WaveError, match=r"takes 1e\+06 wavenumbers.*at most 400000"):
        endless(1e6, 1.0)
