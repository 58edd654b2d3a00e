"""The files of a discovery: what stands in discovery.json and the tables, and that the folder is whole."""

import json
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

import benchmark.discovery.report.discovery_files as module
from benchmark.discovery.discovery_result import ChannelSize, ConditionEstimate, Estimate, LookAlike
from benchmark.discovery.report.discovery_files import discovery_document, write_discovery
from benchmark.discovery.report.discovery_record import NextExperiment
from benchmark.model_file import read_model
from reports.atomic import plain


def test_the_contract_of_the_answer(record) -> None:
    document = discovery_document(record)
    assert document["schema"] == 1
    assert document["verdict"] == "named"
    (effect,) = document["effects"]
    assert effect["name"] == "viscoelastic_relaxation"
    assert effect["confidence"] == 0.99
    assert effect["lookalikes"] == ["poroelastic_drainage"]
    assert effect["parameters"]["g_1"] == {"value": 0.31, "unit": "", "ci95": [0.29, 0.33]}
    first = document["where"][0]
    assert first["channel"] == "force_z"
    assert first["phase"] == "hold"
    assert first["cycle"] == 1
    assert first["depth_mm"] == [1.5, 2.0]
    assert (first["size"], first["unit"], first["percent_of_signal"], first["p"]) == (-0.21, "N", -8.1, 0.002)
    assert document["gap"]["force_z"] == {
        "unit": "N", "rmse_before": 0.21, "rmse_after": 0.035, "noise_floor": 0.03, "closed": 0.99,
        "ci95": [0.95, 1.0], "held_out": "condition",
    }  # fmt: skip
    assert document["candidates"][0]["name"] == "viscoelastic_relaxation"
    assert set(document["candidates"][0]) >= {"z", "delta_bic", "gap_closed"}


def test_markers_are_in_millimetres(record) -> None:
    document = discovery_document(record)
    assert document["where"][3]["unit"] == "mm"
    assert abs(document["where"][3]["size"] + 0.021) < 1e-12
    assert document["gap"]["marker_radial"]["unit"] == "mm"
    assert document["smallest_visible_effect"]["marker_radial"] == {"size": 2e-3, "unit": "mm"}
    assert document["base"]["tool_radius"]["unit"] == "mm"
    assert document["base"]["tool_radius"]["ci95"] == pytest.approx([4.9, 5.1])


def test_nothing_found_is_plain_json(empty) -> None:
    document = plain(discovery_document(empty))
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert document["effects"] == []
    assert "next_experiment" not in document


def test_the_proposal_is_told(record) -> None:
    rivals = ("viscoelastic_relaxation", "force_drift")
    menu = {"rest in air": (40.8, 22.0)}
    proposal = NextExperiment(rivals, "rest in air", "Rest.", 6.9, 40.8, 22.0, menu, "schema = 1\n")
    document = discovery_document(replace(record, proposal=proposal))
    assert document["next_experiment"]["rivals"] == list(rivals)
    assert document["next_experiment"]["menu"]["rest in air"] == {"separation": 40.8, "minutes": 22.0}


def test_the_folder_holds_everything(record, tmp_path: Path) -> None:
    proposal = NextExperiment(("a", "b"), "slower", "Slower.", 1.0, 9.0, 5.0, {"slower": (9.0, 5.0)}, "schema = 1\n")
    outcome = write_discovery(replace(record, proposal=proposal), tmp_path / "new")
    names = {path.relative_to(outcome.folder).as_posix() for path in outcome.folder.rglob("*") if path.is_file()}
    assert names == {
        "manifest.json", "discovery.json", "environment.json", "model.toml", "next_experiment.toml", "report.html",
        "tables/where.csv", "tables/contrasts.csv", "tables/candidates.csv", "tables/gap.csv", "tables/parameters.csv",
    }  # fmt: skip
    assert outcome.headline == record.found.statement
    assert (outcome.folder / "report.html").read_text().count("<path") > 50
    gap = pd.read_csv(outcome.folder / "tables/gap.csv").set_index("channel")
    assert gap.loc["force_z", "closed"] == 0.99
    assert gap.loc["marker_radial", "unit"] == "mm"
    parameters = pd.read_csv(outcome.folder / "tables/parameters.csv")
    assert list(parameters.part) == ["base", "base", "viscoelastic_relaxation", "viscoelastic_relaxation"]


