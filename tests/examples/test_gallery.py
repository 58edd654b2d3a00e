"""The gallery: each script is on its page, and leaves its picture when a user runs it in a folder of their own."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = sorted((ROOT / "examples" / "gallery").glob("*.py"))


def test_every_script_is_on_the_page_and_says_what_it_shows() -> None:
    page = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    for path in SCRIPTS:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        assert ast.get_docstring(tree)
        assert f"examples/gallery/{path.name}" in page
        assert f'"{path.stem}.png"' in path.read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_leaves_its_picture(path: Path, tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONWARNINGS": "ignore", "MPLBACKEND": "Agg"}
    done = subprocess.run(
        [sys.executable, path], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=900
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert (tmp_path / f"{path.stem}.png").stat().st_size > 5000
