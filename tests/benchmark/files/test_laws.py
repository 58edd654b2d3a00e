import pytest
from pydantic import TypeAdapter, ValidationError

from benchmark.files.laws import Fibre, Hyperelastic, PronyTerm
from benchmark.files.quantities import FROM_FILE

laws = TypeAdapter(Hyperelastic)


def read(**table):
    return laws.validate_python(table, context=FROM_FILE)


@pytest.mark.parametrize(
    ("table", "shear_modulus"),
    [
        ({"law": "neo_hookean"}, None),
        ({"law": "neo_hookean", "c10": "20 kPa"}, 40e3),
        ({"law": "mooney_rivlin", "c10": "20 kPa", "c01": "5 kPa"}, 50e3),
        ({"law": "yeoh", "c10": "20 kPa", "c20": "-1 kPa", "c30": "2 kPa"}, 40e3),
        ({"law": "gent", "mu": "40 kPa", "jm": 2.5}, 40e3),
        ({"law": "ogden", "terms": [{"mu": "10 kPa", "alpha": 6.0}, {"mu": "-5 kPa", "alpha": -4.0}]}, 40e3),
    ],
)
def test_each_law_states_its_initial_shear_modulus(table, shear_modulus):
    assert read(**table).shear_modulus == shear_modulus


@pytest.mark.parametrize(
    "table",
    [
        {"law": "hooke"},
        {"law": "yeoh"},
        {"law": "yeoh", "c10": "0 kPa"},
        {"law": "yeoh", "c10": "20 mm"},
        {"law": "yeoh", "c10": "20 kPa", "mu": "1 kPa"},
        {"law": "mooney_rivlin", "c10": "20 kPa", "c01": "-20 kPa"},
        {"law": "gent", "mu": "40 kPa", "jm": 0},
        {"law": "ogden", "terms": []},
        {"law": "ogden", "terms": [{"mu": "10 kPa", "alpha": -6.0}]},
        {"law": "ogden", "terms": [{"mu": "10 kPa", "alpha": 2.0}] * 7},
    ],
)
def test_a_law_that_cannot_be_is_refused(table):
    with pytest.raises(ValidationError):
        read(**table)


@pytest.mark.parametrize("g", [0, 1, -0.1, 1.5])
def test_a_relaxing_fraction_lies_between_none_and_all(g):
    with pytest.raises(ValidationError, match="above 0 and below 1"):
        PronyTerm(g=g, tau=1.0)


def test_a_fibre_family_has_an_angle_and_a_dispersion_up_to_isotropy():
    fibre = Fibre.model_validate({"angle": "45 deg", "k1": "3 kPa", "k2": 1, "dispersion": 1 / 3}, context=FROM_FILE)
    assert fibre.angle == pytest.approx(0.7853981633974483, rel=0)
    for wrong in ({"dispersion": 0.34}, {"k2": 0}, {"angle": "200 deg"}, {"k1": "-1 Pa"}):
        with pytest.raises(ValidationError):
            Fibre.model_validate({"k1": "3 kPa", "k2": 1, **wrong}, context=FROM_FILE)
