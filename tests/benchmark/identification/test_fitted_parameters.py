from dataclasses import replace

import numpy as np
import pytest

from benchmark.identification import FittedParameter, fit_session, parameter_columns
from benchmark.identification.fitted_parameters import fitted_parameters


@pytest.fixture
def by_name(session):
    def fitted(layers, trials=4, **options):
        fit = fit_session(session(np.random.default_rng(1), trials, **options), layers)
        return fit, {parameter.name: parameter for parameter in fit.parameters}

    return fitted


def test_one_layer_has_one_identifiable_modulus(by_name, silicone):
    fit, rows = by_name([silicone])
    modulus, factor = rows["silicone.youngs_modulus"], rows["stiffness_factor"]
    assert modulus.identifiable
    assert factor.identifiable
    assert modulus.unit == "kPa"
    assert modulus.value == pytest.approx(20.0 * fit.stiffness_factor)
    assert modulus.ci95_low == pytest.approx(20.0 * factor.ci95_low)
    assert modulus.ci95_low < modulus.value < modulus.ci95_high


def test_several_layers_cannot_be_told_apart(by_name, skin):
    fit, rows = by_name(skin)
    for name, kilopascal in (("epidermis", 1000.0), ("dermis", 100.0), ("fat", 20.0)):
        modulus = rows[f"{name}.youngs_modulus"]
        assert not modulus.identifiable
        assert "one stiffness, not several" in modulus.source
        assert modulus.value == pytest.approx(kilopascal * fit.stiffness_factor)
        assert (modulus.ci95_low, modulus.ci95_high) == (None, None)
    assert rows["stiffness_factor"].identifiable


def test_fixed_parameters_have_no_interval(by_name, skin):
    _, rows = by_name(skin)
    fixed = rows["dermis.poisson_ratio"]
    assert (fixed.value, fixed.identifiable, fixed.ci95_low) == (0.48, False, None)
    assert "fixed" in fixed.source
    assert (rows["dermis.thickness"].value, rows["dermis.thickness"].unit) == (pytest.approx(1.5), "mm")
    assert rows["fat.thickness"].value is None
    assert "endless" in rows["fat.thickness"].source


def test_onset_and_zero_are_means_over_trials(by_name, silicone):
    fit, rows = by_name([silicone])
    assert rows["contact_onset"].value == pytest.approx(1e3 * np.mean([trial.onset for trial in fit.trials]))
    assert rows["force_zero"].value == pytest.approx(np.mean([trial.zero for trial in fit.trials]))
    assert rows["force_zero"].unit == "N"
    assert rows["contact_onset"].identifiable


def test_what_lies_at_a_bound_has_no_interval(by_name, silicone):
    fit, rows = by_name([silicone])
    bound = [replace(trial, onset_range=(trial.onset, 1.0)) for trial in fit.trials]
    onset = next(row for row in fitted_parameters(fit.stiffness, bound, [silicone]) if row.name == "contact_onset")
    assert onset.value == rows["contact_onset"].value
    assert (onset.ci95_low, onset.ci95_high, onset.identifiable) == (None, None, False)
    assert onset.source.endswith("; 4 of 4 lie at an end of the range the data allow")


def test_an_interval_of_what_is_not_identified_needs_a_prior():
    with pytest.raises(ValueError, match=r"fat\.youngs_modulus is not identified and has no prior"):
        FittedParameter("fat.youngs_modulus", 62.3, "kPa", 61.3, 63.3, False, "one stiffness")
    told = FittedParameter("fat.youngs_modulus", 62.3, "kPa", 61.3, 63.3, False, "weak", "60 kPa +/- 1 %; a paper")
    assert told.text == "fat.youngs_modulus: 62.3 kPa (95 % 61.3 to 63.3, on its prior alone)"
    assert told.unidentified("; lost").text == "fat.youngs_modulus: 62.3 kPa (weak; lost)"


def test_a_single_trial_has_intervals_too(by_name, silicone):
    fit, rows = by_name([silicone], trials=1)
    half = 1.96 * fit.trials[0].zero_stderr
    assert rows["force_zero"].ci95_high == pytest.approx(rows["force_zero"].value + half)
    assert "single trial" in rows["stiffness_factor"].source


def test_columns_of_the_table(by_name, silicone):
    fit, _ = by_name([silicone])
    columns = parameter_columns(fit.parameters)
    assert list(columns) == ["name", "value", "unit", "ci95_low", "ci95_high", "identifiable", "source"]
    assert set(columns["identifiable"]) == {"true", "false"}
    assert len({len(column) for column in columns.values()}) == 1
