import pytest

from benchmark.errors import InputError
from benchmark.files import Support, Tool, load_tissue
from benchmark.response.setup_change import RADIUS, THICKNESS, changed_setup, natural_change

SETUP = (load_tissue("skin_forearm"), Tool(radius=5e-3), Support(kind="hole", hole_radius=30e-3))


def test_the_tool_and_the_support_change_by_their_keys() -> None:
    assert changed_setup(*SETUP, RADIUS, 0.1)[1].radius == pytest.approx(5.5e-3)
    assert changed_setup(*SETUP, "support.hole_radius", -0.1)[2].hole_radius == pytest.approx(27e-3)


def test_one_layer_changes_and_the_others_stay() -> None:
    tissue, tool, support = changed_setup(*SETUP, "dermis.youngs_modulus", 0.5)
    for before, after in zip(SETUP[0].layers, tissue.layers, strict=True):
        assert after.youngs_modulus == pytest.approx((1.5 if before.name == "dermis" else 1.0) * before.youngs_modulus)
    assert (tool, support) == SETUP[1:]


def test_the_thickness_of_all_layers_changes_together() -> None:
    layers = changed_setup(*SETUP, THICKNESS, 0.1)[0].layers
    for before, after in zip(SETUP[0].layers, layers, strict=True):
        assert after.thickness == pytest.approx(1.1 * before.thickness)


@pytest.mark.parametrize("key", ["nowhere.youngs_modulus", "tool.colour", "dermis.name"])
def test_what_is_no_number_of_the_set_up_is_refused(key) -> None:
    with pytest.raises(InputError, match=key):
        changed_setup(*SETUP, key, 0.1)


@pytest.mark.parametrize(
    ("told", "share", "changed"), [(5e-3, 0.1, 5.5e-3), (5e-3, -0.1, 4.5e-3), (4.9e-3, -0.1, 4.5e-3), (1e-3, 0.1, 1e-3)]
)
def test_a_sphere_stays_one_and_an_edge_within_its_radius(told, share, changed) -> None:
    tool = Tool(radius=5e-3, contact="rigid_frictionless", edge_radius=told)
    assert changed_setup(SETUP[0], tool, SETUP[2], RADIUS, share)[1].edge_radius == pytest.approx(changed)


def test_constants_of_a_law_change_by_their_keys() -> None:
    told = SETUP[0].layers[0]
    law = {"law": "ogden", "terms": [{"mu": 1e3, "alpha": 2.0}, {"mu": 2e3, "alpha": 4.0}]}
    tissue = SETUP[0].with_layer(told.name, hyperelastic=law)
    changed = changed_setup(tissue, *SETUP[1:], f"{told.name}.hyperelastic.terms.1.mu", 0.1)[0].layers[0]
    assert [term.mu for term in changed.hyperelastic.terms] == pytest.approx([1e3, 2.2e3])
    stiffer = changed_setup(tissue, *SETUP[1:], f"{told.name}.stiffness", 0.1)[0].layers[0]
    assert [term.mu for term in stiffer.hyperelastic.terms] == pytest.approx([1.1e3, 2.2e3])
    assert stiffer.youngs_modulus == pytest.approx(1.1 * told.youngs_modulus)


def test_what_may_be_zero_changes_by_an_amount() -> None:
    told = SETUP[0].layers[0]
    tissue = SETUP[0].with_layer(told.name, hyperelastic={"law": "yeoh", "c10": 1e4})
    key = f"{told.name}.hyperelastic.c20"
    assert changed_setup(tissue, *SETUP[1:], key, 500.0)[0].layers[0].hyperelastic.c20 == 500.0
    assert natural_change(tissue, key) == pytest.approx(2e4)
    assert natural_change(tissue, f"{told.name}.poisson_ratio") == pytest.approx(0.5 - told.poisson_ratio)
    assert natural_change(tissue, RADIUS) == 1.0
