"""A tissue file of what was identified: correlations, and what the trials do not determine."""

import pytest

from benchmark.errors import InputError
from benchmark.files import load_scenario, load_tissue, scenario_notes

FILE = """schema = 1
name = "identified"
not_determined = ["{unknown}"]
[[correlations]]
between = ["a.youngs_modulus", "b.youngs_modulus"]
value = {value}
[[layers]]
name = "a"
thickness = "1 mm"
density = "1000 kg/m^3"
youngs_modulus = "100 kPa +/- 10 %"
poisson_ratio = 0.45
[[layers]]
name = "b"
thickness = "5 mm"
density = "1000 kg/m^3"
youngs_modulus = "20 kPa +/- 20 %"
poisson_ratio = 0.45
"""


def written(folder, unknown="a.youngs_modulus", value=-0.9):
    path = folder / "tissue.toml"
    path.write_text(FILE.format(unknown=unknown, value=value))
    return path


def test_it_reads_back_as_it_was_written(tmp_path) -> None:
    told = load_tissue(str(written(tmp_path)))
    (tmp_path / "again.toml").write_text(told.to_toml())
    again = load_tissue(str(tmp_path / "again.toml"))
    assert again == told
    assert again.correlations[0].value == -0.9


def test_what_is_not_determined_is_said_of_every_scenario_that_quotes_it(tmp_path) -> None:
    scenario = load_scenario("skin-5N", {"tissue": str(written(tmp_path))})
    assert any(note.startswith("a.youngs_modulus is quoted but not determined") for note in scenario_notes(scenario))


def test_a_value_that_is_told_instead_is_no_longer_one_that_trials_do_not_determine(tmp_path) -> None:
    changed = {"tissue": str(written(tmp_path)), "a.youngs_modulus": "80 kPa"}
    assert not any("not determined" in note for note in scenario_notes(load_scenario("skin-5N", changed)))
    assert load_tissue(str(written(tmp_path)), overrides={"a.youngs_modulus": "80 kPa"}).not_determined is None
    assert load_tissue(str(written(tmp_path)), overrides={"b.youngs_modulus": "80 kPa"}).not_determined is not None


@pytest.mark.parametrize(("unknown", "value"), [("c.youngs_modulus", 0.1), ("a.youngs_modulus", 1.5)])
def test_other_layers_and_impossible_correlations_are_refused(unknown: str, value: float, tmp_path) -> None:
    with pytest.raises(InputError, match=r"tissue\.toml"):
        load_tissue(str(written(tmp_path, unknown, value)))
