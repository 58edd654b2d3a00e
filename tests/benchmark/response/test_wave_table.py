"""The wave models as elastic tables: derivatives by the keys of `--set`."""

from collections.abc import Callable

import numpy as np
import pytest

import fem
from benchmark.errors import InputError
from benchmark.files import Layer, Support, Tool, load_tissue
from benchmark.files.tissue import Fibre, Yeoh
from benchmark.response.setup_change import RADIUS, THICKNESS, changed_setup
from benchmark.response.wave_table import wave_ramp, wave_table

TISSUE = load_tissue("rtv3498_sheet")
SETUP = (TISSUE, Tool(radius=5e-3, contact="rigid_bonded"), Support(kind="hole", hole_radius=30e-3))
MODULUS = f"{TISSUE.layer_names[0]}.youngs_modulus"


def test_derivatives_foretell_another_set_up() -> None:
    table = wave_table(*SETUP, 3e-3, (RADIUS, THICKNESS, MODULUS))
    assert table.depth[-1] >= 3e-3
    assert table.by[MODULUS].force[0] == pytest.approx(table.force, rel=1e-6)  # the force goes with the modulus
    assert table.by[MODULUS].outward[0].table == pytest.approx(0.0, abs=1e-9)
    for key in (RADIUS, THICKNESS):
        other = wave_table(*changed_setup(*SETUP, key, 0.03), 3e-3, ())
        deep = slice(100, None)
        assert table.force_with({key: 0.03})[deep] == pytest.approx(other.force[deep], rel=3e-3)
        assert other.force[-1] > 1.005 * table.force[-1]


def test_a_key_that_the_table_lacks_changes_nothing() -> None:
    table = wave_table(*SETUP, 3e-3, ())
    assert (table.force_with({RADIUS: 0.1}) == table.force).all()
    assert table.sink_with({RADIUS: 0.1}) is table.sink


SHAPE = (0.5, 0.5, 0.2)
"""c10, c20 and c30 over the shear modulus at rest."""


def stiffening(layer: Layer, **changes: object) -> Layer:
    """The same layer with a law that stiffens and without relaxation."""
    mu = layer.youngs_modulus / (2 * (1 + layer.poisson_ratio))
    law = Yeoh(law="yeoh", **{name: share * mu for name, share in zip(("c10", "c20", "c30"), SHAPE, strict=True)})
    return layer.model_copy(update={"hyperelastic": law, "relaxation": (), **changes})


def test_the_wave_follows_the_layers_laws() -> None:
    """Beside the finite elements, which solve the same laws in another way."""
    depth, tool, base = np.linspace(0.0, 3e-3, 4), Tool(radius=5e-3, contact="uniform_pressure"), Support(kind="bonded")
    skin = load_tissue("skin_forearm")
    tissue = skin.model_copy(update={"layers": tuple(map(stiffening, skin.layers))})
    found = wave_ramp(tissue, tool, base, depth).force

    def pressed(material: Callable[[float, float], fem.Material]) -> np.ndarray:
        layers = [
            fem.Layer(one.name, one.thickness, one.density, material(one.youngs_modulus, one.poisson_ratio))
            for one in skin.layers
        ]
        problem = fem.Problem(tuple(layers), fem.Tool(5e-3, "uniform_pressure"), fem.Support("bonded"))
        return fem.prepare(problem).run(fem.Load("depth", depth[1:], depth[1:])).force

    expected = pressed(lambda E, nu: fem.Yeoh(*(share * E / (2 * (1 + nu)) for share in SHAPE), nu))
    assert found[1:] == pytest.approx(expected, rel=3e-3)
    assert found[-1] > 1.2 * pressed(fem.NeoHookean)[-1]


@pytest.mark.parametrize(
    ("contact", "changes", "said"),
    [
        ("rigid_frictionless", {}, "follows no law"),
        ("uniform_pressure", {"fibre": Fibre(k1=1e4, k2=1.0, angle=0.3)}, "fibres in one direction"),
    ],
)
def test_a_law_that_the_wave_would_not_follow_is_refused(contact, changes, said) -> None:
    tissue = TISSUE.model_copy(update={"layers": (stiffening(TISSUE.layers[0], **changes),)})
    tool = Tool(radius=5e-3, contact=contact, edge_radius=1e-3)
    with pytest.raises(InputError, match=said):
        wave_ramp(tissue, tool, SETUP[2], np.linspace(0, 5e-3, 3))
