"""The plan of a sweep: usable points and others, and how one sweep differs from another."""

import json

import pytest
import tomli_w

from benchmark.errors import InputError
from benchmark.files import Scenario, load_scenario, load_tissue
from benchmark.sweeps.plan import differences


def test_every_point_has_its_scenario(plan_of) -> None:
    plan = plan_of("dermis.youngs_modulus=50 kPa,100 kPa", "tool.radius=2 mm,5 mm")
    assert [scenario.tool.radius for scenario in plan.scenarios] == [2e-3, 5e-3, 2e-3, 5e-3]
    assert [scenario.tissue.layer("dermis").youngs_modulus for scenario in plan.scenarios] == [5e4, 5e4, 1e5, 1e5]
    assert plan.scenario.tool.radius == 5e-3


def test_tissues_can_vary(plan_of) -> None:
    plan = plan_of("tissue=skin_forearm,skin_traction")
    assert [len(scenario.tissue.layers) for scenario in plan.scenarios] == [3, 2]


def test_a_point_whose_values_do_not_go_together_is_kept_with_the_reason(plan_of) -> None:
    plan = plan_of("tool.radius=5 mm,40 mm", "wave.window=60 mm,100 mm")
    good, narrow = plan.scenarios[0], plan.scenarios[2]
    assert isinstance(good, Scenario)
    assert isinstance(narrow, str)
    assert "--vary wave.window" in narrow
    assert "--set wave.window" not in narrow


@pytest.mark.parametrize(
    ("vary", "word"),
    [
        ("dermiss.youngs_modulus=1 kPa,2 kPa", "--vary dermiss"),
        ("tool.radius=1 kPa,2 kPa", "--vary tool.radius"),
        ("fem.mesh=coarse,fine", "twice"),
    ],
)
def test_a_key_that_no_point_can_use_is_refused(plan_of, vary: str, word: str) -> None:
    with pytest.raises(InputError, match=word):
        plan_of(vary)


def test_one_key_twice_is_refused(plan_of) -> None:
    with pytest.raises(InputError, match=r"tool\.radius is given twice"):
        plan_of("tool.radius=1 mm,2 mm", "tool.radius=3 mm,4 mm")


def differing(one, other) -> list[str]:
    return differences(*(json.loads(json.dumps(plan.document)) for plan in (one, other)))


def test_the_same_command_is_the_same_sweep(plan_of) -> None:
    assert differing(plan_of("tool.radius=1 mm,2 mm"), plan_of("tool.radius=1 mm,2 mm")) == []


def test_a_varied_tissue_whose_file_has_changed_is_another_sweep(plan_of, tmp_path) -> None:
    mine = tmp_path / "mine.toml"
    vary = (f"tissue=skin_forearm,{mine}", "tool.radius=1 mm,2 mm")
    mine.write_text(load_tissue("skin_forearm").to_toml())
    before = plan_of(*vary)
    assert differing(before, plan_of(*vary)) == []
    mine.write_text(load_tissue("skin_forearm", overrides={"dermis.youngs_modulus": "120 kPa"}).to_toml())
    (said,) = differing(before, plan_of(*vary))
    assert said.startswith(f"files.tissue {mine} (")
    assert "files" not in plan_of("tool.radius=1 mm,2 mm").document


def test_a_varied_load_whose_file_has_changed_is_another_sweep(plan_of, tmp_path) -> None:
    load, usual = tmp_path / "load.csv", tmp_path / "usual.csv"
    for each in (load, usual):
        each.write_text("time_s,force_N\n1,0.1\n2,0.5\n")
    file = tmp_path / "mine.toml"
    mine = {**load_scenario("skin-5N").to_table(), "load": {"shape": "table", "file": str(usual)}}
    file.write_text(tomli_w.dumps(mine))
    before = plan_of(f"load.file={load}", scenario=str(file))
    load.write_text("time_s,force_N\n1,0.1\n2,0.6\n")
    (said,) = differing(before, plan_of(f"load.file={load}", scenario=str(file)))
    assert said.startswith(f"files.load.file {load} (")


def test_differences_are_named(plan_of) -> None:
    base = plan_of("tool.radius=1 mm,2 mm")
    assert differing(base, plan_of("tool.radius=1 mm,3 mm")) == [
        "vary.tool.radius ('1 mm,2 mm' there, '1 mm,3 mm' here)"
    ]
    said = " ".join(differing(base, plan_of("dermis.thickness=1 mm,2 mm", seed=5)))
    for word in ("vary.tool.radius", "nothing here", "vary.dermis.thickness", "seed (0 there, 5 here)"):
        assert word in said
    assert "scenario.load.peak ('0.5 N' there, '2 N' here)" in " ".join(
        differing(base, plan_of("tool.radius=1 mm,2 mm", load_peak="2 N"))
    )
    thick = plan_of("tool.radius=1 mm,2 mm", scenario="skin-5N", dermis_thickness="2 mm")
    assert "scenario.tissue.layers.dermis.thickness ('1.5 mm' there, '2 mm' here)" in " ".join(differing(base, thick))


def test_points_drawn_differently_are_a_difference_of_their_own() -> None:
    there = {"vary": {"a": "1:2"}, "points_sha256": "one"}
    assert differences(there, {**there, "points_sha256": "two"}) == ["points_sha256 ('one' there, 'two' here)"]
    assert not any("sha" in text for text in differences(there, {"vary": {"a": "1:3"}, "points_sha256": "two"}))
