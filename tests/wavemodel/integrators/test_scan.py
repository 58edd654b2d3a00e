import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from wavemodel.integrators.scan import bounded_sum, decaying_sum

SIZES = st.integers(1, 60)


@given(
    SIZES.flatmap(
        lambda n: st.tuples(arrays(float, n, elements=st.floats(0, 80)), arrays(float, n, elements=st.floats(-3, 3)))
    ),
    st.floats(-2, 2),
)
def test_fading_sum_is_its_recursion(pair, start):
    exponent, gain = pair
    expected, y = [], start
    for a, b in zip(exponent, gain, strict=True):
        y = np.exp(-a) * y + b
        expected.append(y)
    np.testing.assert_allclose(decaying_sum(exponent, gain, start), expected, rtol=1e-12, atol=1e-13)


def test_fading_sum_does_not_overflow_over_a_long_history():
    exponent, gain = np.full(20000, 3.0), np.ones(20000)
    np.testing.assert_allclose(decaying_sum(exponent, gain)[-1], 1.0 / (1.0 - np.exp(-3.0)), rtol=1e-14)


def test_fading_sums_side_by_side_are_those_alone():
    """Slow ones, whose exponents sum up to little, beside fast ones and one of each step so long that all is gone."""
    rng = np.random.default_rng(8)
    exponent, gain = np.outer([0.0, 1e-3, 1.0, 7.0, 900.0], rng.uniform(0.0, 2.0, 300)), rng.normal(size=(5, 300))
    start = rng.normal(size=5)
    together = decaying_sum(exponent, gain, start)
    for row, own in enumerate(together):
        expected, y = [], start[row]
        for a, b in zip(exponent[row], gain[row], strict=True):
            y = np.exp(-a) * y + b
            expected.append(y)
        np.testing.assert_allclose(own, expected, rtol=1e-12, atol=1e-13)


def test_fading_sum_turns_where_the_exponent_is_complex():
    exponent, gain = np.full(50, 0.1 + 0.7j), np.zeros(50, dtype=complex)
    gain[0] = 1.0
    np.testing.assert_allclose(decaying_sum(exponent, gain), np.exp(-(0.1 + 0.7j) * np.arange(50)), rtol=1e-12)


@given(
    SIZES.flatmap(
        lambda n: st.tuples(arrays(float, n, elements=st.floats(-3, 3)), arrays(float, n, elements=st.floats(0, 2)))
    ),
    st.floats(-2, 2),
)
def test_bounded_sum_is_its_recursion(pair, start):
    change, limit = pair
    expected, y = [], start
    for a, b in zip(change, limit, strict=True):
        y = min(max(y + a, -b), b)
        expected.append(y)
    np.testing.assert_allclose(bounded_sum(change, limit, start), expected, atol=1e-12)
