import math

import pytest
from pydantic import ValidationError

from benchmark.files.laws import NeoHookean, PronyTerm
from benchmark.files.tissue import Layer, Tissue


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
