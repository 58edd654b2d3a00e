import numpy as np

from benchmark.identification.sheet_model import NONE, Relaxation, relaxed


def test_a_ramp_and_hold_relaxes_as_in_closed_form() -> None:
    share, tau, ramp = 0.3, 0.8, 1.0
    time = np.linspace(0.0, 5.0, 4001)
    elastic = np.minimum(time / ramp, 1.0)
    held = time > ramp
    expected = 1.0 - share + share * tau / ramp * (np.exp(ramp / tau) - 1.0) * np.exp(-time / tau)
    found = relaxed(time, elastic, Relaxation(share, tau))
    np.testing.assert_allclose(found[held], expected[held], atol=2e-4)


def test_uneven_rows_give_the_same_force() -> None:
    time = np.linspace(0.0, 4.0, 801)
    elastic = np.sin(time) ** 2
    whole = relaxed(time, elastic, Relaxation(0.2, 0.5))
    rows = np.sort(np.random.default_rng(0).choice(801, 500, replace=False))
    np.testing.assert_allclose(relaxed(time[rows], elastic[rows], Relaxation(0.2, 0.5)), whole[rows], atol=2e-3)


def test_no_share_changes_nothing() -> None:
    elastic = np.arange(5.0)
    np.testing.assert_array_equal(relaxed(np.arange(5.0), elastic, NONE), elastic)
