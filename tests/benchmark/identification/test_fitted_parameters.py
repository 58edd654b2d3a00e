import numpy as np
import pytest

from benchmark.identification import fit_session, parameter_columns


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
