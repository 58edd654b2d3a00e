import math
from typing import get_args

import pytest

from benchmark.errors import InputError
from benchmark.files import Support, Tool, load_tissue
from benchmark.files.sessions.fit_table import Law
from benchmark.identification.parameters.free_parameters import (
    parameters_of,
    refuse_without_effect,
    value_of,
    with_values,
)
from benchmark.identification.parameters.law_shapes import LAW_SHAPES, shear_modulus, with_law
from benchmark.identification.parameters.presses.press_surrogate import _shape_chain
from benchmark.response.setup_change import is_absolute

SETUP = (load_tissue("skin_forearm"), Tool(radius=5e-3), Support())


@pytest.mark.parametrize("law", LAW_SHAPES)
def test_a_law_keeps_each_layers_shear_modulus_at_rest(law) -> None:
    changed = with_law(SETUP[0], law, LAW_SHAPES[law].start)
    before = [shear_modulus(one) for one in SETUP[0].layers]
    assert [one.hyperelastic.shear_modulus for one in changed.layers] == pytest.approx(before)


def constant(layer, key) -> float:
    """A constant of a layer by its key."""
    found = layer.model_dump()
    for part in key.split(".")[1:]:
        found = found[int(part) if part.isdigit() else part]
    return found


@pytest.mark.parametrize("law", [name for name, one in LAW_SHAPES.items() if one.key])
def test_a_constant_of_shape_is_differentiated_by_the_constants_that_it_changes(law) -> None:
    shape, step = LAW_SHAPES[law].start, 1e-6
    before, after = (with_values(SETUP, {LAW_SHAPES[law].key: s}, law) for s in (shape, shape * (1.0 + step)))
    chain = _shape_chain("dermis", shape, before)
    assert chain
    for key, weight in chain.items():
        old, new = (constant(each[0].layer("dermis"), key) for each in (before, after))
        assert (new - old) / step / (1.0 if is_absolute(key) else old) == pytest.approx(weight, rel=1e-4)


def test_fibres_follow_their_layers_modulus_and_stay_under_another_law() -> None:
    values = {"law.k1_over_c10": 3.0, "dermis.youngs_modulus": 2.0 * value_of("dermis.youngs_modulus", SETUP)}
    dermis = with_values(SETUP, values, "fibres")[0].layer("dermis")
    assert dermis.hyperelastic.law == "neo_hookean"
    assert dermis.fibre.k1 == pytest.approx(3.0 * dermis.hyperelastic.c10)
    assert dermis.hyperelastic.shear_modulus == pytest.approx(2.0 * shear_modulus(SETUP[0].layer("dermis")))
    fibrous = SETUP[0].with_layer("dermis", fibre={"k1": 1e4, "k2": 2.0})
    assert with_law(fibrous, "yeoh", 0.1).layer("dermis").fibre == fibrous.layer("dermis").fibre


def test_a_modulus_takes_the_laws_stresses_along_except_those_with_a_value_of_their_own() -> None:
    tissue = SETUP[0].with_layer("dermis", hyperelastic={"law": "yeoh", "c10": 1e5, "c20": 2e4, "c30": 1e3})
    told = value_of("dermis.youngs_modulus", (tissue, *SETUP[1:]))
    assert told == pytest.approx(2.0 * (1.0 + 0.48) * 2e5)
    values = {"dermis.youngs_modulus": 2.0 * told, "dermis.hyperelastic.c20": 5e4}
    law = with_values((tissue, *SETUP[1:]), values)[0].layer("dermis").hyperelastic
    assert (law.c10, law.c20, law.c30) == pytest.approx((2e5, 5e4, 2e3))


def test_poissons_ratio_changes_at_the_same_modulus() -> None:
    tissue = SETUP[0].with_layer("dermis", hyperelastic={"law": "neo_hookean", "c10": 1e5})
    changed = with_values((tissue, *SETUP[1:]), {"dermis.poisson_ratio": 0.3})
    assert value_of("dermis.youngs_modulus", changed) == pytest.approx(2.0 * 1.48 * 2e5)
    assert changed[0].layer("dermis").hyperelastic.c10 == pytest.approx(1e5 * 1.48 / 1.3)


@pytest.mark.parametrize("key", ["dermis.youngs_modulus", "dermis.poisson_ratio", "tool.radius", "dermis.thickness"])
def test_a_coordinate_gives_its_value_back(key) -> None:
    (one,) = parameters_of(key, SETUP, None)
    assert one.value(one.coordinate(one.start)) == pytest.approx(one.start)
    assert one.limits[0] < one.coordinate(one.start) < one.limits[1]


def test_relaxation_is_a_share_and_a_time() -> None:
    share, time = parameters_of("dermis.relaxation", SETUP, None)
    assert (share.key, time.key) == ("dermis.relaxation.g", "dermis.relaxation.tau")
    assert time.unit == "s"
    assert share.fading
    assert math.isclose(share.start, 0.2)


@pytest.mark.parametrize("key", ["dermis", "bone.youngs_modulus", "dermis.hyperelastic.c20", "law.jm", "tool.tilt"])
def test_what_is_no_positive_number_is_refused_with_what_is_allowed(key) -> None:
    with pytest.raises(InputError, match="allowed"):
        parameters_of(key, SETUP, None)


def test_a_session_may_ask_for_every_law() -> None:
    assert get_args(Law) == tuple(LAW_SHAPES)


@pytest.mark.parametrize(
    ("key", "support", "why"),
    [
        ("dermis.density", Support(), "quasi-static"),
        ("subcutaneous_fat.thickness", Support(kind="half_space"), "endless"),
        ("tool.radius", Support(kind="plates", specimen_radius=5e-3), "covers"),
    ],
)
def test_what_no_force_depends_on_is_refused(key, support, why) -> None:
    setup = (*SETUP[:2], support)
    with pytest.raises(InputError, match=f"--free {key}: no force depends on it.*{why}"):
        refuse_without_effect(key, (setup,))
    with pytest.raises(InputError, match=rf"^\[fit.fixed\] {key}: no force depends on it \(.*{why}"):
        refuse_without_effect(key, (setup,), "[fit.fixed]")
    refuse_without_effect("dermis.thickness", (setup,))


def test_what_a_force_depends_on_in_one_of_two_set_ups_is_taken() -> None:
    covered = (*SETUP[:2], Support(kind="plates", specimen_radius=5e-3))
    refuse_without_effect("tool.radius", (covered, SETUP))
