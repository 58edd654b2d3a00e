"""Grid convergence on series whose limit is known; E and u_val by hand."""

import numpy as np
import pytest
import scipy

from benchmark.comparison import ComparisonError, Validation, grid_convergence, input_uncertainty, replicate_uncertainty


@pytest.mark.parametrize("sizes", [(1.0, 2.0, 4.0), (1.0, 1.5, 2.7)])
@pytest.mark.parametrize("order", [1.0, 1.7, 2.0])
def test_the_order_and_the_limit_of_a_power_law(sizes: tuple[float, ...], order: float) -> None:
    values = [3.0 + 0.01 * size**order for size in sizes]
    found = grid_convergence(values, sizes)
    assert found.observed
    assert found.order == pytest.approx(order, rel=1e-9)
    assert found.extrapolated == pytest.approx(3.0, rel=1e-12)
    assert found.index == pytest.approx(1.25 * 0.01, rel=1e-9)
    assert found.uncertainty == pytest.approx(1.25 * 0.01 / 1.15, rel=1e-9)
    middle = grid_convergence(values, sizes, judged=1)
    assert middle.index == pytest.approx(1.25 * 0.01 * sizes[1] ** order, rel=1e-9)


def test_the_printed_example_of_celik() -> None:
    # J. Fluids Eng. 130:078001, table 1: p = 1.53, extrapolated 6.1685, index 2.2 % of the value
    found = grid_convergence((6.063, 5.972, 5.863), (1.0, 1.5, 1.5 * 1.333))
    assert found.order == pytest.approx(1.53, abs=0.01)
    assert found.extrapolated == pytest.approx(6.1685, abs=5e-4)
    assert 100.0 * found.index / found.value == pytest.approx(2.2, abs=0.05)


def test_oscillating_values_and_two_grids_take_the_cautious_factor() -> None:
    found = grid_convergence((1.00, 1.02, 0.99), (1.0, 2.0, 4.0))
    assert not found.observed
    assert found.index >= 3.0 * 0.5 * 0.03
    two = grid_convergence((1.0, 1.04), (1.0, 2.0), formal_order=1.0)
    assert two.extrapolated == pytest.approx(0.96)
    assert two.index == pytest.approx(3.0 * 0.04)
    assert grid_convergence((1.0, 1.0), (1.0, 2.0)).uncertainty == 0.0


def test_what_cannot_be_judged_is_refused() -> None:
    for values, sizes in (((1.0,), (1.0,)), ((1.0, 2.0), (2.0, 1.0)), ((1.0, float("nan")), (1.0, 2.0))):
        with pytest.raises(ComparisonError):
            grid_convergence(values, sizes)


def test_the_uncertainties_add_in_squares() -> None:
    found = Validation(simulation=5.2, data=5.0, numerical=0.03, inputs=0.04, measured=0.12)
    assert found.error == pytest.approx(0.2)
    assert found.uncertainty == pytest.approx(0.13)
    assert found.interval == pytest.approx((0.07, 0.33))
    assert not found.within
    assert found.missing == ()


def test_what_was_not_assessed_is_named() -> None:
    found = Validation(5.05, 5.0, None, None, 0.06)
    assert found.missing == ("u_num", "u_input")
    assert found.uncertainty == pytest.approx(0.06)
    assert found.within


def test_replicates_give_the_standard_error_of_their_mean() -> None:
    values = [4.9, 5.1, 5.0, 5.3]
    assert replicate_uncertainty(values) == pytest.approx(float(scipy.stats.sem(values)), abs=1e-15)
    assert replicate_uncertainty([5.0]) is None
    with pytest.raises(ComparisonError):
        replicate_uncertainty([1.0, np.nan])


def test_what_conditions_differ_by_is_no_scatter_of_replicates() -> None:
    """Errors of -0.57 and 0.09 N in two conditions had made an u_D of 0.1 N beside replicates that repeat to 0.02."""
    values, names = [-0.58, -0.56, -0.57, 0.08, 0.10, 0.09], ["deep"] * 3 + ["shallow"] * 3
    assert replicate_uncertainty(values, names) == pytest.approx(0.01 / np.sqrt(6.0))
    assert replicate_uncertainty(values) == pytest.approx(float(scipy.stats.sem(values)))
    assert replicate_uncertainty([1.0, 2.0], ["a", "b"]) is None


def test_of_few_trials_an_interval_is_student_s() -> None:
    values = np.array([4.9, 5.1, 5.3])
    half = float(scipy.stats.t.ppf(0.975, 2) * scipy.stats.sem(values))
    found = input_uncertainty(1.0, (5.1 - half, 5.1 + half), 2)
    assert found == pytest.approx(float(scipy.stats.sem(values)), rel=1e-12)


def test_an_interval_becomes_a_standard_uncertainty() -> None:
    width = float(scipy.stats.norm.ppf(0.975))
    assert input_uncertainty(-2.0, (1.0 - width * 0.1, 1.0 + width * 0.1)) == pytest.approx(0.2, rel=1e-12)
