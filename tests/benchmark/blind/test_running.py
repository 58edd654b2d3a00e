"""The verb and its runner with a stub in the discovery's place: resumed, tables written, errors said."""

import json
import re
from pathlib import Path

import pytest

from benchmark.blind import blind_folder
from benchmark.blind.running import load_discoverer
from benchmark.blind.suites import chosen, suite
from benchmark.cli.app import main
from benchmark.errors import InputError
from reports import whole_folder

STUB = '''
from pathlib import Path
from benchmark.discovery.discovery_result import Discovery, NamedEffect

def always(session, *, seed):
    """Answers adhesion, and raises for sessions without markers."""
    with Path({log!r}).open("a") as log:
        log.write(session.name + "\\n")
    if session.camera is None:
        raise ValueError("no camera")
    effects = (NamedEffect("adhesion", 1.0, (), ()),)
    return Discovery("named", "", 0.01, effects, (), (), (), {{}}, (), (), (), (), (), (), (), (), 1.0)
'''


@pytest.fixture
def stub(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    log = tmp_path / "calls.txt"
    (tmp_path / "stub_for_blind.py").write_text(STUB.format(log=str(log)))
    monkeypatch.syspath_prepend(str(tmp_path))
    return log


def test_why_a_discoverer_is_not_there_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mine_for_blind.py").write_text("from benchmark.discovery import Moved\n")
    (tmp_path / "broken_for_blind.py").write_text("def always(:\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    for name, reason in (
        ("no_module:at_all", "no such function; allowed"),
        ("json:at_all", "no such function; allowed"),
        ("mine_for_blind:always", "no such function; ImportError: cannot import name 'Moved'"),
        ("broken_for_blind:always", "no such function; SyntaxError: "),
    ):
        with pytest.raises(InputError, match=re.escape(reason)):
            load_discoverer(name)


def test_suites() -> None:
    first = suite("first")
    assert len(first) == 22 * 5 + 40
    assert len({case.text for case in suite("full")}) == len(suite("full"))
    assert {case.slug for case in chosen(first, ("adhesion", "null"))} == {"adhesion", ""}
    with pytest.raises(InputError, match="allowed: small, first"):
        suite("huge")
    full = suite("full")
    assert {case.lab for case in chosen(full, (), ("printed", "anything"))} == {"printed", "anything"}
    assert {(case.slug, case.lab) for case in chosen(full, ("adhesion",), ("printed",))} == {("adhesion", "printed")}
    with pytest.raises(InputError, match=r"--labs 'printe': no case of this suite; allowed: another_camera, anything"):
        chosen(full, (), ("printe",))
    with pytest.raises(InputError, match="adhesio"):
        chosen(first, ("adhesio",))


def test_the_verb_counts_resumes_and_redoes(stub: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    command = ["blind", "--cases", "adhesion,dry_friction", "--discoverer", "stub_for_blind:always", "--out", str(out)]
    command += ["--workers", "1", "--quiet", "--json", "--seed", "3"]  # seed 3: no markers where the force shows it
    assert main(command) == 0
    document = json.loads(capsys.readouterr().out)
    rows = {row["measure"]: row for row in document["rows"]}
    assert document["synthetic"] is True
    assert rows["cases with an error"]["value"] == 1.0
    assert {path.name for path in out.iterdir()} == {
        "settings.json",
        "blind.json",
        "cases.csv",
        "confusion.csv",
        "table.md",
        "manifest.json",
        "report.html",
    }
    assert len(stub.read_text().splitlines()) == 2

    from benchmark.blind.running import run_cases
    from benchmark.blind.scoring.judging import Judged

    journal = tmp_path / "cases.jsonl"
    names = chosen(suite("small"), ("adhesion", "camera_latency"))
    first = run_cases(names[:1], "stub_for_blind:always", journal, 1, lambda *_: None)
    told: list[tuple[int, int, Judged | None]] = []
    both = run_cases(names, "stub_for_blind:always", journal, 1, lambda *news: told.append(news))
    assert len(stub.read_text().splitlines()) == 4
    assert both[0] == first[0]
    assert [news[0] for news in told] == [1, 2]

    journal.write_text(journal.read_text().replace('"said": "adhesion"', '"said": "none"', 1))
    said: list[str] = []
    both = run_cases(names, "stub_for_blind:always", journal, 1, lambda *_: None, say=said.append)
    assert len(said) == 1
    assert "1 row changed since written" in said[0]
    assert {case.truth: case.said for case in both} == {"adhesion": "adhesion", "camera_latency": "adhesion"}


@pytest.mark.parametrize(
    ("option", "value", "said"),
    [
        ("--suite", "huge", "no such suite"),
        ("--discoverer", "benchmark.discovery:nothing_there", "module:function"),
        ("--cases", "nothing", "no case of this suite"),
    ],
)
def test_what_cannot_be_used_is_said(option, value, said, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["blind", option, value, "--out", str(out)]) == 2
    assert said in capsys.readouterr().err.replace("\n", " ")
    assert not out.exists()


def test_a_print_scatter_is_in_the_cases_names(stub: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["blind", "--cases", "perspective", "--discoverer", "stub_for_blind:always", "--workers", "1", "--quiet"]
    assert main([*command, "--print-scatter", "0.06 mm", "--out", str(tmp_path / "out")]) == 0
    assert "perspective:0:D20:print0.06mm" in (tmp_path / "out/cases.csv").read_text()
    assert json.loads((tmp_path / "out/settings.json").read_text())["print_scatter"] == "0.06 mm"
    assert main([*command, "--print-scatter", "6 mm"]) == 2
    assert "allowed: 0 mm to 1 mm" in capsys.readouterr().err


def test_a_blind_run_replaces_a_result_as_a_whole_and_a_stopped_one_is_gone_on_with(
    stub: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    with whole_folder(out) as new:
        (new / "results.json").write_text("{}")
    command = ["blind", "--cases", "perspective", "--discoverer", "stub_for_blind:always", "--workers", "1", "--quiet"]
    with monkeypatch.context() as stopped:
        stopped.setattr("benchmark.blind.running._work", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
        assert main([*command, "--out", str(out)]) == 130
    assert {path.name for path in out.iterdir()} == {"settings.json", "cases.jsonl", "manifest.json"}
    assert (tmp_path / ".out.previous" / "results.json").is_file()
    assert main([*command, "--seed", "4", "--out", str(out)]) == 2
    for _ in range(2):  # the second one begins anew
        assert main([*command, "--out", str(out)]) == 0
        assert not (tmp_path / ".out.previous").exists()
        assert not {"results.json", "cases.jsonl"} & {path.name for path in out.iterdir()}


def test_a_foreign_folder_is_refused(stub: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["blind", "--discoverer", "stub_for_blind:always", "--out", str(tmp_path)]) == 2
    assert "no blind run" in capsys.readouterr().err.replace("\n", " ")


@pytest.mark.slow
def test_a_dask_cluster_works_instead_of_processes(stub: Path, tmp_path: Path) -> None:
    import distributed

    from benchmark.blind.running import run_cases

    names = chosen(suite("small"), ("adhesion", "camera_latency"))
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        found = run_cases(
            names, "stub_for_blind:always", tmp_path / "cases.jsonl", cluster.scheduler_address, lambda *_: None
        )
        assert {case.truth: case.said for case in found} == {"adhesion": "adhesion", "camera_latency": "adhesion"}
        lost = run_cases(
            names[:1], "no_module:at_all", tmp_path / "other.jsonl", cluster.scheduler_address, lambda *_: None
        )
    assert lost[0].verdict == "error"
    assert "there is no such function" in lost[0].remark


def test_the_first_cases_of_a_mixed_suite(stub: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    command = ["blind", "--suite", "labs", "--seed", "6", "--most", "2", "--discoverer", "stub_for_blind:always"]
    assert main([*command, "--workers", "1", "--quiet", "--json", "--out", str(out)]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["most"] == 2
    rows = {row["measure"]: row for row in document["rows"]}
    assert "is_share" not in rows["right name first"]
    assert rows["nulls named, all labs"]["bar"] == "<= 0.01"
    written = (out / "cases.csv").read_text().splitlines()
    assert len(written) == 3
    assert written[0].endswith("family,lab,conditions,markers,trials,setup_off,experiments,set_before,unexplained")
    assert [name.text for name in suite("labs", 6)[:2]] == [line.partition(",")[0] for line in written[1:]]


def test_a_stopped_run_goes_on_by_the_code_that_began_it_alone(tmp_path, monkeypatch) -> None:
    settings = {"suite": "small", "seed": 0}
    journal = blind_folder.open_folder(tmp_path / "b", settings)
    assert blind_folder.open_folder(tmp_path / "b", settings) == journal
    monkeypatch.setattr(blind_folder, "code_version", lambda: "another")
    with pytest.raises(InputError, match="a stopped blind run with other code of the program"):
        blind_folder.open_folder(tmp_path / "b", settings)
    with pytest.raises(InputError, match="a stopped blind run with other settings"):
        blind_folder.open_folder(tmp_path / "b", {**settings, "seed": 1})
