"""`benchmark report` on finished runs: the page made again, runs side by side."""

import base64
import json
import shutil
from pathlib import Path

import pandas as pd
import pytest

from benchmark.cli.app import main
from benchmark.gate.history.history_file import HistoryEntry, append
from benchmark.runs.output.pressed import Drawn

SMALL = ("--set", "fem.mesh=coarse", "--set", "load.observations=6", "--set", "load.peak=1 N", "--quiet")


DOT = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNgAAAAAgABSK+kcQAAAABJRU5ErkJggg==")
"""A PNG of one pixel, in the place of the picture of the pressed tissue."""


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("runs")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("benchmark.runs.output.pressed.draw_pressed", lambda *_: Drawn(DOT))
        assert main(["run", "skin-5N", *SMALL, "--out", str(folder / "first")]) == 0
    assert (folder / "first" / "pictures" / "pressed.png").read_bytes() == DOT
    stiff = ("--set", "dermis.youngs_modulus=2 MPa", "--set", "support.kind=half_space")
    assert main(["run", "skin-5N", *SMALL, *stiff, "--out", str(folder / "second")]) == 0
    return folder / "first", folder / "second"


def test_lines_of_a_history_that_cannot_be_read_are_told_on_stderr(benchmark_cli, tmp_path: Path) -> None:
    """They were told on the page alone."""
    path = tmp_path / "h.jsonl"
    for number in (1, 2):
        append(path, HistoryEntry(f"2026-01-0{number}T00:00", "abc", "A", None, True, {"mm": 1.0}, {}))
    whole = benchmark_cli("report", path, "--out", tmp_path / "page")
    assert (whole.code, whole.err) == (0, "")
    path.write_bytes(path.read_bytes()[:-40])
    for words in ((), ("--json",)):
        torn = benchmark_cli("report", path, "--out", tmp_path / "page", *words)
        assert (torn.code, torn.err) == (0, f"  warning: {path}: 1 line of the file cannot be read: left out here.\n")
    assert benchmark_cli("report", path, "--out", tmp_path / "page", "--quiet").err == ""


def test_the_page_of_a_run_is_made_again_letter_by_letter(benchmark_cli, runs, tmp_path: Path) -> None:
    for folder in runs:
        before = (folder / "report.html").read_text()
        assert benchmark_cli("report", folder, "--out", tmp_path / folder.name).code == 0
        assert (tmp_path / folder.name / "report.html").read_text() == before
        (folder / "report.html").unlink()
        assert benchmark_cli("report", folder).code == 0
        assert (folder / "report.html").read_text() == before


def test_side_by_side_names_what_changed(benchmark_cli, runs, tmp_path: Path) -> None:
    called = benchmark_cli("report", *runs, "--out", tmp_path / "both", "--json")
    assert called.code == 0
    document = json.loads(called.out)
    changed = pd.read_csv(tmp_path / "both/tables/parameters.csv").set_index("parameter")
    assert dict(changed.loc["dermis.youngs_modulus"]) == {"first": "960 kPa", "second": "2 MPa"}
    assert dict(changed.loc["support.kind"]) == {"first": "bonded", "second": "half_space"}
    assert set(changed.index) == {"dermis.youngs_modulus", "support.kind"}
    table = pd.read_csv(tmp_path / "both/tables/runs.csv").set_index(["run", "layer"])
    for folder in runs:
        largest = pd.read_csv(folder / "tables/max_deformation.csv").groupby("layer")[["fem_mm", "wave_mm"]].max()
        for layer, row in largest.iterrows():
            found = table.loc[(folder.name, layer)]
            assert found.fem_max_mm == pytest.approx(row.fem_mm, rel=1e-12)
            assert found.wave_max_mm == pytest.approx(row.wave_mm, rel=1e-12, nan_ok=True)
    assert [each["name"] for each in document["runs"]] == ["first", "second"]
    page = (tmp_path / "both/report.html").read_text()
    assert "range low <span" in page
    assert "95 % low" not in page
    assert "2 parameters of the scenario differ." in page
    for text in ("first, FEM", "first, wave model", "second, FEM", "Change against first"):
        assert text in page
    assert "second, wave model" not in page


