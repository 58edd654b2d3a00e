"""What is printed of finished runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmark.cli.console import Console
from benchmark.cli.show import show_runs
from benchmark.errors import SolverError
from benchmark.runs import RunOutcome


def stopped(name: str, folder: Path) -> RunOutcome:
    model = {"name": "fem", "failure": f"{name} folds", "last_state": None}
    return RunOutcome(folder / name, {"name": name, "models": {"fem": model}}, "Incomplete", False, ())


def test_each_tissue_that_stopped_has_its_own_folder_in_the_message(tmp_path: Path) -> None:
    gel, skin = stopped("gel", tmp_path), stopped("skin", tmp_path)
    with pytest.raises(SolverError) as one:
        show_runs([gel], Console(quiet=True), as_json=False)
    kept = f"Results up to there are in {gel.folder}, marked incomplete"
    assert str(one.value) == f"fem gel folds. {kept}"
    with pytest.raises(SolverError) as both:
        show_runs([gel, skin], Console(quiet=True), as_json=False)
    other = f"skin: fem skin folds. Results up to there are in {skin.folder}, marked incomplete"
    assert str(both.value) == f"gel: fem gel folds. {kept}. {other}"
