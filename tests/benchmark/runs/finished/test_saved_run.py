import pytest

from benchmark.errors import InputError
from benchmark.runs.finished.saved_run import read_run


def test_the_result_of_another_verb_is_called_by_its_name(tmp_path):
    """`report` of a fit said that results.json was missing, and nothing of what the folder is."""
    (tmp_path / "fit.json").write_text("{}")
    (tmp_path / "manifest.json").write_text('{"program": "tissuebench", "schema": 1}')
    with pytest.raises(InputError, match=r"is a result of `fit` \(its own page is .*report.html\); needed: the result"):
        read_run(tmp_path)
