import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wavemodel import WaveError
from wavemodel.domains.rectangle import Rectangle


def test_wavenumbers_are_those_of_the_paper():
    domain = Rectangle(23.6e-3, 23.6e-3, 3, symmetric=False)
    expected = sorted({m * m + n * n for m in (1, 2, 3) for n in (1, 2, 3)})
    np.testing.assert_allclose(domain.wavenumber, np.pi / 23.6e-3 * np.sqrt(expected))
    assert domain.lowest == pytest.approx(domain.wavenumber[0])


def test_symmetric_loads_meet_only_odd_modes():
    domain = Rectangle(1.0, 1.0, 6)
    assert domain.order.tolist() == [1, 3, 5]
    whole = Rectangle(1.0, 1.0, 6, symmetric=False).participation()
    np.testing.assert_allclose(whole[::2, ::2], domain.participation())
    np.testing.assert_allclose(whole[1::2], 0.0, atol=1e-12)


def test_modes_beyond_the_cutoff_are_left_out():
    domain = Rectangle(1.0, 1.0, 9, cutoff=20.0)
    assert domain.wavenumber.max() <= 20.0
    spread = domain.spread(np.ones((1, domain.wavenumber.size)))[0]
    k = np.pi * np.hypot(domain.order[:, None], domain.order)
    np.testing.assert_array_equal(spread, k <= 20.0)
    assert domain.pairs == np.count_nonzero(k <= 20.0)


@given(st.floats(-0.4, 0.4), st.floats(-0.3, 0.3), st.floats(0.5, 3.0))
def test_projection_and_synthesis_are_inverse(x, y, width):
    """A smooth field made of modes comes back from its values: S is orthogonal with norm ab/4."""
    domain = Rectangle(width, 1.0, 4, symmetric=False)
    points_x, points_y = (np.arange(40) + 0.5) / 40 * width - width / 2, (np.arange(40) + 0.5) / 40 - 0.5
    table_x, table_y = domain.sines(points_x), domain.sines(points_y, axis=1)
    gram = table_x.T @ table_x * width / 40
    np.testing.assert_allclose(gram, np.eye(4) * width / 2, atol=1e-9)
    share = domain.participation(x * width, y)
    value = domain.sines(np.array([x * width])) @ share @ domain.sines(np.array([y]), axis=1).T
    direct = np.sum(np.outer(domain.sines(np.array([x * width])), domain.sines(np.array([y]), axis=1)) ** 2)
    assert value[0, 0] == pytest.approx(direct * 4 / width, rel=1e-9)
    assert (table_x @ share @ table_y.T).shape == (40, 40)


def test_axis_weight_sums_a_field_at_the_middle():
    domain = Rectangle(0.06, 0.06, 9)
    amplitude = np.random.default_rng(3).normal(size=(2, domain.wavenumber.size))
    middle = domain.sines(np.zeros(1))
    field = middle @ (domain.spread(amplitude) * domain.participation()) @ middle.T
    np.testing.assert_allclose(amplitude @ domain.axis_weight, field[:, 0, 0])


@pytest.mark.parametrize(("side", "modes"), [(0.0, 3), (-1.0, 3), (1.0, 0), (np.nan, 3)])
def test_refuses_no_side_and_no_modes(side, modes):
    with pytest.raises(WaveError, match="not allowed"):
        Rectangle(side, 1.0, modes)
