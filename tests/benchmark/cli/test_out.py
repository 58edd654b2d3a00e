"""`--out` never loses what the program did not write: every byte of somebody else's survives every verb."""

import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from bench_hw.storage.folder_lock import locked
from benchmark.sessions import SHIPPED
from reports import whole_folder

PHANTOM = str(SHIPPED / "phantom")


def tree(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def theirs(here):
    """A folder that looks like a result, with raw data and a repository in it."""
    folder = here / "p"
    for name, text in {"results.json": "{}", "data/raw.csv": "x", ".git/HEAD": "ref", "check.json": "{}"}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


@pytest.fixture(autouse=True)
def nothing_is_computed(monkeypatch):
    """All of this is refused before the work begins."""

    def never(*_, **__):
        raise AssertionError("it began to compute")

    for name in (
        "benchmark.runs.fit_run.fit_trials",
        "benchmark.runs.requests.run_scenario",
        "benchmark.runs.requests.run_session",
        "benchmark.runs.requests.run_tissues",
        "benchmark.discovery.discovery_request.findings",
        "benchmark.reproduce.reproduction.gather",
        "benchmark.gate.checking._verdict",
        "benchmark.cli.verify._run",
        "benchmark.blind.running._work",
        "benchmark.sweeps.sweep_run._rows",
        "benchmark.runs.finished.carrying_out.read_run",
        "benchmark.discovery.discovery_request.read_run",
    ):
        monkeypatch.setattr(name, never)


VERBS = {
    "fit": ["fit", PHANTOM],
    "run": ["run", "skin-5N"],
    "run two tissues": ["run", "skin-5N", "--tissue", "skin_forearm", "--tissue", "dragon_skin_10"],
    "run trials": ["run", "--trials", PHANTOM],
    "discover": ["discover", PHANTOM],
    "check": ["check"],
    "reproduce": ["reproduce"],
    "verify": ["verify"],
    "blind": ["blind"],
    "sweep": ["sweep", "skin-5N", "--vary", "tool.radius=2 mm,3 mm"],
    "report": ["report", "a", "b"],
    "report one": ["report", "a"],
    "dossier": ["dossier", "a"],
    "assess": ["assess", "a"],
}


@pytest.mark.parametrize("verb", VERBS)
def test_a_folder_of_theirs_survives(benchmark_cli, theirs, verb):
    before = tree(theirs)
    called = benchmark_cli(*VERBS[verb], "--out", theirs)
    assert called.code == 2
    assert "raw.csv" in called.err or ".git" in called.err
    assert tree(theirs) == before


@pytest.mark.parametrize("verb", VERBS)
def test_a_file_and_a_place_that_cannot_be_made_are_refused(benchmark_cli, here, verb):
    (here / "thesis.tex").write_text("mine")
    for out in ("thesis.tex", "thesis.tex/deep"):
        called = benchmark_cli(*VERBS[verb], "--out", out)
        assert called.code == 2
        assert "thesis.tex" in called.err
    assert tree(here) == {"thesis.tex": b"mine"}


RINGS = {verb: [*words, "--out", "ring"] for verb, words in VERBS.items()} | {
    "in it": ["run", "skin-5N", "--out", "ring/p"],
    "gate": ["check", "--gate", "ring", "--out", "p"],
    "report of it": ["report", "ring"],
    "dossier of it": ["dossier", "ring", "--out", "p"],
    "assess of it": ["assess", "ring"],
}


@pytest.mark.parametrize("verb", RINGS)
def test_a_ring_of_links_is_refused_by_name(benchmark_cli, here, verb):
    """It was a fault of the program."""
    (here / "ring").symlink_to("ring")
    called = benchmark_cli(*RINGS[verb])
    assert called.code == 2
    assert "ring" in called.err
    assert "Too many levels of symbolic links" in " ".join(called.err.split())
    assert [path.name for path in here.iterdir()] == ["ring"]


@pytest.mark.parametrize("verb", VERBS)
def test_notes_beside_a_result_of_ours_survive(benchmark_cli, here, verb):
    with whole_folder(here / "p") as new:
        (new / "report.html").write_text("page")
    (here / "p" / "notes.txt").write_text("mine")
    before = tree(here)
    called = benchmark_cli(*VERBS[verb], "--out", "p")
    assert called.code == 2
    assert "notes.txt" in called.err
    assert tree(here) == before


UNFINISHED = {
    "sweep": ("sweep", ("journal.jsonl", "unfinished"), "sweep.json"),
    "blind run": ("blind run", ("cases.jsonl",), "settings.json"),
    "result": ("", ("journal.jsonl", "unfinished"), "sweep.json"),  # of a version that did not say what is at work
}


@pytest.mark.parametrize("kind", UNFINISHED)
@pytest.mark.parametrize("verb", [*VERBS, "shipped"])
def test_what_is_not_finished_is_replaced_by_no_command(benchmark_cli, here, verb, kind):
    """Hours of points went by one mistyped `--out`."""
    doing, growing, plan = UNFINISHED[kind]
    with whole_folder(here / "p", doing, growing) as new:
        (new / plan).write_text("{}")
    (here / "p" / growing[0]).write_text("{}\n")
    before = tree(here)
    called = benchmark_cli(*VERBS.get(verb, ["run"]), "--out", "p")
    assert called.code == 2
    said = " ".join(called.err.split())
    if (verb, plan) in (("sweep", "sweep.json"), ("blind", "settings.json")):
        assert "--out p" in said or "p/sweep.json" in said
    elif verb != "shipped":
        assert f"--out p holds an unfinished {kind} ({growing[0]}, {plan}" in said
    assert tree(here) == before


def test_the_shipped_runs_are_not_put_into_a_result(benchmark_cli, here):
    with whole_folder(here / "p") as new:
        (new / "report.html").write_text("page")
    before = tree(here)
    called = benchmark_cli("run", "--out", "p")
    assert (called.code, "--out p is a result" in called.err) == (2, True)
    assert tree(here) == before


def test_the_shipped_runs_look_at_both_folders_first(benchmark_cli, here):
    late = here / "p" / "skin-5N"
    late.mkdir(parents=True)
    (late / "notes.txt").write_text("mine")
    called = benchmark_cli("run", "--out", "p")
    assert (called.code, "notes.txt" in called.err) == (2, True)
    assert tree(here) == {"p/skin-5N/notes.txt": b"mine"}


@pytest.mark.parametrize("out", ["S", "./S/../S", "S/fit", "link", "."])
@pytest.mark.parametrize("verb", [["fit", "S"], ["run", "--trials", "S"], ["discover", "S"]])
def test_a_session_is_not_written_over(benchmark_cli, here, verb, out):
    (here / "S").mkdir()
    (here / "S" / "trial.csv").write_text("time_s,depth_mm,force_N\n")
    (here / "link").symlink_to("S")
    before = tree(here)
    called = benchmark_cli(*verb, "--out", out)
    assert called.code == 2
    assert "which is read" in called.err
    assert tree(here) == before


@pytest.mark.parametrize(
    "command",
    [
        ["discover", "press"],
        ["report", "press"],
        ["report", "press", "other"],
        ["run", "press/scenario.toml"],
        ["run", "skin-5N", "--model", "press/model.toml"],
        ["run", "skin-5N", "--reference", "press/max_deformation.csv"],
        ["run", "skin-5N", "--tissue", "press/tissue.toml"],
        ["fit", PHANTOM, "--model", "press/model.toml"],
        ["check", "--baseline", "press/baseline.json"],
        ["sweep", "press/scenario.toml", "--vary", "tool.radius=2 mm,3 mm"],
        ["sweep", "skin-5N", "--vary", "tissue=skin_forearm,press/tissue.toml"],
        ["sweep", "skin-5N", "--set", "load.file=press/max_deformation.csv", "--vary", "tool.radius=2 mm,3 mm"],
        ["dossier", "press"],
        ["assess", "press"],
    ],
)
def test_what_is_read_from_a_result_is_not_replaced_by_the_answer(benchmark_cli, here, command):
    shipped = Path(__file__).parents[3] / "benchmark" / "scenarios" / "skin-5N.toml"
    with whole_folder(here / "press") as new:
        for name in ("results.json", "model.toml", "max_deformation.csv", "tissue.toml", "baseline.json"):
            (new / name).write_text("" if name.endswith(".toml") else "{}")
        (new / "scenario.toml").write_bytes(shipped.read_bytes())
    before = tree(here)
    called = benchmark_cli(*command, "--out", "press")
    assert called.code == 2
    assert "which is read" in called.err
    assert tree(here) == before


@pytest.mark.parametrize("verb", [name for name in VERBS if name != "run two tissues"])
def test_a_second_command_into_the_same_folder_is_refused_by_name(here, benchmark_cli, verb):
    arguments = VERBS[verb]
    with locked(here / "p", "fit"):
        called = benchmark_cli(*arguments, "--out", "p")
    assert called.code == 2
    assert f"--out p is in use (fit, process {os.getpid()} on" in " ".join(called.err.split())
    assert list(here.iterdir()) == []


@pytest.mark.parametrize("verb", ["fit", "run", "discover", "check", "reproduce", "verify", "sweep"])
def test_too_little_room_is_found_before_computing(here, benchmark_cli, monkeypatch, verb):
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(total=1, used=1, free=1_000_000))
    called = benchmark_cli(*VERBS[verb], "--out", "p")
    assert called.code == 2
    said = " ".join(called.err.split())
    assert "--out p has too little room: 1 MB are free on its disk, and about" in said
    assert list(here.iterdir()) == []


def test_the_fields_of_every_step_count(here, benchmark_cli, monkeypatch):
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(total=1, used=1, free=60_000_000))
    called = benchmark_cli("run", "skin-5N", "--fields", "all", "--out", "p")
    assert called.code == 2
    assert "60 MB are free on its disk, and about 66 MB will be needed" in " ".join(called.err.split())
