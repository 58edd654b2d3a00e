"""The five-line scripts, each run as a user would: by its file, from a folder of one's own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

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


SLOW = {"run", "discover", "fit"}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name for name in sorted(SAYS)]
)
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
    for words in SAYS[name]:
        assert words in done.stdout
    for file in LEAVES[name]:
        assert (tmp_path / file).stat().st_size > 0


def test_a_script_has_five_lines_or_so():
    for path in SCRIPTS.glob("*.py"):
        code = path.read_text().split('"""')[2].splitlines()
        assert sum(bool(line) and not line.startswith(("import ", "from ")) for line in code) <= 5
