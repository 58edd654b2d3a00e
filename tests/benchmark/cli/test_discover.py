"""`benchmark discover` on finished runs, on unusable input, and with an algorithm put in for a session."""

import json
import shutil
from pathlib import Path

import pandas as pd
import pytest

from benchmark.cli.app import main
from benchmark.discovery import discovery_request
from benchmark.discovery.discovery_request import DiscoverRequest, carry_out
from benchmark.discovery.report.discovery_files import DiscoveryOutcome
from benchmark.errors import DeviceError
from benchmark.sessions import SHIPPED

PHANTOM = SHIPPED / "phantom"
COARSE = ("--set", "fem.mesh=coarse", "--set", "load.observations=20", "--set", "wave.large_press=linear")


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small skin press, run once."""
    from benchmark.cli.app import main

    out = tmp_path_factory.mktemp("run") / "press"
    assert main(["run", "skin-5N", *COARSE, "--out", str(out), "--quiet"]) == 0
    return out


@pytest.mark.usefixtures("undrawn")
def test_a_run_ends_in_stiffening_and_the_model_file_repairs_it(benchmark_cli, finished: Path, tmp_path: Path) -> None:
    called = benchmark_cli("discover", finished, "--out", tmp_path / "d", "--json", "--quiet")
    assert called.code == 0, called.err
    document = json.loads(called.out)
    assert document["verdict"] == "conditional"
    assert [effect["name"] for effect in document["effects"]] == ["strain_stiffening"]
    assert document["gap"]["force_z"]["closed"] > 0.95
    assert set(document["layers"]) == {"epidermis", "dermis", "subcutaneous_fat"}

    model = tmp_path / "d/model.toml"
    called = benchmark_cli("run", "skin-5N", *COARSE, "--model", model, "--out", tmp_path / "after", "--quiet")
    assert called.code == 0, called.err
    errors = [
        pd.read_csv(folder / "tables/max_deformation.csv").percent_error.abs().max()
        for folder in (finished, tmp_path / "after")
    ]
    assert errors[0] > 20.0
    assert errors[1] < 5.0
    assert json.loads((tmp_path / "after/results.json").read_text())["effects"] == ["strain_stiffening"]
    assert (tmp_path / "after/model.toml").is_file()
    assert "strain stiffening" in (tmp_path / "after/report.html").read_text()


@pytest.mark.slow
def test_stiffening_is_told_from_a_floor(benchmark_cli, tmp_path: Path) -> None:
    """Both bend the fitted half of the shipped press upwards; a floor is worse there, and beyond."""
    press, out = tmp_path / "press", tmp_path / "d"
    called = benchmark_cli("run", "skin-5N", "--set", "wave.large_press=linear", "--out", press, "--quiet")
    assert called.code == 0, called.err
    called = benchmark_cli("discover", press, "--out", out, "--json", "--quiet")
    assert called.code == 0, called.err
    document = json.loads(called.out)
    assert [effect["name"] for effect in document["effects"]] == ["strain_stiffening"]
    assert document["effects"][0]["lookalikes"] == []
    bic = {each["name"]: each["delta_bic"] for each in document["candidates"]}
    assert bic["bottoming_out"] > bic["strain_stiffening"] + 10.0
    assert max(abs(layer["percent_at_peak_after"]) for layer in document["layers"].values()) < 5.0


def test_unusable_input_is_exit_2_and_leaves_nothing(benchmark_cli, finished: Path, tmp_path: Path) -> None:
    out = ("--out", tmp_path / "d", "--quiet")
    few = tmp_path / "few"
    few.mkdir()
    for source in sorted(PHANTOM.glob("press_0[2-3].csv")):
        shutil.copy(source, few)
    cases = [
        (("discover", tmp_path / "nowhere"), "nowhere"),
        (("discover", few), "at least 3"),
        (("discover", PHANTOM, PHANTOM), "one session"),
        (("discover", finished, PHANTOM), "is none"),
        (("discover", finished, "--model", "fem"), "leave it out"),
        (("discover", finished, "--set", "a=b"), "belong to a session"),
        (("discover", PHANTOM, "--effects", tmp_path / "no.py"), "no such effects file"),
        (("discover", finished, "--refit", "found"), "belong to a session"),
        (("discover", finished, "--bench", "simulated"), "belong to a session"),
        (("run", "--model", tmp_path / "m.toml"), "needs a SCENARIO"),
        (("run", "skin-5N", "--model", tmp_path / "m.toml"), "no such model file"),
        (("fit", PHANTOM, "--effects", tmp_path / "e.py"), "--model"),
    ]
    for arguments, words in cases:
        called = benchmark_cli(*arguments, *out)
        assert called.code == 2, arguments
        assert words in " ".join(called.err.split()), arguments
        assert not (tmp_path / "d").exists()


def test_a_folder_that_is_no_result_is_refused_before_the_work(tmp_path: Path, monkeypatch) -> None:
    (tmp_path / "thesis.tex").touch()

    def never(*_: object):
        raise AssertionError("the work began")

    from benchmark.cli.console import Console
    from benchmark.errors import InputError

    monkeypatch.setattr("benchmark.discovery.discovery_request.findings", never)
    with pytest.raises(InputError, match="not a result"):
        carry_out(DiscoverRequest([PHANTOM], out=tmp_path), Console(quiet=True))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--budget", "2"), "give --bench with it"),
        (("--refit", "backlash,strain_stifening"), "did you mean strain_stiffening"),
        (("--refit", "Found"), "did you mean found"),
        (("--refit", ","), "names no effect"),
    ],
)
def test_options_that_can_change_nothing_are_refused_before_the_work(
    benchmark_cli, monkeypatch, options, words
) -> None:
    def never(*_: object):
        raise AssertionError("the work began")

    monkeypatch.setattr(discovery_request, "carry_out", never)
    called = benchmark_cli("discover", PHANTOM, *options)
    assert called.code == 2
    assert words in " ".join(called.err.split())


def test_an_effect_of_the_set_up_is_looked_up_once_the_session_is_known(monkeypatch) -> None:
    asked = []

    def noted(request: DiscoverRequest, _: object) -> DiscoveryOutcome:
        asked.append(request)
        return DiscoveryOutcome(Path("found"), {"name": "gel", "verdict": "named"}, "", (), (), None)

    monkeypatch.setattr(discovery_request, "carry_out", noted)
    assert main(["discover", "phantom", "--refit", "setup.tool.radius, backlash"]) == 0
    assert (asked[0].refit, asked[0].budget) == ("setup.tool.radius, backlash", 3)


def test_a_bench_that_fails_gives_the_exit_code_after_the_answer_so_far(tmp_path: Path, monkeypatch, capsys) -> None:
    document = {"name": "gel", "verdict": "lookalikes"}
    outcome = DiscoveryOutcome(tmp_path / "found", document, "Two stand.", (), (), DeviceError("--bench: it is silent"))
    monkeypatch.setattr(discovery_request, "carry_out", lambda *_: outcome)
    assert main(["discover", "gel", "--bench", "rig.toml"]) == 5
    printed = capsys.readouterr()
    assert printed.out.startswith("gel: lookalikes: Two stand.")
    assert "error: --bench: it is silent; the answer so far is in" in printed.err
    assert str(tmp_path / "found") in printed.err.replace("\n", "")
