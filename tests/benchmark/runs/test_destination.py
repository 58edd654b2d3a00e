from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.runs.destination import destination


def test_default_is_a_fresh_dated_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    first = destination(None, "skin 5/N <b>")
    assert first.parent == Path("results")
    assert first.name.startswith("skin-5-N-b-2")
    first.mkdir(parents=True)
    assert destination(None, "skin 5/N <b>") != first


@pytest.mark.parametrize("marker", ["results.json", "fit.json", "discovery.json"])
def test_an_earlier_result_may_be_replaced(tmp_path: Path, marker: str) -> None:
    (tmp_path / marker).touch()
    (tmp_path / "report.html").touch()
    assert destination(tmp_path, "x") == tmp_path


def test_new_and_empty_folders_are_taken(tmp_path: Path) -> None:
    assert destination(tmp_path, "x") == tmp_path
    assert destination(tmp_path / "new", "x") == tmp_path / "new"


def test_anything_else_is_refused(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(InputError, match="not a result of this program"):
        destination(tmp_path, "x")
    with pytest.raises(InputError, match="is a file"):
        destination(tmp_path / "thesis.tex", "x")
