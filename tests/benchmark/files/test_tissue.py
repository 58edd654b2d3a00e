import math

import pytest
from pydantic import TypeAdapter, ValidationError

from benchmark.files import load_tissue, scaled_tissue, tissue_from_table
from benchmark.files.quantities import FROM_FILE
from benchmark.files.sources import Source
from benchmark.files.tissue import Fibre, Hyperelastic, Layer, NeoHookean, PronyTerm, Tissue

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
        {"law": "ogden", "terms": [{"mu": "10 kPa", "alpha": 2.0}, {"mu": "1 kPa", "alpha": 0.0}]},
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


def layer(name="fat", **changes):
    values = {"thickness": 0.01, "density": 971.0, "youngs_modulus": 20e3, "poisson_ratio": 0.48, **changes}
    return Layer(name=name, **values)


def test_a_layer_is_neo_hookean_from_its_moduli_and_elastic_by_default():
    fat = layer()
    assert fat.hyperelastic == NeoHookean()
    assert fat.relaxation == ()
    assert fat.fibre is None
    assert fat.shear_modulus == pytest.approx(20e3 / 2.96, rel=1e-15)


@pytest.mark.parametrize("ratio", [0.0, 0.35, 0.48, 0.499, 0.4999])
def test_poisson_ratios_up_to_nearly_one_half(ratio):
    assert layer(poisson_ratio=ratio).poisson_ratio == ratio


@pytest.mark.parametrize("ratio", [0.5, 0.6, -0.1, math.nan, "half"])
def test_poisson_ratios_beyond_are_refused(ratio):
    with pytest.raises(ValidationError, match=r"0 to 0\.49999"):
        layer(poisson_ratio=ratio)


@pytest.mark.parametrize(
    "changes", [{"thickness": -1e-3}, {"thickness": 0.0}, {"density": 0.0}, {"youngs_modulus": -1.0}]
)
def test_what_must_be_positive(changes):
    with pytest.raises(ValidationError, match="outside what is allowed"):
        layer(**changes)


def test_bounds_admit_verification_problems():
    assert layer(youngs_modulus=1e12, thickness=2000.0).youngs_modulus == 1e12


def test_something_must_stay_of_the_stiffness():
    with pytest.raises(ValidationError, match="must stay below 1"):
        layer(relaxation=(PronyTerm(g=0.5, tau=1.0), PronyTerm(g=0.5, tau=2.0)))
    with pytest.raises(ValidationError, match="share one time constant"):
        layer(relaxation=(PronyTerm(g=0.1, tau=1.0), PronyTerm(g=0.2, tau=1.0)))


def test_layers_need_names_of_their_own():
    with pytest.raises(ValidationError, match="2 layers are named 'fat'"):
        Tissue(name="t", layers=(layer(), layer()))
    with pytest.raises(ValidationError):
        Tissue(name="t", layers=())


@pytest.mark.parametrize("name", ["", "   ", "two\nlines", "x" * 201, "null\0"])
def test_a_name_is_one_printable_line(name):
    with pytest.raises(ValidationError, match="is no name"):
        Tissue(name=name, layers=(layer(),))


def test_a_name_may_hold_anything_else():
    name = '<script>alert("1")</script> & Haut µ'
    assert Tissue(name=name, layers=(layer(name),)).layer_names == (name,)


def test_only_the_last_layer_may_be_endless():
    endless = layer(thickness=math.inf)
    assert math.isinf(Tissue(name="t", layers=(layer("skin"), endless)).thickness)
    with pytest.raises(ValidationError, match="the layer 'fat' has no thickness"):
        Tissue(name="t", layers=(endless, layer("skin")))


def test_a_layer_is_found_and_replaced_by_name():
    tissue = Tissue(name="t", layers=(layer("skin"), layer("fat")))
    softer = tissue.with_layer("fat", youngs_modulus=5e3)
    assert softer.layer("fat").youngs_modulus == 5e3
    assert softer.layer("skin") == tissue.layer("skin")
    assert tissue.layer("fat").youngs_modulus == 20e3
    with pytest.raises(ValidationError):
        tissue.with_layer("fat", youngs_modulus=-5e3)
    with pytest.raises(KeyError):
        tissue.layer("bone")


def test_a_tissue_cannot_be_changed_in_place():
    tissue = Tissue(name="t", layers=(layer(),))
    with pytest.raises(ValidationError, match="frozen"):
        tissue.name = "u"
    assert hash(tissue) == hash(Tissue(name="t", layers=(layer(),)))


LAYER = {"thickness": "2 mm", "density": "1000 kg/m^3", "youngs_modulus": "30 kPa", "poisson_ratio": 0.45}
LAWS = [
    {"law": "neo_hookean", "c10": "5 kPa"},
    {"law": "mooney_rivlin", "c10": "5 kPa", "c01": "1 kPa"},
    {"law": "yeoh", "c10": "5 kPa", "c20": "2 kPa", "c30": "-1 kPa"},
    {"law": "ogden", "terms": [{"mu": "4 kPa", "alpha": 2.5}, {"mu": "-1 kPa", "alpha": -2.0}]},
    {"law": "gent", "mu": "10 kPa", "jm": 20.0},
]


@pytest.mark.parametrize("law", LAWS, ids=[str(law["law"]) for law in LAWS])
def test_every_law_scales_its_stiffness_and_keeps_its_numbers(law: dict[str, object]) -> None:
    layer = {**LAYER, "name": "one", "hyperelastic": law, "fibre": {"k1": "3 kPa", "k2": 1.5}}
    tissue = tissue_from_table({"schema": 1, "name": "t", "layers": [layer]}, Source("test"))
    before, after = tissue.layers[0], scaled_tissue(tissue, 2.5, "stiff").layers[0]
    assert after.hyperelastic.shear_modulus == pytest.approx(2.5 * before.hyperelastic.shear_modulus)
    assert after.youngs_modulus == pytest.approx(75e3)
    assert (after.fibre.k1, after.fibre.k2) == (pytest.approx(7.5e3), 1.5)
    if law["law"] == "gent":
        assert after.hyperelastic.jm == 20.0


def test_geometry_and_poisson_ratio_stay() -> None:
    tissue = load_tissue("skin_forearm")
    scaled = scaled_tissue(tissue, 0.5, "soft")
    assert scaled.name == "soft"
    for before, after in zip(tissue.layers, scaled.layers, strict=True):
        assert after.youngs_modulus == 0.5 * before.youngs_modulus
        assert (after.thickness, after.poisson_ratio, after.density) == (
            before.thickness,
            before.poisson_ratio,
            before.density,
        )
