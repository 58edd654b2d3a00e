import numpy as np
import pytest

from wavemodel import Prony
from wavemodel.layered.stack.compliance import compliance, exact_faces
from wavemodel.layered.stack.creep import lag_nodes, stack_creep
from wavemodel.layered.stack.laminate import laminate

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


def test_one_rate_is_its_own_node():
    nodes = lag_nodes(np.full((4, 2), 3.0))
    np.testing.assert_allclose(nodes.rate, [3.0])
    np.testing.assert_allclose(nodes.share(np.array([3.0])), [[1.0]])


def test_shared_lags_stand_for_all_at_every_rate_of_loading():
    rates = np.concatenate([np.geomspace(0.9, 2.4, 40), np.geomspace(50.0, 60.0, 7), [4000.0]])
    nodes = lag_nodes(rates)
    share = nodes.share(rates)
    for s in [0.0, 0.3, 4.0j, 70.0, 1e3j, 5.0 + 200.0j, 1e6]:
        found = share @ (1.0 / (1.0 + s / nodes.rate))
        np.testing.assert_allclose(found, 1.0 / (1.0 + s / rates), atol=1e-11)


def test_rates_far_apart_get_nodes_of_their_own():
    nodes = lag_nodes(np.array([1.0, 1.1, 100.0, 110.0]))
    assert len(nodes.groups) == 2
    share = nodes.share(np.array([1.05, 105.0]))
    first = nodes.groups[0].size
    np.testing.assert_array_equal(share[0, first:], 0.0)
    np.testing.assert_array_equal(share[1, :first], 0.0)
    np.testing.assert_allclose(share.sum(axis=1), 1.0)
