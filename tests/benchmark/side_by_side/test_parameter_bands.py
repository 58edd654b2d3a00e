"""What uncertain parameters leave of both models: against models run with each value changed."""

import numpy as np
import pytest

from benchmark.comparison.uncertainty import NORMAL_95
from benchmark.files import load_scenario
from benchmark.files.tissue import Correlation
from benchmark.models import prepare, scenario_drive
from benchmark.side_by_side.parameter_bands import beside, parameter_bands

SMALL = {"fem.mesh": "coarse", "load.observations": "2", "load.peak": "1 N", "load.shape": "ramp"}
STATED = {"dermis.youngs_modulus": "0.96 MPa +/- 20 %", "subcutaneous_fat.thickness": "10 mm +/- 4 %"}


def scenario(**more: str):
    return load_scenario("skin-5N", SMALL | more)


@pytest.fixture(scope="module")
def bands():
    told = scenario(**STATED)
    return told, parameter_bands(told, scenario_drive(told))


def change(model: str, key: str, value: str, told) -> np.ndarray:
    """Logarithm of a model's deflections with one value changed over those as told."""
    drive = scenario_drive(told)
    other, plain = scenario(**{**STATED, key: value}), scenario(**STATED)
    ratio = prepare(model, other).run(drive).top_deflection / prepare(model, plain).run(drive).top_deflection
    return np.log(ratio)


def test_without_a_stated_uncertainty_there_are_none() -> None:
    told = scenario()
    assert parameter_bands(told, scenario_drive(told)) is None


@pytest.mark.parametrize("model", ["fem", "wave"])
def test_they_are_the_root_of_the_sum_of_what_each_value_changes(model: str, bands) -> None:
    told, found = bands
    stiffer = change(model, "dermis.youngs_modulus", "0.9696 MPa", told) / np.log(1.01)
    thicker = change(model, "subcutaneous_fat.thickness", "10.1 mm", told) / np.log(1.01)
    expected = np.hypot(0.20 * stiffer, 0.04 * thicker)
    np.testing.assert_allclose(getattr(found, model), expected, rtol=0.02)


def test_the_finite_elements_are_differentiated_by_themselves(bands) -> None:
    assert bands[1].by == "the solver's own derivatives on one mesh"


def test_models_move_together_so_that_their_difference_is_surer(bands) -> None:
    _, found = bands
    assert found.difference.max() < 0.2 * found.fem.min()


def test_correlated_errors_take_each_other_away() -> None:
    pair = {"dermis.youngs_modulus": "0.96 MPa +/- 10 %", "subcutaneous_fat.youngs_modulus": "47.8 kPa +/- 10 %"}
    told = scenario(**pair, **{"wave.large_press": "linear"})
    drive = scenario_drive(told)
    keys = ("dermis.youngs_modulus", "subcutaneous_fat.youngs_modulus")
    alone = parameter_bands(told, drive)
    sizes = {}
    for value in (-0.95, 0.95):
        correlations = (Correlation(between=keys, value=value),)
        other = told.model_copy(update={"tissue": told.tissue.model_copy(update={"correlations": correlations})})
        sizes[value] = parameter_bands(other, drive).fem
    assert (sizes[-0.95] < alone.fem).all()
    assert (alone.fem < sizes[0.95]).all()
    np.testing.assert_allclose(sizes[-0.95] ** 2 + sizes[0.95] ** 2, 2.0 * alone.fem**2, rtol=1e-6)


def test_words_say_whether_the_difference_matters(bands) -> None:
    _, found = bands
    fem = np.ones((2, 3))
    small, large = (beside(found, ("a", "b", "c"), fem, fem * factor, 1) for factor in (1.001, 1.5))
    assert not any(one.matters for one in small)
    assert all(one.matters for one in large)
    assert "does not matter" in small[0].text
    assert small[0].fem == pytest.approx(100.0 * (np.exp(NORMAL_95 * found.fem[1, 0]) - 1.0))
