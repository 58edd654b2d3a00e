import numpy as np
import pytest

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
    np.testing.assert_allclose(relaxed(time[rows], elastic[rows], Relaxation(0.2, 0.5)), whole[rows], atol=5e-5)


@pytest.mark.parametrize("step", [0.001, 0.05, 0.1])
def test_a_step_within_two_rows_is_exact_in_the_rows_beside_it(step) -> None:
    """On an even grid finer than the rows the corners were 3 % of the force off."""
    time = np.array([0.0, 0.4, 0.9, 1.0, 1.0 + step, 1.0 + 2 * step, 1.5, 3.0, 9.0])
    elastic = np.clip((time - 1.0) / (2.0 * step), 0.0, 1.0)
    share, tau, after = 0.35, 2.0, np.maximum(time - 1.0 - 2.0 * step, 0.0)
    risen = np.clip(time - 1.0, 0.0, 2.0 * step)
    remembered = tau / (2.0 * step) * -np.expm1(-risen / tau) * np.exp(-after / tau)
    expected = elastic - share * (elastic - remembered)
    np.testing.assert_allclose(relaxed(time, elastic, Relaxation(share, tau)), expected, atol=1e-12)


def test_no_share_changes_nothing() -> None:
    elastic = np.arange(5.0)
    np.testing.assert_array_equal(relaxed(np.arange(5.0), elastic, NONE), elastic)
