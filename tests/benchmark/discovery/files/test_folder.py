from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

import benchmark.discovery.files.folder as module
from benchmark.discovery.files import write_discovery
from benchmark.discovery.record import NextExperiment
from benchmark.model_file import read_model


def test_the_folder_holds_everything(record, tmp_path: Path) -> None:
    proposal = NextExperiment(("a", "b"), "slower", "Slower.", 1.0, 9.0, 5.0, {"slower": (9.0, 5.0)}, "schema = 1\n")
    outcome = write_discovery(replace(record, proposal=proposal), tmp_path / "new")
    names = {path.relative_to(outcome.folder).as_posix() for path in outcome.folder.rglob("*") if path.is_file()}
    assert names == {
        "discovery.json", "environment.json", "model.toml", "next_experiment.toml", "report.html",
        "tables/where.csv", "tables/contrasts.csv", "tables/candidates.csv", "tables/gap.csv", "tables/parameters.csv",
    }  # fmt: skip
    assert outcome.headline == record.found.statement
    gap = pd.read_csv(outcome.folder / "tables/gap.csv").set_index("channel")
    assert gap.loc["force_z", "closed"] == 0.99
    assert gap.loc["marker_radial", "unit"] == "mm"
    parameters = pd.read_csv(outcome.folder / "tables/parameters.csv")
    assert list(parameters.part) == ["base", "base", "viscoelastic_relaxation", "viscoelastic_relaxation"]


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
