import numpy as np

from wavemodel.layers.lag_nodes import lag_nodes


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
