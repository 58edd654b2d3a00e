import pytest

from benchmark.files import load_tissue, scaled_tissue, tissue_from_table
from benchmark.files.sources import Source

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
