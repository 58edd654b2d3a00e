"""Standard uncertainties beside the values of input files."""

import tomllib

import pytest

from benchmark.errors import InputError
from benchmark.files import Tissue, Tool
from benchmark.files.loading import scenario_from_table
from benchmark.files.schema import validated
from benchmark.files.sources import Source
from benchmark.files.tool import Support, setup_uncertainties

LAYER = {"name": "dermis", "thickness": "1.5 mm", "density": "1116 kg/m^3", "youngs_modulus": "120 kPa +/- 30 %"}
TISSUE = {"name": "skin", "layers": [{**LAYER, "poisson_ratio": "0.48 +/- 0.012"}]}


def tool(**keys):
    return validated(Tool, keys, Source("tool.toml"))


@pytest.mark.parametrize("text", ["5 mm +/- 0.05 mm", "5 mm ± 1 %", "5 mm +/- 50 um", "5mm+/-1%"])
def test_a_quantity_keeps_its_uncertainty_as_a_share_beside_its_value(text):
    read = tool(radius=text)
    assert read.radius == 5e-3
    assert read.own_uncertainties == {"radius": pytest.approx(0.01, rel=1e-12)}


def test_a_quantity_without_one_has_none():
    assert tool(radius="5 mm").own_uncertainties == {}
    assert Tool(radius=5e-3).own_uncertainties == {}


def test_those_of_a_set_up_have_the_keys_of_set():
    tissue = validated(Tissue, TISSUE, Source("skin.toml"))
    hole = validated(Support, {"kind": "hole", "hole_radius": "30 mm +/- 0.3 mm"}, Source("session.toml"))
    stated = setup_uncertainties(tissue, tool(radius="5 mm +/- 2 %"), hole)
    assert stated == {
        "dermis.youngs_modulus": pytest.approx(0.3),
        "dermis.poisson_ratio": pytest.approx(0.025),
        "tool.radius": pytest.approx(0.02),
        "support.hole_radius": pytest.approx(0.01),
    }


def test_it_is_written_back_and_reads_the_same():
    tissue = validated(Tissue, TISSUE, Source("skin.toml"))
    table = tomllib.loads(tissue.to_toml())
    assert table["layers"][0]["youngs_modulus"] == "120 kPa +/- 30 %"
    again = validated(Tissue, table, Source("again.toml"))
    assert again == tissue
    assert again.uncertainties == tissue.uncertainties


def test_models_that_differ_in_it_differ():
    assert tool(radius="5 mm +/- 1 %") != tool(radius="5 mm")


def test_a_layer_that_is_changed_loses_it_for_what_changed_alone():
    changed = validated(Tissue, TISSUE, Source("skin.toml")).with_layer("dermis", youngs_modulus=1e5)
    assert set(changed.uncertainties) == {"dermis.poisson_ratio"}


def test_set_gives_one_in_a_scenario():
    table = {"name": "press", "tissue": TISSUE, "tool": {"radius": "5 mm"}, "load": {"control": "force", "peak": "1 N"}}
    made = scenario_from_table(table, Source("press.toml"), {"tool.radius": "4 mm +/- 3 %"})
    assert made.tool.radius == 4e-3
    assert made.uncertainties["tool.radius"] == pytest.approx(0.03)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("5 mm +/- 0 mm", "above 0 % and below 100 % of the value"),
        ("5 mm +/- 100 %", "above 0 % and below 100 % of the value"),
        ("5 mm +/- 6 mm", "above 0 % and below 100 % of the value"),
        ("5 mm +/- -1 %", "above 0 % and below 100 % of the value"),
        ("5 mm +/- 3 kPa", "is a pressure, not a length"),
        ("5 mm +/- 0.05", "has no unit"),
        ("5 mm +/-", "is not a finite number with a unit"),
        ("5 +/- 1 %", "has no unit"),
        ("5 +/- 0.05 mm", "the value '5' has no unit; write it to both, '5 mm +/- 0.05 mm'"),
        ("5.e0±1e-1mm", "write it to both, '5.e0 mm +/- 1e-1mm'"),
        ("5 mm +/- 1 mm +/- 1 mm", "has an uncertainty, which is not read here"),
    ],
)
def test_one_that_cannot_be_is_refused_at_its_key(text, why):
    with pytest.raises(InputError, match=r"tool\.toml.*radius") as error:
        tool(radius=text)
    assert why in str(error.value)


def test_a_key_that_takes_none_says_so():
    """It said that the unit N +/- 1 % is not known."""
    for peak in ("1 N +/- 1 %", "500 +/- 20 N", "1 N ± 0.1 N"):
        table = {"name": "press", "tissue": TISSUE, "tool": {"radius": "5 mm"}, "load": {"peak": peak}}
        with pytest.raises(
            InputError, match=r"load\.peak.*has an uncertainty, which is not read here; give a force alone"
        ):
            scenario_from_table(table, Source("press.toml"), {})