def test_files_changed_by_hand_are_named_and_stay_so_in_a_copy(benchmark_cli, runs, tmp_path: Path) -> None:
    """A run whose results were edited was shown, and compared, as if they were its own."""
    edited, copy = tmp_path / "edited", tmp_path / "copy"
    shutil.copytree(runs[0], edited)
    for name in ("results.json", "scenario.toml", "notes.txt"):
        with (edited / name).open("a") as stream:
            stream.write("\n")
    said = f"{edited}: not as they were written: results.json, scenario.toml; what follows is of the changed files"
    for words in ((edited, "--out", copy), (edited,), (runs[1], edited, "--out", tmp_path / "both")):
        called = benchmark_cli("report", *words)
        assert (called.code, called.err) == (0, f"  warning: {said}\n")
    for page in (copy, edited, tmp_path / "both"):
        assert said in (page / "report.html").read_text()
    assert json.loads((copy / "results.json").read_text())["warnings"][-1] == said
    assert benchmark_cli("report", copy).err == ""
    assert (copy / "report.html").read_text().count(said) == 1
    assert benchmark_cli("report", *runs, "--out", tmp_path / "untouched").err == ""


@pytest.mark.usefixtures("undrawn")
def test_side_by_side_names_other_models(benchmark_cli, runs, tmp_path: Path) -> None:
    fea = runs[0] / "tables/max_deformation.csv"
    assert main(["run", "skin-5N", *SMALL, "--reference", str(fea), "--out", str(tmp_path / "mine")]) == 0
    assert benchmark_cli("report", runs[0], tmp_path / "mine", "--out", tmp_path / "both").code == 0
    page = (tmp_path / "both/report.html").read_text()
    assert "The scenarios are the same, the models differ." in page
    assert "FEM and wave model, made" in page
    assert "FEA of max_deformation.csv and wave model, made" in page


@pytest.mark.slow
def test_a_stopped_run_keeps_its_failure(benchmark_cli, tmp_path: Path) -> None:
    soft = [f"{layer}.youngs_modulus=10 kPa" for layer in ("epidermis", "dermis", "subcutaneous_fat")]
    settings = [text for each in soft for text in ("--set", each)]
    out = tmp_path / "r"
    called = benchmark_cli(
        "run",
        "skin-5N",
        "--set",
        "fem.mesh=coarse",
        "--set",
        "load.observations=20",
        *settings,
        "--out",
        out,
        "--quiet",
    )
    assert called.code == 4
    before = (out / "report.html").read_text()
    assert benchmark_cli("report", out).code == 0
    assert (out / "report.html").read_text() == before


@pytest.mark.parametrize("what", ["missing", "a file", "not a run", "broken table"])
def test_what_is_no_run_is_refused_and_left_alone(benchmark_cli, tmp_path: Path, runs, what: str) -> None:
    folder = tmp_path / "r"
    if what == "a file":
        folder.write_text("layer,fem_mm\n")
    if what == "not a run":
        folder.mkdir()
        (folder / "results.json").write_text('{"schema": 1}')
    if what == "broken table":
        (folder / "tables").mkdir(parents=True)
        for source in [*runs[0].glob("*.json"), runs[0] / "scenario.toml", *runs[0].glob("tables/*.csv")]:
            (folder / source.relative_to(runs[0])).write_text(source.read_text())
        (folder / "tables/timing.csv").write_text("model,repeat,setup_s,wall_s,cpu_s\nfem,1,soon,1,1\n")
    called = benchmark_cli("report", folder)
    assert called.code == 2
    assert str(folder) in called.err.replace("\n", "")
    assert "Errno" not in called.err
    assert not (folder / "report.html").exists()


def test_a_run_beside_itself_is_refused(benchmark_cli, runs) -> None:
    called = benchmark_cli("report", runs[0], runs[0])
    assert called.code == 2
    assert "give each one once" in called.err