@pytest.mark.usefixtures("undrawn")
def test_only_what_is_named_goes_into_the_model(record, empty, tmp_path: Path) -> None:
    write_discovery(record, tmp_path / "named")
    model = read_model(tmp_path / "named/model.toml", record.cards)
    assert model.slugs == ("viscoelastic_relaxation",)
    assert model.effects[0].values() == {"g_1": 0.31, "tau_1": 2.99}
    assert model.evidence["fingerprint"] == record.fingerprint
    outside = replace(record, found=replace(record.found, verdict="outside_catalogue"))
    for name, each in (("empty", empty), ("outside", outside)):
        write_discovery(each, tmp_path / name)
        assert read_model(tmp_path / name / "model.toml", record.cards).effects == ()


@pytest.mark.usefixtures("undrawn")
def test_tables_without_a_row_keep_their_columns(empty, tmp_path: Path) -> None:
    write_discovery(empty, tmp_path / "new")
    where = pd.read_csv(tmp_path / "new/tables/where.csv")
    assert where.empty
    assert list(where)[:3] == ["channel", "phase", "condition"]


def test_a_failure_leaves_nothing(record, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise OSError("the disk is full")

    monkeypatch.setattr(module, "write_page", fail)
    with pytest.raises(OSError, match="disk is full"):
        write_discovery(record, tmp_path / "new")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("undrawn")
def test_an_unknown_floor_is_null_in_every_file(record, tmp_path: Path) -> None:
    gap = tuple(replace(each, noise_floor=None) for each in record.found.gap)
    made = write_discovery(replace(record, found=replace(record.found, gap=gap)), tmp_path / "new")
    assert made.document["gap"]["force_z"]["noise_floor"] is None
    assert pd.read_csv(tmp_path / "new/tables/gap.csv")["noise_floor"].isna().all()
    assert "noise_floor" not in read_model(tmp_path / "new/model.toml", record.cards).evidence["gap"]["force_z"]


@pytest.mark.usefixtures("undrawn")
def test_signs_sizes_and_rivals_stand_in_the_files(record, tmp_path: Path) -> None:
    where = (replace(record.found.where[3], size=-8.8e-5, residual=3.4e-5),)
    rival = LookAlike("poroelastic_drainage", (Estimate("drainage_share", 0.4, "", (0.3, 0.5)),), 0.06, 7.0)
    part = ConditionEstimate("tau_1", "slow", 3.0, "s", (2.9, 3.1), True)
    effect = replace(record.found.effects[0], rivals=(rival,), by_condition=(part,), gain=41.0)
    found = replace(
        record.found, where=where, effects=(effect,), sizes=(ChannelSize("marker_radial", 1e-4, 2e-5, 5e-5),)
    )
    document = write_discovery(replace(record, found=found), tmp_path / "new").document
    assert (document["where"][0]["residual"], document["where"][0]["size"]) == pytest.approx((0.034, -0.088))
    table = pd.read_csv(tmp_path / "new/tables/where.csv")
    assert table["residual"].tolist() == pytest.approx([0.034])
    assert document["size"]["marker_radial"] == pytest.approx(
        {"unit": "mm", "before": 0.1, "after": 0.02, "tolerance": 0.05, "within": True}
    )
    assert document["effects"][0]["rivals"][0]["parameters"]["drainage_share"]["ci95"] == [0.3, 0.5]
    assert document["effects"][0]["by_condition"][0]["agrees"] is True
