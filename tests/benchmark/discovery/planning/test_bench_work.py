import tomllib

import pytest

from benchmark.discovery.planning.bench_work import session_copy
from benchmark.errors import InputError
from benchmark.experiments.menu import Usual, second_tools
from benchmark.files import load_session

USUAL = Usual(depth=1e-3, speed=2e-3, hold=0.5, thickness=20e-3)


def test_an_experiment_with_another_tool_joins_the_copy_with_that_tool_alone(bench, folder, proposal) -> None:
    (other,) = second_tools(USUAL, 5e-3, bench.allowed(set()).radii)  # the rig has tools of 5 and 8 mm
    wider = proposal(other)
    files = bench.record(wider, 2, 1)
    bench.add(wider, files)
    grown = load_session(bench.folder)
    assert [trial.condition for trial in grown.trials] == ["usual", "tool of 8 mm", "tool of 8 mm"]
    assert (
        tomllib.loads((bench.folder / "session.toml").read_text())["conditions"]["tool of 8 mm"]["tool"]["radius"]
        == "8 mm"
    )
    assert max(float(trial.table.force.max()) for trial in grown.trials[1:]) > 0.5
    assert [trial.condition for trial in load_session(folder / "session").trials] == ["usual"]


def test_a_folder_without_a_session_file_is_refused(tmp_path) -> None:
    with pytest.raises(InputError, match=r"--bench needs a session\.toml"):
        session_copy(tmp_path, tmp_path / "copy")
