"""The wave models as elastic tables: derivatives by the keys of `--set`."""

import pytest

from benchmark.files import Support, Tool, load_tissue
from benchmark.response.setup_change import RADIUS, THICKNESS, changed_setup
from benchmark.response.wave_table import wave_table

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
