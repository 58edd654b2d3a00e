"""The five-line scripts, each run as a user would: by its file, from a folder of one's own."""

import os
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

import benchmark

SCRIPTS = Path(__file__).resolve().parents[2] / "examples" / "scripts"
SAYS = {
    "run": ("skin-5N: largest deflection", "epidermis", "report.html"),
    "own_model": ("skin-5N: largest deflection", "dermis"),
    "fit": ("stiff", "95 %"),
    "discover": ("conditional: ", "strain stiffening", "report.html"),
    "sweep": ("(3 of 3 points)", "dermis.youngs_modulus"),
}
LEAVES = {
    "run": ("deflections.csv", "press.svg", "press/report.html", "press/manifest.json"),
    "own_model": ("own_model.svg",),
    "fit": ("trials.svg", "parameters.csv"),
    "discover": ("gap.svg", "found/model.toml", "press/results.json"),
    "sweep": ("sweep.svg", "sweep/points.parquet", "sweep/report.html"),
}


def test_every_script_is_tried():
    assert {path.stem for path in SCRIPTS.glob("*.py")} == set(SAYS)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(SAYS))
def test_a_script_does_what_it_says(name, tmp_path):
    environment = {**os.environ, "PYTHONWARNINGS": "ignore"}
    done = subprocess.run(
        [sys.executable, SCRIPTS / f"{name}.py"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    check(name, done.stdout, tmp_path)


def check(name, said, folder):
    for words in SAYS[name]:
        assert words in said
    for file in LEAVES[name]:
        assert (folder / file).stat().st_size > 0


SMALL = {"fem.mesh": "coarse", "load.observations": "4", "fem.kinematics": "linear"}


def with_small_presses(verb, **more):
    def small(*arguments, set=None, **options):
        return verb(*arguments, set={**SMALL, **(set or {})}, **more, **options)

    return small


@pytest.mark.parametrize("name", ["own_model", "sweep"])
def test_a_script_does_so_with_a_small_press_in_this_process(name, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(vars(benchmark), "run", with_small_presses(benchmark.run))
    monkeypatch.setitem(vars(benchmark), "sweep", with_small_presses(benchmark.sweep, workers=1))
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(SCRIPTS / f"{name}.py"))
    check(name, capsys.readouterr().out, tmp_path)


def test_a_script_has_five_lines_or_so():
    for path in SCRIPTS.glob("*.py"):
        code = path.read_text().split('"""')[2].splitlines()
        assert sum(bool(line) and not line.startswith(("import ", "from ")) for line in code) <= 5
