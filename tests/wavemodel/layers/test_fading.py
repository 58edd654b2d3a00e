import numpy as np
import pytest

from wavemodel import Prony
from wavemodel.layers.compliance import compliance, exact_faces
from wavemodel.layers.fading import stack_creep
from wavemodel.layers.laminate import laminate

K = np.array([100.0, 500.0, 2500.0])
SERIES = [Prony(), Prony((0.3,), (0.5,)), Prony((0.2, 0.25), (0.1, 4.0))]


@pytest.mark.parametrize("base", ["bonded", "free"])
@pytest.mark.parametrize("eta", [0.0, 0.02])
def test_at_every_rate_it_is_the_compliance_of_the_moduli_there(skin, base, eta):
    """At a real rate s each modulus is G(s) = 1 - sum g / (1 + s tau) + eta s times the initial one."""
    stack = laminate(skin(), [(1.0,)] * 3, base)
    made = stack_creep(exact_faces(K, stack), base, SERIES, eta)
    for s in [0.0, 0.3, 5.0, 400.0]:
        factor = np.array(
            [1.0 + eta * s - sum(g / (1 + s * tau) for g, tau in zip(p.strength, p.time, strict=True)) for p in SERIES]
        )

        def scaled(k, one, factor=factor):
            return exact_faces(k, one) * factor[:, None, None]

        expected = compliance(K, stack, scaled).faces
        lags = 1.0 / (1.0 + s / made.rate)
        found = made.instant + np.einsum("nm,nmlij->nlij", lags, made.faces)
        scale = np.abs(expected[:, :1]).max(axis=(2, 3), keepdims=True)
        np.testing.assert_allclose(found / scale, expected / scale, atol=1e-9)
    assert np.all(made.rate > 0.0)
